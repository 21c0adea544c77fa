// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/job_score.hpp>

#include "support/errors.hpp"
#include "support/plain_site_folder.hpp"

namespace excavplan::test {
namespace {

/// The ground of a site with the trench of PlainSiteFolder dug from one end to another.
class Trench {
 public:
  explicit Trench(const HiddenSite& site) : ground(site.ground.surface()) {}

  /// Sets the height where x and y lie in a rectangle.
  Trench& set(const Rectangle& area, double height) {
    for (Eigen::Index col = 0; col < ground.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < ground.z.rows(); ++row) {
        if (area.contains(ground.x(col), ground.y(row))) ground.z(row, col) = height;
      }
    }
    return *this;
  }
  HeightMap ground;
};

constexpr Rectangle all_of_it = {2.0, -0.5, 6.0, 0.5};

TEST(JobScore, AGroundOfTheShapeOfItsDesignIsFinished) {
  const HiddenSite site = PlainSiteFolder().read();
  Trench trench(site);
  trench.set(all_of_it, -0.4).set({2.0, 2.0, 6.0, 2.5}, 0.8);
  const JobScore score = score_job(site, trench.ground, 1.0);
  EXPECT_TRUE(score.finished);
  EXPECT_NEAR(score.design_cut, 1.6, 1e-9);
  EXPECT_NEAR(score.rms, 0.0, 1e-9);
  EXPECT_NEAR(score.left, 0.0, 1e-9);
  EXPECT_NEAR(score.overdig_percent(), 0.0, 1e-9);
  EXPECT_NEAR(score.risen, 1.6, 1e-9);
  EXPECT_EQ(score.spilled, 0.0);
}

TEST(JobScore, ARampLeftAtTheEndIsNotFinished) {
  const HiddenSite site = PlainSiteFolder().read(0.025);
  Trench trench(site);
  trench.set(all_of_it, -0.4);
  // Of the zone, 3.8 m long, less than 5 % is off, but more than 1 % by far.
  trench.set({5.75, -0.5, 6.0, 0.5}, -0.25);
  const JobScore score = score_job(site, trench.ground, 1.0);
  EXPECT_LE(score.p95, 0.03);
  EXPECT_GT(score.beyond_twice, 0.03);
  EXPECT_FALSE(score.finished);
}

TEST(JobScore, TheRimDoesNotCount) {
  const HiddenSite site = PlainSiteFolder().read();
  Trench trench(site);
  trench.set(all_of_it, -0.4).set({2.0, -0.5, 2.1, 0.5}, 0.0);
  EXPECT_TRUE(score_job(site, trench.ground, 1.0).finished);
}

TEST(JobScore, TheRimIsAsWideAsToldWhereverCellsLie) {
  PlainSiteFolder folder;
  folder.site["design"]["floor_width_m"] = 1.05;  // half a cell of 5 cm more on each side
  const HiddenSite site = folder.read();
  Trench trench(site);
  trench.set({2.0, -0.4, 6.0, 0.4}, -0.4);
  EXPECT_FALSE(score_job(site, trench.ground, 1.0).finished);
  trench.set({2.0, -0.45, 6.0, 0.45}, -0.4);
  EXPECT_TRUE(score_job(site, trench.ground, 1.0).finished);
}

TEST(JobScore, WhatNobodySawIsNotFinished) {
  const HiddenSite site = PlainSiteFolder().read();
  Trench trench(site);
  trench.set(all_of_it, -0.4);
  EXPECT_FALSE(score_job(site, trench.ground, 0.98).finished);
}

TEST(JobScore, OverdigCountsInsideAndBeside) {
  const HiddenSite site = PlainSiteFolder().read();
  Trench trench(site);
  trench.set(all_of_it, -0.5).set({6.0, -0.5, 6.5, 0.5}, -0.32);
  const JobScore score = score_job(site, trench.ground, 1.0);
  EXPECT_NEAR(score.overdig_inside, 0.4, 1e-9);
  EXPECT_NEAR(score.overdig_beside, 0.16, 1e-9);
  EXPECT_NEAR(score.overdig_percent(), 35.0, 1e-6);
  EXPECT_FALSE(score.finished);
}

TEST(JobScore, SoilBesideTheDumpAreasIsSpilled) {
  PlainSiteFolder folder;
  const HiddenSite site = folder.read();
  Trench trench(site);
  trench.set(all_of_it, -0.4).set({2.0, 2.0, 6.0, 2.5}, 0.9).set({2.0, -1.5, 6.0, -1.0}, 0.1);
  EXPECT_NEAR(score_job(site, trench.ground, 1.0).spill_percent(), 10.0, 1e-6);
  folder.site["dump_areas"] = nlohmann::json::array();
  folder.site["truck"] = {
      {"bed_polygon", {{2, 2}, {6, 2}, {6, 4}}}, {"bed_height_m", 2.4}, {"target_kg", 4000}};
  const HiddenSite by_truck = folder.read();
  Trench hauled(by_truck);
  hauled.set(all_of_it, -0.4).set({2.0, -1.5, 6.0, -1.0}, 0.1);
  EXPECT_NEAR(score_job(by_truck, hauled.ground, 1.0).spill_percent(), 12.5, 1e-6);
}

TEST(JobScore, AKeepOutMayChangeByTenLitres) {
  PlainSiteFolder folder;
  folder.site["keep_out"] = {{{"kind", "cable"}, {"polygon", {{7, -1}, {8, -1}, {8, 1}, {7, 1}}}}};
  const HiddenSite site = folder.read();
  Trench trench(site);
  trench.set(all_of_it, -0.4).set({7.0, 0.0, 7.5, 0.5}, 0.03);
  EXPECT_TRUE(score_job(site, trench.ground, 1.0).finished);
  trench.set({7.5, 0.0, 8.0, 0.5}, -0.03);
  const JobScore score = score_job(site, trench.ground, 1.0);
  EXPECT_NEAR(score.keep_out, 0.015, 1e-9);
  EXPECT_FALSE(score.finished);
  folder.site["keep_out"][0]["depth_m"] = 0.5;
  EXPECT_TRUE(score_job(folder.read(), trench.ground, 1.0).finished);
}

TEST(JobScore, SteepFacesDoNotCount) {
  PlainSiteFolder folder;
  folder.site["design"]["wall_horizontal_per_vertical"] = 0.5;  // 63 degrees
  const HiddenSite steep = folder.read(0.025);
  Trench trench(steep);
  trench.set(all_of_it, -0.4);  // upright where the design slopes
  EXPECT_TRUE(score_job(steep, trench.ground, 1.0).finished);
  folder.site["design"]["wall_horizontal_per_vertical"] = 1.0;
  const HiddenSite gentle = folder.read(0.025);
  EXPECT_FALSE(score_job(gentle, trench.ground, 1.0).finished);
}

TEST(JobScore, AnotherGridIsRefused) {
  const HiddenSite site = PlainSiteFolder().read();
  EXPECT_NE(error_of([&] {
              score_job(site, flat_ground({0, 0, 1, 1}, 0.05), 1.0);
            }).find("not on the grid"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan::test
