// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "trial/dump_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "trial/plan_polygon.hpp"

namespace excavplan {
namespace {

// Ours [m]:
constexpr double spacing = 0.25;
constexpr double inside = 0.7;        // of an area's border, so that the heap stays in it
constexpr double inside_bed = 0.5;    // of a truck's
constexpr double over_ground = 1.6;   // of the pin, so that the open bucket is clear
constexpr double over_bed = 1.2;      // likewise
constexpr double least_height = 2.0;  // of the pin
constexpr double nearest = 3.0;       // from the swing axis
constexpr double spare = 0.2;         // of the reach
constexpr double of_height = 0.7;     // swing that a metre of heap is worth [rad/m]

}  // namespace

double pin_reach(const Machine& machine, double height) {
  const double up = height - machine.boom_pin.y();
  const double length = machine.boom_length + machine.arm_length;
  if (std::abs(up) >= length) return 0.0;
  return machine.boom_pin.x() + std::sqrt(length * length - up * up);
}

PlainDump DumpPlaces::from(const BasePose& base, double heading,
                           const LastSeenGround& ground) const {
  PlainDump best = {{base.x, base.y, base.z + least_height}, {}};
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const SitePolygon& area, double margin, std::optional<double> bed) {
    Eigen::Vector2d low = area.front(), high = area.front();
    for (const Eigen::Vector2d& corner : area) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    for (double x = low.x(); x <= high.x(); x += spacing) {
      for (double y = low.y(); y <= high.y(); y += spacing) {
        if (!is_well_in(area, {x, y}, margin)) continue;
        const double z = ground.at(x, y);
        if (std::isnan(z)) continue;
        const double pin =
            bed ? base.z + *bed + over_bed : std::max(base.z + least_height, z + over_ground);
        const double away = std::hypot(x - base.x, y - base.y);
        const double reach = pin_reach(machine_, pin - base.z) - spare;
        const double swing = std::abs(wrapped(std::atan2(y - base.y, x - base.x) - heading));
        // Out of reach is the last choice.
        const double beyond = std::max({0.0, away - reach, nearest - away});
        const double cost = swing + of_height * std::max(0.0, z - base.z) + 100.0 * beyond;
        if (cost >= least) continue;
        least = cost;
        best.pin = {x, y, pin};
        best.in_reach = beyond == 0.0;
        best.truck = bed ? std::optional<int>(truck_) : std::nullopt;
      }
    }
  };
  for (const DumpArea& area : job_.dump_areas) look(area.polygon, inside, {});
  if (job_.truck) look(job_.truck->bed, inside_bed, job_.truck->bed_height);
  return best;
}

void DumpPlaces::loaded(double payload) {
  if (!job_.truck) return;
  load_ += payload;
  largest_ = std::max(largest_, payload);
  if (load_ + 0.5 * largest_ < job_.truck->target_mass) return;
  ++truck_;
  load_ = 0.0;
}

}  // namespace excavplan
