// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Hostile options of the estimate, of the survey's plan and of depth images.

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/images/depth_image.hpp>
#include <excavplan/sensing/survey_plan.hpp>

#include "base/non_finite.hpp"
#include "support/hostile.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::answers;
using test::finite;
using test::loam;
using test::refuses;

/// A pit and a heap on ground of 4 m x 2 m, a point in every 2 cm.
Scan scan(bool dug) {
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 100; ++j) {
      const double x = -2.0 + 0.02 * i, y = -1.0 + 0.02 * j;
      double z = 0.002 * std::sin(91.0 * x * y);
      if (dug) z -= 0.2 * std::exp(-20.0 * ((x + 1.0) * (x + 1.0) + y * y));
      if (dug) z += 0.24 * std::exp(-20.0 * ((x - 1.0) * (x - 1.0) + y * y));
      cloud->points.emplace_back(x, y, z);
    }
  }
  cloud->width = cloud->points.size();
  Scan made;
  made.clouds = {cloud};
  made.z_is_up = true;
  return made;
}

const DigScans& scans() {
  static const DigScans both = {scan(false), scan(true), {}};
  return both;
}

TEST(HostileEstimate, OptionsAreRefusedByName) {
  const DensityLaw law = density_law_of(loam());
  ASSERT_NO_THROW(estimate_density(scans(), law));
  const auto refused = [&](const std::function<void(DensityOptions&)>& spoil, const char* what) {
    DensityOptions options;
    options.threads = 1;
    options.paper = [](const SurveyedDig& dig) { return dig.surface; };
    spoil(options);
    const auto one = refuses([&] { estimate_density(scans(), law, options); }, what);
    return one ? refuses([&] { estimate_by_both(scans(), law, options); }, what) : one;
  };
  for (const double bad : {nan, infinity, -1.0}) {
    EXPECT_TRUE(refused([=](DensityOptions& o) { o.cell_size = bad; }, "cell_size"));
    EXPECT_TRUE(refused([=](DensityOptions& o) { o.payload_mass = {bad, 1.0}; }, "payload_mass"));
    EXPECT_TRUE(refused([=](DensityOptions& o) { o.payload_mass = {500.0, bad}; }, "payload_mass"));
    EXPECT_TRUE(refused(
        [=](DensityOptions& o) {
          o.soil.water_content = {bad, 0.01};
        },
        "water_content"));
  }
  EXPECT_TRUE(refused([](DensityOptions& o) { o.soil.kind = SoilKind{}; }, "soil ''"));
  EXPECT_TRUE(refused([](DensityOptions& o) { o.soil.possible = {SoilLaw{}}; }, "soil ''"));
  EXPECT_TRUE(refused([](DensityOptions& o) { o.dug_path = DugPath{}; }, "machine"));
  EXPECT_TRUE(refused([](DensityOptions& o) { o.threads = 4000000000U; }, "number of threads"));
  EXPECT_TRUE(refuses([] { estimate_density(scans(), DensityLaw{}); }, "density law, line: a"));
  EXPECT_TRUE(refuses([] { estimate_density(scans(), SoilKind{}); }, "soil ''"));
  EXPECT_THROW(estimate_density({}, law), Error);
  DigScans moved = scans();
  const DigScans taken = std::move(moved);
  EXPECT_THROW(estimate_density(moved, law), Error);
  EXPECT_FALSE(DensityEstimate{}.ground_density().has_value());
}

TEST(HostileSurveyPlan, NumbersAreRefusedOrHarmless) {
  const std::vector<test::Member<SurveyPlan>> members = {
      {"volume", [](SurveyPlan& p) -> double& { return p.dig_volume; }},
      {"depth", [](SurveyPlan& p) -> double& { return p.dig_depth; }},
      {"bulking", [](SurveyPlan& p) -> double& { return p.bulking_factor; }},
      {"spill", [](SurveyPlan& p) -> double& { return p.spill_share; }},
      {"wall", [](SurveyPlan& p) -> double& { return p.wall_angle; }},
      {"repose", [](SurveyPlan& p) -> double& { return p.angle_of_repose; }},
      {"area", [](SurveyPlan& p) -> double& { return p.surveyed_area; }},
      {"noise", [](SurveyPlan& p) -> double& { return p.sensor.noise; }},
      {"pattern", [](SurveyPlan& p) -> double& { return p.sensor.pattern; }},
      {"ray", [](SurveyPlan& p) -> double& { return p.sensor.ray_angle; }},
      {"view", [](SurveyPlan& p) -> double& { return p.sensor.view_along; }},
      {"height", [](SurveyPlan& p) -> double& { return p.height; }},
      {"offset", [](SurveyPlan& p) -> double& { return p.offset; }},
      {"slope", [](SurveyPlan& p) -> double& { return p.density_slope; }}};
  test::make_hostile<SurveyPlan>(
      {}, members,
      {{"plan_survey",
        [](const SurveyPlan& p) { return finite(plan_survey(p).density_sd_percent); }},
       {"survey_needs",
        [](const SurveyPlan& p) { return finite(survey_needs(p, 2.0).nearest_range); }}});
  for (const double bad : {nan, -1.0, 0.0}) {
    EXPECT_TRUE(refuses([&] { survey_needs({}, bad); }, "target"));
  }
  for (const int bad : {0, -1, std::numeric_limits<int>::min()}) {
    SurveyPlan plan;
    plan.frames = bad;
    EXPECT_TRUE(refuses([&] { plan_survey(plan); }, "number of frames"));
  }
  SurveyPlan empty;
  empty.sensor = {};
  EXPECT_TRUE(refuses([&] { plan_survey(empty); }, "survey plan"));
}

TEST(HostileDepthImage, PixelsAndIntrinsics) {
  Cloud image;
  image.width = 8;
  image.height = 6;
  image.points.assign(48, Eigen::Vector3d(0.0, 0.0, 1.0));
  DepthIntrinsics good;
  good.fx = good.fy = 10.0;
  good.cx = good.cy = 3.0;
  ASSERT_NO_THROW(point_at_pixel(image, good, 3.0, 3.0));
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_TRUE(refuses([&] { point_at_pixel(image, good, bad, 3.0); }, "outside"));
    EXPECT_TRUE(refuses([&] { point_at_pixel(image, good, 3.0, bad); }, "outside"));
    DepthIntrinsics camera = good;
    camera.fx = bad == 1e300 ? 0.0 : bad;
    EXPECT_TRUE(refuses([&] { point_at_pixel(image, camera, 3.0, 3.0); }, "fx"));
    camera = good;
    camera.max_depth = bad == 1e300 ? 0.0 : bad;
    EXPECT_TRUE(refuses([&] { depth_image_to_cloud("none.png", camera); }, "max_depth") ||
                answers([&] { return depth_image_to_cloud("none.png", camera).width == 0; }));
  }
  image.points.resize(5);
  EXPECT_TRUE(refuses([&] { point_at_pixel(image, good, 3.0, 3.0); }, "number of its points"));
  EXPECT_TRUE(refuses([&] { point_at_pixel({}, good, 0.0, 0.0); }, "outside"));
  EXPECT_TRUE(refuses([&] { average_depth_images({}, good); }));
}

}  // namespace
}  // namespace excavplan
