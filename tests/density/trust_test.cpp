// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_estimate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/scans/scan_pose.hpp>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "support/cases.hpp"
#include "support/dig_survey.hpp"
#include "support/site_scenes.hpp"

/// @file
/// Trust is neither lost nor given wrongly: whole families of scenes, and scans that people
/// reported.

namespace excavplan {
namespace {

using test::paper_law;

using scenes::Family;
using scenes::SiteScene;

bool warns(const DensityEstimate& estimate, WarningCode code) {
  return std::any_of(estimate.warnings.begin(), estimate.warnings.end(),
                     [&](const Warning& warning) { return warning.code == code; });
}

/// What came of the surveys of a family.
struct Outcome {
  int surveys = 0;
  int answered = 0;
  int inside = 0;            ///< the 95 % interval of k holds the truth
  int trusted_outside = 0;   ///< trusted, and it does not
  int distrusted_right = 0;  ///< not trusted, and k right to 1 %
  double squares = 0.0;      ///< of the relative errors of k
  double rms() const { return std::sqrt(squares / answered); }
};

void add(const SiteScene& scene, const DensityEstimate& estimate, Outcome& outcome) {
  if (!estimate.bulking) return;
  const double truth = scene.truth.bulking();
  const double error = estimate.bulking->value / truth - 1.0;
  const auto interval = bulking_interval(estimate.change);
  const bool holds = interval && truth >= (*interval)[0] && truth <= (*interval)[1];
  ++outcome.answered;
  outcome.squares += error * error;
  outcome.inside += holds ? 1 : 0;
  outcome.trusted_outside += estimate.trustworthy && !holds ? 1 : 0;
  outcome.distrusted_right += !estimate.trustworthy && std::abs(error) < 0.01 ? 1 : 0;
}

Outcome surveyed(const std::vector<std::string>& names, std::uint64_t seeds,
                 std::size_t points = 150000) {
  Outcome outcome;
  const DensityLaw law = paper_law();
  DensityOptions options;
  options.threads = 1;
  for (const std::string& name : names) {
    const auto family = std::find_if(scenes::families().begin(), scenes::families().end(),
                                     [&](const Family& f) { return f.name == name; });
    if (family == scenes::families().end()) {
      ADD_FAILURE() << "no family " << name;
      continue;
    }
    std::vector<std::optional<DensityEstimate>> estimates(seeds);
    std::vector<SiteScene> of_seed(seeds);
    parallel_for(seeds, 0, [&](std::size_t i) {
      of_seed[i] = scenes::site_scene(*family, 4001 + i, points);
      try {
        estimates[i] = estimate_density(scenes::scans_of(of_seed[i], i), law, options);
      } catch (const Error&) {  // refused
      }
    });
    for (std::size_t i = 0; i < seeds; ++i) {
      ++outcome.surveys;
      if (estimates[i]) add(of_seed[i], *estimates[i], outcome);
    }
  }
  return outcome;
}

TEST(Trust, IsKeptWithOutliersFlyingPointsAndMultipath) {
  const Outcome found =
      surveyed({"outliers", "outliers-rough", "outliers-lidars", "flying", "multipath"}, 2);
  EXPECT_EQ(found.answered, found.surveys);
  EXPECT_EQ(found.distrusted_right, 0);
  EXPECT_EQ(found.trusted_outside, 0);
}

TEST(Trust, IsKeptWithNoDataWhichIsNamed) {
  const auto family = std::find_if(scenes::families().begin(), scenes::families().end(),
                                   [](const Family& f) { return f.name == "no-data"; });
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SiteScene scene = scenes::site_scene(*family, seed, 150000);
    const DensityEstimate estimate = estimate_density(scenes::scans_of(scene, seed), paper_law());
    EXPECT_TRUE(estimate.trustworthy) << seed;
    ASSERT_TRUE(warns(estimate, WarningCode::outliers)) << seed;
    EXPECT_NE(estimate.warnings.front().message.find("stands for no data"), std::string::npos);
    EXPECT_NEAR(estimate.bulking->value, scene.truth.bulking(), 0.01) << seed;
  }
}

TEST(Trust, IsKeptOverALevelFloor) {
  const Outcome found = surveyed({"level-floor"}, 4);
  EXPECT_EQ(found.answered, found.surveys);
  EXPECT_EQ(found.distrusted_right, 0);
}

/// Why a result is not to be trusted is told by what ends trust, and by that alone.
void expect_reasons(const DensityEstimate& estimate, const std::string& what) {
  const bool ends = std::any_of(estimate.warnings.begin(), estimate.warnings.end(),
                                [](const Warning& warning) { return warning.ends_trust; });
  EXPECT_EQ(estimate.trustworthy, !ends) << what;
}

TEST(Trust, IsEndedByAWarningThatSaysWhy) {
  const std::vector<Family>& all = scenes::families();
  // Some without a hole.
  const std::size_t each = test::are_all_tried() ? 2 : 1;
  std::vector<std::optional<DensityEstimate>> estimates(each * all.size());
  DensityOptions options;
  options.threads = 1;
  parallel_for(estimates.size(), 0, [&](std::size_t i) {
    const SiteScene scene = scenes::site_scene(all[i / each], 9001 + i, 20000);
    DigScans scans = scenes::scans_of(scene, i);
    if (i % 2 == 1 && i % 3 == 0) scans.after = scans.before;
    try {
      estimates[i] = estimate_density(scans, paper_law(), options);
    } catch (const Error&) {  // refused
    }
  });
  int untrusted = 0;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    if (!estimates[i]) continue;
    expect_reasons(*estimates[i], all[i / each].name);
    untrusted += estimates[i]->trustworthy ? 0 : 1;
  }
  EXPECT_GT(untrusted, 10);
}

TEST(StrewnSoil, IsInTheInterval) {
  const Outcome found = surveyed({"strewn-layer", "strewn-crumbs"}, 4);
  EXPECT_EQ(found.answered, found.surveys);
  EXPECT_EQ(found.inside, found.surveys);
  EXPECT_LT(found.rms(), 0.005);
}

TEST(StrewnSoil, IsStatedWithAndWithoutAThreshold) {
  const auto family = std::find_if(scenes::families().begin(), scenes::families().end(),
                                   [](const Family& f) { return f.name == "strewn-none"; });
  const SiteScene scene = scenes::site_scene(*family, 3, 150000);
  const VolumeChange change = estimate_density(scenes::scans_of(scene, 3), paper_law()).change;
  EXPECT_GT(change.outside.sd, 0.0);
  EXPECT_LT(std::abs(change.outside.value), 4.0 * change.outside.sd) << "nothing was strewn";
  EXPECT_GE(change.strewn.value, 0.0);
  EXPECT_LE(change.strewn.value, std::max(0.0, change.outside.value) + 1e-12);
}

TEST(ForeignThings, AreInTheIntervalOrEndTrust) {
  const Outcome found =
      surveyed({"back-over-rim", "foreign-berm", "bucket-rests", "crate-before"}, 2);
  EXPECT_EQ(found.trusted_outside, 0);
}

// ---- Thorough ---------------------------------------------------------------------------------

TEST(Families, StrewnSoilIsInMostIntervals) {
  const Outcome found = surveyed({"strewn-layer", "strewn-crumbs"}, 100);
  const Outcome without = surveyed({"strewn-none"}, 50);
  std::cout << "  inside " << found.inside << " of " << found.surveys << ", rms " << found.rms()
            << "; without strewn soil " << without.inside << " of " << without.surveys << ", rms "
            << without.rms() << "\n";
  EXPECT_GE(found.inside, 184) << "92 %";
  EXPECT_LT(found.rms(), 0.005);
  EXPECT_LT(without.rms(), 0.002);
}

TEST(Families, OutliersNoDataAndFlatFloorsLoseTrustInThreeOfAHundredAtMost) {
  const Outcome found = surveyed({"outliers", "outliers-rough", "outliers-lidars", "flying",
                                  "multipath", "no-data", "level-floor"},
                                 12);
  std::cout << "  not trusted and right " << found.distrusted_right << " of " << found.surveys
            << ", trusted and outside " << found.trusted_outside << "\n";
  EXPECT_LE(found.distrusted_right, 2);
  EXPECT_LE(found.trusted_outside, 4) << "intervals of 95 %";
}

TEST(Families, ForeignThingsAreSeldomTrustedAndOutside) {
  const Outcome found =
      surveyed({"back-over-rim", "foreign-berm", "bucket-rests", "crate-before"}, 26);
  std::cout << "  trusted and outside " << found.trusted_outside << " of " << found.surveys << "\n";
  EXPECT_LE(found.trusted_outside, 2) << "2 %";
}

// ---- Scans of others --------------------------------------------------------------------------

constexpr const char* shared_data = EXCAVPLAN_SHARED_DATA;

DigScans reported(const std::string& folder, const std::string& ending) {
  const std::string path = std::string(shared_data) + "/reported/" + folder + "/";
  Scan before;
  before.files = {path + "b" + ending};
  Scan after;
  after.files = {path + "a" + ending};
  return {before, after};
}

TEST(ReportedScans, HoldTheTruthAndAreTrusted) {
  if (!std::filesystem::exists(std::string(shared_data) + "/reported")) {
    GTEST_SKIP() << "no reported scans in " << shared_data;
  }
  for (const auto& [folder, ending] : std::vector<std::pair<std::string, std::string>>{
           {"crumbs", ".pcd"}, {"thin-spill", ".pcd"}, {"no-data", ".xyz"}}) {
    const DensityEstimate estimate = estimate_density(reported(folder, ending), paper_law());
    EXPECT_TRUE(estimate.trustworthy) << folder;
    const auto interval = bulking_interval(estimate.change);
    ASSERT_TRUE(interval) << folder;
    EXPECT_LE((*interval)[0], 1.220) << folder;
    EXPECT_GE((*interval)[1], 1.220) << folder;
  }
}

/// The scans of a wheel loader's bite in a whole site, in two random halves or as they are.
DigScans bite(std::optional<std::uint64_t> split, bool second) {
  const std::string folder = std::string(shared_data) + "/dig-pair-livox/";
  Random random(split.value_or(0), 0);
  const auto part = [&](const std::string& name) {
    auto cloud = std::make_shared<Cloud>();
    for (const Eigen::Vector3d& point : read_cloud(folder + name + ".pcd").points) {
      if (!split || (random.uniform() < 0.5) == second) cloud->points.push_back(point);
    }
    cloud->width = cloud->points.size();
    Scan scan;
    scan.clouds = {cloud};
    scan.site_from_scan = read_frame(folder + name + "_frame.txt");
    return scan;
  };
  Scan before = part("before");
  return {std::move(before), part("after")};
}

bool holds(const Measured& volume, double low, double high) {
  return volume.value - 1.96 * volume.sd <= high && volume.value + 1.96 * volume.sd >= low;
}

TEST(RealPair, IsAnsweredWithoutAnArea) {
  if (!std::filesystem::exists(std::string(shared_data) + "/dig-pair-livox")) {
    GTEST_SKIP() << "no real scans in " << shared_data;
  }
  const VolumeChange change = estimate_density(bite({}, false), paper_law()).change;
  EXPECT_TRUE(holds(change.excavated, 2.80, 2.96)) << change.excavated.value;
  EXPECT_TRUE(holds(change.spilled, 0.36, 0.38)) << change.spilled.value;
  EXPECT_LT(change.excavated.sd, 0.4);
  EXPECT_LT(change.spilled.sd, 0.1);
}

TEST(RealPair, HalvesAgreeWithoutAnArea) {
  if (!std::filesystem::exists(std::string(shared_data) + "/dig-pair-livox")) {
    GTEST_SKIP() << "no real scans in " << shared_data;
  }
  int holes = 0;
  int spills = 0;
  const auto agree = [](const Measured& a, const Measured& b) {
    return std::abs(a.value - b.value) < 1.96 * std::hypot(a.sd, b.sd);
  };
  for (std::uint64_t split = 1; split <= 20; ++split) {
    const VolumeChange one = estimate_density(bite(split, false), paper_law()).change;
    const VolumeChange two = estimate_density(bite(split, true), paper_law()).change;
    holes += agree(one.excavated, two.excavated) ? 1 : 0;
    spills += agree(one.spilled, two.spilled) ? 1 : 0;
  }
  std::cout << "  hole agrees in " << holes << ", spill in " << spills << " of 20 splits\n";
  EXPECT_GE(holes, 19);
  EXPECT_GE(spills, 19);
}

}  // namespace
}  // namespace excavplan
