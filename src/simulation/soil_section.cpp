// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil_section.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double look_ahead = 0.25;  // for level and slope of the ground [m]; ours

double square(double value) { return value * value; }

/// Area between `top` and a line from `from` to `to` where the line lies below.
double area_above_line(double length, double from, double to, double top) {
  const double a = top - from;
  const double b = top - to;
  if (a <= 0.0 && b <= 0.0) return 0.0;
  if (a >= 0.0 && b >= 0.0) return 0.5 * (a + b) * length;
  return 0.5 * square(std::max(a, b)) / std::abs(a - b) * length;
}

CutArea cut_fresh(Column& column, double from, double to, const Below& line) {
  const double length = to - from;
  if (!(length > 0.0)) return {};
  const double at_from = line.at(from);
  const double at_to = line.at(to);
  const double bank = area_above_line(length, at_from, at_to, column.bank_before);
  const double all = area_above_line(length, at_from, at_to, column.top_before());
  const double swept = column.swept();
  column.floor = (column.floor * swept + column.bank_before * length - bank) / (swept + length);
  return {bank, all - bank};
}

/// What the tip has passed before is cut again only as far as the line lies below its mean floor.
CutArea cut_column(Column& column, double from, double to, const Below& line) {
  if (!(column.swept() > 0.0)) column.swept_from = column.swept_to = from;
  const double again_from = std::clamp(column.swept_from, from, to);
  const double again_to = std::clamp(column.swept_to, from, to);
  CutArea sum;
  if (again_to > again_from) {
    const double level = line.at(0.5 * (again_from + again_to));
    sum.bank = std::max(0.0, column.floor - level) * (again_to - again_from);
    column.floor -= sum.bank / column.swept();
  }
  const CutArea before = cut_fresh(column, from, again_from, line);
  column.swept_from = std::min(column.swept_from, from);
  const CutArea after = cut_fresh(column, again_to, to, line);
  column.swept_to = std::max(column.swept_to, to);
  return {sum.bank + before.bank + after.bank, before.loose + after.loose};
}

/// Share of a heap of this cross-section, piled over the width, that comes to rest beside it: the
/// heap is a trapezoid through its mid-height at both edges, or a triangle.
double area_beside(double area, double width, double slope) {
  const double top = area / width;
  if (top <= width * slope) return 0.25 * top * top / slope;
  return slope * square(std::sqrt(area / slope) - 0.5 * width);
}

/// Its height over the distance from the bucket's side plane.
class HeapShape {
 public:
  HeapShape(double area, double width, double slope) : slope_(slope), top_(area / width) {
    const bool flat = top_ <= width * slope;
    at_edge_ = flat ? 0.5 * top_ : std::sqrt(area * slope) - 0.5 * width * slope;
    if (!flat) top_ = std::sqrt(area * slope);
  }
  double operator()(double outwards) const { return std::min(top_, at_edge_ - slope_ * outwards); }

 private:
  double slope_;
  double top_;
  double at_edge_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::bad_input, "dig: " + what);
}

std::string span(double from, double to) {
  return std::to_string(from) + " .. " + std::to_string(to) + " m";
}

/// Writes a section back: what was cut comes off the rows under the bucket, what came to rest lies
/// on them and slopes off beside them.
class MapWriter {
 public:
  MapWriter(Terrain& terrain, const SoilSection& section, const SlopeLimits& limits)
      : terrain_(terrain), section_(section), width_(section.width()), limits_(limits) {
    for (const double share : section.coverage()) rows_ += share;
    raised_.resize(static_cast<std::size_t>(terrain.loose.rows()));
  }

  /// Returns the loose volume that lies where the ground was cut, and the rest.
  LooseSoil write() {
    LooseSoil rest;
    for (std::size_t i = 0; i < section_.columns().size(); ++i) {
      const Column& column = section_.columns()[i];
      const Index col = section_.first_col() + static_cast<Index>(i);
      const double cut = column.bank_before - column.bank;
      if (cut > 0.0) lower_bank(col, cut);
      if (column.loose < column.loose_before) thin_loose(col, column.loose / column.loose_before);
      deposit(col, column, cut > 0.0, rest);
      if (cut > 0.0) break_walls(col, column, rest);
    }
    return rest;
  }

 private:
  Index row_of(std::size_t r) const { return section_.first_row() + static_cast<Index>(r); }

  /// Cuts all rows down to the one level that takes out the mean thickness `cut`.
  void lower_bank(Index col, double cut) {
    const std::vector<double>& share = section_.coverage();
    auto bank = terrain_.bank.z.col(col);
    double level = section_.columns()[static_cast<std::size_t>(col - section_.first_col())].bank;
    double above = 0.0;
    for (std::size_t n = 0; n <= share.size(); ++n) {  // Newton's method, from below: ends exactly
      double sum = 0.0;
      double weight = 0.0;
      for (std::size_t r = 0; r < share.size(); ++r) {
        if (!(bank(row_of(r)) > level)) continue;
        sum += share[r] * (bank(row_of(r)) - level);
        weight += share[r];
      }
      above = sum;
      const double rise = weight > 0.0 ? (sum - cut * rows_) / weight : 0.0;
      if (!(rise > 1e-15)) break;
      level += rise;
    }
    if (!(above > 0.0)) return;
    const double exact = cut * rows_ / above;
    for (std::size_t r = 0; r < share.size(); ++r) {
      double& z = bank(row_of(r));
      if (z > level) z -= exact * share[r] * (z - level);
    }
  }

  void thin_loose(Index col, double left) {
    const std::vector<double>& share = section_.coverage();
    for (std::size_t r = 0; r < share.size(); ++r) {
      terrain_.loose(row_of(r), col) *= 1.0 - share[r] * (1.0 - left);
    }
  }

  void deposit(Index col, const Column& column, bool cut, LooseSoil& rest) {
    const double cell = terrain_.bank.cell;
    const double slope = limits_.loose_slope;
    const double heap = std::clamp(column.top() - column.top_before(), 0.0, column.settled);
    const double within = column.settled - heap;
    const double fallen = cut ? 0.5 * column.windrow : 0.0;  // the inner half slides into the cut
    fill(col, within + fallen / width_);
    if (cut && column.windrow > 0.0) {
      const double edge = std::sqrt(column.windrow * slope);  // height while the pile held it
      spread(col, 0.5 * column.windrow,
             [&](double u) { return u > 0.0 ? std::min(slope * u, edge - slope * u) : 0.0; });
    }
    const double area = heap * width_ + (cut ? 0.0 : column.windrow);
    if (area > 0.0) spread(col, area, HeapShape(area, width_, slope));
    (cut ? rest.in_cut : rest.elsewhere) += (column.settled * width_ + fallen) * cell;
    rest.elsewhere += (column.windrow - fallen) * cell;
  }

  /// Walls beside the cut that are higher than they can stand break back at the friction angle;
  /// what falls lies against their foot at the angle of repose.
  void break_walls(Index col, const Column& column, LooseSoil& rest) {
    const double wall = column.bank_before - column.bank - column.settled - limits_.critical_height;
    if (!(wall > 0.0)) return;
    const double ratio = std::sqrt(limits_.swell * limits_.loose_slope / limits_.bank_slope);
    const double foot = wall * ratio / (1.0 + ratio);
    const HeightMap& map = terrain_.bank;
    double broken = 0.0;
    for (Index row = 0; row < map.z.rows(); ++row) {
      const double outwards = std::abs(map.y(row)) - 0.5 * width_;
      const double fall = wall - foot - limits_.bank_slope * outwards;
      if (outwards < 0.0 || !(fall > 0.0) || std::isnan(map.z(row, col))) continue;
      terrain_.bank.z(row, col) -= fall;
      broken += fall * map.cell;
    }
    if (!(broken > 0.0)) return;
    spread(col, broken * limits_.swell, [&](double outwards) {
      return outwards < 0.0 ? foot + limits_.loose_slope * outwards : 0.0;
    });
    rest.in_cut += broken * limits_.swell * map.cell;
  }

  void fill(Index col, double thickness) {
    const std::vector<double>& share = section_.coverage();
    for (std::size_t r = 0; r < share.size(); ++r) {
      terrain_.loose(row_of(r), col) += share[r] * thickness;
    }
  }

  /// Lays a cross-section [m^2] of this shape across the rows; what finds no known cell stays
  /// under the bucket.
  template <typename Shape>
  void spread(Index col, double area, const Shape& shape) {
    const HeightMap& map = terrain_.bank;
    double sum = 0.0;
    const Index rows = terrain_.loose.rows();
    const double reach = 0.5 * width_ + std::sqrt(area / limits_.loose_slope) * 2.0 + map.cell;
    const auto index = [&](double y) {
      return std::clamp<Index>(static_cast<Index>((y - map.origin.y()) / map.cell), 0, rows);
    };
    const Index begin = index(-reach);
    const Index end = index(reach + map.cell);
    for (Index row = begin; row < end; ++row) {
      const double rise = std::max(0.0, shape(std::abs(map.y(row)) - 0.5 * width_));
      raised_[static_cast<std::size_t>(row)] = std::isnan(map.z(row, col)) ? 0.0 : rise;
      sum += raised_[static_cast<std::size_t>(row)];
    }
    if (!(sum > 0.0)) return fill(col, area / (rows_ * map.cell));
    const double exact = area / (sum * map.cell);
    for (Index row = begin; row < end; ++row) {
      terrain_.loose(row, col) += exact * raised_[static_cast<std::size_t>(row)];
    }
  }

  Terrain& terrain_;
  const SoilSection& section_;
  double width_;
  SlopeLimits limits_;
  double rows_ = 0.0;
  std::vector<double> raised_;
};

}  // namespace

SoilSection::SoilSection(const Terrain& terrain, double width, double x_min, double x_max)
    : width_(width), cell_(terrain.bank.cell), origin_(terrain.bank.origin.x()) {
  if (terrain.bank.z.size() == 0) refuse("the map is empty");
  cover_rows(terrain.bank);
  cover_columns(terrain, x_min, x_max);
}

void SoilSection::cover_rows(const HeightMap& map) {
  const double low = (-0.5 * width_ - map.origin.y()) / cell_;
  const double high = (0.5 * width_ - map.origin.y()) / cell_;
  if (!(low >= -1e-9 && high <= static_cast<double>(map.z.rows()) + 1e-9)) {
    refuse("the bucket, y = " + span(-0.5 * width_, 0.5 * width_) + ", must lie on the map");
  }
  first_row_ = static_cast<Index>(std::floor(low + 1e-9));
  const auto end = static_cast<Index>(std::ceil(high - 1e-9));
  for (Index row = first_row_; row < end; ++row) {
    const auto r = static_cast<double>(row);
    coverage_.push_back(std::min(r + 1.0, high) - std::max(r, low));
  }
}

void SoilSection::cover_columns(const Terrain& terrain, double x_min, double x_max) {
  const HeightMap& map = terrain.bank;
  const Rectangle extent = map.extent();
  if (!(x_min >= extent.x_min && x_max < extent.x_max)) {
    refuse("the path, x = " + span(x_min, x_max) + ", must lie on the map");
  }
  const auto col_of = [&](double x) { return static_cast<Index>((x - origin_) / cell_); };
  const Index needed_end = std::min(map.z.cols(), col_of(x_max) + 1);
  first_col_ = col_of(x_min);
  for (Index col = first_col_; col < needed_end; ++col) {
    if (!known(map, col)) {
      refuse("the path crosses unknown ground at x = " + std::to_string(map.x(col)) + " m");
    }
  }
  const double reach = look_ahead + 4.0 * width_;  // of a pile; ours
  Index end = needed_end;
  while (end < map.z.cols() && map.x(end) < x_max + reach && known(map, end)) ++end;
  while (first_col_ > 0 && map.x(first_col_ - 1) > x_min - reach && known(map, first_col_ - 1)) {
    --first_col_;
  }
  columns_.reserve(static_cast<std::size_t>(end - first_col_));
  for (Index col = first_col_; col < end; ++col) columns_.push_back(mean_column(terrain, col));
}

bool SoilSection::known(const HeightMap& map, Index col) const {
  for (std::size_t r = 0; r < coverage_.size(); ++r) {
    if (std::isnan(map.z(first_row_ + static_cast<Index>(r), col))) return false;
  }
  return true;
}

Column SoilSection::mean_column(const Terrain& terrain, Index col) const {
  Column column;
  double weight = 0.0;
  for (std::size_t r = 0; r < coverage_.size(); ++r) {
    const Index row = first_row_ + static_cast<Index>(r);
    column.bank += coverage_[r] * terrain.bank.z(row, col);
    column.loose += coverage_[r] * terrain.loose(row, col);
    weight += coverage_[r];
  }
  column.bank_before = column.bank /= weight;
  column.loose_before = column.loose /= weight;
  return column;
}

std::size_t SoilSection::column_at(double x) const {
  const double last = static_cast<double>(columns_.size() - 1);
  return static_cast<std::size_t>(std::clamp((x - left(0)) / cell_, 0.0, last));
}

CutArea SoilSection::cut(Vector2d p, Vector2d q) {
  CutArea sum;
  if (p.x() > q.x()) std::swap(p, q);
  if (!(q.x() > p.x())) return sum;
  const double slope = (q.y() - p.y()) / (q.x() - p.x());
  for (std::size_t i = column_at(p.x()); i <= column_at(q.x()); ++i) {
    const double from = std::max(p.x(), left(i));
    const double to = std::min(q.x(), left(i) + cell_);
    if (!(to > from)) continue;
    const Below line = {p.y() - slope * p.x(), slope};
    const CutArea area = cut_column(columns_[i], from, to, line);
    columns_[i].bank -= area.bank / cell_;
    columns_[i].loose = std::max(0.0, columns_[i].loose - area.loose / cell_);
    sum.bank += area.bank;
    sum.loose += area.loose;
  }
  return sum;
}

GroundAhead SoilSection::ahead(double x) const {
  const std::size_t last = column_at(x);
  const std::size_t first = column_at(x - look_ahead + 0.5 * cell_);
  const double n = static_cast<double>(last - first + 1);
  double mean_bank = 0.0;
  double mean_surface = 0.0;
  double moment = 0.0;
  double inertia = 0.0;
  const double centre = 0.5 * (middle(first) + middle(last));
  for (std::size_t i = first; i <= last; ++i) {
    const Column& column = columns_[i];
    const bool passed = column.swept() > cell_ - 1e-9;
    const double bank = passed ? column.bank : column.bank_before;
    const double loose = passed ? column.loose : column.loose_before;
    mean_bank += bank / n;
    mean_surface += (bank + loose) / n;
    moment += (middle(i) - centre) * (bank + loose);
    inertia += square(middle(i) - centre);
  }
  const double gradient = inertia > 0.0 ? moment / inertia : 0.0;
  const double shift = gradient * (x - centre);
  return {mean_bank + shift, mean_surface + shift, -std::atan(gradient)};
}

double SoilSection::shed(double x, double high, double fall, double slope) {
  double shed = 0.0;
  const double end = high / fall;
  double u = 0.0;
  while (u < end) {
    const std::size_t i = column_at(x - u - 1e-12);
    const double length = std::min(x - u - left(i), end - u);
    if (!(length > 1e-12)) break;
    const double thickness = high - fall * (u + 0.5 * length);
    double& windrow = columns_[i].windrow;
    const double target = area_beside(thickness * width_ + windrow, width_, slope);
    const double leaving = std::max(0.0, target - windrow) * length;
    windrow += leaving / cell_;
    shed += leaving / width_;
    u += length;
    if (i == 0) break;
  }
  return shed;
}

void SoilSection::settle(double x, double area, double slope, std::size_t first, std::size_t last) {
  if (!(area > 0.0)) return;
  const auto raised = [&](std::size_t i, double apex) {
    return std::max(0.0, apex - slope * std::abs(middle(i) - x) - columns_[i].top());
  };
  const auto total = [&](double apex) {
    double sum = 0.0;
    for (std::size_t i = first; i <= last; ++i) sum += raised(i, apex);
    return sum * cell_;
  };
  double low = columns_[first].top() + slope * std::abs(middle(first) - x);
  for (std::size_t i = first + 1; i <= last; ++i) {
    low = std::min(low, columns_[i].top() + slope * std::abs(middle(i) - x));
  }
  double high = low + std::sqrt(area * slope) + slope * cell_;
  while (total(high) < area) high += high - low;
  while (high - low > 1e-6) {
    const double half = 0.5 * (low + high);
    (total(half) < area ? low : high) = half;
  }
  const double exact = area / total(high);
  for (std::size_t i = first; i <= last; ++i) columns_[i].settled += exact * raised(i, high);
}

LooseSoil write_back(const SoilSection& section, const SlopeLimits& limits, Terrain& terrain) {
  return MapWriter(terrain, section, limits).write();
}

}  // namespace excavplan
