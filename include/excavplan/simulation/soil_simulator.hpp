// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/terrain.hpp>

namespace excavplan {

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
  Terrain after(const Terrain& before) const {
    Terrain terrain = before;
    apply(patch, terrain);
    return terrain;
  }

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

}  // namespace excavplan
