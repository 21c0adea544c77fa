// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/site/site.hpp>

#include "base/random.hpp"

/// @file
/// Digs of the simulator in a row, as a site is told of them.

namespace excavplan::test {

inline SiteSettings loam_site() {
  return {load_soil(find_data_file("soils/loam.json")),
          load_machine(find_data_file("machines/zx120.json")),
          load_density_law(find_data_file("laws/zx120-loam.json")),
          0.05,
          {}};
}

inline bool has(const std::vector<Warning>& warnings, WarningCode code) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const Warning& warning) { return warning.code == code; });
}

/// Points of a surface, four in a cell, with errors of 3 mm.
inline Scan scanned(const HeightMap& surface, std::uint64_t seed, const Eigen::Vector3d& shift) {
  Random random(7, seed);
  auto cloud = std::make_shared<Cloud>();
  const double step = 0.5 * surface.cell_size;
  const Rectangle extent = surface.extent();
  for (double x = extent.x_min + 0.5 * step; x < extent.x_max; x += step) {
    for (double y = extent.y_min + 0.5 * step; y < extent.y_max; y += step) {
      const double z = height_at(surface, x, y);
      if (std::isnan(z)) continue;
      cloud->points.push_back(Eigen::Vector3d(x, y, z + 0.003 * random.normal()) + shift);
    }
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  scan.z_is_up = true;
  return scan;
}

/// A machine that digs.
class DigsInARow {
 public:
  explicit DigsInARow(double density_percent = 50.0, double relief = 0.03)
      : density_(density_percent),
        ground_(undisturbed(flat_ground(scene_extent(site_.machine, default_dump_point()), 0.05))) {
    for (Eigen::Index row = 0; row < ground_.bank.z.rows(); ++row) {
      for (Eigen::Index col = 0; col < ground_.bank.z.cols(); ++col) {
        const double x = ground_.bank.x(col);
        const double y = ground_.bank.y(row);
        ground_.bank.z(row, col) =
            relief * (std::sin(1.3 * x + 0.4 + 10.0 * relief) * std::cos(1.7 * y - 7.0 * relief) +
                      0.5 * std::sin(2.9 * x - 1.1 * y));
      }
    }
  }

  const SiteSettings& settings() const { return site_; }
  const Terrain& ground() const { return ground_; }

  SiteEvent scan(const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) {
    SiteEvent event;
    event.scan = scanned(ground_.surface(), ++scans_, shift);
    event.time = 100.0 * static_cast<double>(scans_);
    event.dug = false;
    event.options.threads = threads;
    return event;
  }

  /// Digs at a distance and scans.
  SiteEvent dig(double start_x) {
    SceneOptions options;
    options.start_x = start_x;
    const DigScene scene = run_scene(site_.machine, site_.soil, density_, ground_, options);
    ground_ = scene.after;
    SiteEvent event = scan();
    event.dug = true;
    event.options.dug_path = {site_.machine, options.path, start_x};
    return event;
  }

  unsigned threads = 1;

 private:
  SiteSettings site_ = loam_site();
  double density_;
  Terrain ground_;
  std::uint64_t scans_ = 0;
};

}  // namespace excavplan::test
