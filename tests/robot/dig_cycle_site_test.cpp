// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/dig_cycle_session.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/robot/node_settings.hpp>

#include "site/site_digs.hpp"
#include "support/errors.hpp"
#include "support/ros_bytes.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

constexpr std::int64_t one_second = 1'000'000'000;          // [ns]
constexpr std::int64_t begin = 1'700'000'000 * one_second;  // [ns]
constexpr double truth = 40.0;                              // of the density [%]
DigCycleSettings settings_on(const std::string& site) {
  static const DigCycleSettings usual = cycle_settings();
  DigCycleSettings settings = usual;
  settings.scans = 1;
  settings.site = site;
  return settings;
}

/// A machine and its sensor, on ground that it digs.
class Machinery {
 public:
  explicit Machinery(const DigCycleSettings& settings, double relief = 0.03)
      : settings_(settings), ground_(DigsInARow(truth, relief).ground()) {}

  /// A scan of the ground as it is, in the frame that the settings take it from.
  void scan(DigCycleSession& session) {
    ++scans_;
    Points points = scanned(ground_.surface(), static_cast<std::uint64_t>(scans_), {0.0, 0.0, 0.0})
                        .clouds.front()
                        ->points;
    const Eigen::Isometry3d from_machine = Eigen::Isometry3d(settings_.site_from_scan).inverse();
    for (Eigen::Vector3d& point : points) point = from_machine * point;
    session.take({"/points",
                  "sensor_msgs/msg/PointCloud2",
                  true,
                  cloud_bytes(begin + scans_ * one_second, "map", points),
                  {}});
  }
  /// Drives a plan.
  void dig(DigCycleSession& session, const PlannedDig& planned) {
    session.start_dig();
    SceneOptions driven;
    driven.path = planned.parameters;
    driven.start_x = planned.start_x;
    ground_ = run_scene(settings_.machine, settings_.soil, truth, ground_, driven).after;
    session.end_dig();
  }
  double height(const Eigen::Vector2d& at) const {
    return height_at(ground_.surface(), at.x(), at.y());
  }

 private:
  const DigCycleSettings& settings_;
  Terrain ground_;
  std::int64_t scans_ = 0;
};

void expect_density(const CycleEstimate& answer) {
  ASSERT_TRUE(answer.site && answer.site->density);
  EXPECT_TRUE(answer.site->taken);
  EXPECT_TRUE(answer.adopted) << to_json(answer);
  EXPECT_NEAR(answer.site->density->percent, truth, 3.0 * answer.site->density->sd_percent);
  EXPECT_EQ(answer.before, 0U) << "the site knew the ground";
}

TEST(DigCycleOnSite, DigsInARowNeedOneScanEach) {
  const TemporaryFolder folder;
  const DigCycleSettings settings = settings_on(folder.file("site"));
  Machinery machine(settings);
  {
    DigCycleSession session(settings);
    EXPECT_EQ(error_of([&] { session.start_dig(); }), "the dig begins, but no scan came before it");
    machine.scan(session);
    for (const int dig : {1, 2}) {
      SCOPED_TRACE(dig);
      const CyclePlan plan = session.plan();
      ASSERT_TRUE(plan.plan.dig) << plan.plan.reason;
      EXPECT_EQ(plan.density_is_stated, dig == 1);
      EXPECT_FALSE(has(plan.warnings, WarningCode::ground_before_dig));
      machine.dig(session, *plan.plan.dig);
      EXPECT_TRUE(has(session.plan().warnings, WarningCode::ground_before_dig));
      machine.scan(session);
      const CycleEstimate answer = session.estimate();
      expect_density(answer);
      EXPECT_EQ(answer.site->digs, dig);
      const auto json = nlohmann::json::parse(to_json(answer));
      EXPECT_EQ(json["site"]["density_percent"], session.density().percent);
    }
    EXPECT_NE(error_of([&] { DigCycleSession second_one(settings); }, ErrorKind::bad_file)
                  .find("in use by process"),
              std::string::npos);
  }
  DigCycleSession later(settings);  // the next day
  const CyclePlan plan = later.plan();
  ASSERT_TRUE(plan.plan.dig) << plan.plan.reason;
  EXPECT_FALSE(plan.density_is_stated);
  EXPECT_TRUE(has(plan.warnings, WarningCode::scan_old)) << "nothing was seen yet";
  EXPECT_FALSE(has(plan.warnings, WarningCode::level_ground));
  EXPECT_FALSE(plan.trustworthy);
  machine.dig(later, *plan.plan.dig);
  machine.scan(later);
  expect_density(later.estimate());
  EXPECT_EQ(Site(settings.site, {}).updates(), 4);
}

TEST(DigCycleOnSite, PlansOnTheLooseSoilThatItRemembers) {
  const TemporaryFolder folder;
  const DigCycleSettings settings = settings_on(folder.file("site"));
  Machinery machine(settings);
  DigCycleSession session(settings);
  machine.scan(session);
  machine.dig(session, *session.plan().plan.dig);
  machine.scan(session);
  const CycleEstimate first = session.estimate();
  EXPECT_EQ(to_json(session.estimate()), to_json(first)) << "a dig is taken in once";
  EXPECT_EQ(session.plan().density.percent, session.density().percent);
  const GroundState known = Site(settings.site, {}).ground();
  EXPECT_EQ(Site(settings.site, {}).updates(), 2);
  EXPECT_GT(known.terrain.loose.maxCoeff(), 0.1);
  const Eigen::Vector2d heap = default_dump_point();
  EXPECT_NEAR(height_at(known.terrain.surface(), heap.x(), heap.y()), machine.height(heap), 0.05);
}

TEST(DigCycleOnSite, AScanThatDoesNotFitIsNotTaken) {
  const TemporaryFolder folder;
  const DigCycleSettings settings = settings_on(folder.file("site"));
  Machinery machine(settings);
  DigCycleSession session(settings);
  machine.scan(session);
  machine.dig(session, *session.plan().plan.dig);
  Machinery(settings, 0.3).scan(session);  // of another place
  const CycleEstimate answer = session.estimate();
  EXPECT_TRUE(has(answer.warnings, WarningCode::scan_not_taken)) << to_json(answer);
  EXPECT_FALSE(answer.adopted);
  EXPECT_FALSE(answer.estimate.trustworthy);
  EXPECT_EQ(Site(settings.site, {}).updates(), 1);
  const CyclePlan plan = session.plan();
  EXPECT_TRUE(has(plan.warnings, WarningCode::ground_before_dig));
  EXPECT_TRUE(plan.previous_density);
  EXPECT_FALSE(plan.trustworthy);
}

TEST(DigCycleOnSite, AnOperatorsFirstDigHasAScanBeforeIt) {
  const TemporaryFolder folder;
  const DigCycleSettings settings = settings_on(folder.file("site"));
  Machinery machine(settings);
  DigCycleSession session(settings);
  machine.scan(session);
  machine.dig(session, *plan_dig(settings.machine, settings.soil, truth, settings.plan).dig);
  machine.scan(session);
  const CycleEstimate answer = session.estimate();
  EXPECT_EQ(answer.before, 1U);
  EXPECT_TRUE(answer.adopted) << to_json(answer);
  EXPECT_EQ(Site(settings.site, {}).updates(), 1);
}

TEST(DigCycleOnSite, TheMachineStandsWhereItsFrameSays) {
  const TemporaryFolder folder;
  DigCycleSettings settings = settings_on(folder.file("site"));
  settings.site_frame = "map";
  const Eigen::Isometry3d base = Eigen::Translation3d(20.0, -5.0, 1.0) *
                                 Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitZ());  // on the map
  settings.site_from_scan = base.inverse().matrix();
  Machinery machine(settings);
  DigCycleSession session(settings);
  session.take({"/tf_static",
                "tf2_msgs/msg/TFMessage",
                true,
                transform_bytes({{begin, "map", "lidar", {0.0, 0.0, 0.0}}}),
                {}});
  machine.scan(session);
  const CyclePlan plan = session.plan();
  ASSERT_TRUE(plan.plan.dig) << plan.plan.reason;
  machine.dig(session, *plan.plan.dig);
  machine.scan(session);
  expect_density(session.estimate());
  const Site site(settings.site, {});
  EXPECT_EQ(site.ground().frame, "map");
  const Eigen::Vector2d dump = default_dump_point();
  const Eigen::Vector3d heap = base * Eigen::Vector3d(dump.x(), dump.y(), 0.0);
  const HeightMap surface = site.ground().terrain.surface();
  EXPECT_NEAR(height_at(surface, heap.x(), heap.y()), 1.0 + machine.height(dump), 0.05);
  settings.site_from_scan = (Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()) *
                             Eigen::Isometry3d(settings.site_from_scan))
                                .matrix();
  EXPECT_NE(error_of([&] { check(settings); }).find("the machine stands tilted on the site"),
            std::string::npos);
}

TEST(DigCycleOnSite, NodesTakeItAsAParameter) {
  NodeParameters given;
  given.site = "pit";
  EXPECT_EQ(node_settings(given).session.site, "pit");
  DigCycleSettings settings = settings_on("pit");
  settings.estimate.method = VolumeMethod::paper;
  EXPECT_EQ(error_of([&] { check(settings); }),
            "site: the ground is known by its surface, not by the paper's method");
}

}  // namespace
}  // namespace excavplan::test
