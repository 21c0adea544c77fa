// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/site/site.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "site/site_digs.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;
using test::DigsInARow;
using test::error_of;
using test::TemporaryFolder;

/// Names and contents of the files of a site.
std::map<std::string, std::string> files_in(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name != "site.lock") files[name] = test::content_of(entry.path());
  }
  return files;
}

TEST(Site, BeginsWithItsFirstScan) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  EXPECT_EQ(error_of([&] { Site(path, digs.settings()); }, ErrorKind::bad_file),
            path + ": holds no site: it has no site.json");
  {
    Site site(path, digs.settings(), SiteAccess::write);
    EXPECT_TRUE(site.is_empty());
    const SiteUpdate update = site.update(digs.scan());
    EXPECT_TRUE(update.taken);
    EXPECT_FALSE(update.estimate);
  }
  const Site site(path, digs.settings());
  EXPECT_EQ(site.updates(), 1);
  EXPECT_EQ(site.digs(), 0);
  const HeightMap surface = site.ground().terrain.surface();
  const double truth = height_at(digs.ground().surface(), 6.0, 0.3);
  EXPECT_NEAR(height_at(surface, 6.0, 0.3), truth, 0.01);
}

TEST(Site, GivesTheDensityOfDigAfterDigAtOnePlace) {
  const TemporaryFolder folder;
  DigsInARow digs(60.0);
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  for (const double start : {6.0, 6.0, 5.6}) {
    const SiteUpdate update = site.update(digs.dig(start));
    ASSERT_TRUE(update.taken);
    ASSERT_TRUE(update.estimate && update.estimate->density) << start;
    std::cout << update.estimate->density->percent << " +- " << update.estimate->density->sd_percent
              << " trust " << update.trustworthy << " site " << update.density->percent << " +- "
              << update.density->sd_percent << '\n';
    for (const Warning& each : update.warnings) std::cout << "  " << each.message << '\n';
    EXPECT_TRUE(update.trustworthy);
    EXPECT_NEAR(update.density->percent, 60.0, 3.0 * update.density->sd_percent);
  }
  EXPECT_EQ(site.digs(), 3);
  EXPECT_GT(site.ground().terrain.loose.maxCoeff(), 0.1);
}

}  // namespace
}  // namespace excavplan
