// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/dig_path.hpp>

namespace excavplan {

/// Ground in two layers on one grid. Unknown cells are NaN in `bank`; nothing moves on or off them.
struct Terrain {
  HeightMap bank;         ///< top of the undisturbed soil [m]
  Eigen::ArrayXXd loose;  ///< thickness of the loose soil on it [m], >= 0, same size

  /// Void ratio of the undisturbed soil, the same down a whole cell, in the soil's
  /// void_ratio_min .. void_ratio_max [-]. Empty: all of it as dense as the simulator was told.
  Eigen::ArrayXXd bank_void_ratio{};
  /// Void ratio of the loose layer, in the soil's void_ratio_min .. void_ratio_loose [-]. Empty:
  /// all of it is void_ratio_loose, to which all soil swells that is dug or slides.
  Eigen::ArrayXXd loose_void_ratio{};

  HeightMap surface() const;  ///< bank + loose
};

/// Undisturbed ground of this surface, with no loose soil.
Terrain undisturbed(const HeightMap& surface);

/// A block of a terrain's cells in a new state.
struct TerrainPatch {
  Eigen::Index row = 0;  ///< of the block's first cell on the whole terrain
  Eigen::Index col = 0;
  Eigen::ArrayXXd bank;              ///< top of the undisturbed soil [m]
  Eigen::ArrayXXd loose;             ///< [m]
  Eigen::ArrayXXd loose_void_ratio;  ///< empty if the terrain's is
};

/// Puts a patch onto the terrain it was made for.
void apply(const TerrainPatch& patch, Terrain& terrain);

/// Energy of one dig [J]: design section 5. Every total is the sum over boom, arm and bucket of the
/// integral of max(0, torque * rate) over penetrate, drag and scoop; no energy comes back.
struct EnergyLedger {
  double total = 0.0;
  std::array<double, 3> by_phase{};  ///< penetrate, drag, scoop
  std::array<double, 3> by_joint{};  ///< boom, arm, bucket
  double soil = 0.0;                 ///< share of the total that the soil's resistance took
  double payload = 0.0;              ///< share that the soil carried took
  double links = 0.0;  ///< share that the weight of the links took; the three add up to the total
  double lift = 0.0;   ///< of the lift clear of the ground, not part of the total
};

/// Where the soil went. Bank volumes are undisturbed, loose volumes are swollen [m^3].
struct SoilLedger {
  double bank_cut = 0.0;           ///< undisturbed soil cut
  double loose_cut = 0.0;          ///< loose soil cut again
  double payload = 0.0;            ///< loose, in the bucket once it is clear of the ground
  double spilled = 0.0;            ///< loose, left on ground that was not cut
  double fallen_back = 0.0;        ///< loose, lying in the pit at the end
  double fallback_fraction = 0.0;  ///< fallen_back / bank_cut [-]
  double solids_before = 0.0;  ///< dry mass of the patch above its and the path's lowest point [kg]
  double solids_after = 0.0;   ///< the same plus what is in the bucket [kg]
};

/// The machine could not go on. A result, not an error.
struct Stall {
  DigPhase phase = DigPhase::penetrate;
  Joint joint = Joint::boom;
  double travelled = 0.0;  ///< tip travel from the start of the dig [m]
  double torque = 0.0;     ///< that was asked of the joint [N m]
};

/// Forces half-way of one step.
struct ForceSample {
  DigPhase phase = DigPhase::penetrate;
  double travelled = 0.0;                          ///< tip travel [m]
  JointAngles joints = JointAngles::Zero();        ///< [rad]
  Eigen::Vector2d soil = Eigen::Vector2d::Zero();  ///< of the soil on the bucket (x, z) [N]
  JointAngles torque = JointAngles::Zero();        ///< of the joints [N m]
  double bucket_fill = 0.0;                        ///< loose [m^3]
};

struct DigResult {
  TerrainPatch patch;           ///< every cell that changed, as it is afterwards
  double payload_mass = 0.0;    ///< moist [kg]
  double payload_volume = 0.0;  ///< loose [m^3]
  EnergyLedger energy;
  SoilLedger soil;
  double peak_force = 0.0;  ///< largest force of the soil on the bucket [N]
  std::optional<Stall> stall;
  bool given_up = false;             ///< ended early, as DigOptions::give_up_below says
  std::vector<ForceSample> history;  ///< empty unless asked for

  /// The whole terrain afterwards.
  Terrain after(const Terrain& before) const;

  /// The paper's eq. 7, f = payload mass / energy [kg/J]; 0 without energy.
  double efficiency() const { return energy.total > 0.0 ? payload_mass / energy.total : 0.0; }
};

struct DigOptions {
  bool history = false;
  std::optional<Eigen::Vector2d> dump_at;  ///< heap the payload here; else it stays in the bucket

  // For searches, which care for the efficiency of many digs. A simulator may ignore both.

  /// Let the ground come to rest once the bucket is out. If not, only the patch and the account of
  /// spilled and fallen_back are those of ground still sliding; payload and energy are the same.
  bool settle = true;
  /// End the dig as soon as its efficiency cannot reach this any more [kg/J]: the energy spent
  /// never falls, and the payload is at most what the bucket holds in its last attitude. Such a dig
  /// is `given_up`; its efficiency() is below this, but else it is no guide to the whole dig.
  double give_up_below = 0.0;
};

/// A simulation of one dig on one terrain, ours or yours.
///
/// An implementation returns the same bytes for the same arguments, may be called from several
/// threads at once, conserves solids to 1e-9, leaves unknown cells unknown, and looks at no more of
/// the terrain than it digs: the size of the map costs nothing.
/// tests/soil_simulator_contract.hpp checks this for any implementation.
class SoilSimulator {
 public:
  virtual ~SoilSimulator() = default;

  /// @throws Error (bad_input) if the path leaves the map or its known cells, the map is empty, a
  ///         layer is negative or a void ratio out of range where the dig works, or the dump point
  ///         lies off the map
  virtual DigResult dig(const Terrain& terrain, const DigPath& path,
                        const DigOptions& options = {}) const = 0;

  /// All that decides its digs besides their arguments, as text: with its name and version, the
  /// fingerprints of machine and soil, the density. The checkpoint of a search is refused by
  /// another identity. Empty: a search knows the simulator by what it says of a few digs alone.
  virtual std::string identity() const { return {}; }
};

/// Volumes of a dig straight from the height maps, cell by cell, as the paper does in its
/// simulator.
struct HeightMapVolumes {
  double excavated = 0.0;       ///< ground that fell [m^3]
  double spilled = 0.0;         ///< ground that rose away from the heap [m^3]
  double dumped = 0.0;          ///< ground that rose within `dump_radius` of the dump point [m^3]
  double bulking_factor = 0.0;  ///< (spilled + dumped) / excavated; 0 if nothing was excavated
};
HeightMapVolumes height_map_volumes(const Terrain& before, const Terrain& after,
                                    const Eigen::Vector2d& dump_at, double dump_radius = 2.0);

/// Slope of the heap that rose at `at`, mean of its flank between a quarter and three quarters of
/// its radius over 36 directions [rad]; NaN if nothing rose there.
double heap_slope(const Terrain& before, const Terrain& after, const Eigen::Vector2d& at);

}  // namespace excavplan
