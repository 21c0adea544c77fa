// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/dig_path.hpp>

namespace excavplan {

/// Energy of one dig [J]: the sum over boom, arm and bucket of the integral of max(0, torque *
/// rate) over penetrate, drag and scoop. Negative work is not recovered.
struct EnergyLedger {
  double total = 0.0;                ///< of the dig, without the lift
  std::array<double, 3> by_phase{};  ///< penetrate, drag, scoop
  std::array<double, 3> by_joint{};  ///< boom, arm, bucket
  double soil = 0.0;                 ///< part of the total against the resistance of the soil
  double edge = 0.0;                 ///< of `soil`: against lip and teeth
  double payload = 0.0;              ///< part against the weight of the soil carried
  double links = 0.0;  ///< part against the weight of the links: the rest of the total
  double lift = 0.0;   ///< of the lift clear of the ground, not part of the total
};

/// Where the soil went [m^3]. Bank volumes are those of undisturbed soil, loose ones are swollen.
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

/// The machine could not continue. A result, not an error.
struct Stall {
  /// What gave way (docs/methods.md#machine).
  enum class Cause {
    torque,       ///< of a joint
    front_lifts,  ///< the machine tips over its rear edge
    rear_lifts,   ///< the machine tips over its front edge
    slides        ///< the machine slides on its tracks
  };
  DigPhase phase = DigPhase::penetrate;  ///< in which the dig ended
  Joint joint = Joint::boom;             ///< that lacked torque; the boom for another cause
  double travelled = 0.0;                ///< tip travel from the start of the dig [m]
  double torque = 0.0;                   ///< that the joint needed [N m]; 0 for another cause
  Cause cause = Cause::torque;           ///< what gave way
  /// Of the joint's torque [N m], of the moment of soil and payload about the edge [N m], or of
  /// their force along the ground [N]: what the dig takes, and what the machine holds.
  double needed = 0.0;
  double held = 0.0;  ///< likewise
};
/// "torque", "front_lifts", "rear_lifts" or "slides", as in files.
const char* name(Stall::Cause cause);

/// Forces in the middle of one step.
struct ForceSample {
  DigPhase phase = DigPhase::penetrate;            ///< of the step
  double travelled = 0.0;                          ///< tip travel [m]
  JointAngles joints = JointAngles::Zero();        ///< [rad]
  Eigen::Vector2d soil = Eigen::Vector2d::Zero();  ///< of the soil on the bucket (x, z) [N]
  JointAngles torque = JointAngles::Zero();        ///< of the joints [N m]
  double bucket_fill = 0.0;                        ///< loose [m^3]
};

/// What a dig lifts, costs and leaves behind.
struct DigResult {
  TerrainPatch patch;                ///< all cells that changed, afterwards
  double payload_mass = 0.0;         ///< moist [kg]
  double payload_volume = 0.0;       ///< loose [m^3]
  EnergyLedger energy;               ///< [J]
  SoilLedger soil;                   ///< [m^3]
  double peak_force = 0.0;           ///< largest force of the soil on the bucket [N]
  std::optional<Stall> stall;        ///< nothing: the machine finished the path
  bool given_up = false;             ///< ended early: DigOptions::give_up_below
  std::vector<ForceSample> history;  ///< empty unless requested
  /// Of the joints [N m], half-way from each pose of the path to the next, as far as the machine
  /// came. time_dig_path() takes them; a simulator may leave them out.
  std::vector<JointAngles> torques;

  /// The whole terrain afterwards.
  Terrain after(const Terrain& before) const {
    Terrain terrain = before;
    apply(patch, terrain);
    return terrain;
  }

  /// The paper's eq. 8, f = payload mass / energy [kg/J]; 0 without energy.
  double efficiency() const { return energy.total > 0.0 ? payload_mass / energy.total : 0.0; }
};

/// Settings of SoilSimulator::dig().
struct DigOptions {
  bool history = false;                    ///< record the forces
  std::optional<Eigen::Vector2d> dump_at;  ///< heap the payload here; else it stays in the bucket

  // For searches, which need only the efficiency of many digs. A simulator may ignore all three.

  /// Let the ground come to rest once the bucket is out. If false, the patch, spilled and
  /// fallen_back are those of ground that still slides; payload and energy are the same.
  bool settle = true;
  /// End the dig as soon as its efficiency cannot reach this any more [kg/J]: the energy never
  /// falls, and the payload is at most what the bucket holds in its last attitude. Such a dig is
  /// `given_up`; its efficiency() is below this value, its other figures are incomplete.
  double give_up_below = 0.0;
  bool worth_alone = false;  ///< no patch, and of the soil ledger only what was cut and payload
};

/// A simulation of one dig on one terrain: the interface of a simulator of your own.
///
/// An implementation returns the same bytes for the same arguments, may be called from several
/// threads at once, conserves solids to 1e-9, leaves unknown cells unknown, and reads no more of
/// the terrain than it digs, so that the size of the map does not matter.
/// tests/support/soil_simulator_contract.hpp checks this for any implementation.
///
/// Whatever plans, searches, calibrates or rehearses with a simulator does not trust it: an
/// exception, a number that is not finite or is negative, results of a wrong size, and a payload
/// that was lifted with less energy than its weight takes (docs/methods.md#energy) are refused by
/// an Error (bad_input) with the simulator's name. A search counts such a dig as failed and goes
/// on; where one dig is asked for the error is passed on. A simulator that does not return, or ends
/// the process, cannot be stopped from inside of it.
class SoilSimulator {
 public:
  virtual ~SoilSimulator() = default;

  /// Digs along the path.
  ///
  /// @throws Error (bad_input) if the path leaves the map or its known cells, the map is empty, a
  ///         layer is negative or a void ratio out of range where the dig works, or the dump point
  ///         lies off the map
  virtual DigResult dig(const Terrain& terrain, const DigPath& path,
                        const DigOptions& options = {}) const = 0;

  /// All that determines a dig besides its arguments, as text: name and version of the simulator,
  /// fingerprints of machine and soil, density. A search refuses a checkpoint of another identity.
  /// Empty: a search identifies the simulator by the results of a few digs. Messages name a
  /// simulator by its identity up to the first comma, or by its class.
  virtual std::string identity() const { return {}; }
};

}  // namespace excavplan
