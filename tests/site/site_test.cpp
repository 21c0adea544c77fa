// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/site/site.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <excavplan/sensing/sensor_setup.hpp>
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
    SCOPED_TRACE(start);
    const SiteUpdate update = site.update(digs.dig(start));
    ASSERT_TRUE(update.taken);
    ASSERT_TRUE(update.estimate && update.estimate->density && update.density);
    EXPECT_TRUE(update.trustworthy);
    EXPECT_NEAR(update.density->percent, 60.0, 3.0 * update.density->sd_percent);
    EXPECT_LT(update.density->sd_percent, 12.0);
  }
  EXPECT_EQ(site.digs(), 3);
  EXPECT_GT(site.ground().terrain.loose.maxCoeff(), 0.1);
}

TEST(Site, TakesBeforeAndAfterOfItsFirstDig) {
  const TemporaryFolder folder;
  DigsInARow digs(40.0);
  const SiteEvent before = digs.scan();
  SiteEvent dig = digs.dig(6.0);
  dig.before = before.scan;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  const SiteUpdate update = site.update(dig);
  ASSERT_TRUE(update.density);
  EXPECT_NEAR(update.density->percent, 40.0, 3.0 * update.density->sd_percent);
  EXPECT_EQ(site.digs(), 1);
}

TEST(Site, LookAnswersLikeUpdateAndLeavesTheSite) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const SiteEvent dig = digs.dig(6.0);
  const SiteUpdate looked = site.look(dig);
  EXPECT_EQ(site.updates(), 1);
  const SiteUpdate updated = site.update(dig);
  ASSERT_TRUE(looked.density && updated.density);
  EXPECT_EQ(looked.density->raw_percent, updated.density->raw_percent);
  EXPECT_EQ(looked.digs, updated.digs);
}

TEST(Site, TheGroundOfAMachineThatTurnedIsTurned) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const BasePose base = {3.0, 1.0, 0.1, 0.5};
  const GroundState seen = site.ground_for(base, {1.0, -1.0, 3.0, 1.0}, 0.05);
  const Eigen::Vector3d place = base.site_from_machine() * Eigen::Vector3d(2.025, 0.025, 0.0);
  EXPECT_NEAR(height_at(seen.terrain.bank, 2.025, 0.025),
              height_at(site.ground().terrain.bank, place.x(), place.y()) - 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(
      site.ground_for({500.0, 0.0, 0.0, 0.0}, {1.0, -1.0, 3.0, 1.0}, 0.05).terrain.bank.z(3, 3)));
}

TEST(Site, TakesInWhatALaterScanShowsBesideTheGround) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  SiteEvent narrow = digs.scan();
  narrow.scan.area = Rectangle{2.0, -2.0, 9.0, 2.0};
  site.update(narrow);
  EXPECT_TRUE(std::isnan(height_at(site.ground().terrain.bank, 5.0, 3.5)));
  ASSERT_TRUE(site.update(digs.scan()).taken);
  EXPECT_NEAR(height_at(site.ground().terrain.bank, 5.0, 3.5),
              height_at(digs.ground().bank, 5.0, 3.5), 0.02);
}

TEST(Site, ADigThatNoScanShowsGivesNoDensity) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  SiteEvent stalled = digs.scan();
  stalled.dug = true;
  stalled.options.dug_path = {digs.settings().machine, SceneOptions().path, 6.0};
  const SiteUpdate update = site.update(stalled);
  EXPECT_FALSE(update.estimate && update.estimate->trustworthy);
  EXPECT_EQ(site.digs(), 0);
  EXPECT_TRUE(site.belief().digs().empty());
}

TEST(Site, AStallTellsOfTheSoilThatHeld) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const Rectangle strip = {5.5, -0.4, 6.0, 0.4};
  const GroundDensity before = site.density_at({}, strip, 0.3);
  SiteEvent stalled = digs.scan();
  stalled.dug = stalled.stalled = true;
  stalled.options.dug_path = {digs.settings().machine, SceneOptions().path, 6.0};
  site.update(stalled);
  EXPECT_EQ(site.digs(), 0) << "no survey told a density";
  ASSERT_EQ(site.belief().digs().size(), 1U);
  EXPECT_GT(site.density_at({}, strip, 0.3).percent, before.percent + 5.0);
  const DigParameters path = SceneOptions().path;
  const double length =
      path.penetration_length * std::cos(path.penetration_angle) + path.drag_length;
  double along = 0.0, volume = 0.0;
  for (const BankPart& part : site.belief().digs().front().bank) {
    along += part.volume * part.place.x;
    volume += part.volume;
  }
  EXPECT_NEAR(along / volume, 6.0 - 0.5 * length, 0.05) << "the middle of the path";
}

TEST(Site, TwiceTheWorkForetoldTellsOfStrongerSoil) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  SiteEvent dug = digs.dig(6.0);
  dug.foretold = ForetoldDig{50.0, 5e4};
  dug.options.joint_work = Measured{1e5, 5e3};
  site.update(dug);
  EXPECT_GT(site.belief().common_states().log_strength.value, 0.3);
}

TEST(Site, AnUnmovedMachineSeesTheCellsAsTheyAre) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const HeightMap& bank = site.ground().terrain.bank;
  const GroundState seen = site.ground_for({}, bank.extent(), site.cell_size());
  EXPECT_TRUE(
      (seen.terrain.bank.z == bank.z || (seen.terrain.bank.z.isNaN() && bank.z.isNaN())).all());
}

TEST(Site, ADigOfATurnedMachineIsMeasuredInItsFrame) {
  const TemporaryFolder folder;
  DigsInARow digs(60.0);
  const BasePose base = {20.0, -7.0, 0.0, 0.7};
  const auto in_site = [&](SiteEvent event) {
    event.base = base;
    event.scan.site_from_scan = base.site_from_machine().matrix();
    return event;
  };
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(in_site(digs.scan()));
  const SiteUpdate update = site.update(in_site(digs.dig(6.0)));
  ASSERT_TRUE(update.taken);
  ASSERT_TRUE(update.estimate && update.estimate->density && update.density);
  EXPECT_TRUE(update.estimate->fallback);
  EXPECT_NEAR(update.density->percent, 60.0, 3.0 * update.density->sd_percent);
  const GroundDensity there = site.density_at(base, {5.0, -0.3, 6.0, 0.3}, 0.4);
  EXPECT_TRUE(there.trustworthy);
  EXPECT_NEAR(there.percent, update.density->percent, 5.0);
}

// ---- What is told and refused -----------------------------------------------------------------

/// A machine with a lidar above its cab that digs at one place and dumps on one heap, in gravel.
class HeapOnHeap {
 public:
  SiteSettings settings = {load_soil(find_data_file("soils/gravel.json")),
                           load_machine(find_data_file("machines/zx120.json")),
                           load_density_law(find_data_file("laws/zx120-gravel.json")),
                           0.05,
                           {}};
  BasePose base;

  explicit HeapOnHeap(const BasePose& at) : base(at) {
    ground_ = undisturbed(flat_ground({-3.0, -4.0, 12.0, 8.0}, 0.05));
  }

  SiteEvent look() {
    SiteEvent event;
    const SensorSetup& lidar = sensor_setup_of_word("cab-lidar");
    for (PlacedScan& look : look_at(ground_.surface(), lidar, {0.0, 0.535, 1.035}, ++scans_)) {
      auto cloud = std::make_shared<Cloud>();
      cloud->sensor_origin = base.site_from_machine() * look.place;
      for (const Eigen::Vector3d& point : look.points) {
        cloud->points.push_back(base.site_from_machine() * point);
      }
      cloud->width = cloud->points.size();
      event.scan.clouds.push_back(cloud);
    }
    event.scan.z_is_up = true;
    event.time = 100.0 * static_cast<double>(scans_);
    event.base = base;
    event.dug = false;
    return event;
  }
  SiteEvent dig() {
    SceneOptions options;
    options.start_x = 6.2 - 0.25 * static_cast<double>(scans_);
    options.dump_at = {3.0, 3.0};
    const DigScene scene = run_scene(settings.machine, settings.soil, 20.0, ground_, options);
    ground_ = scene.after;
    heap = scene.volumes.dumped;
    SiteEvent event = look();
    event.dug = true;
    event.options.dug_path =
        DugPath{settings.machine, options.path, options.start_x, {}, options.dump_at};
    return event;
  }

  double heap = 0.0;  ///< that the last dig left

 private:
  Terrain ground_;
  std::uint64_t scans_ = 0;
};

TEST(Site, SoilHiddenBehindAHeapCountsOnce) {
  for (const BasePose& base : {BasePose{}, BasePose{-2.4, 0.5, 0.0, 0.3}}) {
    const TemporaryFolder folder;
    HeapOnHeap digs(base);
    Site site(folder.file("site"), digs.settings, SiteAccess::write);
    site.update(digs.look());
    for (int number = 1; number <= 5; ++number) {
      SCOPED_TRACE(number);
      const SiteUpdate update = site.update(digs.dig());
      ASSERT_TRUE(update.estimate);
      EXPECT_NEAR(update.estimate->change.dumped.value, digs.heap, 0.015);
    }
  }
}

TEST(Site, ADigOffTheGridLeavesTheRestOfTheBankAsItWas) {
  const TemporaryFolder folder;
  const BasePose base{-2.413, 0.517, 0.0, 0.3};
  HeapOnHeap digs(base);
  Site site(folder.file("site"), digs.settings, SiteAccess::write);
  site.update(digs.look());
  site.update(digs.dig());
  const Terrain before = site.ground().terrain;
  for (int number = 0; number < 3; ++number) {  // told of a dig beside it, but nothing changed
    SiteEvent again = digs.look();
    again.dug = true;
    again.options.dug_path = DugPath{digs.settings.machine, paper_fixed_path(), 7.1, {}, {}};
    site.update(again);
  }
  const HeightMap& bank = site.ground().terrain.bank;
  double squares = 0.0, cells = 0.0;
  for (Eigen::Index row = 0; row < bank.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < bank.z.cols(); ++col) {
      const double was = height_at(before.bank, bank.x(col), bank.y(row));
      const double ahead =
          (base.site_from_machine().inverse() * Eigen::Vector3d(bank.x(col), bank.y(row), 0.0)).x();
      if (std::isnan(was - bank.z(row, col)) || !(was < -0.05) || ahead > 5.0) continue;
      squares += std::pow(bank.z(row, col) - was, 2);
      cells += 1.0;
    }
  }
  ASSERT_GT(cells, 50.0);
  EXPECT_LT(std::sqrt(squares / cells), 0.006);
}

TEST(SiteDoubts, AScanThatIsTakenTwiceIsRefused) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  SiteEvent scan = digs.scan();
  site.update(scan);
  scan.time += 50.0;
  EXPECT_NE(error_of([&] {
              site.update(scan);
            }).find("this scan is in the site already, as update 1 of 1"),
            std::string::npos);
  site.undo();
  EXPECT_TRUE(site.update(scan).taken);
}

TEST(SiteDoubts, AnOldScanIsRefused) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const SiteEvent old = digs.scan();
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  EXPECT_NE(error_of([&] { site.update(old); }).find("older than the last one of the site"),
            std::string::npos);
}

TEST(SiteDoubts, AScanOfAnotherPlaceIsNotTaken) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const GroundState before = site.ground();
  // Out of sight: no ground in common.
  EXPECT_NE(error_of(
                [&] {
                  site.update(digs.scan({100.0, 0.0, 0.0}));
                },
                ErrorKind::bad_file),
            "no error");
  // Other ground within the extent of the site.
  DigsInARow elsewhere(50.0, 0.3);
  elsewhere.scan();
  const SiteUpdate update = site.update(elsewhere.scan());
  EXPECT_FALSE(update.taken);
  EXPECT_FALSE(update.trustworthy);
  EXPECT_TRUE(has(update.warnings, WarningCode::scan_not_taken));
  EXPECT_EQ(site.updates(), 1);
  EXPECT_TRUE((site.ground().seen == before.seen || before.seen.isNaN()).all());
}

TEST(SiteDoubts, AMachineThatMovedIsToldAndItsScanPutInPlace) {
  const TemporaryFolder folder;
  DigsInARow digs(50.0, 0.15);
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const SiteUpdate update = site.update(digs.scan({0.3, 0.0, 0.1}));
  EXPECT_TRUE(has(update.warnings, WarningCode::registration_beyond_prior));
  EXPECT_NEAR(height_at(site.ground().terrain.surface(), 6.0, 0.3),
              height_at(digs.ground().surface(), 6.0, 0.3), 0.015);
}

TEST(SiteDoubts, AScanOfAnotherDatumIsNotTaken) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  for (const double raised : {5000.0, -45.0}) {
    SiteEvent event = digs.scan();
    event.scan.name = "raised.ply";
    event.scan.site_from_scan(2, 3) = raised;
    const SiteUpdate update = site.update(event);
    EXPECT_FALSE(update.taken);
    EXPECT_FALSE(update.trustworthy);
    const std::string found = raised > 0.0 ? "raised.ply: lies 5000 m above known ground"
                                           : "raised.ply: lies 45.0 m below known ground";
    EXPECT_TRUE(
        std::any_of(update.warnings.begin(), update.warnings.end(), [&](const Warning& each) {
          return each.message.find(found + ", must be within 10 m") != std::string::npos;
        }));
  }
  EXPECT_EQ(site.updates(), 1);
  SiteEvent elsewhere = digs.scan();  // no height is absolute
  elsewhere.scan.site_from_scan(2, 3) = 2.0;
  EXPECT_TRUE(site.update(elsewhere).taken);
}

/// All later scans would be compared with it.
TEST(SiteDoubts, AScanInAnotherUnitOrFrameBeginsNoSite) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  const auto refused = [&](const SiteEvent& event) {
    return error_of([&] { site.update(event); }, ErrorKind::bad_file);
  };
  for (const double unit : {0.001, 1000.0}) {
    SiteEvent event = digs.scan();
    event.scan.unit = unit;
    EXPECT_NE(refused(event).find("is `unit` that of the coordinates?"), std::string::npos);
  }
  SiteEvent tipped = digs.scan();
  tipped.scan.site_from_scan.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.5 * 3.14159265, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NE(refused(tipped).find("the ground lies at 90 degrees to level"), std::string::npos);
  EXPECT_TRUE(site.is_empty());
  site.update(digs.scan());
  SiteEvent far = digs.scan();
  far.scan.unit = 1000.0;
  EXPECT_NE(error_of([&] { site.update(far); }).find("is `unit` that of the coordinates?"),
            std::string::npos);
}

TEST(SiteDoubts, ASiteIsOfOneSoilMachineAndLaw) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  { Site(path, digs.settings(), SiteAccess::write).update(digs.scan()); }
  SiteSettings other = digs.settings();
  other.soil.name = "clay";
  EXPECT_EQ(error_of([&] { Site(path, other); }),
            path + ": the site is of soil 'loam', not 'clay': begin another site for it");
  other = digs.settings();
  other.machine.name = "small";
  EXPECT_NE(error_of([&] { Site(path, other); }).find("the site is of machine 'zx120'"),
            std::string::npos);
  other = digs.settings();
  other.cell_size = 0.1;
  EXPECT_NE(error_of([&] { Site(path, other); }).find("0.05 m, not 0.1 m"), std::string::npos);
}

TEST(SiteDoubts, ASiteThatIsOpenForReadingIsNotChanged) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  { Site(path, digs.settings(), SiteAccess::write).update(digs.scan()); }
  Site site(path, digs.settings());
  EXPECT_NE(error_of([&] { site.update(digs.scan()); }).find("is open for reading"),
            std::string::npos);
  EXPECT_NE(error_of([&] { site.undo(); }).find("is open for reading"), std::string::npos);
}

TEST(SiteDoubts, ASiteGrowsToItsLimit) {
  const TemporaryFolder folder;
  DigsInARow digs;
  Site site(folder.file("site"), digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  SiteEvent far = digs.scan();
  auto cloud = std::make_shared<Cloud>(*far.scan.clouds.front());
  for (int i = 0; i < 20000; ++i) cloud->points.emplace_back(5000.0 + 0.001 * i, 4000.0, 0.0);
  cloud->width = cloud->points.size();
  far.scan.clouds = {cloud};
  EXPECT_NE(error_of([&] { site.update(far); }).find("most are 5000000"), std::string::npos);
}

}  // namespace
}  // namespace excavplan
