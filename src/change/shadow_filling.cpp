// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/shadow_filling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/hole_filling.hpp"
#include "ground/plane_fit.hpp"
#include "ground/sight_lines.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

/// An angle of a face and its standard deviation [rad].
struct Angle {
  double mean;
  double sd;
};

/// Of faces that were not seen; ours: cut walls stand steeply, loose soil at its angle of repose.
constexpr Angle usual_wall = {70.0 * degree, 8.0 * degree};
constexpr Angle usual_repose = {33.0 * degree, 4.0 * degree};
/// Ours: by which the faces of one hole or heap differ.
constexpr double wall_scatter = 4.0 * degree;
constexpr double repose_scatter = 2.0 * degree;

/// What is known of a zone from its seen cells.
struct Shape {
  bool is_hole = false;
  double size = 0.0;  ///< sum of the change [m]
  Angle face{};
  double floor = 0.0;     ///< [m]
  double floor_sd = 0.0;  ///< [m]
};

/// How the ground falls from a rim: on loose soil above the ground before, on a wall below it.
struct Descent {
  double repose;  ///< [m/cell]
  double wall;    ///< [m/cell]

  /// Way from a height down to the ground before, < 0 below it [cell].
  double way(double height) const { return height / (height > 0.0 ? repose : wall); }
  double height(double way) const { return way * (way > 0.0 ? repose : wall); }
};

/// A known cell beside a shadow.
struct Rim {
  Eigen::Vector2d place;  ///< (column, row)
  double height;          ///< above the ground before [m]
  double beyond = 0.5;    ///< the way from there on which the ground is not hidden [cell]
  Eigen::Vector2d outward = Eigen::Vector2d::Zero();  ///< from the sensor, where the cell hides
};

struct Shadow {
  std::vector<Cell> cells;
  std::vector<Rim> rim;
  std::vector<Rim> hiding;  ///< those that hide the ground behind
  std::size_t mixed = 0;    ///< cells that held mixed returns
  int hole_zone = -1;
  int heap_zone = -1;
};

class ShadowFiller {
 public:
  ShadowFiller(const ShadowedScans& scans, ChangedGround& ground)
      : before_(scans.before),
        after_(scans.after),
        mixed_(scans.mixed),
        inferred_(scans.inferred),
        lowest_(scans.lowest),
        ground_(ground),
        sight_(scans.after, scans.places),
        change_{after_.origin, after_.cell_size, after_.z - before_.z - ground.datum},
        variance_(ground.zone_is_cut.size(), 0.0) {
    const Gradient gradient = gradient_of(change_);
    slope_ = (gradient.x.square() + gradient.y.square()).sqrt();
  }

  std::vector<double> fill_all() {
    find_shapes();
    const Holes holes = find_holes(after_.z);
    std::vector<Shadow> shadows;
    for (const std::vector<Cell>& hole : holes.cells) {
      Shadow shadow = shadow_of(hole);
      if (is_shadow(shadow)) shadows.push_back(std::move(shadow));
    }
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (ground_.zone_is_cut[i] && !shapes_[i].is_hole) {
        shadows.push_back(shadow_beyond(static_cast<int>(i), holes));
      }
    }
    for (const Shadow& shadow : shadows) fill_one(shadow);
    return std::move(variance_);
  }

 private:
  using Zones = std::vector<std::vector<Cell>>;

  double change(Cell at) const { return change_.z(at.row, at.col); }
  int zone(Cell at) const { return ground_.zone(at.row, at.col); }

  // ---- What is seen ---------------------------------------------------------------------------

  void find_shapes() {
    Zones seen(ground_.zone_is_cut.size());
    for_each_cell(ground_.zone, [&](Cell at) {
      if (zone(at) >= 0 && !std::isnan(change(at))) {
        seen[static_cast<std::size_t>(zone(at))].push_back(at);
      }
    });
    for (const std::vector<Cell>& cells : seen) shapes_.push_back(shape_of(cells));
  }

  Shape shape_of(const std::vector<Cell>& cells) const {
    Shape shape;
    double sum = 0.0;
    for (const Cell at : cells) sum += change(at);
    shape.is_hole = sum < 0.0;
    shape.size = std::abs(sum);
    if (cells.empty()) return shape;
    shape.face = face_of(cells, shape.is_hole);
    if (shape.is_hole) find_floor(cells, shape);
    return shape;
  }

  /// Slope of the faces by the area between a quarter and three quarters of their height. The sum
  /// of the slope over all cells is height times length of the contours, however cells blur it. A
  /// wide ledge that is hidden ends in a rim that is seen; a narrow one may be hidden with its
  /// wall.
  Angle face_of(const std::vector<Cell>& cells, bool is_hole) const {
    constexpr double fewest = 20.0;  // ours: cells of a face
    const double sign = is_hole ? -1.0 : 1.0;
    std::vector<double> heights;
    heights.reserve(cells.size());
    for (const Cell at : cells) heights.push_back(sign * change(at));
    const double top = quantile(heights, 0.95);
    double slopes = 0.0;
    double counted = 0.0;
    double middle = 0.0;
    std::vector<double> between;  // slopes
    for (const Cell at : cells) {
      const double slope = slope_(at.row, at.col);
      if (std::isnan(slope)) continue;
      slopes += slope * change_.cell_size;
      const double height = sign * change(at);
      counted += height > 0.1 * top ? 1.0 : 0.0;
      if (!(height > 0.25 * top && height < 0.75 * top)) continue;
      middle += 1.0;
      between.push_back(slope);
    }
    const Angle usual = is_hole ? usual_wall : usual_repose;
    if (!(counted > fewest) || !(middle > 0.0) || !(top > 0.0)) return usual;
    if (!is_hole) return {std::atan(median(between)), repose_scatter};
    const double length = slopes / top;  // of a contour [cell]
    const auto angle = [&](double cells_of_face) {
      const double blurred = 2.0 * cells_of_face / length;  // width of the face [cell]
      const double least = 0.2;                             // ours [cell]
      const double width = std::sqrt(std::max(blurred * blurred - 1.0 / 3.0, least * least));
      return std::atan2(top, width * change_.cell_size);
    };
    const double wall = angle(middle - ledge_cells(between));
    return {wall, std::max(wall_scatter, 0.5 * (wall - angle(middle)))};
  }

  /// Cells far gentler than the wall above and below them.
  static double ledge_cells(const std::vector<double>& slopes) {
    constexpr double level = 0.5;  // ours: of the slope of the wall
    const double limit = level * quantile(slopes, 0.95);
    return static_cast<double>(
        std::count_if(slopes.begin(), slopes.end(), [&](double s) { return s < limit; }));
  }

  /// Level of the deepest cells that are not steep, or what the deepest faces leave open.
  void find_floor(const std::vector<Cell>& cells, Shape& shape) const {
    constexpr double deep = 0.8;          // ours: of the depth
    constexpr double gentle = 0.5;        // ours
    constexpr std::size_t fewest = 12;    // ours: cells
    constexpr double least_share = 0.03;  // ours: of the depth, by which floors are uneven
    std::vector<double> heights;
    heights.reserve(cells.size());
    for (const Cell at : cells) heights.push_back(change(at));
    const double lowest = quantile(heights, 0.03);
    heights.clear();
    for (const Cell at : cells) {
      if (change(at) > deep * lowest || !(slope_(at.row, at.col) < gentle)) continue;
      heights.push_back(change(at));
    }
    if (heights.size() >= fewest) {
      const Spread spread = robust_spread(std::move(heights));
      shape.floor = spread.middle;
      shape.floor_sd = std::max(spread.sd, -least_share * shape.floor);
    } else {  // between the deepest cell and twice its depth
      shape.floor = 1.5 * lowest;
      shape.floor_sd = -0.5 * lowest / std::sqrt(3.0);
    }
  }

  // ---- Shadows --------------------------------------------------------------------------------

  Shadow shadow_of(const std::vector<Cell>& hole) const {
    Shadow shadow;
    for (const Cell at : hole) {
      if (!std::isnan(before_.z(at.row, at.col))) shadow.cells.push_back(at);
    }
    Eigen::ArrayXXi taken = Eigen::ArrayXXi::Zero(after_.z.rows(), after_.z.cols());
    std::size_t facing = 0;
    for (const Cell at : hole) {
      for (Eigen::Index c = at.col - 1; c <= at.col + 1; ++c) {
        for (Eigen::Index r = at.row - 1; r <= at.row + 1; ++r) {
          if (r < 0 || c < 0 || r >= taken.rows() || c >= taken.cols()) continue;
          if (taken(r, c) != 0 || std::isnan(change({r, c}))) continue;
          taken(r, c) = 1;
          facing += sight_.faces_unseen({r, c}) ? 1 : 0;
          shadow.rim.push_back(rim_at({r, c}));
          if (sight_.hidden_by({r, c}) != nullptr) shadow.hiding.push_back(shadow.rim.back());
          note_zone({r, c}, shadow);
        }
      }
      note_zone(at, shadow);
      shadow.mixed += static_cast<std::size_t>(mixed_(at.row, at.col));
    }
    if (2 * shadow.hiding.size() < facing) shadow.hiding.clear();
    return shadow;
  }

  double size_of(int zone) const { return shapes_[static_cast<std::size_t>(zone)].size; }

  /// Of the zones of a kind that meet in a shadow the largest tells its shape.
  void note_zone(Cell at, Shadow& shadow) const {
    if (zone(at) < 0) return;
    const bool is_hole = shapes_[static_cast<std::size_t>(zone(at))].is_hole;
    int& known = is_hole ? shadow.hole_zone : shadow.heap_zone;
    if (known < 0 || size_of(zone(at)) > size_of(known)) known = zone(at);
  }

  /// The shadow of a heap that reaches the edge of the survey, as far as the heap may.
  Shadow shadow_beyond(int heap, const Holes& holes) const {
    constexpr int open = -2;
    constexpr int taken = 0;
    Eigen::ArrayXXi label =
        (after_.z.isNaN() && !before_.z.isNaN() && holes.index < 0)
            .select(Eigen::ArrayXXi::Constant(after_.z.rows(), after_.z.cols(), open), -1);
    std::vector<Rim> rim;
    std::vector<Cell> seeds;
    for_each_cell(label, [&](Cell at) {
      if (zone(at) != heap || std::isnan(change(at))) return;
      const std::size_t known = seeds.size();
      for_each_neighbour(label, at, [&](Cell n) {
        if (label(n.row, n.col) == open) seeds.push_back(n);
      });
      if (seeds.size() > known) rim.push_back(rim_at(at));
    });
    const Shape& shape = shapes_[static_cast<std::size_t>(heap)];
    const Descent descent = descent_at(shape_in(-1, true), shape, -std::sqrt(3.0));
    const auto joins = [&](Cell at) {
      return highest_from(rim, {static_cast<double>(at.col), static_cast<double>(at.row)},
                          descent) > 0.0;
    };
    std::vector<Cell> cells;
    for (const Cell seed : seeds) {
      if (label(seed.row, seed.col) != open || !joins(seed)) continue;
      const std::vector<Cell> more = mark_connected(label, seed, taken, joins);
      cells.insert(cells.end(), more.begin(), more.end());
    }
    Shadow shadow = shadow_of(cells);
    shadow.heap_zone = heap;
    shadow.hole_zone = -1;
    return shadow;
  }

  static bool is_shadow(const Shadow& shadow) {
    constexpr std::size_t fewest = 3;  // ours
    const bool is_hidden = shadow.hiding.size() >= fewest || 2 * shadow.mixed > shadow.cells.size();
    return is_hidden && (shadow.hole_zone >= 0 || shadow.heap_zone >= 0);
  }

  /// The last cell that holds its points ends at the rim of a shadow, on average, but for returns
  /// that are mixed there; the first ray that is not mixed passes as far beyond the rim. The ground
  /// goes on to the rim as it lies before it.
  Rim rim_at(Cell at) const {
    Rim rim{{static_cast<double>(at.col), static_cast<double>(at.row)}, change(at)};
    const SightLines* const lines = sight_.hidden_by(at);
    if (lines == nullptr) return rim;
    const GroundPlane plane = plane_at(at);
    const double level = plane.terms.x();
    if (level < 3.0 * ground_.noise_sd) {
      rim.beyond = 0.5 * (0.5 + std::clamp(lines->cells_to_rim(at), -0.5, 1.5));
    }
    rim.outward = lines->outward(at);
    rim.height = level + rim.beyond * plane.gradient().dot(rim.outward);
    return rim;
  }

  /// Level and slope along columns and rows of the change by the 5 x 5 cells around, which takes
  /// the noise off.
  GroundPlane plane_at(Cell at) const {
    constexpr Eigen::Index reach = 2;
    constexpr double fewest = 8.0;  // ours: cells
    PlaneFit fit;
    for_each_around(after_.z, at, reach, [&](Cell n) {
      if (std::isnan(change(n))) return;
      fit.add(static_cast<double>(n.col - at.col), static_cast<double>(n.row - at.row), change(n));
    });
    if (fit.count() < fewest || !(fit.reciprocal_condition() > 1e-3)) {
      return {{change(at), 0.0, 0.0}};
    }
    return fit.plane();
  }

  Shape shape_in(int zone, bool is_hole) const {
    if (zone >= 0) return shapes_[static_cast<std::size_t>(zone)];
    return {is_hole, 0.0, is_hole ? usual_wall : usual_repose, 0.0, 0.0};
  }

  /// Cells where the ground fell, by a membrane through the rim.
  std::vector<bool> fallen(const Shadow& shadow) const {
    Eigen::ArrayXXd guess = change_.z;
    fill(guess, shadow.cells, Filling::membrane);
    std::vector<bool> fell;
    for (const Cell at : shadow.cells) fell.push_back(guess(at.row, at.col) < 0.0);
    return fell;
  }

  struct Filled {
    std::vector<double> height;  ///< of every cell [m]
    double on_floor = 0.0;       ///< number of cells that the level of the floor decides
  };

  Filled descend(const Shadow& shadow, const std::vector<bool>& fell, const Descent& descent,
                 double floor) const {
    constexpr int along = 3;  // points of a cell
    Filled filled;
    for (std::size_t i = 0; i < shadow.cells.size(); ++i) {
      const Cell cell = shadow.cells[i];
      const double bottom = fell[i] ? floor_at(cell, floor) : 0.0;
      const double ceiling = sight_.ceiling(cell) - before_.z(cell.row, cell.col) - ground_.datum;
      double sum = 0.0;
      for (int n = 0; n < along * along; ++n) {
        const int line = n / along;
        const Eigen::Vector2d point(static_cast<double>(cell.col) + (n % along + 0.5) / along - 0.5,
                                    static_cast<double>(cell.row) + (line + 0.5) / along - 0.5);
        const double height = std::max(bottom, highest_from(shadow.rim, point, descent));
        filled.on_floor += fell[i] && height <= floor ? 1.0 / (along * along) : 0.0;
        sum += height;
      }
      filled.height.push_back(std::min(sum / (along * along), ceiling));
    }
    return filled;
  }

  double floor_at(Cell at, double floor) const {
    return lowest_.size() == 0 ? floor : std::max(floor, lowest_(at.row, at.col));
  }

  /// Of the descents from all cells of the rim.
  static double highest_from(const std::vector<Rim>& rim, const Eigen::Vector2d& point,
                             const Descent& descent) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Rim& from : rim) {
      const Eigen::Vector2d way = point - from.place;
      const double distance = way.norm();
      const double edge = from.beyond * distance / std::max(way.lpNorm<1>(), 1e-9);
      most = std::max(most, descent.way(from.height) - std::max(0.0, distance - edge));
    }
    return descent.height(most);
  }

  Descent descent_at(const Shape& hole, const Shape& heap, double deviations) const {
    const auto rise = [&](const Angle& angle) {
      const double turned =
          std::clamp(angle.mean + deviations * angle.sd, 5.0 * degree, 89.0 * degree);
      return std::tan(turned) * after_.cell_size;
    };
    return {rise(heap.face), rise(hole.face)};
  }

  void fill_one(const Shadow& shadow) {
    const Shape hole = shape_in(shadow.hole_zone, true);
    const Shape heap = shape_in(shadow.heap_zone, false);
    const std::vector<bool> fell = fallen(shadow);
    // Gauss and Hermite's three points for the angles.
    const double far = std::sqrt(3.0);
    const std::array<double, 3> weight = {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};
    std::array<Filled, 3> tries;
    for (std::size_t i = 0; i < 3; ++i) {
      tries[i] = descend(shadow, fell, descent_at(hole, heap, far * (static_cast<double>(i) - 1.0)),
                         hole.floor);
    }
    std::array<Eigen::Vector2d, 3> sums;
    sums.fill(Eigen::Vector2d::Zero());
    for (std::size_t c = 0; c < shadow.cells.size(); ++c) {
      double mean = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        mean += weight[i] * tries[i].height[c];
        sums[i](fell[c] ? 0 : 1) += tries[i].height[c];
      }
      enter(shadow.cells[c], mean, fell[c] ? shadow.hole_zone : shadow.heap_zone);
    }
    const Eigen::Vector2d mean = weight[0] * sums[0] + weight[1] * sums[1] + weight[2] * sums[2];
    Eigen::Vector2d variance = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      variance += weight[i] * (sums[i] - mean).cwiseAbs2();
    }
    cut_rims(shadow, descent_at(hole, heap, 0.0), hole.floor);
    variance(0) += std::pow(hole.floor_sd * tries[1].on_floor, 2) + rim_variance(shadow, hole) +
                   place_variance(shadow, hole);
    if (shadow.hole_zone >= 0) variance_[static_cast<std::size_t>(shadow.hole_zone)] += variance(0);
    if (shadow.heap_zone >= 0) variance_[static_cast<std::size_t>(shadow.heap_zone)] += variance(1);
  }

  /// What is hidden of cells of the rim themselves.
  void cut_rims(const Shadow& shadow, const Descent& descent, double floor) {
    constexpr int along = 5;  // points of a cell
    if (shadow.hole_zone < 0) return;
    for (const Rim& rim : shadow.hiding) {
      const Cell at = {static_cast<Eigen::Index>(rim.place.y()),
                       static_cast<Eigen::Index>(rim.place.x())};
      double sum = 0.0;
      for (int n = 0; n < along * along; ++n) {
        const int line = n / along;
        const Eigen::Vector2d off((n % along + 0.5) / along - 0.5, (line + 0.5) / along - 0.5);
        const double hidden = std::max(0.0, off.dot(rim.outward) - rim.beyond);
        const double way = descent.way(rim.height) - hidden;
        sum += std::max(floor_at(at, floor), descent.height(way)) - rim.height;
      }
      enter(at, change(at) + sum / (along * along), shadow.hole_zone);
    }
  }

  /// The mean of two places of the rim, each of which is even over a cell; where the rim runs along
  /// the grid neighbours share the error. Cells beside a shadow of several places that do not hide
  /// it are seen in part from one or the other: it is always their upper side, which ends anywhere
  /// in the cell, so that all err to the same side by up to a cell.
  double rim_variance(const Shadow& shadow, const Shape& hole) const {
    constexpr double shared = 8.0;  // ours: cells
    constexpr double of_place = 1.0 / 24.0;
    constexpr double of_cell = 1.0 / 3.0;  // second moment of 0 .. 1
    const auto hiding = static_cast<double>(shadow.hiding.size());
    double places = shared * of_place * hiding;
    if (sight_.are_several()) {
      const auto upper = std::count_if(shadow.rim.begin(), shadow.rim.end(), [&](const Rim& rim) {
        return rim.height > 0.5 * hole.floor;
      });
      places += of_cell * std::pow(std::max(0.0, static_cast<double>(upper) - hiding), 2);
    }
    return hole.floor * hole.floor * places;
  }

  /// By the place of the sensor, where only the scan tells it: what a wall hides is as wide as the
  /// wall is high, times the tangent of the rays, and half of it is the wall's own slope.
  double place_variance(const Shadow& shadow, const Shape& hole) const {
    if (!inferred_ || shadow.hiding.empty()) return 0.0;
    double sds = 0.0;
    for (const Rim& rim : shadow.hiding) {
      const Cell at = {static_cast<Eigen::Index>(rim.place.y()),
                       static_cast<Eigen::Index>(rim.place.x())};
      sds += inferred_->tangent_sd({after_.x(at.col), after_.y(at.row), after_.z(at.row, at.col)});
    }
    return std::pow(0.5 * sds * hole.floor * hole.floor / after_.cell_size, 2);
  }

  void enter(Cell at, double height, int zone) {
    after_.z(at.row, at.col) = before_.z(at.row, at.col) + ground_.datum + height;
    if (std::abs(height) > 3.0 * ground_.noise_sd && zone >= 0) {
      ground_.zone(at.row, at.col) = zone;
    }
  }

  const HeightMap& before_;
  HeightMap& after_;
  const Eigen::ArrayXXi& mixed_;
  const std::optional<SensorPlace>& inferred_;
  const Eigen::ArrayXXd& lowest_;
  ChangedGround& ground_;
  AllSightLines sight_;
  HeightMap change_;  ///< after - before, less the datum
  Eigen::ArrayXXd slope_;
  std::vector<Shape> shapes_;  ///< of the zones
  std::vector<double> variance_;
};

}  // namespace

std::vector<double> fill_shadows(const ShadowedScans& scans, ChangedGround& ground) {
  return ShadowFiller(scans, ground).fill_all();
}

}  // namespace excavplan
