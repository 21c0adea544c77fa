// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/site/site.hpp>
#include <excavplan/trial/site_scan.hpp>

#include "ground/grid_cells.hpp"
#include "ground/window.hpp"
#include "support/run_program.hpp"
#include "trial/site_sensors.hpp"

/// @file
/// What a site knows of an open trench that it sees from one place after the other.

namespace excavplan::test {
namespace {

constexpr double fine = 0.025;  // [m]
constexpr double wrong = 0.05;  // [m]

SiteSensor with_noise(SiteSensor sensor, double noise) {
  sensor.noise = noise;
  return sensor;
}

/// Ground with a trench along x, 7 m long, 1 m wide and 0.5 m deep, with upright walls.
HeightMap trench() {
  HeightMap ground = flat_ground({-5, -6, 13, 6}, fine);
  for_each_cell(ground.z, [&](Cell at) {
    const double x = ground.x(at.col), y = ground.y(at.row);
    const bool inside = x > 3.0 && x < 10.0 && std::abs(y) < 0.5;
    ground.z(at.row, at.col) = 0.03 * std::sin(0.7 * x) * std::cos(0.9 * y) - (inside ? 0.5 : 0.0);
  });
  return ground;
}

/// Its ground as a scan of every cell.
Scan whole_scan(const HeightMap& ground) {
  auto cloud = std::make_shared<Cloud>();
  for_each_cell(ground.z, [&](Cell at) {
    cloud->points.emplace_back(ground.x(at.col), ground.y(at.row), ground.z(at.row, at.col));
  });
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  scan.z_is_up = true;
  return scan;
}

/// Points in each cell of a grid.
Eigen::ArrayXXd returns_in(const Scan& scan, const HeightMap& grid) {
  Eigen::ArrayXXd returns = Eigen::ArrayXXd::Zero(grid.z.rows(), grid.z.cols());
  for (const auto& cloud : scan.clouds) {
    for (const Eigen::Vector3d& point : cloud->points) {
      if (const auto at = cell_at(grid, point.x(), point.y())) returns(at->row, at->col) += 1.0;
    }
  }
  return returns;
}

/// What an update made of cells that its scan has no returns of.
struct Unseen {
  int spoiled = 0;  ///< right before, wrong since
  int shadow = 0;   ///< cells with no return within 3 cells
  int touched = 0;  ///< those whose height, time or deviation changed
};

class TrenchSite {
 public:
  TrenchSite() : site_(folder_.file("site"), settings(), SiteAccess::write) {
    update(whole_scan(truth_), {});
  }

  Unseen look(const SiteSensor& sensor, const BasePose& base) {
    const Scan scan = scan_site(truth_, sensor, base, ++scans_);
    const GroundState before = site_.ground();
    EXPECT_TRUE(update(scan, base).taken);
    return compare(before, site_.ground(), scan);
  }

 private:
  static SiteSettings settings() {
    return {load_soil(find_data_file("soils/loam.json")),
            load_machine(find_data_file("machines/zx120.json")),
            load_density_law(find_data_file("laws/zx120-loam.json")),
            2.0 * fine,
            {}};
  }

  SiteUpdate update(const Scan& scan, const BasePose& base) {
    SiteEvent event;
    event.scan = scan;
    event.dug = false;
    event.base = base;
    event.time = time_ += 100.0;
    event.options.threads = 1;
    return site_.update(event);
  }

  double truth_at(double x, double y) const {
    double sum = 0.0;
    for (const double dx : {-0.5 * fine, 0.5 * fine}) {
      for (const double dy : {-0.5 * fine, 0.5 * fine}) sum += height_at(truth_, x + dx, y + dy);
    }
    return 0.25 * sum;
  }

  Unseen compare(const GroundState& before, const GroundState& after, const Scan& scan) const {
    const HeightMap was = before.terrain.surface(), is = after.terrain.surface();
    EXPECT_TRUE(same_grid(was, is));
    const AreaSums returns(returns_in(scan, is));
    Unseen unseen;
    for_each_cell(is.z, [&](Cell at) {
      const double x = is.x(at.col), y = is.y(at.row);
      const bool at_trench = x > 2.5 && x < 10.5 && std::abs(y) < 1.0;
      if (!at_trench || returns.around(at, 1) > 0.0) return;
      const double truth = truth_at(x, y);
      const double height = is.z(at.row, at.col), known = was.z(at.row, at.col);
      const bool was_right = std::abs(known - truth) <= wrong;
      unseen.spoiled += was_right && std::abs(height - truth) > wrong ? 1 : 0;
      if (returns.around(at, 3) > 0.0) return;
      ++unseen.shadow;
      const bool same = height == known &&
                        after.seen(at.row, at.col) == before.seen(at.row, at.col) &&
                        after.deviation(at.row, at.col) == before.deviation(at.row, at.col);
      unseen.touched += same ? 0 : 1;
    });
    return unseen;
  }

  TemporaryFolder folder_;
  HeightMap truth_ = trench();
  double time_ = 0.0;
  std::uint64_t scans_ = 0;
  Site site_;
};

TEST(SiteViews, WhatAScanDoesNotSeeKeepsWhatIsKnown) {
  const std::vector<BasePose> places = {
      {0, 0, 0, 0}, {5, -2, 0, 0}, {-2.7, 0, 0, 0}, {5, -3, 0, 0}};
  for (const SiteSensor& sensor : {with_noise(lidar(), 0.004), with_noise(camera(), 0.0003)}) {
    TrenchSite site;
    int shadow = 0;
    for (const BasePose& base : places) {
      const Unseen unseen = site.look(sensor, base);
      EXPECT_EQ(unseen.spoiled, 0) << sensor.name << " at " << base.x << ", " << base.y;
      EXPECT_EQ(unseen.touched, 0) << sensor.name << " at " << base.x << ", " << base.y;
      shadow += unseen.shadow;
    }
    EXPECT_GT(shadow, 100) << sensor.name;
  }
}

}  // namespace
}  // namespace excavplan::test
