// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_by_loads.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/random.hpp"
#include "base/text.hpp"
#include "support/soil_digs.hpp"

/// @file
/// The density by the work of the joints, in digs of the simulator that it does not use.

namespace excavplan {
namespace {

class DensityByLoads : public testing::Test {
 protected:
  struct Sums {
    test::Coverage loads, scans, both;
    int disagree = 0;

    void print(const std::string& soil, double scans_sd) const {
      const auto text = [](const test::Coverage& sum) {
        return readable(100.0 * sum.share(), 3) + " % / " + readable(sum.rms(), 3) + " / " +
               readable(sum.mean_sd(), 3);
      };
      std::cout << "  " << soil << ", scans to " << readable(scans_sd, 2)
                << " points, inside / rms / sd: loads " << text(loads) << ", scans " << text(scans)
                << ", both " << text(both) << '\n';
    }
  };

  WorkOverDensity expected(const SoilKind& soil) const {
    return work_over_density({machine_, path_, ground_, soil}, density_law_of(soil).freed_form);
  }

  double work(const SoilKind& soil, double density, const SimulatorKind& simulator) const {
    return simulator.make(digger_, soil, density)->dig(ground_, path_).energy.total;
  }

  /// Digs of the other simulator in drawn soils of all densities; the scans have normal errors.
  std::vector<Sums> runs(const SoilKind& kind, int count,
                         const std::vector<double>& scans_sds) const {
    const WorkOverDensity curve = expected(kind);
    std::vector<Sums> all(scans_sds.size());
    for (int run = 0; run < count; ++run) {
      Random random(static_cast<std::uint64_t>(run), 9);
      const SoilKind soil = drawn_strength(drawn_soil(kind, {}, random.bits()), {}, random.bits());
      const double truth = 100.0 * (run + random.uniform()) / count;
      const double meter = 1.0 + 0.02 * random.normal();
      const double measured = work(soil, truth, simulator_kinds().back()) * meter;
      const double scans_error = random.normal();
      for (std::size_t i = 0; i < all.size(); ++i) {
        const RelativeDensity scans = by_scans(truth + scans_sds[i] * scans_error, scans_sds[i]);
        const LoadsDensity found = density_by_loads(curve, {measured, 0.02 * measured}, scans);
        RelativeDensity alone;
        if (found.density_percent) {
          alone.percent = found.density_percent->value;
          alone.sd_percent = found.density_percent->sd;
          alone.interval_percent = found.interval_percent;
          all[i].loads.add(alone, truth);
        }
        all[i].scans.add(scans, truth);
        all[i].both.add(found.density, truth);
        all[i].disagree += found.disagrees();
      }
    }
    return all;
  }

  static RelativeDensity by_scans(double percent, double sd) {
    RelativeDensity density;
    density.raw_percent = percent;
    density.percent = std::clamp(percent, 0.0, 100.0);
    density.sd_given_law_percent = sd;
    set_error(density, sd);
    return density;
  }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const Machine digger_ = that_never_stalls(machine_);
  const SoilKind loam_ = load_soil(find_data_file("soils/loam.json"));
  const Terrain ground_ = level_planning_ground(machine_);
  const DigPath path_ = std::get<DigPath>(
      make_dig_path(machine_, paper_fixed_path(), 6.05, boom_plane_profile(ground_)));
};

TEST_F(DensityByLoads, HarderSoilTakesMoreWorkAndSoilsScatter) {
  const WorkOverDensity curve = expected(loam_);
  ASSERT_EQ(curve.points.size(), 11U);
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    EXPECT_GT(curve.points[i].log_work, curve.points[i - 1].log_work);
    EXPECT_GT(curve.points[i].sd, 0.1);
  }
  EXPECT_NEAR(std::exp(curve.at(40.0).log_work), work(loam_, 40.0, default_simulator()), 1e-6);
  EXPECT_NEAR(curve.at(45.0).log_work, 0.5 * (curve.at(40.0).log_work + curve.at(50.0).log_work),
              1e-12);
  EXPECT_EQ(curve.at(-5.0).log_work, curve.at(0.0).log_work);
}

TEST_F(DensityByLoads, IntervalsHoldTheTruthInDigsOfTheOtherSimulator) {
  const std::vector<double> scans_sds = {3.0, 10.0, 20.0};
  for (const SoilLaw& kind : shipped_soil_laws()) {
    SCOPED_TRACE(kind.soil.name);
    const std::vector<Sums> all = runs(kind.soil, 200, scans_sds);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Sums& sums = all[i];
      sums.print(kind.soil.name, scans_sds[i]);
      for (const test::Coverage& each : {sums.loads, sums.both}) {
        EXPECT_GE(each.share(), 0.90);
        EXPECT_LE(each.share(), 0.99);
      }
      EXPECT_LT(sums.both.rms(), sums.scans.rms());
      EXPECT_LT(sums.both.mean_sd(), sums.scans.mean_sd());
      EXPECT_LE(sums.disagree, 5);
    }
  }
}

TEST_F(DensityByLoads, LoadsOfAnotherDigAreNotUsedAndEndTrust) {
  const WorkOverDensity curve = expected(loam_);
  const double usual = std::exp(curve.at(40.0).log_work);
  const RelativeDensity scans = by_scans(40.0, 3.0);
  const LoadsDensity near = density_by_loads(curve, {1.2 * usual, 0.02 * usual}, scans);
  EXPECT_FALSE(near.disagrees());
  EXPECT_TRUE(near.density.trustworthy);
  EXPECT_GT(near.density.percent, 40.0);
  EXPECT_GT(near.weight, 0.0);
  const LoadsDensity far = density_by_loads(curve, {5.0 * usual, 0.1 * usual}, scans);
  EXPECT_TRUE(far.disagrees());
  EXPECT_FALSE(far.density.trustworthy);
  EXPECT_EQ(far.density.percent, 40.0);
  EXPECT_EQ(far.weight, 0.0);
}

TEST_F(DensityByLoads, AWorkOfNoDensityGivesNone) {
  const WorkOverDensity curve{{{0.0, 9.0, 0.3, 0.0}, {100.0, 11.0, 0.5, 0.0}}};
  const RelativeDensity vague = by_scans(60.0, 200.0);  // with which nothing disagrees
  for (const auto& [log_work, reason] :
       {std::pair(12.5, "3.0 standard deviations more than expected at any density"),
        std::pair(8.1, "3.0 standard deviations less than expected at any density")}) {
    const LoadsDensity out = density_by_loads(curve, {std::exp(log_work), 0.0}, vague);
    EXPECT_FALSE(out.density_percent);
    EXPECT_EQ(out.reason, reason);
    EXPECT_TRUE(out.disagrees());
    EXPECT_FALSE(out.density.trustworthy);
    EXPECT_EQ(out.weight, 0.0);
  }
  const LoadsDensity hard = density_by_loads(curve, {std::exp(11.5), 0.0}, vague);
  ASSERT_TRUE(hard.density_percent);
  EXPECT_GT(hard.density_percent->value, 80.0);
  EXPECT_EQ(hard.reason, "");
}

TEST_F(DensityByLoads, ADrawnSoilIsASoil) {
  SoilKind hard = loam_;
  hard.friction_gain = 1.05 - hard.friction_loosest;
  hard.cohesion_loosest = hard.cone_index_reference = 1e6;
  hard.adhesion_ratio = 1.0;
  SoilKind soft = loam_;
  soft.friction_loosest = 0.01;
  soft.cone_index_reference = 1.0;
  SoilKind of_all_angles = loam_;
  of_all_angles.friction_loosest = 0.01;
  of_all_angles.friction_gain = 1.04;
  const StrengthScatter wide = {1.0, 1.0, 1.0, 1.0, 0.2};
  for (const SoilKind& kind : {hard, soft, of_all_angles, loam_}) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      EXPECT_NO_THROW(require_soil(drawn_strength(kind, wide, seed)));
    }
  }
}

TEST_F(DensityByLoads, RefusesWorkAndScatterThatAreNone) {
  const WorkOverDensity curve{{{0.0, 9.0, 0.3, 0.0}, {100.0, 11.0, 0.3, 0.0}}};
  for (const double value : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(density_by_loads(curve, {value, 1.0}, {}), Error);
  }
  EXPECT_THROW(density_by_loads(curve, {1e4, -1.0}, {}), Error);
  EXPECT_THROW(density_by_loads({}, {1e4, 1.0}, {}), Error);
  EXPECT_THROW(drawn_strength(loam_, {-0.1, 0.0, 0.0, 0.0, 0.0}, 1), Error);
}

TEST(JointWork, IsThatOfOneDigByItsJoints) {
  DigLog log;
  log.file = "dig.csv";
  log.spent = Spent::energy;
  log.meter = LogMeter::torques;
  log.of_joints = true;
  log.time = {0.0, 1.0, 2.0};
  log.rates = {{100.0, 100.0, 100.0}, {-50.0, -50.0, -50.0}};
  log.digs = {{0.0, 2.0}};
  EXPECT_DOUBLE_EQ(joint_work(log, 0.02).value, 200.0);
  EXPECT_DOUBLE_EQ(joint_work(log, 0.02).sd, 4.0);
  const auto refused = [](const DigLog& bad, const std::string& reason) {
    try {
      joint_work(bad, 0.02);
      ADD_FAILURE() << reason;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  DigLog idle = log;
  idle.rates = {{0.0, 0.0, 0.0}};
  refused(idle, "must be above 0");
  DigLog two = log;
  two.digs = {{0.0, 1.0}, {1.0, 2.0}};
  refused(two, "holds 2 digs, expected one");
  DigLog fuel = log;
  fuel.meter = LogMeter::fuel_flow;
  fuel.of_joints = false;
  refused(fuel, "dig.csv: records fuel flow, expected the loads of the joints");
}

}  // namespace
}  // namespace excavplan
