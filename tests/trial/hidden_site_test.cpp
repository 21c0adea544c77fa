// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/hidden_site.hpp>

#include <cstdlib>
#include <filesystem>

#include <excavplan/trial/job_score.hpp>

#include "support/errors.hpp"
#include "support/plain_site_folder.hpp"

namespace excavplan::test {
namespace {

TEST(HiddenSite, TheTrueSoilHasAStrengthAndWaterOfItsOwn) {
  PlainSiteFolder folder;
  folder.truth["strength_factor"] = 1.5;
  folder.truth["water_content_true"] = 0.14;
  const HiddenSite site = folder.read();
  const SoilKind& told = site.known.soil;
  EXPECT_DOUBLE_EQ(site.soil.cohesion_loosest, 1.5 * told.cohesion_loosest);
  EXPECT_DOUBLE_EQ(bank_state(site.soil, 50).adhesion, 1.5 * bank_state(told, 50).adhesion);
  EXPECT_DOUBLE_EQ(site.soil.cone_index_reference, 1.5 * told.cone_index_reference);
  EXPECT_EQ(site.soil.friction_loosest, told.friction_loosest);
  EXPECT_EQ(site.soil.water_content, 0.14);
  EXPECT_EQ(told.water_content, 0.12);
}

TEST(HiddenSite, WaterThatThePoresCannotHoldIsLeftOut) {
  PlainSiteFolder folder;
  folder.truth["water_content_true"] = 0.5;
  const HiddenSite site = folder.read();
  EXPECT_DOUBLE_EQ(bank_state(site.soil, 100).saturation, 1.0);
}

TEST(HiddenSite, VoidRatiosOfTheSiteReplaceThoseOfTheSoil) {
  PlainSiteFolder folder;
  folder.site["soil"] = {{"name", "sand"}, {"e_max", 0.85}, {"e_min", 0.5}};
  const SoilKind soil = folder.read().known.soil;
  EXPECT_EQ(soil.void_ratio_min, 0.5);
  EXPECT_NEAR(soil.void_ratio_loose, 0.85 - 0.05 * 0.35, 1e-12);
}

TEST(HiddenSite, DensityGrowsWithDepthAndIsClipped) {
  TrueDensity field;
  field.percent = flat_ground({0, 0, 4, 4}, 0.5, 5.0);
  EXPECT_EQ(field.at(2, 2, 0.0), 10.0);  // without a gradient
  field.gradient = 30.0;
  field.datum = 0.2;
  EXPECT_DOUBLE_EQ(field.at(2, 2, 0.2), 5.0);
  EXPECT_DOUBLE_EQ(field.at(2, 2, -0.8), 35.0);
  EXPECT_EQ(field.at(2, 2, -9.0), 100.0);
  EXPECT_EQ(field.at(2, 2, 1.2), 0.0);
}

TEST(HiddenSite, TheBankHasTheVoidRatioOfItsPlace) {
  PlainSiteFolder folder;
  folder.density = [](double x, double) { return x < 2.0 ? 20.0 : 80.0; };
  const HiddenSite site = folder.read();
  const auto density = [&](double x) {
    const auto col = static_cast<Eigen::Index>((x + 8.0) / 0.05);
    return 100.0 * bank_state_of_void_ratio(site.soil, site.ground.bank_void_ratio(50, col))
                       .relative_density;
  };
  EXPECT_NEAR(density(-3.0), 20.0, 1e-9);
  EXPECT_NEAR(density(6.0), 80.0, 1e-9);
  EXPECT_GT(mean_density(site), 70.0);
}

TEST(HiddenSite, TheFootprintIsWhereTheDesignLiesBelowTheGround) {
  PlainSiteFolder folder;
  folder.site["design"]["wall_horizontal_per_vertical"] = 1.0;
  const HiddenSite site = folder.read(0.025);
  const HeightMap footprint = footprint_of(site);
  const double area = 0.025 * 0.025 * static_cast<double>((!footprint.z.isNaN()).count());
  EXPECT_NEAR(area, 4.8 * 1.8, 0.05 * 13.2);
  EXPECT_NEAR(score_job(site, site.ground.surface(), 1.0).design_cut,
              0.4 * 4.0 + 0.5 * 0.4 * 0.4 * 10.0 + 4.0 / 3.0 * 0.4 * 0.4 * 0.4, 0.01);
}

TEST(HiddenSite, WhatIsWrongIsNamed) {
  PlainSiteFolder folder;
  folder.site["sensor"]["mount"] = "kite";
  EXPECT_NE(error_of([&] { folder.read(); }, ErrorKind::bad_file)
                .find("mount: is 'kite', must be boom, cab or mast"),
            std::string::npos);
  folder.site["sensor"]["mount"] = "cab";
  folder.site.erase("start_pose");
  EXPECT_NE(error_of([&] { folder.read(); }, ErrorKind::bad_file).find("start_pose"),
            std::string::npos);
}

TEST(HiddenSite, TheSitesThatWeHaveAreRead) {
  const std::string archive = std::string(EXCAVPLAN_SHARED_DATA) + "/sites/sites.tar.gz";
  if (!std::filesystem::exists(archive)) GTEST_SKIP() << "no plain sites";
  const TemporaryFolder folder;
  const std::string unpack = "tar -xzf '" + archive + "' -C '" + folder.file("") + "'";
  ASSERT_EQ(std::system(unpack.c_str()), 0);  // NOLINT: a test
  int sites = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.file(""))) {
    if (entry.path().filename() != "site.json") continue;
    const HiddenSite site = read_hidden_site(entry.path().parent_path().string(), 0.05);
    const double told =
        nlohmann::json::parse(content_of(entry.path().string())).at("design_cut_m3");
    const JobScore untouched = score_job(site, site.ground.surface(), 0.0);
    EXPECT_NEAR(untouched.design_cut, told, 0.01 * told) << entry.path();
    EXPECT_NEAR(untouched.left_percent(), 100.0, 1e-6);
    ++sites;
  }
  EXPECT_EQ(sites, 6);
}

}  // namespace
}  // namespace excavplan::test
