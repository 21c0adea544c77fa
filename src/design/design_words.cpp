// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/design_words.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/plan_geometry.hpp"
#include "base/text.hpp"
#include "clouds/file_stream.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void require_words(const DesignWords& words) {
  require_in("design: length [m]", words.length, 0.1, 10000.0);
  require_in("design: width of the floor [m]", words.floor_width, 0.05, 10000.0);
  require_in("design: heading [rad]", words.heading, -100.0, 100.0);
  require_in("design: grade", words.grade, -1.0, 1.0);
  require_in("design: batter, horizontal per vertical", words.batter, 0.0, 20.0);
  require(words.from.allFinite() && words.from.cwiseAbs().maxCoeff() <= 1e9,
          "design: the place where it begins must be within 1e9 m");
  require(words.depth.has_value() != words.floor_z.has_value(),
          "design: it must have either a depth or the height of its floor");
  if (words.depth) require_in("design: depth [m]", *words.depth, 0.01, 100.0);
  if (words.floor_z) {
    require_in("design: height of the floor [m]", *words.floor_z, -farthest_height,
               farthest_height);
  }
}

double mean_along(const DesignWords& words, const HeightMap& ground) {
  const PlanFrame line(words.from, words.heading);
  const auto steps =
      static_cast<int>(std::clamp(std::ceil(2.0 * words.length / ground.cell_size), 2.0, 1e6));
  double sum = 0.0;
  int known = 0;
  for (int i = 0; i < steps; ++i) {
    const Vector2d place = line.place(words.length * (i + 0.5) / steps, 0.0);
    const double z = height_at(ground, place.x(), place.y());
    if (std::isnan(z)) continue;
    sum += z;
    ++known;
  }
  require(known > 0, "design: no ground is known along it, so its depth says no height");
  return sum / known;
}

/// The floor and how high its walls must be.
class Shape {
 public:
  Shape(const DesignWords& words, const HeightMap& ground)
      : words_(words),
        line_(words.from, words.heading),
        is_slope_(words.kind == DesignKind::slope) {
    middle_z_ = words.floor_z ? *words.floor_z : mean_along(words, ground) - *words.depth;
    left_ = is_slope_ ? 0.0 : 0.5 * words.floor_width;
    right_ = is_slope_ ? -words.floor_width : -0.5 * words.floor_width;
    if (words.batter > 0.0) rise_ = rise_to(ground);
  }

  Tin tin() const {
    Tin tin;
    tin.origin = {words_.from.x(), words_.from.y(), middle_z_};
    add_corners(tin, 0.0);
    tin.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (!(rise_ > 0.0)) return tin;
    add_corners(tin, rise_);
    const std::uint32_t walls = is_slope_ ? 1 : 4;
    for (std::uint32_t i = 0; i < walls; ++i) {
      const std::uint32_t next = (i + 1) % 4;
      tin.triangles.push_back({4 + i, 4 + next, next});
      tin.triangles.push_back({4 + i, next, i});
    }
    return tin;
  }

 private:
  /// The left side first, in the sense of the line; outwards by the batter of this rise.
  void add_corners(Tin& tin, double rise) const {
    const double out = words_.batter * rise;
    const double ends = is_slope_ ? 0.0 : out;
    const double right = is_slope_ ? right_ : right_ - out;
    add(tin, 0.0, -ends, left_ + out, rise);
    add(tin, words_.length, ends, left_ + out, rise);
    add(tin, words_.length, ends, right, rise);
    add(tin, 0.0, -ends, right, rise);
  }
  void add(Tin& tin, double along, double farther, double left, double rise) const {
    const Vector2d place = line_.place(along + farther, left);
    tin.points.emplace_back(place.x() - words_.from.x(), place.y() - words_.from.y(),
                            words_.grade * (along - 0.5 * words_.length) + rise);
  }

  /// Grows as far as ground beside the walls is higher, so that a heap farther off is none of it.
  double rise_to(const HeightMap& ground) const {
    constexpr int most_rounds = 1000;
    constexpr double above = 0.05;  // the ground; ours [m]
    double rise = 0.0;
    for (int round = 0; round < most_rounds; ++round) {
      const double reach = words_.batter * rise + 2.0 * ground.cell_size;
      double highest = rise;
      for_each_cell(ground.z, [&](Cell at) {
        const double z = ground.z(at.row, at.col);
        if (std::isnan(z)) return;
        const Vector2d place = line_.of({ground.x(at.col), ground.y(at.row)});
        const double along = std::clamp(place.x(), 0.0, words_.length);
        const double off =
            std::max({std::abs(place.x() - along), place.y() - left_, right_ - place.y()});
        if (off > reach) return;
        highest = std::max(highest, z - middle_z_ - words_.grade * (along - 0.5 * words_.length));
      });
      if (highest == rise) break;
      rise = highest;
    }
    return rise > 0.0 ? rise + above : 0.0;
  }

  const DesignWords& words_;
  PlanFrame line_;
  bool is_slope_;
  double middle_z_ = 0.0;
  double left_ = 0.0, right_ = 0.0;  // of the floor, from the line
  double rise_ = 0.0;
};

const char* name_of(DesignKind kind) {
  if (kind == DesignKind::trench) return "trench";
  return kind == DesignKind::pit ? "pit" : "slope";
}

struct SizeUnit {
  std::string_view word;
  double length;
};
constexpr std::array<SizeUnit, 4> size_units = {
    {{"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"m", 1.0}}};

/// Takes the unit off the end of a text.
double take_unit(std::string_view& text) {
  for (const SizeUnit& unit : size_units) {
    if (text.size() <= unit.word.size()) continue;
    if (text.substr(text.size() - unit.word.size()) != unit.word) continue;
    text.remove_suffix(unit.word.size());
    return unit.length;
  }
  return 1.0;
}

}  // namespace

DesignWords trench_of_size(const std::string& size) {
  std::string_view rest = size;
  const double unit = take_unit(rest);
  std::array<double, 3> numbers = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t end = i < 2 ? rest.find('x') : rest.size();
    const auto value = parse_number(rest.substr(0, end));
    if (end == rest.npos || !value || !(*value > 0.0)) {
      refuse("design: the size of a trench is " + in_quotes(size) +
             ", must be length x width x depth as 15x1x0.5 or 15x1x0.5m");
    }
    numbers[i] = unit * *value;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  DesignWords words;
  words.length = numbers[0];
  words.floor_width = numbers[1];
  words.depth = numbers[2];
  return words;
}

DesignSurface design_of_words(const DesignWords& words, const HeightMap& ground) {
  require_map(ground, "design: ground");
  require_words(words);
  DesignSurface design;
  design.name = name_of(words.kind);
  design.shape = Shape(words, ground).tin();
  design.cuts_only = true;
  design.hangs_on_scan = words.depth.has_value();
  design.unit_told_by = "words";
  return design;
}

}  // namespace excavplan
