// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/job_reference.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <excavplan/planning/dig_cycle.hpp>
#include <excavplan/planning/dig_goal.hpp>
#include <excavplan/trial/job_score.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "planning/front_load.hpp"
#include "trial/scored_design.hpp"

namespace excavplan {
namespace {

/// Least work to part soil from the ground, per volume: a wedge without weight ahead of a smooth
/// plate of the rake of the lip (Coulomb), over all planes of rupture [J/m^3].
double rupture(const SoilState& soil, double rake) {
  const double phi = soil.friction_angle;
  double least = std::numeric_limits<double>::infinity();
  constexpr double step = 0.01;
  for (double plane = step; plane + rake + phi < pi - step; plane += step) {
    const double force = soil.cohesion * std::cos(phi) * std::sin(rake) /
                         (std::sin(plane) * std::sin(rake + plane + phi));
    least = std::min(least, force);
  }
  return least;
}

/// Height of a ridge of this volume at its angle of repose along the design, or of the truck's bed.
double windrow_height(const SiteBrief& site, double loose) {
  if (site.job.dump_areas.empty() && site.job.truck) return site.job.truck->bed_height;
  const Rectangle all = extent_of(site.design);
  const double length = site.job.words ? site.job.words->length
                                       : std::max(all.x_max - all.x_min, all.y_max - all.y_min);
  return std::sqrt(loose / length * std::tan(site.soil.angle_of_repose));
}

/// Positive work of the joints that raise a full bucket, its mouth level, from a depth over a
/// height in the middle of the reach [J].
double lift(const Machine& machine, double payload, double depth, double height) {
  const double reach = 0.6 * machine.full_length();  // ours
  const BucketPose low = {reach, -depth, pi - machine.beta()};
  const auto joints = inverse_kinematics(machine, low);
  const FrontLoad front(machine, payload);
  if (!std::holds_alternative<JointAngles>(joints)) return payload * gravity * (depth + height);
  const JointAngles from = std::get<JointAngles>(joints);
  const JointAngles to = raised(machine, from, height + machine.bucket_length);
  constexpr int steps = 32;
  double work = 0.0;
  for (int i = 0; i < steps; ++i) {
    const JointAngles middle = from + (i + 0.5) / steps * (to - from);
    work += (front.torque(middle).array() * (to - from).array() / steps).max(0.0).sum();
  }
  return work;
}

}  // namespace

JobReference job_reference(const HiddenSite& site, const Machine& machine,
                           const FullDigOptions& options) {
  const ScoredDesign design = scored_design(site.known, site.ground.surface());
  const double cell = site.ground.bank.cell_size;
  const double area = cell * cell * design.share.sum();
  JobReference reference;
  reference.density_percent = mean_density(site);
  reference.design_cut = design.below(site.ground.bank.z);
  require(area > 0.0, "reference of a job: the design lies nowhere below the ground");
  const SoilState bank = bank_state(site.soil, reference.density_percent);
  reference.swollen =
      reference.design_cut * bulking_of_density(site.soil, reference.density_percent);

  const auto best = best_full_dig(machine, site.soil, reference.density_percent, options);
  reference.energy = reference.time = reference.digs = nan;
  if (best) {
    reference.dig = best->dig;
    reference.digs = reference.swollen / best->dig.payload_volume;
    reference.energy = reference.digs * best->dig.cycle_energy / reference.design_cut;
    reference.time = reference.digs * best->dig.cycle_time / reference.design_cut;
  }
  const double load = heaped_capacity(machine);
  reference.least_loads = reference.swollen / load;
  const double bank_of_load = reference.design_cut / reference.least_loads;
  const double mass = bank_of_load * bank.bulk_density;
  const double height = windrow_height(site.known, reference.swollen);
  const double depth = 0.5 * reference.design_cut / area;
  double of_load =
      rupture(bank, machine.bucket.edge_angle) * bank_of_load + lift(machine, mass, depth, height);
  if (best && machine.swing) {
    PlannedDig dig = best->dig;
    dig.payload_mass = mass;
    DigObjective least;
    least.swing = FullDigCycle{}.swing;
    least.dump_height = height + machine.bucket_length;
    const auto cycle = cycle_of(machine, best->path, dig, least);
    if (cycle) of_load += cycle->swing.energy + cycle->back.energy;
  }
  reference.bound = of_load * reference.least_loads / reference.design_cut;
  return reference;
}

}  // namespace excavplan
