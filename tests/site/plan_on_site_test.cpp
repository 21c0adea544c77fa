// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/site/plan_on_site.hpp>

#include <gtest/gtest.h>

#include <excavplan/simulation/dig_ground.hpp>

#include "site/site_digs.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::DigsInARow;
using test::error_of;
using test::has;
using test::TemporaryFolder;

TEST(PlanOnSite, IsForTheStatedDensityUntilADigToldOne) {
  const TemporaryFolder folder;
  DigsInARow digs(60.0);
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  SitePlanOptions options;
  EXPECT_NE(error_of([&] { plan_on_site(site, options); }).find("no scan was taken in"),
            std::string::npos);
  site.update(digs.scan());
  options.density = GroundDensity(35.0, 5.0);
  const SitePlan first = plan_on_site(site, options);
  EXPECT_EQ(first.density.percent, 35.0);
  ASSERT_TRUE(first.plan.dig);
  site.update(digs.dig(6.0));
  const SitePlan second = plan_on_site(site, options);
  EXPECT_NEAR(second.density.percent, 60.0, 4.0 * second.density.sd_percent);
  EXPECT_LT(second.density.sd_percent, 15.0);
  EXPECT_EQ(second.density.soil, "loam");
  EXPECT_GT(second.ground.loose.maxCoeff(), 0.1) << "the heap, beside or in the strip";
  options.base.x = 40.0;  // off what any scan showed
  const SitePlan elsewhere = plan_on_site(site, options);
  EXPECT_FALSE(elsewhere.plan.dig);
  EXPECT_FALSE(elsewhere.plan.reason.empty());
}

TEST(PlanOnSite, KeepsClearOfWhatStandsThereNow) {
  const TemporaryFolder folder;
  DigsInARow digs(60.0);
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  SitePlanOptions options;
  options.density = GroundDensity(60.0);
  const Machine& machine = digs.settings().machine;
  Terrain present = level_planning_ground(machine);
  present.obstacles =
      Eigen::ArrayXXd::Constant(present.bank.z.rows(), present.bank.z.cols(), std::nan(""));
  EXPECT_FALSE(has(plan_on_site(site, options).plan.warnings, WarningCode::obstacle_in_strip));
  options.present = present;
  EXPECT_FALSE(has(plan_on_site(site, options).plan.warnings, WarningCode::obstacle_in_strip));
  for (Eigen::Index row = 0; row < present.bank.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < present.bank.z.cols(); ++col) {
      const bool stands = std::abs(present.bank.x(col) - 8.0) < 0.3;
      if (stands && std::abs(present.bank.y(row)) < 0.3) present.obstacles(row, col) = 1.7;
    }
  }
  options.present = present;
  const SitePlan plan = plan_on_site(site, options);
  EXPECT_TRUE(has(plan.plan.warnings, WarningCode::obstacle_in_strip));
  EXPECT_TRUE(std::isnan(height_at(plan.ground.bank, 8.0, 0.0)));
  options.present->bank.origin.x() += 0.02;
  EXPECT_EQ(error_of([&] { plan_on_site(site, options); }),
            "the present ground must have the cells of the plan");
}

}  // namespace
}  // namespace excavplan
