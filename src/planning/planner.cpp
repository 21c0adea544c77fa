// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/planner.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "../json_file.hpp"
#include "dig_layout.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double half_width =
    1.5;  // of the ground planned on [m]; ours: the bucket and its windrows

/// The two rows of cells on either side of the boom plane.
struct BoomPlaneRows {
  Index first;
  Index count;
};

BoomPlaneRows rows_at_boom_plane(const HeightMap& map) {
  const auto row = static_cast<Index>(std::floor(-map.origin.y() / map.cell - 0.5));
  const Index first = std::clamp<Index>(row, 0, std::max<Index>(0, map.z.rows() - 2));
  return {first, std::min<Index>(2, map.z.rows() - first)};
}

GroundProfile profile_of(const HeightMap& map, const Eigen::ArrayXXd& rows, Index first_row) {
  HeightMap strip{map.origin, map.cell, rows};
  strip.origin.y() += map.cell * static_cast<double>(first_row);
  return [strip](double x) { return height_at(strip, x, 0.0); };
}

}  // namespace

std::string describe(const DigFailure& failure) {
  if (const auto* infeasible = std::get_if<Infeasible>(&failure)) return infeasible->message;
  const Stall& stall = std::get<Stall>(failure);
  return std::string("the ") + name(stall.joint) + " stalls in the phase " + name(stall.phase) +
         " after " + decimals(stall.travelled, 3) + " m: it would need " +
         decimals(std::abs(stall.torque) / 1000.0, 1) + " kN m";
}

Rectangle planning_extent(const Machine& machine) {
  return {machine.track_front - 1.0, -half_width,
          machine.boom_pin.x() + machine.full_length() + 0.5, half_width};
}

Terrain level_planning_ground(const Machine& machine, double cell) {
  return undisturbed(flat_ground(planning_extent(machine), cell));
}

GroundProfile boom_plane_profile(const HeightMap& surface) {
  const BoomPlaneRows rows = rows_at_boom_plane(surface);
  return profile_of(surface, surface.z.middleRows(rows.first, rows.count), rows.first);
}

GroundProfile boom_plane_profile(const Terrain& terrain) {
  const BoomPlaneRows rows = rows_at_boom_plane(terrain.bank);
  return profile_of(terrain.bank,
                    terrain.bank.z.middleRows(rows.first, rows.count) +
                        terrain.loose.middleRows(rows.first, rows.count),
                    rows.first);
}

double boom_plane_slope(const Terrain& terrain, double from_x) {
  const GroundProfile ground = boom_plane_profile(terrain);
  const HeightMap& bank = terrain.bank;
  double count = 0.0, x_sum = 0.0, z_sum = 0.0, xx = 0.0, xz = 0.0;
  for (Index col = 0; col < bank.z.cols(); ++col) {
    const double x = bank.x(col) - from_x;
    const double z = ground(bank.x(col));
    if (x < 0.0 || std::isnan(z)) continue;
    count += 1.0;
    x_sum += x;
    z_sum += z;
    xx += x * x;
    xz += x * z;
  }
  if (count < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(count * xz - x_sum * z_sum, count * xx - x_sum * x_sum);
}

std::string describe(const StartRule& rule) {
  switch (rule.kind) {
    case StartRule::Kind::largest_margin:
      return "largest margin to joint limits and heel contact";
    case StartRule::Kind::least_work:
      return "least work of the links' own weight";
    case StartRule::Kind::given:
      return "given, x = " + number_text(rule.x) + " m";
    case StartRule::Kind::searched:
      return "searched with the path";
  }
  return "unknown rule";
}

std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  const StartRule& start) {
  const auto path = DigLayout(machine, terrain).path(parameters, start);
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) return DigFailure(*infeasible);
  return dig_along(machine, simulator, terrain, std::get<DigPath>(path));
}

}  // namespace excavplan
