// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_by_loads.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include <excavplan/calibration/calibration.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "density/joined_density.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

constexpr double step = 10.0;          // of density [%]; ours
constexpr std::size_t draws = 40;      // ours
constexpr double within = 0.99;        // of the limits of friction; ours
constexpr double least_log_sd = 1e-6;  // of the work
constexpr double least_slope = 1e-4;   // of the logarithm [1/%]: such loads have no weight; ours

/// Work of the joints, that against the soil times a factor [J].
double work_of(const LoadedDig& dig, const SoilKind& soil, double density, double factor) {
  const auto simulator = default_simulator().make(that_never_stalls(dig.machine), soil, density);
  DigOptions options;
  options.settle = false;
  const EnergyLedger energy = simulator->dig(dig.ground, dig.path, options).energy;
  return std::max(1.0, energy.total + (factor - 1.0) * energy.soil);
}

/// A soil of the kind and a simulator, and the error of the law in it at a density.
struct Draw {
  SoilKind soil;
  double simulator_factor = 1.0;
};

Draw drawn(const LoadedDig& dig, std::size_t i) {
  const SoilKind soil = drawn_soil(dig.soil, dig.scatter, Random(i, 2).bits());
  return {drawn_strength(soil, dig.strength, Random(i, 3).bits()),
          std::exp(dig.strength.simulator * Random(i, 4).normal())};
}

}  // namespace

SoilKind drawn_strength(const SoilKind& soil, const StrengthScatter& scatter, std::uint64_t seed) {
  require_soil(soil);
  for (const double sd : {scatter.cohesion, scatter.adhesion_ratio, scatter.friction,
                          scatter.cone_index, scatter.simulator}) {
    require_in("strength scatter: a deviation", sd, 0.0, 1.0);
  }
  Random random(seed);
  const auto factor = [&random](double sd) { return std::exp(sd * random.normal()); };
  SoilKind drawn = soil;
  drawn.cohesion_loosest =
      std::min(most_cohesion, soil.cohesion_loosest * factor(scatter.cohesion));
  drawn.adhesion_ratio = std::min(1.0, soil.adhesion_ratio * factor(scatter.adhesion_ratio));
  const double densest = soil.friction_loosest + soil.friction_gain;
  const auto [flattest, steepest] = std::minmax(soil.friction_loosest, densest);
  const double friction =
      std::clamp(factor(scatter.friction), std::min(1.0, flattest_friction / (within * flattest)),
                 std::max(1.0, within * steepest_friction / steepest));
  drawn.friction_loosest *= friction;
  drawn.friction_gain *= friction;
  drawn.cone_index_reference = std::clamp(soil.cone_index_reference * factor(scatter.cone_index),
                                          least_cone_index, most_cone_index);
  return drawn;
}

Measured joint_work(const DigLog& log, double meter_sd) {
  require_in("meter_sd", meter_sd, 0.0, 1.0);
  const auto refuse = [&log](const std::string& why) {
    throw Error(ErrorKind::bad_file, log.file + ": " + why);
  };
  if (!log.of_joints) {
    refuse(
        std::string("records ") + name(log.meter) +
        ", expected the loads of the joints: their powers, their torques and rates, or pressures "
        "and piston speeds of their cylinders");
  }
  if (log.digs.size() != 1) {
    refuse("holds " + std::to_string(log.digs.size()) +
           " digs, expected one: state from when to when");
  }
  const double work = log.integral(log.digs.front());
  if (!(work > 0.0 && std::isfinite(work))) {
    refuse("the joints do a work of " + number_text(work) + " J in it, must be above 0 and finite");
  }
  return {work, meter_sd * work};
}

WorkOverDensity::Point WorkOverDensity::at(double density_percent) const {
  require(points.size() >= 2, "work over density: fewer than two points");
  const double d =
      std::clamp(density_percent, points.front().density_percent, points.back().density_percent);
  const auto after = std::find_if(points.begin() + 1, points.end() - 1,
                                  [d](const Point& p) { return p.density_percent >= d; });
  const Point& low = *(after - 1);
  const Point& high = *after;
  const double share = (d - low.density_percent) / (high.density_percent - low.density_percent);
  const auto between = [&](double Point::*figure) {
    return low.*figure + share * (high.*figure - low.*figure);
  };
  return {d, between(&Point::log_work), between(&Point::sd), between(&Point::with_law)};
}

WorkOverDensity work_over_density(const LoadedDig& dig, const DensityForm& freed_form,
                                  unsigned threads) {
  WorkOverDensity result;
  for (double d = 0.0; d <= 100.0; d += step) result.points.push_back({d, 0.0, 0.0, 0.0});
  const std::size_t count = result.points.size();
  std::vector<double> logs((draws + 1) * count);  // by soil, that of the kind first
  std::vector<double> law_errors(logs.size());
  parallel_for(logs.size(), threads, [&](std::size_t i) {
    const double d = result.points[i % count].density_percent;
    const Draw draw = i < count ? Draw{dig.soil} : drawn(dig, i / count);
    logs[i] = std::log(work_of(dig, draw.soil, d, draw.simulator_factor));
    law_errors[i] = density_of_bulking(freed_form, bulking_of_density(draw.soil, d)) - d;
  });
  for (std::size_t p = 0; p < count; ++p) {
    WorkOverDensity::Point& point = result.points[p];
    point.log_work = logs[p];
    double square = 0.0;
    for (std::size_t i = count + p; i < logs.size(); i += count) {
      const double off = logs[i] - point.log_work;
      square += off * off / draws;
      point.with_law += off * (law_errors[i] - law_errors[p]) / draws;
    }
    point.sd = std::sqrt(square);
  }
  return result;
}

namespace {

/// The work over that expected where both are nearest, in deviations.
double least_deviation(const WorkOverDensity& expected, const Measured& work) {
  double least = HUGE_VAL;
  for (const auto& point : expected.points) {
    const double off = (std::log(work.value) - point.log_work) /
                       std::max(least_log_sd, std::hypot(point.sd, work.sd / work.value));
    if (std::abs(off) < std::abs(least)) least = off;
  }
  return least;
}

/// Mean, deviation and interval of the density by the work alone.
void set_posterior(const WorkOverDensity& expected, LoadsDensity& loads) {
  constexpr int cells = 1000;
  constexpr double width = 100.0 / cells;
  const double log_work = std::log(loads.work.value);
  const double meter = loads.work.sd / loads.work.value;
  Eigen::ArrayXd logs(cells);  // of the likelihood
  const Eigen::ArrayXd middle = Eigen::ArrayXd::LinSpaced(cells, 0.5 * width, 100.0 - 0.5 * width);
  for (int i = 0; i < cells; ++i) {
    const auto point = expected.at(middle(i));
    const double sd = std::max(least_log_sd, std::hypot(point.sd, meter));
    logs(i) = -0.5 * std::pow((log_work - point.log_work) / sd, 2) - std::log(sd);
  }
  Eigen::ArrayXd shares = (logs - logs.maxCoeff()).exp();
  shares /= shares.sum();
  const double mean = (shares * middle).sum();
  loads.density_percent = Measured{mean, std::sqrt((shares * (middle - mean).square()).sum())};
  const auto quantile = [&](double share) {
    double sum = 0.0;
    int i = 0;
    while (i < cells - 1 && sum + shares(i) < share) sum += shares(i++);
    return width * (i + 0.5);
  };
  loads.interval_percent = {quantile(0.025), quantile(0.975)};
}

}  // namespace

bool LoadsDensity::disagrees() const {
  return !density_percent || std::abs(disagreement) > largest_disagreement;
}

LoadsDensity density_by_loads(const WorkOverDensity& expected, const Measured& work,
                              const RelativeDensity& by_scans) {
  require(work.value > 0.0 && std::isfinite(work.value), "work of the joints [J]", work.value,
          "above 0 and finite");
  require(work.sd >= 0.0 && std::isfinite(work.sd), "work of the joints, its sd,", work.sd,
          "at least 0 and finite");
  LoadsDensity loads;
  loads.work = work;
  loads.by_scans = loads.density = by_scans;
  const double off = least_deviation(expected, work);
  if (std::abs(off) > largest_disagreement) {
    loads.reason = readable(std::abs(off), 2) + " standard deviations " +
                   (off > 0.0 ? "more" : "less") + " than expected at any density";
  } else {
    set_posterior(expected, loads);
  }

  const WorkOverDensity::Point here = expected.at(by_scans.raw_percent);
  const double low = std::max(0.0, here.density_percent - step);
  const double high = std::min(100.0, here.density_percent + step);
  const double rise = expected.at(high).log_work - expected.at(low).log_work;
  const double slope = std::max(least_slope, rise / (high - low));
  const double meter = work.sd / work.value;
  const double own_sd = shared_sd_of(by_scans);
  // The draws know nothing of the path, the law's error may: it is correlated by as much as theirs.
  const double with_law = std::clamp(here.with_law, -own_sd * here.sd, own_sd * here.sd) / slope;
  TwoDensities both{
      {by_scans.raw_percent, here.density_percent + (std::log(work.value) - here.log_work) / slope},
      Eigen::Matrix2d::Zero()};
  both.by_measurement =
      Eigen::Vector2d(std::pow(by_scans.sd_given_law_percent, 2), std::pow(meter / slope, 2))
          .asDiagonal();
  both.covariance = both.by_measurement;
  both.covariance(0, 0) += own_sd * own_sd;
  both.covariance(1, 1) += std::pow(here.sd / slope, 2);
  both.covariance(0, 1) = both.covariance(1, 0) = with_law;
  const JoinedDensity mean = joined(both);
  loads.disagreement = mean.disagreement;
  if (loads.disagrees()) {
    loads.density.trustworthy = false;
  } else {
    loads.weight = mean.second_share;
    loads.density = answer_of(mean, by_scans, mean.sd);
  }
  return loads;
}

}  // namespace excavplan
