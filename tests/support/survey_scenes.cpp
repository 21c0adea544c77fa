// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/survey_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "support/cases.hpp"

namespace excavplan::scenes {

double height_of_cell(const HeightMap& map, double x, double y) {
  if (!map.extent().contains(x, y)) return 0.0;
  const auto row = static_cast<Eigen::Index>((y - map.origin.y()) / map.cell_size);
  const auto col = static_cast<Eigen::Index>((x - map.origin.x()) / map.cell_size);
  return map.z(std::min(row, map.z.rows() - 1), std::min(col, map.z.cols() - 1));
}

Dig random_dig(std::uint64_t seed) {
  Random random(seed, 7);
  Dig dig;
  dig.pit_length = random.uniform(1.4, 2.6);
  dig.pit_width = random.uniform(0.8, 1.3);
  dig.pit_depth = random.uniform(0.20, 0.45);
  dig.wall_angle = random.uniform(55.0, 80.0) * degree;
  dig.pit_x = random.uniform(-0.3, 0.3);
  dig.pit_y = random.uniform(-0.3, 0.3);
  dig.heading = random.uniform(0.0, pi);
  dig.ridge_height = random.uniform(0.08, 0.20);
  dig.ridge_slope = random.uniform(28.0, 38.0) * degree;
  dig.ridge_offset = 0.5 * dig.pit_width + dig.ridge_height / std::tan(dig.ridge_slope) +
                     random.uniform(0.02, 0.20);
  dig.bulking = random.uniform(1.0, 1.6);
  dig.heap_slope = random.uniform(28.0, 38.0) * degree;
  dig.heap_x = random.uniform(-0.3, 0.3);
  dig.heap_y = random.uniform(-0.3, 0.3);
  return dig;
}

std::vector<Variant> variants() {
  ScanErrors noise;
  noise.noise = 0.005;
  const auto with = [&noise](auto change) {
    ScanErrors errors = noise;
    change(errors);
    return errors;
  };
  const auto all = [](ScanErrors& e) {
    e.outliers = 0.01;
    e.unseen = 0.05;
    e.tilt = 2.0 * degree;
    e.slope = 8.0 * degree;
    e.roughness = 0.02;
    e.shift = 0.010;
    e.turn = 0.3 * degree;
    e.correlated = 0.005;
  };
  return {{"clean", {}},
          {"noise", noise},
          {"noise20", with([](ScanErrors& e) { e.noise = 0.020; })},
          {"outliers", with([](ScanErrors& e) { e.outliers = 0.01; })},
          {"tilt", with([](ScanErrors& e) { e.tilt = 2.0 * degree; })},
          {"rough", with([](ScanErrors& e) { e.slope = 8.0 * degree, e.roughness = 0.02; })},
          {"moved", with([](ScanErrors& e) { e.shift = 0.010, e.turn = 0.3 * degree; })},
          {"correlated", with([](ScanErrors& e) { e.correlated = 0.005; })},
          {"unseen", with([](ScanErrors& e) { e.unseen = 0.05; })},
          {"all", with(all)}};
}

ScanErrors errors_of(const std::string& variant) {
  for (const Variant& v : variants()) {
    if (v.name == variant) return v.errors;
  }
  return {};
}

Rectangle extent_of(Part part) {
  return part == Part::dig ? dig_extent : part == Part::dump ? dump_extent : whole_extent;
}

double change_at(const Dig& dig, Part part, double x, double y) {
  if (part == Part::dig) return dig.dug(x, y);
  if (part == Part::dump) return dig.dumped(x, y);
  return dig.dug(x, y) + dig.dumped(x - dump_offset, y);
}

std::vector<Disc> unseen_discs(const Rectangle& extent, double share, Random random) {
  std::vector<Disc> discs;
  double area = share * (extent.x_max - extent.x_min) * (extent.y_max - extent.y_min);
  while (area > 0.0) {
    const double radius = random.uniform(0.10, 0.25);
    discs.push_back({random.uniform(extent.x_min, extent.x_max),
                     random.uniform(extent.y_min, extent.y_max), radius});
    area -= pi * radius * radius;
  }
  return discs;
}

Eigen::Isometry3d random_motion(double shift, double turn, Random random) {
  const auto direction = [&random] {
    return Eigen::Vector3d(test::drawn_normals(random).normalized());
  };
  Eigen::Isometry3d motion(Eigen::AngleAxisd(turn, direction()));
  motion.translation() = shift * direction();
  return motion;
}

Points scan(const Dig& dig, Part part, const ScanErrors& errors, std::size_t points,
            std::uint64_t seed, bool after) {
  const Rectangle extent = extent_of(part);
  const std::uint64_t stream = 100 * (static_cast<std::uint64_t>(part) + 1) + (after ? 50 : 0);
  const Ground ground(errors, seed + static_cast<std::uint64_t>(part) * 1000003);
  const std::vector<Disc> discs = unseen_discs(extent, errors.unseen, Random(seed, stream, 1));
  const SmoothError smooth(extent, errors.correlation, Random(seed, stream, 2));
  Eigen::Isometry3d frame(Eigen::AngleAxisd(errors.tilt, Eigen::Vector3d::UnitX()));
  if (after) frame = random_motion(errors.shift, errors.turn, Random(seed, stream, 3)) * frame;
  Random random(seed, stream, 4);
  Points cloud;
  cloud.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double x = random.uniform(extent.x_min, extent.x_max);
    const double y = random.uniform(extent.y_min, extent.y_max);
    const bool hidden = std::any_of(discs.begin(), discs.end(),
                                    [&](const Disc& disc) { return disc.contains(x, y); });
    if (hidden) continue;
    double z = ground(x, y) + (after ? change_at(dig, part, x, y) : 0.0);
    if (errors.correlated > 0.0) z += errors.correlated * smooth(x, y);
    Eigen::Vector3d point(x, y, z);
    if (errors.noise > 0.0) {
      point += errors.noise * test::drawn_normals(random);
    }
    if (errors.outliers > 0.0 && random.uniform() < errors.outliers) {
      point.z() += random.uniform(-0.3, 1.0);
    }
    cloud.push_back(frame * point);
  }
  return cloud;
}

}  // namespace excavplan::scenes
