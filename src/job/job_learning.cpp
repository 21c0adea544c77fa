// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_learning.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/statistics.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr double normal_95 = 1.959963984540054;
constexpr double memory = 0.1;       // of the scatter, of each new reading
constexpr double drift = 0.02;       // of the two ratios from dig to dig, as the soil changes
constexpr double least_share = 0.1;  // of the energy of a dig that tells of the strength
constexpr double strength_reading =
    0.3;                           // sd of ln of the energy, as the simulator and the path are off
constexpr double stall_sd = 0.25;  // of ln of the strength at which a dig stalls, likewise
constexpr double least_likelihood = 1e-6;  // of a stall or none
constexpr double chance_of_stall = 0.05;   // whatever the strength: the edge met ground not seen
constexpr double least_share_left = 0.05;  // of a variance after one
constexpr double least_doubt = 0.25;       // about ln of the strength, from place to place
constexpr double least_fill = 0.3;         // of a bucket that teaches anything
constexpr double least_energy = 0.1;       // of the dig in that of its cycle, to tell its own

void learn_ratio(LearntNumber& ratio, double& scatter, double reading) {
  ratio.variance += drift * drift;
  const double surprise = reading - ratio.mean;
  ratio.learn(reading, scatter);
  const double left = std::max(0.0, surprise * surprise - ratio.variance);
  scatter += memory * (left - scatter);
}

std::array<double, 2> interval(double mean, double sd_of_logarithm) {
  const double factor = std::exp(normal_95 * sd_of_logarithm);
  return {mean / factor, mean * factor};
}

}  // namespace

void LearntNumber::learn(double reading, double reading_variance) {
  const double gain = variance / (variance + reading_variance);
  mean += gain * (reading - mean);
  variance *= 1.0 - gain;
}

void LearntNumber::learn_bound(double bound, bool is_above, double bound_variance,
                               double chance_of_else) {
  const double spread = std::sqrt(variance + bound_variance);
  const double sign = is_above ? 1.0 : -1.0;
  const double z = sign * (mean - bound) / spread;
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * pi);
  const double likelihood = std::max(normal_cdf(z), least_likelihood);
  const double ratio = density / likelihood;
  const double moved = sign * variance / spread * ratio;
  const double less = variance * variance / (spread * spread) * ratio * (z + ratio);
  const double left = std::max(variance - less, least_share_left * variance);
  const double of_else = chance_of_else / (chance_of_else + (1.0 - chance_of_else) * likelihood);
  mean += (1.0 - of_else) * moved;
  variance = of_else * variance + (1.0 - of_else) * (left + of_else * moved * moved);
}

void ScanDatum::learn(const Alignment& scan) {
  const Motion& motion = scan.found;
  const Eigen::Vector2d rise(-motion[4], motion[3]);
  sum += Eigen::Vector3d(motion[2] - rise.dot(scan.centre.head<2>()), rise.x(), rise.y());
  ++scans;
}

double LearntNumber::sd() const { return std::sqrt(variance); }

ForetoldStep JobLearning::foretell(const PlannedDig& dig) const {
  ForetoldStep foretold;
  foretold.payload_mass = dig.payload_mass * std::exp(payload.mean);
  const double in_soil = dig.energy * std::exp(energy.mean);
  foretold.energy = dig.cycle_energy - dig.energy + in_soil;
  foretold.time = dig.cycle_time;
  foretold.payload_interval =
      interval(foretold.payload_mass, std::sqrt(payload.variance + payload_scatter));
  const double sd = std::sqrt(energy.variance + energy_scatter);
  const double share = foretold.energy > 0.0 ? in_soil / foretold.energy : 0.0;
  foretold.energy_interval = interval(foretold.energy, share * sd);
  return foretold;
}

void JobLearning::learn(const PlannedDig& dig, const StrengthSigns& signs,
                        const StepReport& report) {
  if (signs.stalls_at > 0.0)
    strength.learn_bound(std::log(signs.stalls_at), report.stalled, stall_sd * stall_sd,
                         report.stalled ? chance_of_stall : 0.0);
  if (report.stalled) return;
  if (dig.fill < least_fill) return;
  if (report.payload_mass && *report.payload_mass > 0.0) {
    learn_ratio(payload, payload_scatter, std::log(*report.payload_mass / dig.payload_mass));
  }
  const double rest = dig.cycle_energy - dig.energy;
  if (report.joint_work && dig.energy > least_energy * dig.cycle_energy &&
      *report.joint_work > rest) {
    const double ratio = std::log((*report.joint_work - rest) / dig.energy);
    learn_ratio(energy, energy_scatter, ratio);
    if (signs.energy_share > least_share) {
      const double sd = strength_reading / signs.energy_share;
      strength.learn(strength.mean + ratio / signs.energy_share, sd * sd);
    }
  }
}

double JobLearning::strength_factor(int deviations) const {
  return std::exp(strength.mean + deviations * std::max(strength.sd(), least_doubt));
}
double JobLearning::hard_factor() const { return strength_factor(1); }

SoilKind with_strength(SoilKind soil, double factor) {
  soil.cohesion_loosest *= factor;
  soil.cone_index_reference *= factor;
  return soil;
}

WallSoil wall_soil(const SoilKind& soil, double density_percent, const JobLearning& learnt) {
  const auto at = [&](int deviations) {
    return bank_state(with_strength(soil, learnt.strength_factor(deviations)), density_percent);
  };
  return {at(0), at(-1)};
}

}  // namespace excavplan
