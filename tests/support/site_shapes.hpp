// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "support/survey_scenes.hpp"

/// @file
/// Shapes that a site brings beside pit, ridge and heap: tracks, further heaps, clods, boxes.

namespace excavplan::scenes {

/// A height [m] over x, y [m].
using Height = std::function<double(double x, double y)>;

double flat(double, double);

/// The sum of changes of height that lie beside each other.
Height sum_of(std::vector<Height> parts);

/// Of changes that overlap the one that moved the surface most.
Height largest_of(std::vector<Height> parts);

/// Volume above 0 less that below, by the midpoint rule on squares of 1 cm.
double volume_of(const Height& height, const Rectangle& extent);

/// A cone of soil.
struct Cone {
  double x = 0.0;
  double y = 0.0;
  double volume = 0.0;
  double slope = 35.0 * degree;

  double radius() const { return std::cbrt(3.0 * volume / (pi * std::tan(slope))); }
  double operator()(double px, double py) const {
    return std::max(0.0, (radius() - std::hypot(px - x, py - y)) * std::tan(slope));
  }
};

/// A clod: half a ball.
struct Clod {
  double x = 0.0;
  double y = 0.0;
  double volume = 0.0;

  double operator()(double px, double py) const {
    const double radius = std::cbrt(1.5 * volume / pi);
    const double away = (px - x) * (px - x) + (py - y) * (py - y);
    return std::sqrt(std::max(0.0, radius * radius - away));
  }
};

/// A straight strip that starts at x, y and goes along its heading, height above the ground or
/// below, with sides of one slope: a rut, or where it is too narrow for a top a berm.
struct Strip {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  double length = 3.0;
  double width = 0.5;
  double height = -0.03;
  double slope = 45.0 * degree;

  double operator()(double px, double py) const {
    const double u = (px - x) * std::cos(heading) + (py - y) * std::sin(heading);
    const double v = (py - y) * std::cos(heading) - (px - x) * std::sin(heading);
    const double inside = std::min({u, length - u, 0.5 * width - std::abs(v)});
    const double size = std::clamp(inside * std::tan(slope), 0.0, std::abs(height));
    return std::copysign(size, height);
  }
};

/// The tracks of a machine: two ruts, each with berms at its sides.
struct Tracks {
  double x = 0.0;  ///< between the ruts, where they start
  double y = 0.0;
  double heading = 0.0;
  double length = 3.0;
  double spacing = 2.0;  ///< between the axes of the ruts
  double width = 0.5;
  double depth = 0.03;
  double berm_height = 0.0;
  double berm_slope = 16.0 * degree;

  Height change() const {
    std::vector<Height> parts;
    const auto strip = [&](double aside, double wide, double height, double slope) {
      parts.push_back(Strip{x - aside * std::sin(heading), y + aside * std::cos(heading), heading,
                            length, wide, height, slope});
    };
    const double berm_width = 2.0 * berm_height / std::tan(berm_slope);
    for (const double side : {-0.5 * spacing, 0.5 * spacing}) {
      strip(side, width, -depth, 45.0 * degree);
      if (berm_height == 0.0) continue;
      strip(side - 0.5 * (width + berm_width), berm_width, berm_height, berm_slope);
      strip(side + 0.5 * (width + berm_width), berm_width, berm_height, berm_slope);
    }
    return largest_of(parts);
  }
};

/// A box, or a wall, whose top is level.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  double length = 0.4;
  double width = 0.4;
  double top = 0.3;  ///< as a height of the scene

  bool holds(double px, double py) const {
    const double u = (px - x) * std::cos(heading) + (py - y) * std::sin(heading);
    const double v = (py - y) * std::cos(heading) - (px - x) * std::sin(heading);
    return std::abs(u) < 0.5 * length && std::abs(v) < 0.5 * width;
  }
};

}  // namespace excavplan::scenes
