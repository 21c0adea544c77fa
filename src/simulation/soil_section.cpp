// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/soil_section.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "simulation/section_bucket.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Numbers of our own choice.
constexpr double look_ahead = 0.25;           // for level and slope of the ground [m]
constexpr double rounding_of_section = 1e-9;  // of a row that the bucket only touches [-]
constexpr double growth = 0.5;  // by which a section grows, and its room ahead at first [m]

double square(double value) { return value * value; }

/// Area between a level and the part of a line below it; the line's ends lie `a` and `b` below.
double area_above_line(double length, double a, double b) {
  if (a <= 0.0 && b <= 0.0) return 0.0;
  if (a >= 0.0 && b >= 0.0) return 0.5 * (a + b) * length;
  return 0.5 * square(std::max(a, b)) / std::abs(a - b) * length;
}

CutArea cut_fresh(Column& column, double from, double to, const Below& line) {
  const double length = to - from;
  if (!(length > 0.0)) return {};
  const double at_from = line.at(from);
  const double at_to = line.at(to);
  const double bank =
      area_above_line(length, column.bank_before - at_from, column.bank_before - at_to);
  const double top = column.top_before();
  const double all = area_above_line(length, top - at_from, top - at_to);
  const double swept = column.swept();
  column.floor = (column.floor * swept + column.bank_before * length - bank) / (swept + length);
  return {bank, all - bank, 0.0};
}

/// Ground that the tip has passed before is cut again only where the line lies below its mean
/// floor.
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
  return {sum.bank + before.bank + after.bank, before.loose + after.loose, 0.0};
}

/// Share of a pile of this cross-section that comes to rest beside the bucket: it is level over the
/// width and falls from both edges.
double area_beside(double area, double width, double slope) {
  return slope * square(std::sqrt(0.25 * width * width + area / slope) - 0.5 * width);
}

/// Height of a heap of this cross-section, a trapezoid through its mid-height at both edges or a
/// triangle, over the distance from the bucket's side plane.
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

std::string span(double from, double to) {
  return number_text(from) + " .. " + number_text(to) + " m";
}

/// The cells that the bucket passes.
CellBlock cells_under(const HeightMap& map, const Swath& swath, const TipReach& reach) {
  const Rectangle extent = map.extent();
  if (!(reach.x_min >= extent.x_min && reach.x_max < extent.x_max)) {
    throw Error(ErrorKind::bad_input,
                "dig: the path, x = " + span(reach.x_min, reach.x_max) +
                    ", must lie on the map, x = " + span(extent.x_min, extent.x_max));
  }
  const auto col_of = [&](double x) {
    return static_cast<Index>((x - map.origin.x()) / map.cell_size);
  };
  const CellBlock cells = {swath.first_row(), swath.end_row(), col_of(reach.x_min),
                           std::min(map.z.cols(), col_of(reach.x_max) + 1)};
  for (Index col = cells.col_begin; col < cells.col_end; ++col) {
    if (swath.is_known(col)) continue;
    throw Error(ErrorKind::bad_input,
                "dig: the path crosses unknown ground at x = " + number_text(map.x(col)) + " m");
  }
  return cells;
}

/// These cells and room around them, the first extent of the section.
CellBlock with_room(const CellBlock& cells, const HeightMap& map, const TipReach& reach) {
  const auto cells_in = [&](double length) {
    return static_cast<Index>(std::ceil(length / map.cell_size));
  };
  CellBlock room = cells;
  room.col_begin = std::max<Index>(0, cells.col_begin - cells_in(growth));
  room.col_end = std::min(map.z.cols(), cells.col_end + cells_in(reach.behind + growth));
  return room;
}

/// Writes the soil at rest on a section to the map and breaks the walls of the cut.
class MapWriter {
 public:
  MapWriter(SoilSection& section, double slope)
      : section_(section),
        ground_(section.ground()),
        map_(ground_.before().bank),
        width_(section.width()),
        slope_(slope) {}

  /// Returns the loose volume that lies where the ground was cut, and the rest.
  LooseSoil write() {
    LooseSoil rest;
    for (Index col = section_.first_col(); col < section_.end_col(); ++col) {
      const Column& column = section_.column(col);
      const bool cut = column.bank < column.bank_before;
      deposit(col, column, cut, rest);
      if (cut) break_walls(col, column, rest);
    }
    return rest;
  }

 private:
  void deposit(Index col, const Column& column, bool cut, LooseSoil& rest) {
    if (!(column.settled > 0.0 || column.windrow > 0.0)) return;
    const double heap = std::clamp(column.top() - column.top_before(), 0.0, column.settled);
    const double within = column.settled - heap;
    const double fallen = cut ? 0.5 * column.windrow : 0.0;  // the inner half slides into the cut
    fill(col, within + fallen / width_);
    if (cut && column.windrow > 0.0) {
      const double edge = std::sqrt(column.windrow * slope_);  // height while the pile held it
      spread(col, 0.5 * column.windrow,
             [&](double u) { return u > 0.0 ? std::min(slope_ * u, edge - slope_ * u) : 0.0; });
    }
    const double area = heap * width_ + (cut ? 0.0 : column.windrow);
    if (area > 0.0) spread(col, area, HeapShape(area, width_, slope_));
    (cut ? rest.in_cut : rest.elsewhere) += (column.settled * width_ + fallen) * map_.cell_size;
    rest.elsewhere += (column.windrow - fallen) * map_.cell_size;
  }

  /// Walls beside the cut that are higher than they can stand break back at the friction angle;
  /// the fallen soil lies at their foot at the angle of repose.
  void break_walls(Index col, const Column& column, LooseSoil& rest) {
    const SoilState bank = section_.bank_of(column.void_ratio);
    const double wall = column.bank_before - column.bank - column.settled - critical_height(bank);
    if (!(wall > 0.0)) return;
    const double broken_slope = std::tan(bank.friction_angle);
    const double swell = (1.0 + ground_.soil().loose.void_ratio) / (1.0 + bank.void_ratio);
    const double ratio = std::sqrt(swell * slope_ / broken_slope);
    const double foot = wall * ratio / (1.0 + ratio);
    const CellBlock rows = rows_within((wall - foot) / broken_slope);
    double fallen = 0.0;
    for (Index row = rows.row_begin; row < rows.row_end; ++row) {
      const double outwards = std::abs(map_.y(row)) - 0.5 * width_;
      const double fall = wall - foot - broken_slope * outwards;
      if (outwards < 0.0 || !(fall > 0.0) || std::isnan(map_.z(row, col))) continue;
      fallen += ground_.swollen_bank(row, col, fall) * map_.cell_size;
      ground_.lower_bank(ground_.at(row, col), fall);
    }
    if (!(fallen > 0.0)) return;
    spread(col, fallen,
           [&](double outwards) { return outwards < 0.0 ? foot + slope_ * outwards : 0.0; });
    rest.in_cut += fallen * map_.cell_size;
  }

  void fill(Index col, double thickness) {
    if (!(thickness > 0.0)) return;
    const Swath& swath = section_.swath();
    for (Index r = 0; r < swath.rows(); ++r) {
      ground_.raise_loose(ground_.at(swath.first_row() + r, col), swath.cover(r) * thickness);
    }
  }

  /// Lays a cross-section [m^2] of this shape across the rows; without known cells it stays under
  /// the bucket.
  template <typename Shape>
  void spread(Index col, double area, const Shape& shape) {
    const CellBlock rows = rows_within(2.0 * std::sqrt(area / slope_));
    raised_.clear();
    double sum = 0.0;
    for (Index row = rows.row_begin; row < rows.row_end; ++row) {
      const double rise = std::max(0.0, shape(std::abs(map_.y(row)) - 0.5 * width_));
      raised_.push_back(std::isnan(map_.z(row, col)) ? 0.0 : rise);
      sum += raised_.back();
    }
    if (!(sum > 0.0)) return fill(col, area / (section_.rows() * map_.cell_size));
    const double exact = area / (sum * map_.cell_size);
    for (Index row = rows.row_begin; row < rows.row_end; ++row) {
      const double rise = exact * raised_[static_cast<std::size_t>(row - rows.row_begin)];
      if (rise > 0.0) ground_.raise_loose(ground_.at(row, col), rise);
    }
  }

  /// The rows under the bucket and up to this distance beside it; grows the window to contain them.
  CellBlock rows_within(double outwards) {
    const double reach = 0.5 * width_ + outwards + map_.cell_size;
    const auto row_at = [&](double y) {
      const double row = (y - map_.origin.y()) / map_.cell_size;
      return static_cast<Index>(std::clamp(row, 0.0, static_cast<double>(map_.z.rows())));
    };
    const CellBlock rows = {row_at(-reach), row_at(reach + map_.cell_size), section_.first_col(),
                            section_.end_col()};
    ground_.cover(rows);
    return rows;
  }

  SoilSection& section_;
  GroundWindow& ground_;
  const HeightMap& map_;
  double width_;
  double slope_;
  std::vector<double> raised_;
};

}  // namespace

// ---- The ground under the bucket ----------------------------------------------------------------

SoilSection::SoilSection(const Terrain& terrain, const GroundSoil& soil, double width,
                         const TipReach& reach)
    : swath_(terrain.bank, width, rounding_of_section),
      ground_(terrain, soil,
              with_room(cells_under(terrain.bank, swath_, reach), terrain.bank, reach)),
      width_(width),
      cell_size_(terrain.bank.cell_size),
      origin_(terrain.bank.origin.x()) {
  for (Index r = 0; r < swath_.rows(); ++r) rows_ += swath_.cover(r);
  cover_columns(reach);
}

void SoilSection::cover_columns(const TipReach& reach) {
  const CellBlock path = cells_under(ground_.before().bank, swath_, reach);
  first_col_ = path.col_begin;
  for (Index col = path.col_begin; col < path.col_end; ++col) columns_.push_back(mean_column(col));
  while (left(end_col()) < reach.x_max + reach.behind && grow_behind()) continue;
  while (left(first_col_) > reach.x_min - growth && grow_ahead()) continue;
  for (Index col = end_col() - 1; col >= first_col_ && middle(col) > reach.x_max; --col) {
    left_behind_.emplace_back(middle(col), column(col).top_before());
  }
}

bool SoilSection::grow_ahead() {
  const auto cells = static_cast<Index>(std::ceil(growth / cell_size_));
  const Index end = first_col_;
  while (end - first_col_ < cells && first_col_ > 0 && swath_.is_known(first_col_ - 1))
    --first_col_;
  if (first_col_ == end) return false;
  ground_.cover({swath_.first_row(), swath_.first_row() + 1, first_col_, end});
  columns_.insert(columns_.begin(), static_cast<std::size_t>(end - first_col_), Column{});
  for (Index col = first_col_; col < end; ++col) at(col) = mean_column(col);
  return true;
}

bool SoilSection::grow_behind() {
  const Index begin = end_col();
  const Index wanted = begin + static_cast<Index>(std::ceil(growth / cell_size_));
  Index end = begin;
  while (end < std::min(wanted, ground_.before().loose.cols()) && swath_.is_known(end)) ++end;
  if (end == begin) return false;
  ground_.cover({swath_.first_row(), swath_.first_row() + 1, begin, end});
  for (Index col = begin; col < end; ++col) columns_.push_back(mean_column(col));
  return true;
}

Column SoilSection::mean_column(Index col) {
  Column mean;
  double thickness = 0.0;  // of the loose soil, as void ratios count
  for (Index r = 0; r < swath_.rows(); ++r) {
    const Index row = swath_.first_row() + r;
    mean.bank += swath_.cover(r) * ground_.bank(row, col);
    mean.loose += swath_.cover(r) * ground_.loose(row, col);
    mean.void_ratio += swath_.cover(r) * ground_.bank_void_ratio(row, col);
    if (ground_.loose_is_even()) continue;
    mean.loose_void_ratio += swath_.cover(r) * ground_.before().loose(row, col) *
                             ground_.before().loose_void_ratio(row, col);
    thickness += swath_.cover(r) * ground_.before().loose(row, col);
  }
  mean.loose_void_ratio =
      thickness > 0.0 ? mean.loose_void_ratio / thickness : ground_.soil().loose.void_ratio;
  mean.bank_before = mean.bank /= rows_;
  mean.loose_before = mean.loose /= rows_;
  const SoilKind& kind = ground_.soil().kind;
  mean.void_ratio = std::clamp(mean.void_ratio / rows_, kind.void_ratio_min, kind.void_ratio_max);
  return mean;
}

Index SoilSection::column_at(double x) const {
  const auto col = std::floor((x - origin_) / cell_size_);
  return static_cast<Index>(
      std::clamp(col, static_cast<double>(first_col_), static_cast<double>(end_col() - 1)));
}

// ---- Cutting ------------------------------------------------------------------------------------

CutArea SoilSection::cut(Vector2d p, Vector2d q) {
  pass(q);
  CutArea sum;
  if (p.x() > q.x()) std::swap(p, q);
  if (!(q.x() > p.x())) return sum;
  const double slope = (q.y() - p.y()) / (q.x() - p.x());
  const Below line = {p.y() - slope * p.x(), slope};
  const Index last = column_at(q.x());
  for (Index col = column_at(p.x()); col <= last; ++col) {
    const double from = std::max(p.x(), left(col));
    const double to = std::min(q.x(), left(col) + cell_size_);
    if (!(to > from)) continue;
    const CutArea area = cut_column(at(col), from, to, line);
    sum.bank += area.bank;
    sum.loose += area.loose;
    sum.swollen += take_bank(col, area.bank / cell_size_) * cell_size_;
    sum.swollen += take_loose(col, area.loose / cell_size_) * cell_size_;
  }
  return sum;
}

/// Cuts all rows to the common level that removes this mean thickness; returns its swollen
/// thickness.
double SoilSection::take_bank(Index col, double thickness) {
  if (!(thickness > 0.0)) return 0.0;
  double level = at(col).bank -= thickness;
  const auto top = [&](Index r) {  // where the bucket covers the row
    const Index row = swath_.first_row() + r;
    const double before = ground_.before().bank.z(row, col);
    return before - (before - ground_.bank(row, col)) / swath_.cover(r);
  };
  double above = 0.0;
  for (Index n = 0; n <= swath_.rows(); ++n) {  // Newton's method, from below: ends exactly
    above = 0.0;
    double weight = 0.0;
    for (Index r = 0; r < swath_.rows(); ++r) {
      const double height = top(r) - level;
      if (!(height > 0.0)) continue;
      above += swath_.cover(r) * height;
      weight += swath_.cover(r);
    }
    const double rise = weight > 0.0 ? (above - thickness * rows_) / weight : 0.0;
    if (!(rise > 1e-15)) break;
    level += rise;
  }
  if (!(above > 0.0)) return 0.0;
  const double exact = thickness * rows_ / above;
  double swollen = 0.0;
  for (Index r = 0; r < swath_.rows(); ++r) {
    const double height = top(r) - level;
    if (!(height > 0.0)) continue;
    const Index row = swath_.first_row() + r;
    const double taken = exact * swath_.cover(r) * height;
    swollen += ground_.swollen_bank(row, col, taken);
    ground_.lower_bank(ground_.at(row, col), taken);
  }
  return swollen / rows_;
}

/// Removes the same share of the loose soil of all rows; returns its swollen thickness.
double SoilSection::take_loose(Index col, double thickness) {
  Column& mean = at(col);
  const double taken = std::min(thickness, mean.loose);
  if (!(taken > 0.0)) return 0.0;
  mean.loose -= taken;
  double swollen = 0.0;
  for (Index r = 0; r < swath_.rows(); ++r) {
    const Index row = swath_.first_row() + r;
    const double share = swath_.cover(r) * ground_.before().loose(row, col) / mean.loose_before;
    const std::size_t cell = ground_.at(row, col);
    swollen += ground_.swollen_loose(cell, share * taken);
    ground_.lower_loose(cell, share * taken);
  }
  return swollen / rows_;
}

void SoilSection::pass(const Vector2d& tip) {
  const double level = std::min(tip.y(), surface_before(tip.x()));
  if (left_behind_.empty() || tip.x() < left_behind_.back().x()) {
    left_behind_.emplace_back(tip.x(), level);
  } else if (tip.x() == left_behind_.back().x()) {
    left_behind_.back().y() = std::min(left_behind_.back().y(), level);
  }
}

// ---- The ground ahead and behind ----------------------------------------------------------------

template <typename Level>
double SoilSection::between(double x, const Level& level) const {
  const double first = middle(first_col_);
  const double along =
      std::clamp((x - first) / cell_size_, 0.0, static_cast<double>(columns_.size() - 1));
  const auto i = static_cast<std::size_t>(along);
  const double here = level(columns_[i]);
  if (i + 1 == columns_.size()) return here;
  return here + (along - static_cast<double>(i)) * (level(columns_[i + 1]) - here);
}

double SoilSection::bank_before(double x) const {
  return between(x, [](const Column& column) { return column.bank_before; });
}

double SoilSection::surface_before(double x) const {
  return between(x, [](const Column& column) { return column.top_before(); });
}

SoilState SoilSection::bank_of(double void_ratio) const {
  const GroundSoil& soil = ground_.soil();
  return ground_.bank_is_even() ? soil.bank : bank_state_of_void_ratio(soil.kind, void_ratio);
}

SoilState SoilSection::loose_of(double void_ratio) const {
  const GroundSoil& soil = ground_.soil();
  return ground_.loose_is_even() ? soil.loose : checked_loose_state(soil.kind, void_ratio);
}

GroundAhead SoilSection::ahead(double x) const {
  const Index last = column_at(x);
  const Index first = column_at(x - look_ahead + 0.5 * cell_size_);
  const auto n = static_cast<double>(last - first + 1);
  GroundAhead mean;
  double moment = 0.0;
  double inertia = 0.0;
  double all_loose = 0.0;
  const double centre = 0.5 * (middle(first) + middle(last));
  for (Index col = first; col <= last; ++col) {
    const Column& here = column(col);
    const bool passed = here.swept() > cell_size_ - 1e-9;
    const double bank = passed ? here.bank : here.bank_before;
    const double loose = passed ? here.loose : here.loose_before;
    mean.bank += bank / n;
    mean.surface += (bank + loose) / n;
    mean.void_ratio += here.void_ratio / n;
    mean.loose_void_ratio += loose * here.loose_void_ratio;
    all_loose += loose;
    moment += (middle(col) - centre) * (bank + loose);
    inertia += square(middle(col) - centre);
  }
  mean.loose_void_ratio =
      all_loose > 0.0 ? mean.loose_void_ratio / all_loose : ground_.soil().loose.void_ratio;
  mean.gradient = inertia > 0.0 ? moment / inertia : 0.0;
  const double shift = mean.gradient * (x - centre);
  mean.bank += shift;
  mean.surface += shift;
  return mean;
}

// ---- What comes to rest -------------------------------------------------------------------------

double SoilSection::shed(double x, const PileProfile& pile, double slope) {
  double shed = 0.0;
  const double end = pile.level + pile.high / pile.fall;
  double u = 0.0;
  while (u < end) {
    const double foot = x - u - 1e-12;
    if (foot < left(first_col_) && !grow_ahead()) break;
    const Index col = column_at(foot);
    const double length = std::min(x - u - left(col), end - u);
    if (!(length > 1e-12)) break;
    const double thickness = pile.high - pile.fall * std::max(0.0, u + 0.5 * length - pile.level);
    double& windrow = at(col).windrow;
    const double target = area_beside(thickness * width_ + windrow, width_, slope);
    const double leaving = std::max(0.0, target - windrow) * length;
    windrow += leaving / cell_size_;
    shed += leaving / width_;
    u += length;
  }
  return shed;
}

void SoilSection::settle(double place, const Heap& heap, double area) {
  if (!(area > 0.0)) return;
  const double reach = 2.0 * std::sqrt(area / heap.slope);  // twice that on level ground
  while (heap.side != Side::behind && left(first_col_) > heap.x - reach && grow_ahead()) continue;
  while (heap.side != Side::ahead && left(end_col()) < heap.x + reach && grow_behind()) continue;
  const Index edge = column_at(place);
  const Index begin = heap.side == Side::behind ? edge : first_col_;
  raise(heap, area, begin, heap.side == Side::ahead ? std::max(edge, begin + 1) : end_col());
}

void SoilSection::raise(const Heap& heap, double area, Index begin, Index end) {
  const auto above = [&](Index col, double apex) {
    return apex - heap.slope * std::abs(middle(col) - heap.x) - column(col).top();
  };
  const auto total = [&](double apex) {
    double sum = 0.0;
    for (Index col = begin; col < end; ++col) sum += std::max(0.0, above(col, apex));
    return sum * cell_size_;
  };
  double low = std::numeric_limits<double>::infinity();
  for (Index col = begin; col < end; ++col) low = std::min(low, -above(col, 0.0));
  double high = low + std::sqrt(area * heap.slope) + heap.slope * cell_size_;
  while (total(high) < area) high += high - low;
  while (high - low > 1e-6) {
    const double half = 0.5 * (low + high);
    (total(half) < area ? low : high) = half;
  }
  const double exact = area / total(high);
  for (Index col = begin; col < end; ++col) {
    at(col).settled += exact * std::max(0.0, above(col, high));
  }
}

LooseSoil write_back(SoilSection& section, double slope) {
  return MapWriter(section, slope).write();
}

}  // namespace excavplan
