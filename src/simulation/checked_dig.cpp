// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/checked_dig.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <typeinfo>

#include <cxxabi.h>

#include <excavplan/base/error.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "ground/map_check.hpp"
#include "ground/terrain.hpp"
#include "machine/machine_mass.hpp"
#include "simulation/bucket_cavity.hpp"
#include "simulation/dig_account.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

/// Lifting the payload by so much takes less than any dig: of digs in the built-in soils over the
/// search ranges none has more than a third of that efficiency [m]; ours.
constexpr double least_rise = 0.1;
constexpr double rounding = 1e-6;  // of an energy

// ---- whose it is --------------------------------------------------------------------------------

std::string class_of(const SoilSimulator& simulator) {
  const char* mangled = typeid(simulator).name();
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(
      abi::__cxa_demangle(mangled, nullptr, nullptr, &status), &std::free);
  const std::string whole = status == 0 ? name.get() : mangled;
  const std::size_t scope = whole.rfind("::");
  return scope == std::string::npos ? whole : whole.substr(scope + 2);
}

/// Of its identity the part that names it, or its class.
std::string name_of(const SoilSimulator& simulator) {
  try {
    const std::string identity = simulator.identity();
    if (!identity.empty()) return identity.substr(0, identity.find(','));
  } catch (...) {  // NOLINT(bugprone-empty-catch): then its class names it
  }
  return class_of(simulator);
}

[[noreturn]] void blame(const std::string& name, const std::string& what) {
  throw Error(ErrorKind::bad_input, "simulator " + in_quotes(name) + ": " + what);
}

/// What a call to a user's code gives. A lack of memory is not its fault.
template <typename Call, typename Name>
auto asked(const Call& call, const Name& name) -> decltype(call()) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Error& error) {
    throw Error(error.kind(), "simulator " + in_quotes(name()) + ": " + error.what());
  } catch (const std::exception& error) {
    blame(name(), std::string("it threw: ") + error.what());
  } catch (...) {
    blame(name(), "it threw something that is no std::exception");
  }
}

// ---- what a dig can have ------------------------------------------------------------------------

/// Looks at one result; the name is only made if there is something to say.
class Examination {
 public:
  Examination(const SoilSimulator& simulator, const DigResult& result)
      : simulator_(simulator), result_(result) {}

  [[noreturn]] void fail(const std::string& what) const { blame(name_of(simulator_), what); }

  void not_negative(const char* what, double value) const {
    if (value >= 0.0 && std::isfinite(value)) return;
    fail(std::string("its dig has ") + what + " of " + number_text(value) +
         ", must be finite and not negative");
  }
  void finite(const char* what, double value) const {
    if (!std::isfinite(value)) {
      fail(std::string("its dig has ") + what + " of " + number_text(value) + ", must be finite");
    }
  }

  void check_numbers() const {
    not_negative("a payload_mass [kg]", result_.payload_mass);
    not_negative("a payload_volume [m^3]", result_.payload_volume);
    if (result_.payload_volume > 0.0 && result_.payload_mass == 0.0) {
      fail("its dig has a payload of " + number_text(result_.payload_mass) + " kg in " +
           number_text(result_.payload_volume) + " m^3");
    }
    const EnergyLedger& energy = result_.energy;
    not_negative("an energy.total [J]", energy.total);
    for (const double part : energy.by_phase) not_negative("an energy.by_phase [J]", part);
    for (const double part : energy.by_joint) not_negative("an energy.by_joint [J]", part);
    not_negative("an energy.lift [J]", energy.lift);
    for (const double part : {energy.soil, energy.edge, energy.payload, energy.links}) {
      finite("a part of the energy [J]", part);
    }
    const SoilLedger& soil = result_.soil;
    for (const double volume : {soil.bank_cut, soil.loose_cut, soil.payload}) {
      not_negative("a volume of the soil ledger [m^3]", volume);
    }
    for (const double number : {soil.spilled, soil.fallen_back, soil.fallback_fraction,
                                soil.solids_before, soil.solids_after}) {
      finite("a number of the soil ledger", number);
    }
    not_negative("a peak_force [N]", result_.peak_force);
    if (const auto& stall = result_.stall) {
      for (const double number : {stall->travelled, stall->torque, stall->needed, stall->held}) {
        finite("a number of the stall", number);
      }
    }
  }

  /// No bucket holds more, and no soil is denser (SoilKind::specific_gravity).
  void check_load(const Machine& machine) const {
    constexpr double most_heaped = 3.0;  // over the struck capacity; ours
    constexpr double densest = 1e4;      // [kg/m^3]
    const double room = most_heaped * struck_capacity(machine);
    if (result_.payload_volume > room || result_.payload_mass > densest * room ||
        (result_.payload_volume > 0.0 && result_.payload_mass > densest * result_.payload_volume)) {
      fail("its dig has a payload of " + plain_number(result_.payload_mass) + " kg in " +
           number_text(result_.payload_volume) + " m^3, the bucket holds " +
           number_text(struck_capacity(machine)) + " m^3 struck");
    }
  }

  void check_torques(const DigPath& path) const {
    if (result_.torques.size() >= path.poses.size()) {
      fail("its dig has " + std::to_string(result_.torques.size()) + " torques between " +
           std::to_string(path.poses.size()) + " poses, must be fewer");
    }
    for (const JointAngles& torque : result_.torques) {
      if (!torque.allFinite()) fail("its dig has a torque that is not finite");
    }
  }

  /// It enters the terrain as it was dug: unknown cells stay unknown, and known ones known.
  void check_patch(const Terrain& terrain) const {
    const TerrainPatch& patch = result_.patch;
    try {
      require_patch(patch, terrain);
    } catch (const Error& error) {
      fail(std::string("its dig leaves a ") + error.what());
    }
    for (Index col = 0; col < patch.bank.cols(); ++col) {
      for (Index row = 0; row < patch.bank.rows(); ++row) {
        const bool unknown = std::isnan(terrain.bank.z(patch.row + row, patch.col + col));
        const double bank = patch.bank(row, col);
        if (unknown && std::isnan(bank) && !(std::abs(patch.loose(row, col)) > farthest_height)) {
          continue;
        }
        const double loose = patch.loose(row, col);
        if (!unknown && std::abs(bank) <= farthest_height && loose >= 0.0 &&
            loose <= farthest_height && has_void_ratio(row, col)) {
          continue;
        }
        fail("its dig leaves a bank of " + number_text(bank) + " m and a loose layer of " +
             number_text(loose) + " m" +
             (has_void_ratio(row, col) ? "" : ", whose void ratio is none,") +
             " where the ground was " + (unknown ? "un" : "") + "known");
      }
    }
  }

  void check_energy(const Machine& machine, const Terrain& terrain, const DigPath& path) const;

 private:
  /// Of the loose layer, where the patch has one.
  bool has_void_ratio(Index row, Index col) const {
    const Eigen::ArrayXXd& ratio = result_.patch.loose_void_ratio;
    return ratio.size() == 0 || (ratio(row, col) > 0.0 && ratio(row, col) <= most_void_ratio);
  }

  const SoilSimulator& simulator_;
  const DigResult& result_;
};

/// Sum of mass times height of boom, arm and bucket [kg m].
double moment_of_links(const Machine& machine, const JointAngles& joints) {
  const auto centres = link_centres(machine, link_positions(machine, joints));
  double sum = 0.0;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    sum += machine.links[i].mass * centres[i].dot(machine.up());
  }
  return sum;
}

/// Of the surface over which the bucket passes, along `up` [m].
double highest_ground(const Terrain& terrain, const DigPath& path, const Eigen::Vector2d& up) {
  const auto [first, last] = std::minmax_element(
      path.poses.begin(), path.poses.end(),
      [](const DigPose& a, const DigPose& b) { return a.bucket.x < b.bucket.x; });
  const HeightMap& map = terrain.bank;
  double highest = -farthest_height;
  for (Index col = 0; col < map.z.cols(); ++col) {
    const bool under = map.x(col) >= first->bucket.x - map.cell_size &&
                       map.x(col) <= last->bucket.x + map.cell_size;
    for (Index row = 0; under && row < map.z.rows(); ++row) {
      const double height =
          up.dot(Eigen::Vector2d(map.x(col), map.z(row, col) + terrain.loose(row, col)));
      if (height > highest) highest = height;
    }
  }
  return highest;
}

/// Lifting the payload above the ground takes no more than the dig's energy and what the weight of
/// the links gives while they sink (docs/methods.md#energy).
void Examination::check_energy(const Machine& machine, const Terrain& terrain,
                               const DigPath& path) const {
  const double weight = gravity * result_.payload_mass;
  const double energy = result_.energy.total;
  const auto lifting = [&](double rise) {
    if (weight * rise <= (1.0 + rounding) * energy) return;
    fail("its dig lifts " + number_text(result_.payload_mass) + " kg with " + number_text(energy) +
         " J, less than raising it by " + readable(rise) + " m takes");
  };
  lifting(least_rise);
  auto end = std::find_if(path.poses.begin(), path.poses.end(),
                          [](const DigPose& pose) { return pose.phase == DigPhase::lift; });
  const DigPose& first = path.poses.front();
  const DigPose& last = end == path.poses.begin() ? first : *std::prev(end);
  const Eigen::Vector2d up = machine.up();
  const Eigen::Vector2d first_tip(first.bucket.x, first.bucket.z);
  const Eigen::Vector2d last_tip(last.bucket.x, last.bucket.z);
  // Nothing in the bucket lies higher above its tip than its pin can.
  if (weight * (up.dot(last_tip) + machine.bucket_length - up.dot(first_tip)) <= energy) return;
  Cavity cavity(machine.bucket);
  cavity.turn_to(link_positions(machine, last.joints).phi3);
  const double held = std::min(result_.payload_volume, struck_capacity(machine));
  const double rise =
      up.dot(last_tip + cavity.packed(held).centroid) - highest_ground(terrain, path, up);
  const double released =
      gravity * (moment_of_links(machine, first.joints) - moment_of_links(machine, last.joints));
  lifting(rise - std::max(0.0, released) / weight);
}

}  // namespace

std::unique_ptr<const SoilSimulator> make_simulator(const SimulatorKind& kind,
                                                    const Machine& machine, const SoilKind& soil,
                                                    double density_percent) {
  if (!kind.make) blame(kind.name, "it has no function that makes one");
  auto simulator =
      asked([&] { return kind.make(machine, soil, density_percent); }, [&] { return kind.name; });
  if (!simulator) blame(kind.name, "the function that makes one gave none");
  return simulator;
}

std::string checked_identity(const SoilSimulator& simulator) {
  return asked([&] { return simulator.identity(); }, [&] { return class_of(simulator); });
}

DigResult checked_dig(const SoilSimulator& simulator, const Machine& machine,
                      const Terrain& terrain, const DigPath& path, const DigOptions& options) {
  check_dig(terrain, path);
  DigResult result = asked([&] { return simulator.dig(terrain, path, options); },
                           [&] { return name_of(simulator); });
  const Examination examination(simulator, result);
  examination.check_numbers();
  examination.check_load(machine);
  examination.check_torques(path);
  if (options.settle) examination.check_patch(terrain);
  if (result.given_up && !(options.give_up_below > 0.0)) {
    examination.fail("its dig gave up, which it was not allowed to");
  }
  const bool whole = !result.stall && !result.given_up;
  if (whole && result.payload_mass > 0.0) examination.check_energy(machine, terrain, path);
  return result;
}

}  // namespace excavplan
