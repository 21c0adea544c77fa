// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/dig_account.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "simulation/slump.hpp"

namespace excavplan {

void check_dig(const Terrain& terrain, const DigPath& path) {
  const HeightMap& map = terrain.bank;
  if (map.z.size() == 0) refuse("dig: the map is empty");
  require(map.cell_size > 0.0, "dig: cell size", map.cell_size, "above 0 m");
  const auto same_size = [&](const Eigen::ArrayXXd& layer) {
    return layer.rows() == map.z.rows() && layer.cols() == map.z.cols();
  };
  if (!same_size(terrain.loose)) refuse("dig: the loose layer must be as large as the map");
  for (const Eigen::ArrayXXd* layer : {&terrain.bank_void_ratio, &terrain.loose_void_ratio}) {
    if (layer->size() > 0 && !same_size(*layer))
      refuse("dig: void ratios must be as large as the map");
  }
  if (path.poses.size() < 2) {
    refuse("dig: a path has at least 2 poses, this one has " + std::to_string(path.poses.size()));
  }
  for (const DigPose& pose : path.poses) {
    if (std::isfinite(pose.bucket.x) && std::isfinite(pose.bucket.z)) continue;
    refuse("dig: every pose of the path must be finite");
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
    result.stall = Stall{step.phase, static_cast<Joint>(j), travelled_, torque(j)};
    return true;
  }
  return false;
}

void DigAccount::book(const DigStep& step) {
  EnergyLedger& energy = result.energy;
  const JointAngles torque = step.torque();
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
