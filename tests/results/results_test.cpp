// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/results/result_json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <variant>

#include <Eigen/Geometry>

#include <excavplan/base/data_files.hpp>
#include <excavplan/figures/figure_images.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/maps/ground_maps.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/results/force_history.hpp>
#include <excavplan/results/stated_density.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/json.hpp"
#include "results/plan_results.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::loam;
using test::zx120;

const DigScene& scene() {
  static const DigScene dug = [] {
    SceneOptions options;
    options.history = true;
    const Terrain ground =
        undisturbed(flat_ground(scene_extent(zx120(), options.dump_at), usual_cell(zx120())));
    return run_scene(zx120(), loam(), 40.0, ground, options);
  }();
  return dug;
}

TEST(Results, OfADigAreItsNumbers) {
  const auto json = nlohmann::json::parse(to_json(zx120(), scene()));
  EXPECT_EQ(json.at("soil"), "loam");
  EXPECT_DOUBLE_EQ(json.at("payload_mass_kg"), scene().dig.payload_mass);
  EXPECT_DOUBLE_EQ(json.at("energy_kj"), scene().dig.energy.total / 1000.0);
  EXPECT_TRUE(json.at("stall").is_null());
}

TEST(Results, AScanOfAJobTellsWhereTheFrontLooksAndADigOnItsPath) {
  JobStep step;
  step.swung = 1.25;
  step.what = JobAction::scan;
  EXPECT_EQ(job_step_json(step).at("swung_rad"), 1.25);
  EXPECT_TRUE(job_step_json(step).at("path").is_null());
  step.what = JobAction::dig;
  EXPECT_EQ(job_step_json(step).at("path").at("swung_rad"), 1.25);
  EXPECT_FALSE(job_step_json(step).contains("swung_rad"));
}

TEST(Results, ForceHistoryHasARowPerStep) {
  const std::string csv = force_history_csv(zx120(), scene());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'),
            static_cast<std::ptrdiff_t>(scene().dig.history.size() + 1));
}

TEST(Results, ForceHistoryOfALiftAloneHasNoRow) {
  DigScene lift = scene();
  for (DigPose& pose : lift.path.poses) pose.phase = DigPhase::lift;
  lift.dig.history.clear();
  const std::string csv = force_history_csv(zx120(), lift);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1);
}

TEST(Results, OfAnEstimateAreReadAgain) {
  DensityEstimate estimate;
  estimate.bulking = Measured{1.2, 0.01};
  RelativeDensity density;
  density.percent = density.raw_percent = 41.5;
  density.sd_percent = 3.0;
  density.sd_given_law_percent = 2.0;
  estimate.density = density;
  estimate.law.soil = "loam";
  const auto file = std::filesystem::path(::testing::TempDir()) / "estimate_of_results_test.json";
  std::ofstream(file) << to_json(estimate);
  const StatedDensity stated = stated_density(file.string());
  std::filesystem::remove(file);
  EXPECT_DOUBLE_EQ(stated.density.percent, 41.5);
  EXPECT_DOUBLE_EQ(stated.density.sd_percent, 3.0);
  EXPECT_DOUBLE_EQ(stated.independent_sd, 2.0);
  EXPECT_EQ(stated.density.soil, "loam");
}

TEST(Results, MapsOfADigAreOfItsGround) {
  const std::vector<NamedMap> maps = scene_maps(scene());
  ASSERT_EQ(maps.size(), 4u);
  EXPECT_EQ(maps.front().name, "all");
  EXPECT_EQ(maps.front().map.layers.size(), 3u);
  const Eigen::ArrayXXd& change = maps.back().map.layers.front().values;
  EXPECT_LT(change.minCoeff(), -0.1);
  EXPECT_GT(change.maxCoeff(), 0.1);
}

// On ground that rises away from the machine, whose path goes on above it.
TEST(Results, TheOutlineOfAPlannedCutLiesOnTheGroundAboutWhatTheDigLowers) {
  const Terrain ground = sloped_planning_ground(zx120(), 0.15, 0.1);
  DigPlan plan;
  plan.dig.emplace();
  plan.path = std::get<DigPath>(
      make_dig_path_anywhere(zx120(), {0.785, 0.35, 1.0}, boom_plane_profile(ground)));
  const SimulatorKind simulator = default_simulator();
  const std::vector<NamedMap> maps = plan_maps(zx120(), plan, {loam(), 30.0, ground, simulator});
  ASSERT_EQ(maps.back().name, "path");
  const MapLine& outline = maps.back().lines.back();
  ASSERT_EQ(outline.points.size(), 4U);
  EXPECT_TRUE(outline.is_closed);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : outline.points) {
    box.extend(corner.head<2>());
    EXPECT_NEAR(corner.z(), std::tan(0.15) * (corner.x() - zx120().track_front), 1e-9);
  }
  EXPECT_DOUBLE_EQ(box.min().y(), -0.35);
  EXPECT_DOUBLE_EQ(box.max().y(), 0.35);
  ASSERT_EQ(maps[4].name, "footprint");
  const HeightMap& cells = maps[4].map.ground;
  const auto lowered = (maps[4].map.layers.front().values == 1.0).colwise().any().eval();
  Eigen::AlignedBox1d along;
  for (Eigen::Index col = 0; col < lowered.size(); ++col) {
    if (lowered(col)) along.extend(Eigen::Matrix<double, 1, 1>(cells.x(col)));
  }
  EXPECT_NEAR(box.min().x(), along.min()(0), 0.1);
  EXPECT_NEAR(box.max().x(), along.max()(0), 0.1);
}

TEST(Figures, AreEqualForEqualResults) {
  for (const DigImage what : {DigImage::section, DigImage::forces, DigImage::torques,
                              DigImage::power, DigImage::cylinders}) {
    const std::string svg = dig_image(zx120(), scene(), what);
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_EQ(svg, dig_image(zx120(), scene(), what));
  }
}

TEST(Figures, OfGroundHaveAtMostSoManyCells) {
  HeightMap plain = flat_ground({0.0, 0.0, 40.0, 2.0}, 0.05);  // 800 cells long
  plain.z.leftCols(80).setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::string svg = ground_image(plain);
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("not seen"), std::string::npos);
  EXPECT_LT(svg.size(), ground_image(flat_ground({0.0, 0.0, 10.0, 10.0}, 0.05)).size() + 200000);
}

TEST(Pages, OfTheLibraryHoldTheResultAndNoOptions) {
  const std::string page = report_page(zx120(), scene());
  EXPECT_EQ(page, report_page(zx120(), scene()));
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0U);
  EXPECT_NE(page.find("payload_mass_kg"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("<section id=\"settings\">"), std::string::npos);
}

TEST(Figures, HaveTheFormatAskedFor) {
  EXPECT_EQ(reach_image(zx120(), ImageFormat::png).substr(1, 3), "PNG");
  EXPECT_EQ(reach_image(zx120(), ImageFormat::pdf).substr(0, 4), "%PDF");
}

}  // namespace
}  // namespace excavplan
