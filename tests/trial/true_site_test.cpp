// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/true_site.hpp>

#include <cmath>

#include "base/angles.hpp"
#include "simulation/across_tracks.hpp"
#include "site/scan_digest.hpp"
#include "support/errors.hpp"
#include "support/plain_site_folder.hpp"
#include "trial/tracked_path.hpp"

namespace excavplan::test {
namespace {

JobStep dig_step(double x = 5.5) {
  JobStep step;
  step.id = 7;
  step.what = JobAction::dig;
  step.path =
      std::get<DigPath>(make_dig_path(zx120(), {0.785, 0.3, 1.5}, x, [](double) { return 0.0; }));
  step.dump = {2.5, 3.5, 2.0};
  return step;
}

JobStep step_of(JobAction what) {
  JobStep step;
  step.what = what;
  return step;
}

struct SiteAtOrigin : PlainSiteFolder {
  SiteAtOrigin() { site["start_pose"]["x"] = 0.0; }
};

double rms_of(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(TrueSite, ADigTakesItsSoilToTheDump) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  const TrueStep done = truth.execute(dig_step());
  EXPECT_FALSE(done.stall.has_value());
  EXPECT_GT(done.payload_mass, 100.0);
  EXPECT_EQ(*done.report.payload_mass, done.payload_mass);
  EXPECT_GT(done.energy, 50e3);
  EXPECT_EQ(*done.report.joint_work, done.energy);
  EXPECT_GT(done.time, 5.0);
  EXPECT_EQ(done.report.time, truth.time());
  EXPECT_GT(height_at(truth.ground().surface(), 2.5, 3.5), 0.2);
  EXPECT_LT(height_at(truth.ground().surface(), 4.5, 0.0), -0.1);
}

TEST(TrueSite, ADigAcrossTheTracksIsWhereTheFrontLooks) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  JobStep across = dig_step();
  across.swung = 0.5 * pi;
  EXPECT_GT(truth.execute(across).payload_mass, 100.0);
  EXPECT_LT(height_at(truth.ground().surface(), 0.0, 4.5), -0.1);
  EXPECT_EQ(height_at(truth.ground().surface(), 4.5, 0.0), 0.0);
}

TEST(TrueSite, AcrossItsTracksAMachineTipsSooner) {
  SiteAtOrigin folder;
  folder.truth["strength_factor"] = 12.0;
  const HiddenSite site = folder.read();
  const auto stall = [&](double swung) {
    TrueSite truth(site, zx120());
    JobStep step = dig_step(7.0);
    step.path =
        std::get<DigPath>(make_dig_path(zx120(), {1.2, 0.5, 1.5}, 7.0, [](double) { return 0.0; }));
    step.swung = swung;
    return truth.execute(step).stall;
  };
  const auto along = stall(0.0), across = stall(0.5 * pi);
  ASSERT_TRUE(along && across);
  EXPECT_EQ(across->cause, along->cause);
  EXPECT_NEAR(across->held / along->held, side_edge, 0.01);
}

TEST(TrueSite, AScanIsMadeWhereTheFrontLooks) {
  SiteAtOrigin folder;
  folder.site["sensor"]["field_of_view_deg"] = {40, 45};
  const HiddenSite site = folder.read();
  const auto mean_of = [&](double swung) {
    TrueSite truth(site, zx120());
    JobStep look = step_of(JobAction::scan);
    look.swung = swung;
    const TrueStep done = truth.execute(look);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    for (const auto& cloud : done.report.scan->clouds) {
      for (const auto& point : cloud->points) sum += point;
      count += cloud->points.size();
    }
    return Eigen::Vector3d(sum / static_cast<double>(count));
  };
  const Eigen::Vector3d ahead = mean_of(0.0), aside = mean_of(0.5 * pi);
  EXPECT_GT(ahead.x(), 2.0);
  EXPECT_LT(std::abs(ahead.y()), 0.5);
  EXPECT_GT(aside.y(), 2.0);
  EXPECT_LT(std::abs(aside.x()), 0.5);
}

TEST(TrueSite, SolidsAreConserved) {
  SiteAtOrigin folder;
  folder.truth["tracking_height_sd_m"] = 0.012;
  folder.truth["depth_gradient_percent_per_m"] = 30.0;
  folder.density = [](double x, double y) { return 50.0 + 4.0 * x - 3.0 * y; };
  folder.height = [](double x, double y) { return 0.03 * std::sin(2.0 * x + y); };
  folder.site["truck"] = {{"bed_polygon", {{-1, -5}, {3, -5}, {3, -3}, {-1, -3}}},
                          {"bed_height_m", 2.4},
                          {"target_kg", 4000}};
  const HiddenSite site = folder.read();
  TrueSite truth(site, zx120());
  for (int i = 0; i < 6; ++i) {
    JobStep step = dig_step(5.5 - 0.1 * i);
    step.lane = 0.1 * i - 0.3;
    if (i % 2 == 1) {
      step.dump = {1.0, -4.0, 3.6};
      step.truck = 1;
    }
    truth.execute(step);
  }
  const SolidsLedger& solids = truth.solids();
  EXPECT_GT(solids.cut, 300.0);
  EXPECT_GT(solids.hauled, 100.0);
  EXPECT_NEAR(solids.cut, solids.lying + solids.hauled, 1e-9 * solids.cut);
}

TEST(TrueSite, ALoadIsKeptUntilItIsDumped) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  JobStep first = dig_step();
  first.keeps_load = true;
  first.dump = {0.0, 90.0, 2.0};  // is not looked at
  truth.execute(first);
  const SolidsLedger kept = truth.solids();
  EXPECT_GT(kept.held, 50.0);
  EXPECT_NEAR(kept.cut, kept.lying + kept.held, 1e-9 * kept.cut);
  EXPECT_NEAR(height_at(truth.ground().surface(), 2.5, 3.5), 0.0, 1e-9);
  truth.execute(dig_step(5.0));
  const SolidsLedger& dumped = truth.solids();
  EXPECT_EQ(dumped.held, 0.0);
  EXPECT_NEAR(dumped.cut, dumped.lying, 1e-9 * dumped.cut);
  EXPECT_GT(height_at(truth.ground().surface(), 2.5, 3.5), 0.2);
}

TEST(TrueSite, AKeptLoadIsDumpedBeforeAScan) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  JobStep first = dig_step();
  first.keeps_load = true;
  truth.execute(first);
  const double held = truth.solids().held;
  JobStep look = first;
  look.what = JobAction::scan;
  look.keeps_load = false;
  look.dumps_first = true;
  look.carried = CarriedLoad{0.1, {-0.3, 0.9, 1.5, 0.0}};
  const TrueStep done = truth.execute(look);
  EXPECT_GT(held, 50.0);
  EXPECT_EQ(truth.solids().held, 0.0);
  EXPECT_NEAR(truth.solids().cut, truth.solids().lying, 1e-9 * truth.solids().cut);
  EXPECT_GT(done.energy, 5e3);
  EXPECT_GT(done.time, 5.0);
  EXPECT_TRUE(done.report.scan.has_value());
}

TEST(TrueSite, WhatTheBucketCannotHoldFallsBack) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  const double full = heaped_capacity(zx120()) * site.soil.specific_gravity * 1000.0 /
                      (1.0 + site.soil.void_ratio_loose);
  for (int i = 0; i < 4; ++i) {
    JobStep step = dig_step();
    step.lane = 0.8 * i - 1.2;
    step.keeps_load = true;
    truth.execute(step);
  }
  const SolidsLedger& solids = truth.solids();
  EXPECT_NEAR(solids.held, full, 1e-6 * full);
  EXPECT_NEAR(solids.cut, solids.lying + solids.held, 1e-9 * solids.cut);
}

TEST(TrueSite, TheScaleHasItsErrors) {
  SiteAtOrigin folder;
  folder.truth["payload_scale_error"] = 0.04;
  TrueSite exact(folder.read(), zx120());
  const TrueStep done = exact.execute(dig_step());
  EXPECT_NEAR(*done.report.payload_mass, 1.04 * done.payload_mass, 1e-9);
  folder.truth["payload_noise"] = 0.01;
  TrueSite noisy(folder.read(), zx120());
  const TrueStep again = noisy.execute(dig_step());
  EXPECT_EQ(again.payload_mass, done.payload_mass);
  EXPECT_NE(*again.report.payload_mass, *done.report.payload_mass);
}

TEST(TrueSite, StrengthAloneMakesADigCostMore) {
  SiteAtOrigin folder;
  const double plain = TrueSite(folder.read(), zx120()).execute(dig_step()).energy;
  folder.truth["strength_factor"] = 1.3;
  EXPECT_GT(TrueSite(folder.read(), zx120()).execute(dig_step()).energy, 1.02 * plain);
}

TEST(TrueSite, AMoveLandsALittleOffAndIsKnownBetter) {
  const HiddenSite site = SiteAtOrigin().read();
  std::vector<double> landing, turn, known;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    TruthOptions options;
    options.seed = seed;
    TrueSite truth(site, zx120(), options);
    JobStep step = step_of(JobAction::move);
    step.base = {-2.0, 0.5, 0.0, 0.1};
    const TrueStep done = truth.execute(step);
    EXPECT_NEAR(done.time, 9.0 + 2.0 * 2.06, 0.6);
    EXPECT_NEAR(done.energy, 30e3 + 15e3 * 2.06, 5e3);
    landing.push_back(truth.true_base().x + 2.0);
    landing.push_back(truth.true_base().y - 0.5);
    turn.push_back(truth.true_base().heading - 0.1);
    known.push_back(done.report.base->x - truth.true_base().x);
    known.push_back(done.report.base->y - truth.true_base().y);
  }
  EXPECT_NEAR(rms_of(landing), 0.05, 0.015);
  EXPECT_NEAR(rms_of(turn), 0.01745, 0.006);
  EXPECT_NEAR(rms_of(known), 0.01, 0.003);
}

TEST(TrueSite, SeenIsWhatAScanSawSinceItChanged) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  const HeightMap around = [&] {
    HeightMap area = site.ground.surface();
    for (Eigen::Index col = 0; col < area.z.cols(); ++col) {
      const bool inside = area.x(col) > 4.0 && area.x(col) < 5.5;
      for (Eigen::Index row = 0; row < area.z.rows(); ++row) {
        if (!inside || std::abs(area.y(row)) > 0.3) area.z(row, col) = std::nan("");
      }
    }
    return area;
  }();
  EXPECT_EQ(truth.seen_share(around), 1.0);  // by the first scan
  truth.execute(dig_step());
  EXPECT_LT(truth.seen_share(around), 0.5);
  const TrueStep done = truth.execute(step_of(JobAction::scan));
  ASSERT_TRUE(done.report.scan.has_value());
  EXPECT_EQ(done.time, 3.0);
  EXPECT_GT(truth.seen_share(around), 0.9);
}

TEST(TrueSite, ASiteTakesTwoExactScansOfTheSameGround) {
  TrueSite truth(SiteAtOrigin().read(), zx120());
  const auto scanned = [&] { return truth.execute(step_of(JobAction::scan)).report.scan; };
  const auto first = scanned(), second = scanned();
  ASSERT_TRUE(first && second);
  EXPECT_NE(scan_digest(*first), scan_digest(*second));
  const auto &one = first->clouds[0]->points, &other = second->clouds[0]->points;
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_LT((one[i] - other[i]).norm(), 1e-9);
}

TEST(TrueSite, ADumpOutOfReachIsRefused) {
  const HiddenSite site = SiteAtOrigin().read();
  TrueSite truth(site, zx120());
  JobStep step = dig_step();
  step.dump = {0.0, 9.0, 2.0};
  EXPECT_NE(error_of([&] { truth.execute(step); }).find("step 7 (dig): distance of its dump"),
            std::string::npos);
}

TEST(TrueSite, TheSectionSimulatorCanBeTheTruth) {
  const HiddenSite site = SiteAtOrigin().read();
  TruthOptions options;
  options.simulator = simulator_kinds().back();
  TrueSite truth(site, zx120(), options);
  EXPECT_GT(truth.execute(dig_step()).payload_mass, 50.0);
  EXPECT_NEAR(truth.solids().cut, truth.solids().lying, 1e-9 * truth.solids().cut);
}

TEST(TrackedPath, HeightErrorsHaveTheStatedDeviationAndLength) {
  const DigPath path = dig_step().path;
  HiddenErrors errors;
  errors.height_bias = 0.007;
  errors.height_sd = 0.012;
  std::vector<double> first, along;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Random random(seed);
    const std::vector<double> shift = height_errors(path, errors, random);
    first.push_back(shift.front() - 0.007);
    along.push_back(shift[20] - shift.front());  // 0.5 m on
  }
  EXPECT_NEAR(rms_of(first), 0.012, 0.0005);
  EXPECT_NEAR(rms_of(along), 0.012 * std::sqrt(1.0 - std::exp(-1.0)), 0.0007);
}

TEST(TrackedPath, AnErrorOfTheTipDoesNotPressTheHeel) {
  const DigPath path = dig_step().path;
  const auto simulator = default_simulator().make(
      zx120(), load_soil(std::string(EXCAVPLAN_DATA_SOURCE) + "/soils/loam.json"), 50.0);
  int stalls = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    const std::vector<double> shift = height_errors(path, HiddenErrors{}, random);
    const DigPath driven = tracked_path(zx120(), path, shift, [](double) { return 0.0; });
    const Terrain ground = undisturbed(flat_ground({1.5, -2.0, 8.5, 2.0}, 0.05));
    stalls += simulator->dig(ground, driven).stall ? 1 : 0;
    for (const DigPose& pose : driven.poses) {
      const BucketPose at = forward_kinematics(zx120(), pose.joints);
      ASSERT_NEAR(at.z, pose.bucket.z, 1e-9);
      ASSERT_NEAR(at.x, pose.bucket.x, 1e-9);
    }
  }
  EXPECT_EQ(stalls, 0);
}

TEST(TrackedPath, ATipThatBeginsFlatBelowTheGroundComesFromAbove) {
  DigPath path = dig_step().path;
  path.poses[1].bucket.z = path.poses[0].bucket.z;
  const double ground = path.poses[0].bucket.z + 0.1;
  const std::vector<double> shift(path.poses.size(), 0.0);
  const DigPath driven = tracked_path(zx120(), path, shift, [=](double) { return ground; });
  EXPECT_GT(driven.poses.size(), path.poses.size());
  EXPECT_NEAR(driven.poses.front().bucket.z, ground, 0.03);
}

TEST(TrackedPath, ABucketThatSinksIsTurnedAsItsTipGoes) {
  const DigPath path = dig_step().path;
  constexpr double slope = 0.15;
  std::vector<double> shift;
  for (const DigPose& pose : path.poses)
    shift.push_back(slope * (pose.bucket.x - path.poses.front().bucket.x));
  const DigPath driven = tracked_path(zx120(), path, shift, [](double) { return 0.0; });
  const std::size_t before = driven.poses.size() - path.poses.size();
  double most = 0.0;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const double turned =
        driven.poses[before + i].bucket.floor_angle - path.poses[i].bucket.floor_angle;
    most = std::max(most, turned);
  }
  EXPECT_GT(most, 0.3 * slope);
  EXPECT_LT(most, slope);
}

}  // namespace
}  // namespace excavplan::test
