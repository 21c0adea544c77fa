// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/dump_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Numbers of our own choice.
constexpr double nearest = 0.5;        // of the pin, share of boom and arm
constexpr double farthest = 0.9;       // likewise
constexpr double radius_step = 0.4;    // [m]
constexpr double turn_step = 0.05;     // [rad]
constexpr double most_turn = 2.6;      // [rad]
constexpr double drop = 0.3;           // from the open bucket to the heap [m]
constexpr double height_price = 0.15;  // of a metre, as a swing [rad/m]
constexpr double edge_of_cut = 0.6;    // soil keeps so far from the design [m]
constexpr double off_keep_out = 0.3;   // likewise from keep-outs, as heaps run and no dump is exact

/// Height of the cone of a bucket of soil.
double heap_height(const JobSettings& settings) {
  const double repose = std::tan(settings.site.soil.angle_of_repose);
  const double volume = heaped_capacity(settings.site.machine);
  return std::cbrt(3.0 * volume * repose * repose / pi);
}

/// A heap of this radius lies in the dump areas, and runs neither into the cut nor to what no soil
/// may touch.
bool fits(const JobMap& map, const Vector2d& place, double radius) {
  const double cell = map.target.cell_size;
  const double around = radius + std::max(edge_of_cut, off_keep_out);
  for (double x = -around; x <= around; x += cell) {
    for (double y = -around; y <= around; y += cell) {
      const double distance = std::hypot(x, y);
      if (distance > around) continue;
      const auto at = cell_at(map.target, place.x() + x, place.y() + y);
      if (distance <= radius && (!at || !map.dump(at->row, at->col))) return false;
      if (!at) continue;
      if (distance <= radius + off_keep_out && map.untouched(at->row, at->col)) return false;
      if (distance <= radius + edge_of_cut && !std::isnan(map.target.z(at->row, at->col)))
        return false;
    }
  }
  return true;
}

std::optional<DumpPlace> in_truck(const JobSettings& settings, const Terrain& ground,
                                  const BasePose& base) {
  const JobTruck& truck = *settings.design.truck;
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& corner : truck.bed) middle += corner;
  middle /= static_cast<double>(truck.bed.size());
  const Machine& machine = settings.site.machine;
  const Vector2d from = middle - Vector2d(base.x, base.y);
  if (from.norm() > farthest * (machine.boom_length + machine.arm_length)) return std::nullopt;
  const auto at = cell_at(ground.bank, middle.x(), middle.y());
  const double z = at ? ground.bank.z(at->row, at->col) : base.z;
  DumpPlace place;
  place.place = {middle.x(), middle.y(),
                 (std::isnan(z) ? base.z : z) + truck.bed_height + machine.bucket_length + drop};
  place.swing = wrapped(std::atan2(from.y(), from.x()) - base.heading);
  place.height = place.place.z() - base.z;
  place.in_truck = true;
  return place;
}

}  // namespace

std::optional<DumpPlace> dump_place(const JobSettings& settings, const JobMap& map,
                                    const Terrain& ground, const BasePose& base) {
  if (settings.design.truck) return in_truck(settings, ground, base);
  const Machine& machine = settings.site.machine;
  const double reach = machine.boom_length + machine.arm_length;
  const double repose = std::tan(settings.site.soil.angle_of_repose);
  const double cone = heap_height(settings);
  std::optional<DumpPlace> best;
  double least = std::numeric_limits<double>::infinity();
  for (double radius = nearest * reach; radius <= farthest * reach; radius += radius_step) {
    for (double turn = -most_turn; turn <= most_turn; turn += turn_step) {
      if (turn < machine.swing->lower || turn > machine.swing->upper) continue;
      const Vector2d place =
          Vector2d(base.x, base.y) +
          radius * Vector2d(std::cos(base.heading + turn), std::sin(base.heading + turn));
      const auto at = cell_at(map.target, place.x(), place.y());
      if (!at || !map.dump(at->row, at->col)) continue;
      const double loose = ground.loose(at->row, at->col);
      const double surface = ground.bank.z(at->row, at->col) + loose;
      if (std::isnan(surface)) continue;
      const double cost = std::abs(turn) + height_price * std::max(0.0, surface - base.z);
      if (cost >= least || !fits(map, place, (loose + cone) / repose)) continue;
      least = cost;
      const double pin = surface + cone + drop + machine.bucket_length;
      best = DumpPlace{{place.x(), place.y(), pin}, turn, std::max(0.0, pin - base.z), false};
    }
  }
  return best;
}

}  // namespace excavplan
