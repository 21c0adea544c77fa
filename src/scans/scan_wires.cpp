// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_wires.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// Ours:
constexpr double beside = 0.1;           // of a return to the line of its wire [m]
constexpr double sagging = 0.5;          // of a return to that line in height [m]
constexpr double near = 0.3;             // returns that tell how wide something is [m]
constexpr double widest_spread = 0.045;  // standard deviation of these across a line [m]
constexpr double shortest = 0.15;        // between returns that give a direction [m]
constexpr double noise = 0.03;           // of a return in plan [m]
constexpr std::size_t most_wire_points = 300, most_wires = 20, fewest_of_wire = 3;

/// Principal axes of points in plan.
struct Spread {
  Vector2d mean = Vector2d::Zero();
  Vector2d along = Vector2d::UnitX();
  double across = 0.0;  ///< standard deviation [m]
};

Spread spread_of(const Points& points) {
  Spread spread;
  for (const Vector3d& p : points) spread.mean += p.head<2>() / static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Vector3d& p : points) {
    const Vector2d d = p.head<2>() - spread.mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  const double turned = 0.5 * std::atan2(2.0 * xy, xx - yy);
  spread.along = {std::cos(turned), std::sin(turned)};
  const double least = 0.5 * (xx + yy - std::hypot(xx - yy, 2.0 * xy));
  spread.across = std::sqrt(std::max(0.0, least) / static_cast<double>(points.size()));
  return spread;
}

/// Those that are no part of something wide, such as the top of a truck.
Points thin(const Points& hanging) {
  Points kept;
  for (const Vector3d& p : hanging) {
    Points around;
    for (const Vector3d& q : hanging) {
      if ((p - q).head<2>().norm() <= near) around.push_back(q);
    }
    if (spread_of(around).across <= widest_spread) kept.push_back(p);
  }
  return kept;
}

Points on_line(const Points& points, const Vector3d& from, const Vector3d& to) {
  const Vector2d along = (to - from).head<2>();
  const double length = along.norm(), slope = (to.z() - from.z()) / length;
  const Vector2d direction = along / length;
  Points found;
  for (const Vector3d& p : points) {
    const Vector2d d = (p - from).head<2>();
    const double s = d.dot(direction);
    const double off = std::abs(direction.x() * d.y() - direction.y() * d.x());
    if (off <= beside && std::abs(p.z() - from.z() - slope * s) <= sagging) found.push_back(p);
  }
  return found;
}

/// The most that lie on one line.
Points best_line(const Points& points) {
  Points best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = i + 1; k < points.size(); ++k) {
      const Vector3d move = points[k] - points[i];
      const double length = move.head<2>().norm();
      if (length < shortest || std::abs(move.z()) > 0.5 * length) continue;
      Points line = on_line(points, points[i], points[k]);
      if (line.size() > best.size()) best = std::move(line);
    }
  }
  return best;
}

Wire wire_of(const Points& line) {
  const Spread spread = spread_of(line);
  Wire wire{spread.mean, spread.along, 0.0, 0.0, line.front().z()};
  for (const Vector3d& p : line) {
    wire.half = std::max(wire.half, std::abs((p.head<2>() - spread.mean).dot(spread.along)));
    wire.top = std::max(wire.top, p.z());
  }
  wire.turn = noise / std::max(wire.half, 0.5 * shortest);
  return wire;
}

}  // namespace

std::vector<Wire> find_wires(const Points& hanging) {
  Points few;
  const std::size_t stride = hanging.size() / (10 * most_wire_points) + 1;
  for (std::size_t i = 0; i < hanging.size(); i += stride) few.push_back(hanging[i]);
  Points left = thin(few);
  if (left.size() > most_wire_points) {
    const std::size_t each = left.size() / most_wire_points + 1;
    Points fewer;
    for (std::size_t i = 0; i < left.size(); i += each) fewer.push_back(left[i]);
    left = std::move(fewer);
  }
  std::vector<Wire> wires;
  while (wires.size() < most_wires) {
    const Points line = best_line(left);
    if (line.size() < fewest_of_wire) break;
    wires.push_back(wire_of(line));
    left.erase(std::remove_if(left.begin(), left.end(),
                              [&](const Vector3d& p) {
                                return std::find(line.begin(), line.end(), p) != line.end();
                              }),
               left.end());
  }
  return wires;
}

}  // namespace excavplan
