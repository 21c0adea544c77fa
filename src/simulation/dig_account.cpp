// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/dig_account.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "earth/slump.hpp"
#include "ground/map_check.hpp"
#include "ground/terrain.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

constexpr double largest_angle = 100.0;  // of a joint, as for a trajectory [rad]

/// More than the machine holds: as in Stall.
struct Excess {
  Stall::Cause cause;
  double needed;
  double held;
};

/// Equilibrium of the machine on its tracks; derivation: docs/methods.md#machine. Moments are
/// counter-clockwise, so positive ones lift the front; torques of the boom are those about its pin.
std::optional<Excess> lifted_or_dragged(const Machine& machine, const DigStep& step) {
  if (!machine.body) return std::nullopt;
  const Body& body = *machine.body;
  double links = 0.0;
  for (const LinkMass& link : machine.links) links += gravity * link.mass;
  const double weight = gravity * body.mass;
  const auto of_bucket = [&](double edge) {
    const Eigen::Vector2d pin(machine.boom_pin.x() - edge, machine.boom_pin.y());
    return step.by_soil[0] + step.by_payload[0] + cross(pin, step.force);
  };
  const Eigen::Vector2d up = machine.up();
  const auto of_weight = [&](double edge) {
    const Eigen::Vector2d foot(edge, 0.0);
    return step.by_links[0] - links * cross(machine.boom_pin - foot, up) -
           weight * cross(body.centre - foot, up);
  };
  const Eigen::Vector3d down = -(weight + links) * machine.attitude.up();
  const double along = std::hypot(step.force.x() + down.x(), down.y());
  const double on_ground = std::max(0.0, -down.z() - step.force.y());
  for (const Excess& excess :
       {Excess{Stall::Cause::front_lifts, of_bucket(body.rear_edge), -of_weight(body.rear_edge)},
        Excess{Stall::Cause::rear_lifts, -of_bucket(body.front_edge), of_weight(body.front_edge)},
        Excess{Stall::Cause::slides, along, body.track_friction * on_ground}}) {
    if (excess.needed > excess.held) return excess;
  }
  return std::nullopt;
}

}  // namespace

const char* name(Stall::Cause cause) {
  switch (cause) {
    case Stall::Cause::torque:
      return "torque";
    case Stall::Cause::front_lifts:
      return "front_lifts";
    case Stall::Cause::rear_lifts:
      return "rear_lifts";
    case Stall::Cause::slides:
      return "slides";
  }
  return "unknown cause";
}

void check_dig(const Terrain& terrain, const DigPath& path) {
  require_terrain(terrain, "dig");
  if (path.poses.size() < 2) {
    refuse("dig: a path has at least 2 poses, this one has " + std::to_string(path.poses.size()));
  }
  for (const DigPose& pose : path.poses) {
    require(std::isfinite(pose.bucket.x), "dig: x of a pose [m]", pose.bucket.x, "finite");
    require(std::isfinite(pose.bucket.floor_angle), "dig: floor angle of a pose [rad]",
            pose.bucket.floor_angle, "finite");
    require_in("dig: z of a pose [m]", pose.bucket.z, -farthest_height, farthest_height);
    for (const double angle : pose.joints) {
      require_in("dig: joint angle of a pose [rad]", angle, -largest_angle, largest_angle);
    }
    if (pose.phase >= DigPhase::penetrate && pose.phase <= DigPhase::lift) continue;
    refuse("dig: every pose must be of a phase from penetrate to lift");
  }
}

std::string simulator_identity(const std::string& name, const Machine& machine,
                               const SoilKind& soil, double density_percent) {
  return name + ", machine " + fingerprint(machine) + ", soil " + fingerprint(soil) + " at " +
         number_text(density_percent) + " %";
}

DigAccount::DigAccount(const Machine& machine, const DigPath& path, const DigOptions& options)
    : machine_(machine), path_(path), options_(options) {
  if (options.history) result.history.reserve(path.poses.size());
  result.torques.reserve(path.poses.size());
}

void DigAccount::note_force(const DigStep& step, const Eigen::Vector2d& force, double fill) {
  result.peak_force = std::max(result.peak_force, force.norm());
  if (!options_.history) return;
  result.history.push_back(
      {step.phase, travelled_ + 0.5 * step.length, step.joints, force, step.torque(), fill});
}

bool DigAccount::stalls(const DigStep& step) {
  const JointAngles torque = step.torque();
  for (int j = 0; j < 3; ++j) {
    const double highest = machine_.limits[static_cast<std::size_t>(j)].torque;
    if (!(torque(j) * step.turn(j) > 0.0) || std::abs(torque(j)) <= highest) continue;
    result.stall = Stall{step.phase,           static_cast<Joint>(j), travelled_, torque(j),
                         Stall::Cause::torque, std::abs(torque(j)),   highest};
    return true;
  }
  if (const auto excess = lifted_or_dragged(machine_, step)) {
    result.stall = Stall{step.phase,    Joint::boom,    travelled_,  0.0,
                         excess->cause, excess->needed, excess->held};
  }
  return result.stall.has_value();
}

void DigAccount::book(const DigStep& step) {
  EnergyLedger& energy = result.energy;
  const JointAngles torque = step.torque();
  if (!result.stall) result.torques.push_back(torque);
  const int end = result.stall ? static_cast<int>(result.stall->joint) : 3;
  for (int j = 0; j < end; ++j) {
    const double work = torque(j) * step.turn(j);
    if (work <= 0.0) continue;
    if (step.phase == DigPhase::lift) {
      energy.lift += work;
      continue;
    }
    const int phase = static_cast<int>(step.phase) - static_cast<int>(DigPhase::penetrate);
    energy.total += work;
    energy.by_joint[static_cast<std::size_t>(j)] += work;
    energy.by_phase[static_cast<std::size_t>(phase)] += work;
    energy.soil += step.by_soil(j) * step.turn(j);
    energy.edge += step.by_edge(j) * step.turn(j);
    energy.payload += step.by_payload(j) * step.turn(j);
    energy.links += step.by_links(j) * step.turn(j);
  }
}

void DigAccount::close(GroundWindow& ground, double fill, double repose) {
  const SoilState& loose = ground.soil().loose;
  result.payload_volume = fill;
  result.payload_mass = fill * loose.bulk_density;
  SoilLedger& ledger = result.soil;
  ledger.payload = fill;
  if (options_.worth_alone) return;
  if (ledger.bank_cut > 0.0) ledger.fallback_fraction = ledger.fallen_back / ledger.bank_cut;
  if (options_.dump_at) pour(ground, *options_.dump_at, fill, repose);
  double lowest = ground.lowest();
  for (const DigPose& pose : path_.poses) lowest = std::min(lowest, pose.bucket.z);
  const double carried = options_.dump_at ? 0.0 : fill;
  ledger.solids_before = ground.solids_before(lowest);
  ledger.solids_after = ground.solids(lowest) + carried * loose.dry_density;
  result.patch = ground.patch();
}

}  // namespace excavplan
