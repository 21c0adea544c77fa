// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/dig_series.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <excavplan/base/data_files.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/simulators.hpp>

#include "base/angles.hpp"
#include "support/cases.hpp"

namespace excavplan::test {
namespace {

constexpr double deepest = 1.0;  // of a hole [m]
constexpr Rectangle site_extent = {-4.0, -20.0, 13.0, 9.0};

double waves(const Eigen::Vector2d& at, double roughness, std::uint64_t seed) {
  Random random(seed, 9);
  constexpr int count = 8;
  double z = 0.0;
  for (int i = 0; i < count; ++i) {
    const double length = 0.3 * std::pow(8.0, i / (count - 1.0));
    const double heading = random.uniform(0.0, 2.0 * pi);
    const double phase = random.uniform(0.0, 2.0 * pi);
    z += std::sin(2.0 * pi / length * (at.x() * std::cos(heading) + at.y() * std::sin(heading)) +
                  phase);
  }
  return roughness * z / std::sqrt(0.5 * count);
}

double volume_of(const Eigen::ArrayXXd& layer, double cell) {
  return cell * cell * layer.isNaN().select(0.0, layer).sum();
}

GroundState moved(GroundState state, const Eigen::Vector2d& by) {
  state.terrain.bank.origin += by;
  return state;
}

}  // namespace

const char* name(Layout layout) {
  constexpr const char* names[] = {"apart", "beside", "behind", "trench", "inside"};
  return names[static_cast<int>(layout)];
}

DigSeries::DigSeries(const SeriesSettings& settings)
    : settings_(settings),
      machine_(load_machine(find_data_file("machines/zx120.json"))),
      soil_(load_soil(find_data_file("soils/loam.json"))),
      random_(settings.seed, 3) {
  HeightMap surface = flat_ground(site_extent, settings.cell);
  for (Eigen::Index row = 0; row < surface.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < surface.z.cols(); ++col) {
      surface.z(row, col) =
          waves({surface.x(col), surface.y(row)}, settings.roughness, settings.seed);
    }
  }
  site_ = undisturbed(surface);
}

GroundState DigSeries::in_frame(GroundState state) const {
  return moved(std::move(state), -place_);
}
GroundState DigSeries::in_site(GroundState state) const { return moved(std::move(state), place_); }

Terrain DigSeries::ground() const {
  Terrain terrain = site_;
  terrain.bank.origin -= place_;
  return terrain;
}

void DigSeries::move() {
  const auto cells = [&](double length) {
    return settings_.cell * std::round(length / settings_.cell);
  };
  const double n = digs_;
  switch (settings_.layout) {
    case Layout::apart:
      place_ = {0.0, cells(-1.6 * std::fmod(n, 10.0))};
      break;
    case Layout::beside:
      place_ = {0.0, cells(-0.8 * std::fmod(n, 10.0))};
      break;
    case Layout::behind:
      place_ = {cells(-0.35 * n), 0.0};
      break;
    case Layout::trench:
      place_ = {cells(-0.7 * std::fmod(n, 3.0)), 0.0};
      break;
    case Layout::inside:
      place_ = {cells(random_.uniform(-0.15, 0.15)), 0.0};
      break;
  }
  ++digs_;
}

std::optional<DigPath> DigSeries::path_for_next() {
  constexpr int tries = 60;
  const GroundProfile profile = boom_plane_profile(ground());
  const double weaker = 1.0 - 0.005 * settings_.density_percent;
  for (int i = 0; i < tries; ++i) {
    const DigParameters parameters = {random_.uniform(0.5, 1.0), random_.uniform(0.3, 0.6) * weaker,
                                      random_.uniform(0.8, 2.0)};
    const double start = 6.8 + random_.uniform(-0.2, 0.2);
    const auto path = make_dig_path(machine_, parameters, start, profile);
    if (!std::holds_alternative<DigPath>(path)) continue;
    const auto& poses = std::get<DigPath>(path).poses;
    const auto is_deep = [](const DigPose& pose) { return pose.bucket.z < -deepest; };
    if (std::none_of(poses.begin(), poses.end(), is_deep)) return std::get<DigPath>(path);
  }
  return std::nullopt;
}

std::optional<SeriesDig> DigSeries::dig() {
  constexpr int tries = 12;
  constexpr double least_payload = 0.1;  // [m^3]: nobody digs for less
  const auto simulator =
      simulator_of_word(settings_.simulator).make(machine_, soil_, settings_.density_percent);
  const double across = settings_.layout == Layout::behind ? 2.5 : 3.2;
  for (int i = 0; i < tries; ++i) {
    const auto path = path_for_next();
    if (!path) return std::nullopt;
    SeriesDig dug;
    dug.path = *path;
    dug.dump_at = {5.0 + random_.uniform(-0.4, 0.4), across + random_.uniform(-0.3, 0.3)};
    DigOptions options;
    if (settings_.heap_in_sight) options.dump_at = dug.dump_at;
    const Terrain before = ground();
    const DigResult result = simulator->dig(before, *path, options);
    if (result.stall || result.payload_volume < least_payload) continue;
    apply(result.patch, site_);
    dug.loose_before = volume_of(before.loose, settings_.cell);
    dug.bank_cut = volume_of(before.bank.z - site_.bank.z, settings_.cell);
    dug.payload_mass = result.payload_mass;
    return dug;
  }
  return std::nullopt;
}

std::shared_ptr<const Cloud> DigSeries::scan() {
  const Terrain terrain = ground();
  const HeightMap surface = terrain.surface();
  const Rectangle extent = {2.2, -3.5, 9.5, 5.8};
  auto cloud = std::make_shared<Cloud>();
  const double area = (extent.x_max - extent.x_min) * (extent.y_max - extent.y_min);
  const auto points = static_cast<std::size_t>(settings_.points_per_m2 * area);
  while (cloud->points.size() < points) {
    const double x = random_.uniform(extent.x_min, extent.x_max);
    const double y = random_.uniform(extent.y_min, extent.y_max);
    const double z = height_at(surface, x, y);
    cloud->points.push_back(Eigen::Vector3d(x, y, z) + settings_.noise * drawn_normals(random_));
  }
  cloud->width = cloud->points.size();
  return cloud;
}

}  // namespace excavplan::test
