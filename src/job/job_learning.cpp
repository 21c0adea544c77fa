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
constexpr double least_layer_sd = 0.004;   // of the layer that a dig takes [m]
constexpr double least_cycle_sd = 0.03;    // of the energy of a cycle, over it

/// @param own  variance of the reading that is none of the ratio's
void learn_ratio(LearntNumber& ratio, double& scatter, double reading, double own = 0.0) {
  ratio.variance += drift * drift;
  const double surprise = reading - ratio.mean;
  ratio.learn(reading, scatter + own);
  const double left = std::max(0.0, surprise * surprise - ratio.variance - own);
  scatter += memory * (left - scatter);
}

double squared(double value) { return value * value; }

std::array<double, 2> interval(double mean, double variance) {
  const double half = normal_95 * std::sqrt(variance);
  return {std::max(0.0, mean - half), mean + half};
}

/// Moves a variance to that of a deviation, of which a part is told by something else.
void learn_variance(double& variance, double squared_deviation, double told, double least) {
  variance += memory * (squared_deviation - told - variance);
  variance = std::max(variance, least);
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

/// ln of the energy of a dig in soil of the believed strength, over that as it was simulated.
double JobLearning::beyond_planned(const DigSigns& signs) const {
  return signs.energy_share * (strength.mean - std::log(signs.strength));
}

ForetoldStep JobLearning::foretell(const PlannedDig& dig, const DigSigns& signs) const {
  ForetoldStep foretold;
  foretold.payload_mass = dig.payload_mass * std::exp(payload.mean);
  const double in_soil = dig.energy * std::exp(energy.mean + beyond_planned(signs));
  foretold.energy = dig.cycle_energy - dig.energy + in_soil;
  foretold.time = dig.cycle_time;
  foretold.payload_interval = interval(
      foretold.payload_mass, squared(foretold.payload_mass) * (payload.variance + payload_scatter) +
                                 squared(signs.layer) * layer_variance);
  foretold.energy_interval =
      interval(foretold.energy,
               squared(in_soil) * energy.variance + squared(foretold.energy) * cycle_variance);
  return foretold;
}

void JobLearning::learn(const PlannedDig& dig, const DigSigns& signs, const StepReport& report) {
  if (!report.stalled) learn_spread(dig, signs, report);
  const double beyond = beyond_planned(signs);
  if (signs.stalls_at > 0.0)
    strength.learn_bound(std::log(signs.stalls_at), report.stalled, stall_sd * stall_sd,
                         report.stalled ? chance_of_stall : 0.0);
  if (report.stalled) return;
  if (dig.fill < least_fill) return;
  if (report.payload_mass && *report.payload_mass > 0.0) {
    const double own = squared(signs.layer / dig.payload_mass) * layer_variance;
    learn_ratio(payload, payload_scatter, std::log(*report.payload_mass / dig.payload_mass), own);
  }
  const double rest = dig.cycle_energy - dig.energy;
  if (report.joint_work && dig.energy > least_energy * dig.cycle_energy &&
      *report.joint_work > rest) {
    const double ratio = std::log((*report.joint_work - rest) / dig.energy);
    learn_ratio(energy, energy_scatter, ratio - beyond);
    if (signs.energy_share > least_share) {
      const double sd = strength_reading / signs.energy_share;
      strength.learn(std::log(signs.strength) + ratio / signs.energy_share, sd * sd);
    }
  }
}

/// By how far a dig came from what was foretold.
void JobLearning::learn_spread(const PlannedDig& dig, const DigSigns& signs,
                               const StepReport& report) {
  const ForetoldStep foretold = foretell(dig, signs);
  const double layer = signs.layer;
  if (report.payload_mass && layer > 0.0) {
    const double of_ratio = squared(foretold.payload_mass) * (payload.variance + payload_scatter);
    learn_variance(layer_variance, squared((*report.payload_mass - foretold.payload_mass) / layer),
                   of_ratio / squared(layer), squared(least_layer_sd));
  }
  if (report.joint_work && foretold.energy > 0.0) {
    const double of_ratio = squared(dig.energy * std::exp(energy.mean)) * energy.variance;
    learn_variance(cycle_variance, squared(*report.joint_work / foretold.energy - 1.0),
                   of_ratio / squared(foretold.energy), squared(least_cycle_sd));
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
