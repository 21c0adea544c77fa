// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_estimate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/paper/paper_change.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/random.hpp"
#include "support/dig_survey.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"
#include "support/survey_scenes.hpp"

namespace excavplan {
namespace {

using scenes::Part;
using test::error_of;
using test::has;
using test::paper_law;

std::shared_ptr<const Cloud> cloud_from(std::vector<Eigen::Vector3d> points) {
  auto cloud = std::make_shared<Cloud>();
  cloud->points = std::move(points);
  cloud->width = cloud->points.size();
  return cloud;
}

/// Clouds in memory of a dig whose soil swells by `bulking`.
Scan seen(Part part, bool after, double bulking = 1.2) {
  scenes::Dig dig;
  dig.bulking = bulking;
  Scan scan;
  scan.clouds = {cloud_from(scenes::scan(dig, part, scenes::errors_of("noise"), 60000, 7, after))};
  return scan;
}

DigScans whole_scene(double bulking = 1.2) {
  return {seen(Part::whole, false, bulking), seen(Part::whole, true, bulking)};
}

DigScans two_areas() {
  return {seen(Part::dig, false), seen(Part::dig, true),
          ScanPair{seen(Part::dump, false), seen(Part::dump, true)}};
}

void expect_same(const DensityEstimate& a, const DensityEstimate& b) {
  EXPECT_EQ(a.cell_size, b.cell_size);
  EXPECT_EQ(a.change.excavated.value, b.change.excavated.value);
  EXPECT_EQ(a.change.dumped.value, b.change.dumped.value);
  if (a.method == VolumeMethod::surface) {  // the paper's gives no error
    EXPECT_EQ(a.change.after.sd, b.change.after.sd);
  }
  ASSERT_TRUE(a.density && b.density);
  EXPECT_EQ(a.density->raw_percent, b.density->raw_percent);
  EXPECT_EQ(a.density->sd_percent, b.density->sd_percent);
}

TEST(EstimateDensity, FindsTheDensityThatGaveTheBulkingFactor) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  for (const double density : {20.0, 60.0}) {
    const DensityEstimate found =
        estimate_density(whole_scene(bulking_of_density(loam, density)), loam);
    ASSERT_TRUE(found.density);
    EXPECT_NEAR(found.density->percent, density, 3.0 * found.density->sd_percent);
    EXPECT_LT(found.density->sd_percent, 2.0);
    EXPECT_EQ(found.density->raw_percent, found.density_without_fallback);
    EXPECT_TRUE(found.trustworthy);
    EXPECT_TRUE(found.registration);
    EXPECT_FALSE(found.dump_registration);
    EXPECT_FALSE(found.corrected);
  }
}

TEST(EstimateDensity, LawAndScansOfTheEstimateAreThoseOfItsParts) {
  const DensityLaw law = paper_law();
  const DensityEstimate found = estimate_density(two_areas(), law);
  ASSERT_TRUE(found.bulking && found.density);
  EXPECT_EQ(found.bulking->value, bulking_factor(found.change)->value);
  EXPECT_EQ(found.density->percent, relative_density(law, *found.bulking).percent);
  EXPECT_EQ(found.law.name, law.name);
  EXPECT_EQ(found.change.areas.size(), 2U);
  EXPECT_TRUE(found.dump_registration);
}

TEST(EstimateDensity, ScansInMemoryGiveTheNumbersOfFiles) {
  const test::TemporaryFolder folder;
  const auto stored = [&](Scan scan, const std::string& name) {
    scan.files = {folder.file(name)};
    write_cloud(scan.files.front(), *scan.clouds.front(), {"ply", true});
    scan.clouds.clear();
    return scan;
  };
  DigScans held = whole_scene();
  for (Scan* scan : {&held.before, &held.after}) {
    scan->site_from_scan(0, 3) = 4.0;
    scan->area = Rectangle{1.2, -2.4, 11.8, 2.4};
  }
  const DigScans files = {stored(held.before, "a.ply"), stored(held.after, "b.ply")};
  std::vector<VolumeMethod> methods = {VolumeMethod::surface};
  DensityOptions options;
#ifdef EXCAVPLAN_PAPER
  methods.push_back(VolumeMethod::paper);
  options.paper = paper_change();
#endif
  for (const VolumeMethod method : methods) {
    options.method = method;
    expect_same(estimate_density(held, paper_law(), options),
                estimate_density(files, paper_law(), options));
  }
}

TEST(EstimateDensity, IsTheSameForAnyNumberOfThreads) {
  DensityOptions one;
  one.threads = 1;
  DensityOptions three;
  three.threads = 3;
  expect_same(estimate_density(two_areas(), paper_law(), one),
              estimate_density(two_areas(), paper_law(), three));
}

TEST(EstimateDensity, VolumesOfAnotherMethodAreAskedForWithWhatIsKnown) {
  const DigScans scans = two_areas();
  DensityOptions options;
  options.method = VolumeMethod::paper;
  options.cell_size = 0.11;
  EXPECT_EQ(error_of([&] { estimate_density(scans, paper_law(), options); }).substr(0, 52),
            "VolumeMethod::paper needs DensityOptions::paper, the");
  EXPECT_NE(error_of([&] { estimate_by_both(scans, paper_law(), options); }), "no error");
  options.paper = [&](const SurveyedDig& dig) {
    EXPECT_EQ(dig.scans.before.clouds, scans.before.clouds);
    EXPECT_EQ(dig.dump->after.clouds, scans.dump->after.clouds);
    EXPECT_EQ(dig.cell_size, 0.11);
    VolumeChange twice = dig.surface;
    twice.excavated.value *= 2.0;
    return twice;
  };
  const BothEstimates both = estimate_by_both(scans, paper_law(), options);
  EXPECT_EQ(both.paper.change.excavated.value, 2.0 * both.surface.change.excavated.value);
  options.paper = [](const SurveyedDig&) -> VolumeChange {
    throw Error(ErrorKind::bad_input, "no volumes");
  };
  EXPECT_NE(
      test::error_of([&] { estimate_density(scans, paper_law(), options); }, ErrorKind::bad_file)
          .find(": no volumes"),
      std::string::npos);
}

#ifdef EXCAVPLAN_PAPER
TEST(EstimateDensity, BothMethodsAreThoseOfSingleCalls) {
  const DigScans scans = whole_scene();
  DensityOptions options;
  options.paper = paper_change();
  const BothEstimates both = estimate_by_both(scans, paper_law(), options);
  expect_same(both.surface, estimate_density(scans, paper_law(), options));
  options.method = VolumeMethod::paper;
  const DensityEstimate paper = estimate_density(scans, paper_law(), options);
  EXPECT_EQ(both.paper.change.excavated.value, paper.change.excavated.value);
  EXPECT_EQ(both.paper.method, VolumeMethod::paper);
  EXPECT_EQ(paper.change.zones.size(), both.surface.change.zones.size());
  EXPECT_NE(paper.change.excavated.value, both.surface.change.excavated.value);
  EXPECT_FALSE(paper.trustworthy);
  EXPECT_TRUE(has(paper.warnings, "volume_error_unknown"));
}
#endif

TEST(EstimateDensity, OptionsReachTheSurvey) {
  DensityOptions options;
  options.cell_size = 0.11;
  options.registered = false;
  const DensityEstimate found = estimate_density(whole_scene(), paper_law(), options);
  EXPECT_EQ(found.cell_size, 0.11);
  EXPECT_EQ(found.change.areas.front().difference.cell_size, 0.11);
  EXPECT_FALSE(found.registration);
  options.change.dump_area = Rectangle{-3.0, 1.0, -2.0, 2.0};  // nothing was dumped there
  EXPECT_FALSE(estimate_density(whole_scene(), paper_law(), options).bulking);
}

TEST(EstimateDensity, WithoutDumpedSoilThereIsNoDensityToPlanWith) {
  const DensityEstimate found =
      estimate_density({seen(Part::dig, false), seen(Part::dig, true)}, paper_law());
  EXPECT_FALSE(found.bulking);
  EXPECT_FALSE(found.density);
  EXPECT_FALSE(found.ground_density());
  EXPECT_FALSE(found.trustworthy);
  EXPECT_TRUE(has(found.warnings, "no_dumped_soil"));
}

TEST(EstimateDensity, DensityToPlanWithIsThatOfTheEstimate) {
  DensityLaw law = paper_law();
  law.soil = "clay";
  DensityEstimate found = estimate_density(whole_scene(), law);
  found.trustworthy = false;
  const auto ground = found.ground_density();
  ASSERT_TRUE(ground);
  EXPECT_EQ(ground->percent, found.density->percent);
  EXPECT_EQ(ground->sd_percent, found.density->sd_percent);
  EXPECT_FALSE(ground->trustworthy);
  EXPECT_EQ(ground->soil, "clay");
}

TEST(EstimateDensity, ScansThatCannotBeComparedAreRefused) {
  DigScans scans = whole_scene();
  scans.after.site_from_scan(0, 3) = 100.0;
  EXPECT_THROW(estimate_density(scans, paper_law()), FrameError);
  scans = whole_scene();
  std::swap(scans.before, scans.after);
  EXPECT_NE(error_of([&] { estimate_density(scans, paper_law()); }, ErrorKind::bad_file)
                .find("are probably swapped"),
            std::string::npos);
  scans = whole_scene();
  scans.before.area = Rectangle{0.0, 0.0, 0.1, 0.1};
  EXPECT_EQ(error_of([&] { estimate_density(scans, paper_law()); }, ErrorKind::bad_file),
            "a scan in memory: holds fewer than 100 finite points inside the area");
  scans = whole_scene();
  scans.after.clouds.push_back(nullptr);
  EXPECT_EQ(error_of([&] { estimate_density(scans, paper_law()); }),
            "scan: one of its clouds is a null pointer");
}

TEST(EstimateDensity, APathThatWasNotDugHereIsRefused) {
  DensityOptions options;
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  options.dug_path = DugPath{machine, {0.78, 0.35, 9.0}, 6.0};
  EXPECT_EQ(error_of([&] {
              estimate_density(whole_scene(), paper_law(), options);
            }).rfind("path that was dug: ", 0),
            0U);
}

/// The scans of a wheel loader's bite, of which no truth is known, each in two random halves.
DigScans half_of_the_bite(std::uint64_t split, bool second) {
  const std::string folder = std::string(EXCAVPLAN_SHARED_DATA) + "/dig-pair-livox/";
  Random random(split, 0);
  const auto half = [&](const std::string& name) {
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3d& point : read_cloud(folder + name + ".pcd").points) {
      if ((random.uniform() < 0.5) == second) points.push_back(point);
    }
    Scan scan;
    scan.clouds = {cloud_from(std::move(points))};
    scan.site_from_scan = read_frame(folder + name + "_frame.txt");
    scan.area = Rectangle{0.3, 0.3, 9.0, 10.0};
    return scan;
  };
  Scan before = half("before");
  return {std::move(before), half("after")};
}

TEST(EstimateDensity, HalvesOfARealPairAgreeWithinTheirIntervals) {
  if (!std::filesystem::exists(EXCAVPLAN_SHARED_DATA "/dig-pair-livox")) {
    GTEST_SKIP() << "no real scans in " << EXCAVPLAN_SHARED_DATA;
  }
  int holes = 0;
  int spills = 0;
  const auto agree = [](const Measured& a, const Measured& b) {
    return std::abs(a.value - b.value) < 1.96 * std::hypot(a.sd, b.sd);
  };
  for (std::uint64_t split = 1; split <= 10; ++split) {
    const VolumeChange one = estimate_density(half_of_the_bite(split, false), paper_law()).change;
    const VolumeChange two = estimate_density(half_of_the_bite(split, true), paper_law()).change;
    holes += agree(one.excavated, two.excavated);
    spills += agree(one.spilled, two.spilled);
  }
  std::cout << "  hole agrees in " << holes << ", spill in " << spills << " of 10 splits\n";
  EXPECT_GE(holes, 9);
  EXPECT_GE(spills, 9);
}

}  // namespace
}  // namespace excavplan
