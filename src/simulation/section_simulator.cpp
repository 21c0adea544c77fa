// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/section_simulator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/error.hpp>

#include "soil_layers.hpp"

// Areas are [m^2] in the boom plane and stand for a volume over the bucket's outside width. The
// bucket digs towards the machine: "ahead" is towards smaller x.

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double pi = 3.14159265358979323846;
constexpr double look_ahead = 0.25;  // of the lip, for level and slope of the ground [m]; ours

double square(double value) { return value * value; }

// ---- What the bucket holds ----------------------------------------------------------------------

using Polygon = std::vector<Vector2d>;

/// The half plane z <= height + slope * x.
struct Below {
  double height;
  double slope;
  double margin(const Vector2d& p) const { return height + slope * p.x() - p.y(); }
};

void clip(Polygon& polygon, const Below& side, Polygon& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = side.margin(p);
    const double at_q = side.margin(q);
    if (at_p >= 0.0) scratch.push_back(p);
    if ((at_p < 0.0) != (at_q < 0.0)) scratch.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  polygon.swap(scratch);
}

struct AreaCentre {
  double area = 0.0;
  Vector2d centre = Vector2d::Zero();
};

AreaCentre area_centre(const Polygon& polygon) {
  AreaCentre result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double cross = p.x() * q.y() - p.y() * q.x();
    result.area += 0.5 * cross;
    result.centre += cross / 6.0 * (p + q);
  }
  if (result.area > 0.0) result.centre /= result.area;
  return result;
}

/// Volume over a stretch of mouth on which the soil's face stands `from` .. `to` above it, linearly,
/// between side plates from which it may only rise at `slope`.
double heap_over_mouth(double length, double from, double to, double width, double slope) {
  const double full = 0.5 * width * slope;  // the slopes of both plates meet here
  const auto integral = [&](double height) {
    const double low = std::clamp(height, 0.0, full);
    const double high = std::max(0.0, height - full);
    return low * low * (0.5 * width - low / (3.0 * slope)) + high * 0.5 * width * full;
  };
  if (std::abs(to - from) < 1e-12) return 0.0;
  return length * (integral(to) - integral(from)) / (to - from);
}

/// The bucket in one attitude, relative to the tip.
class BucketSection {
 public:
  explicit BucketSection(const Bucket& bucket) : bucket_(bucket) {}

  void turn_to(double phi3) {
    const double c = std::cos(phi3);
    const double s = std::sin(phi3);
    corners_.clear();
    for (const Vector2d& corner : bucket_.profile) {
      const Vector2d p = corner - bucket_.profile.front();
      corners_.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    }
  }

  /// Volume held, and the centre of the part between the side plates.
  AreaCentre held(double support, const HoldingSlopes& slopes) {
    const Vector2d top = corners_.back();
    const Below face = {support, slopes.face};
    const Below rear = {top.y() + slopes.heap * top.x(), -slopes.heap};
    polygon_ = corners_;
    clip(polygon_, face, scratch_);
    clip(polygon_, rear, scratch_);
    AreaCentre result = area_centre(polygon_);
    result.area *= bucket_.width_inside;
    if (top.x() > 0.0) result.area += heaped(top, face, rear, slopes.heap);
    return result;
  }

  /// The part of the side plates below a line of this height and slope.
  AreaCentre buried(const Below& ground) {
    polygon_ = corners_;
    clip(polygon_, ground, scratch_);
    return area_centre(polygon_);
  }

 private:
  double heaped(const Vector2d& top, const Below& face, const Below& rear, double slope) const {
    const Below mouth = {0.0, top.y() / top.x()};
    const auto above = [&](double x) {
      return std::min(face.height + face.slope * x, rear.height + rear.slope * x) - mouth.slope * x;
    };
    const double crossing = (rear.height - face.height) / (face.slope - rear.slope);
    const double peak = std::clamp(crossing, 0.0, top.x());
    const double width = bucket_.width_inside;
    return heap_over_mouth(peak, above(0.0), above(peak), width, slope) +
           heap_over_mouth(top.x() - peak, above(peak), above(top.x()), width, slope);
  }

  const Bucket& bucket_;
  Polygon corners_;
  Polygon polygon_;
  Polygon scratch_;
};

// ---- The ground in the boom plane ---------------------------------------------------------------

struct Column {
  double bank_before = 0.0;   ///< mean over the width [m]
  double loose_before = 0.0;  ///< [m]
  double bank = 0.0;
  double loose = 0.0;       ///< what is left of the loose soil that lay here
  double swept_from = 0.0;  ///< the tip has passed from here ..
  double swept_to = 0.0;    ///< .. to here [m]
  double floor = 0.0;       ///< mean level of the bank where the tip has passed
  double windrow = 0.0;     ///< loose, beside the bucket on both sides together [m^2]
  double settled = 0.0;     ///< loose, come to rest here [m]

  double swept() const { return swept_to - swept_from; }
  double top_before() const { return bank_before + loose_before; }
  double top() const { return bank + loose + settled; }
};

struct CutArea {
  double bank = 0.0;
  double loose = 0.0;
};

/// Area between `top` and a line from `from` to `to` where the line lies below.
double area_above_line(double length, double from, double to, double top) {
  const double a = top - from;
  const double b = top - to;
  if (a <= 0.0 && b <= 0.0) return 0.0;
  if (a >= 0.0 && b >= 0.0) return 0.5 * (a + b) * length;
  return 0.5 * square(std::max(a, b)) / std::abs(a - b) * length;
}

/// Level and slope of the ground ahead of a point; slope positive uphill along the travel.
struct GroundAhead {
  double bank = 0.0;
  double surface = 0.0;
  double slope = 0.0;
};

/// Mean heights over the bucket's width, one column of cells each.
class SoilSection {
 public:
  /// @throws Error (bad_input) if a cell the bucket passes is off the map or unknown
  SoilSection(const Terrain& terrain, double width, double x_min, double x_max)
      : cell_(terrain.bank.cell), origin_(terrain.bank.origin.x()) {
    const HeightMap& map = terrain.bank;
    if (map.z.size() == 0) throw Error(ErrorKind::bad_input, "dig: the map is empty");
    cover_rows(map, width);
    const double reach = look_ahead + 4.0 * width;  // of what a pile can need
    const Index needed_begin = index_of(x_min);
    const Index needed_end = index_of(x_max) + 1;
    if (needed_begin < 0 || needed_end > map.z.cols()) leaves_map(x_min, x_max);
    begin_ = needed_begin;
    while (begin_ > 0 && map.x(begin_ - 1) > x_min - reach && known(map, begin_ - 1)) --begin_;
    for (Index col = needed_begin; col < needed_end; ++col) {
      if (known(map, col)) continue;
      throw Error(ErrorKind::bad_input, "dig: the path crosses unknown ground at x = " +
                                            std::to_string(map.x(col)) + " m");
    }
    Index end = needed_end;
    while (end < map.z.cols() && map.x(end) < x_max + reach && known(map, end)) ++end;
    columns_.reserve(static_cast<std::size_t>(end - begin_));
    for (Index col = begin_; col < end; ++col) columns_.push_back(mean_column(terrain, col));
  }

  double cell() const { return cell_; }
  Index begin() const { return begin_; }
  Index first_row() const { return first_row_; }
  const std::vector<double>& coverage() const { return coverage_; }
  std::vector<Column>& columns() { return columns_; }
  const std::vector<Column>& columns() const { return columns_; }
  double left(std::size_t i) const {
    return origin_ + cell_ * static_cast<double>(begin_ + static_cast<Index>(i));
  }
  double middle(std::size_t i) const { return left(i) + 0.5 * cell_; }
  std::size_t at(double x) const {
    const Index i = std::clamp<Index>(index_of(x) - begin_, 0,
                                      static_cast<Index>(columns_.size()) - 1);
    return static_cast<std::size_t>(i);
  }

  /// Takes out what lies above the line from p to q.
  CutArea cut(Vector2d p, Vector2d q) {
    CutArea sum;
    if (p.x() > q.x()) std::swap(p, q);
    if (!(q.x() > p.x())) return sum;
    const double slope = (q.y() - p.y()) / (q.x() - p.x());
    for (std::size_t i = at(p.x()); i <= at(q.x()); ++i) {
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

  GroundAhead ahead(double x) const {
    const std::size_t last = at(x);
    const std::size_t first = at(x - look_ahead + 0.5 * cell_);
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

  /// Heaps an area on the columns from `first` to `last` inclusive, under slopes that fall off to
  /// both sides of x.
  void settle(double x, double area, double slope, std::size_t first, std::size_t last) {
    if (!(area > 0.0)) return;
    const auto raised = [&](std::size_t i, double apex) {
      return std::max(0.0, apex - slope * std::abs(middle(i) - x) - columns_[i].top());
    };
    const auto total = [&](double apex) {
      double sum = 0.0;
      for (std::size_t i = first; i <= last; ++i) sum += raised(i, apex);
      return sum * cell_;
    };
    double low = columns_[std::clamp(at(x), first, last)].top() - slope * cell_;
    double high = low + std::sqrt(area * slope) + slope * cell_;
    while (total(high) < area) high += high - low;
    while (high - low > 1e-6) {
      const double middle = 0.5 * (low + high);
      (total(middle) < area ? low : high) = middle;
    }
    const double exact = area / total(high);
    // From the outside in: what a column takes does not depend on the others.
    for (std::size_t i = first; i <= last; ++i) columns_[i].settled += exact * raised(i, high);
  }

 private:
  Index index_of(double x) const { return static_cast<Index>(std::floor((x - origin_) / cell_)); }

  [[noreturn]] static void leaves_map(double from, double to) {
    throw Error(ErrorKind::bad_input, "dig: the path, x = " + std::to_string(from) + " .. " +
                                          std::to_string(to) + " m, must lie on the map");
  }

  void cover_rows(const HeightMap& map, double width) {
    const double low = (-0.5 * width - map.origin.y()) / cell_;
    const double high = (0.5 * width - map.origin.y()) / cell_;
    first_row_ = static_cast<Index>(std::floor(low + 1e-9));
    const auto end = static_cast<Index>(std::ceil(high - 1e-9));
    if (first_row_ < 0 || end > map.z.rows()) {
      throw Error(ErrorKind::bad_input, "dig: the bucket, y = " + std::to_string(-0.5 * width) +
                                            " .. " + std::to_string(0.5 * width) +
                                            " m, must lie on the map");
    }
    for (Index row = first_row_; row < end; ++row) {
      const auto r = static_cast<double>(row);
      coverage_.push_back(std::min(r + 1.0, high) - std::max(r, low));
    }
  }

  bool known(const HeightMap& map, Index col) const {
    for (std::size_t r = 0; r < coverage_.size(); ++r) {
      if (std::isnan(map.z(first_row_ + static_cast<Index>(r), col))) return false;
    }
    return true;
  }

  Column mean_column(const Terrain& terrain, Index col) const {
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

  static CutArea cut_fresh(Column& column, double from, double to, const Below& line) {
    const double length = to - from;
    if (!(length > 0.0)) return {};
    const double at_from = line.height + line.slope * from;
    const double at_to = line.height + line.slope * to;
    const double bank = area_above_line(length, at_from, at_to, column.bank_before);
    const double all = area_above_line(length, at_from, at_to, column.top_before());
    const double swept = column.swept();
    column.floor = (column.floor * swept + column.bank_before * length - bank) / (swept + length);
    return {bank, all - bank};
  }

  /// What the tip has passed before is cut again only as far as the line lies below its mean floor.
  static CutArea cut_column(Column& column, double from, double to, const Below& line) {
    if (!(column.swept() > 0.0)) column.swept_from = column.swept_to = from;
    const double again_from = std::clamp(column.swept_from, from, to);
    const double again_to = std::clamp(column.swept_to, from, to);
    CutArea sum;
    if (again_to > again_from) {
      const double level = line.height + line.slope * 0.5 * (again_from + again_to);
      sum.bank = std::max(0.0, column.floor - level) * (again_to - again_from);
      column.floor -= sum.bank / column.swept();
    }
    const CutArea before = cut_fresh(column, from, again_from, line);
    column.swept_from = std::min(column.swept_from, from);
    const CutArea after = cut_fresh(column, again_to, to, line);
    column.swept_to = std::max(column.swept_to, to);
    return {sum.bank + before.bank + after.bank, before.loose + after.loose};
  }

  double cell_;
  double origin_;
  Index begin_ = 0;
  Index first_row_ = 0;
  std::vector<double> coverage_;  ///< share of each row under the bucket
  std::vector<Column> columns_;
};

// ---- The pile ahead of the lip ------------------------------------------------------------------

/// Share of a heap of this cross-section, piled over the width, that comes to rest beside it: the
/// heap is a trapezoid through its mid-height at both edges, or a triangle.
double area_beside(double area, double width, double slope) {
  const double top = area / width;
  if (top <= width * slope) return 0.25 * top * top / slope;
  return slope * square(std::sqrt(area / slope) - 0.5 * width);
}

/// Soil that leans against the lip as a wedge at the angle of repose.
struct Pile {
  double area = 0.0;

  double height(double fall) const { return std::sqrt(2.0 * area * fall); }

  /// Takes what lies over the next `advance` of ground above `lip`, measured from the pile's foot.
  double take(double advance, double lip, double fall) {
    const double high = height(fall);
    const double from = std::max(0.0, lip);
    if (high <= from || advance <= 0.0) return 0.0;
    const double length = std::min(advance, (high - from) / fall);
    const double taken = std::min(area, length * (high - from - 0.5 * fall * length));
    area -= taken;
    return taken;
  }

  /// Sheds to both sides what stands too steep there.
  void shed(SoilSection& section, double x, double fall, double width, double slope) {
    const double high = height(fall);
    const double cell = section.cell();
    for (double u = 0.0; u * fall < high;) {
      const std::size_t i = section.at(x - u - 1e-12);
      const double length = std::min(x - u - section.left(i), high / fall - u);
      if (!(length > 1e-12)) break;
      const double thickness = high - fall * (u + 0.5 * length);
      double& windrow = section.columns()[i].windrow;
      const double target = area_beside(thickness * width + windrow, width, slope);
      const double leaving = std::max(0.0, target - windrow) * length / cell;
      windrow += leaving;
      area = std::max(0.0, area - leaving * cell / width);
      u += length;
      if (i == 0) break;
    }
  }
};

}  // namespace
}  // namespace excavplan
