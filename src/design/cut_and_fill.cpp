// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/cut_and_fill.hpp>

#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "design/deviation.hpp"
#include "design/pieces.hpp"
#include "design/placement.hpp"
#include "ground/hole_filling.hpp"
#include "ground/map_check.hpp"
#include "ground/noise_model.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;

// Ours:
constexpr int sign_reach = 2;          // cells to every side, of whose mean the sign counts
constexpr double of_highest = 0.25;    // of the largest difference, the deviation of unknown ground
constexpr double most_overlap = 1e-3;  // of a design's area
constexpr double filled_from = 3.0;    // around unknown cells under a design; ours [m]
constexpr double upright_area = 1e-9;  // of a face in a cell is that of rounding [m^2]

/// What of the design lies in each cell, and how the ground lies to it.
struct CellSums {
  explicit CellSums(const HeightMap& grid)
      : area(ArrayXXd::Zero(grid.z.rows(), grid.z.cols())),
        above(area),
        below(area),
        height(area),
        steep(area),
        upright(Mask::Constant(area.rows(), area.cols(), false)) {}

  ArrayXXd area;             // [m^2]
  ArrayXXd above;            // of ground over the design [m^3]
  ArrayXXd below;            // missing below it [m^3]
  ArrayXXd height;           // integral of the design's [m^3]
  ArrayXXd steep;            // part of the area that is steep faces [m^2]
  Mask upright;              // has a part of one without area
  double whole_area = 0.0;   // of the design
  double placed_area = 0.0;  // of it, on the grid
};

double slope_of(const Piece& face) {
  const Eigen::Vector3d a = face.corners[1] - face.corners[0];
  const Eigen::Vector3d b = face.corners[2] - face.corners[0];
  const Eigen::Vector3d normal = a.cross(b);
  return std::atan2(normal.head<2>().norm(), std::abs(normal.z()));
}

/// Ground and design, cell by cell.
class Comparison {
 public:
  Comparison(const DesignSurface& design, const HeightMap& filled, double steepest)
      : ground_(filled), sums_(filled), cuts_only_(design.cuts_only) {
    for_each_face(design, filled, [&](const Piece& face) {
      const bool is_steep = slope_of(face) > steepest;
      sums_.whole_area += sum_of(face).area;
      for_each_part(face, filled, [&](Cell at, const Piece& part) { add(at, part, is_steep); });
    });
  }
  const CellSums& sums() const { return sums_; }

 private:
  void add(Cell at, const Piece& part, bool is_steep) {
    const double ground = ground_.z(at.row, at.col);
    const PieceSum sum = sum_of(part);
    sums_.placed_area += sum.area;
    if (std::isnan(ground)) return;
    const double before = sums_.area(at.row, at.col);
    const double lowest = part.lowest(2), highest = part.highest(2);
    if (highest <= ground) {
      add_cut(at, sum, ground);
    } else if (lowest >= ground) {
      add_fill(at, sum, ground);
    } else {
      const Piece under = part_of(part, 2, ground, 1.0);
      const Piece over = part_of(part, 2, ground, -1.0);
      if (!under.is_empty()) add_cut(at, sum_of(under), ground);
      if (!over.is_empty()) add_fill(at, sum_of(over), ground);
    }
    if (!is_steep) return;
    sums_.steep(at.row, at.col) += sums_.area(at.row, at.col) - before;
    if (sum.area < upright_area) sums_.upright(at.row, at.col) = true;
  }
  void add_cut(Cell at, const PieceSum& sum, double ground) {
    sums_.area(at.row, at.col) += sum.area;
    sums_.height(at.row, at.col) += sum.volume;
    sums_.above(at.row, at.col) += ground * sum.area - sum.volume;
  }
  void add_fill(Cell at, const PieceSum& sum, double ground) {
    if (cuts_only_) return;
    sums_.area(at.row, at.col) += sum.area;
    sums_.height(at.row, at.col) += sum.volume;
    sums_.below(at.row, at.col) += sum.volume - ground * sum.area;
  }

  const HeightMap& ground_;
  CellSums sums_;
  bool cuts_only_;
};

void require_options(const CutOptions& options) {
  const GroundErrors& errors = options.errors;
  require_in("cut: deviation of all heights [m]", errors.height_sd, 0.0, 10.0);
  require_in("cut: deviation of the tilt [rad]", errors.tilt_sd, 0.0, 1.0);
  require_in("cut: deviation of the sensor's pattern [m]", errors.pattern_sd, 0.0, 10.0);
  require_in("cut: length of the sensor's pattern [m]", errors.pattern_length, 1e-3, 1e3);
  require_in("cut: tolerance [m]", options.tolerance, 1e-4, 10.0);
  require_in("cut: edge margin [m]", options.edge_margin, 0.0, 100.0);
  require_in("cut: steepest face [rad]", options.steepest, 0.0, 0.5 * pi);
  require_in("cut: least share on known ground", options.least_known_share, 0.0, 1.0);
}

/// The block of cells that holds all of some and so many around.
struct CellBlock {
  Eigen::Index row, col, rows, cols;
};
CellBlock block_around(const Mask& some, Eigen::Index around) {
  Eigen::AlignedBox<Eigen::Index, 2> box;
  for_each_cell(some, [&](Cell at) {
    if (some(at.row, at.col)) box.extend(Eigen::Matrix<Eigen::Index, 2, 1>(at.row, at.col));
  });
  const Eigen::Index row = std::max<Eigen::Index>(0, box.min()(0) - around);
  const Eigen::Index col = std::max<Eigen::Index>(0, box.min()(1) - around);
  return {row, col, std::min(some.rows(), box.max()(0) + 1 + around) - row,
          std::min(some.cols(), box.max()(1) + 1 + around) - col};
}

/// Unknown cells under the design, filled from around.
struct FilledGround {
  std::optional<HeightMap> map;  ///< none if there are none
  Mask unseen;
};
FilledGround filled_under(const DesignSurface& design, const HeightMap& ground) {
  FilledGround filled = {std::nullopt, ground.z.isNaN()};
  if (!filled.unseen.any()) return filled;
  filled.unseen = filled.unseen && cover_of(design, ground).share > 0.0;
  if (!filled.unseen.any()) return filled;
  CellBlock near =
      block_around(filled.unseen, static_cast<Eigen::Index>(filled_from / ground.cell_size));
  if (!ground.z.block(near.row, near.col, near.rows, near.cols).isFinite().any())
    near = {0, 0, ground.z.rows(), ground.z.cols()};
  ArrayXXd z = ground.z.block(near.row, near.col, near.rows, near.cols);
  std::vector<Cell> unknown;
  for_each_cell(z, [&](Cell at) {
    if (std::isnan(z(at.row, at.col))) unknown.push_back(at);
  });
  fill(z, unknown, Filling::membrane);
  filled.map = ground;
  filled.map->z.block(near.row, near.col, near.rows, near.cols) = z;
  return filled;
}

/// Variance of a volume of one kind, by the cells that make it up.
class VolumeError {
 public:
  VolumeError(const Surface& ground, const GroundErrors& errors, double usual_variance)
      : ground_(ground), errors_(errors), usual_(usual_variance) {
    const Rectangle all = ground.height.extent();
    middle_ = {0.5 * (all.x_min + all.x_max), 0.5 * (all.y_min + all.y_max)};
  }
  void add(Cell at, double area, bool is_unseen) {
    area_ += area;
    moment_ +=
        area * (Eigen::Vector2d(ground_.height.x(at.col), ground_.height.y(at.row)) - middle_);
    if (is_unseen) unseen_ += area;
    double variance = usual_;
    if (ground_.variance.size() > 0 && !std::isnan(ground_.variance(at.row, at.col))) {
      variance = ground_.variance(at.row, at.col);
    }
    if (!is_unseen) own_ += area * area * variance;
  }
  double sd(double highest) const {
    const NoiseModel pattern = {0.0, errors_.pattern_sd * errors_.pattern_sd,
                                errors_.pattern_length, 1.0};
    const double of_pattern = area_ * std::min(pattern.integral(), area_ * pattern.correlated);
    const double of_height = area_ * errors_.height_sd;
    const double of_unseen = unseen_ * of_highest * highest;
    return std::sqrt(own_ + of_pattern + of_height * of_height + of_unseen * of_unseen +
                     moment_.squaredNorm() * errors_.tilt_sd * errors_.tilt_sd);
  }

 private:
  const Surface& ground_;
  const GroundErrors& errors_;
  double usual_;
  Eigen::Vector2d middle_;
  Eigen::Vector2d moment_ = Eigen::Vector2d::Zero();
  double area_ = 0.0, unseen_ = 0.0, own_ = 0.0;
};

/// Adds up cut and fill, with a scan's noise by the sign of the mean around.
void add_volumes(const CellSums& sums, const Surface& ground, const Mask& unseen,
                 const GroundErrors& errors, CutAndFill& result) {
  std::vector<double> known = known_values(ground.variance);
  const double usual = known.empty() ? 0.0 : median(known);
  VolumeError cut_error(ground, errors, usual), fill_error(ground, errors, usual);
  double highest = 0.0;
  for_each_cell(sums.area, [&](Cell at) {
    const double area = sums.area(at.row, at.col);
    if (!(area > 0.0)) return;
    const double above = sums.above(at.row, at.col), below = sums.below(at.row, at.col);
    const double off = above - below;
    highest = std::max(highest, std::abs(off) / area);
    result.area += area;
    if (unseen(at.row, at.col)) result.unseen_area += area;
    bool is_cut = off >= 0.0;
    if (usual > 0.0) {
      double around = 0.0;
      for_each_around(sums.area, at, sign_reach, [&](Cell n) {
        around += sums.above(n.row, n.col) - sums.below(n.row, n.col);
      });
      is_cut = around >= 0.0;
      (is_cut ? result.cut : result.fill).value += is_cut ? off : -off;
    } else {
      result.cut.value += above;
      result.fill.value += below;
    }
    (is_cut ? cut_error : fill_error).add(at, area, unseen(at.row, at.col));
  });
  result.cut.sd = cut_error.sd(highest);
  result.fill.sd = fill_error.sd(highest);
}

/// Cells that count: far enough from the rim and from steep faces.
Mask counting_cells(const CellSums& sums, const HeightMap& grid, double margin) {
  const ArrayXXd share = (sums.area - sums.steep) / (grid.cell_size * grid.cell_size);
  return inner_cells(sums.upright.select(0.0, share), grid.cell_size, margin);
}

void require_one_layer(const CellSums& sums, const HeightMap& grid, const DesignSurface& design) {
  const double cell = grid.cell_size * grid.cell_size;
  const double overlap = (sums.area - cell).max(0.0).sum();
  if (overlap <= most_overlap * sums.whole_area) return;
  throw Error(ErrorKind::bad_file,
              "design " + in_quotes(design.name) + ": its triangles lie above one another on " +
                  readable(overlap, 3) +
                  " m^2, expected one surface: a closed body or several surfaces are none");
}

}  // namespace

Deviation deviation_of(const ArrayXXd& off, double cell_size, double tolerance) {
  std::vector<double> errors = known_values(off.abs());
  if (errors.empty()) return {0.0, nan, nan, nan, false};
  double squares = 0.0;
  std::size_t beyond = 0, within = 0;
  for (const double e : errors) {
    squares += e * e;
    if (e <= tolerance) ++within;
    if (e > 2.0 * tolerance) ++beyond;
  }
  const auto n = static_cast<double>(errors.size());
  Deviation deviation;
  deviation.area = n * cell_size * cell_size;
  deviation.rms = std::sqrt(squares / n);
  deviation.p95 = quantile(std::move(errors), 0.95);
  deviation.beyond_twice = static_cast<double>(beyond) / n;
  deviation.is_within = static_cast<double>(within) >= 0.95 * n && deviation.beyond_twice <= 0.01;
  return deviation;
}

CutAndFill cut_and_fill(const DesignSurface& design, const Surface& ground,
                        const CutOptions& options) {
  require_surface(ground, "cut: ground");
  require_options(options);
  require_placement(design, ground.height, options.least_known_share);
  const FilledGround filled = filled_under(design, ground.height);
  const Comparison comparison(design, filled.map ? *filled.map : ground.height, options.steepest);
  const CellSums& sums = comparison.sums();
  require_one_layer(sums, ground.height, design);
  CutAndFill result;
  result.outside_area = std::max(0.0, sums.whole_area - sums.placed_area);
  if (result.outside_area < 1e-9 * sums.whole_area) result.outside_area = 0.0;
  add_volumes(sums, ground, filled.unseen, options.errors, result);
  const Mask counts = counting_cells(sums, ground.height, options.edge_margin);
  result.deviation = deviation_of(counts.select(ground.height.z - sums.height / sums.area, nan),
                                  ground.height.cell_size, options.tolerance);
  const double missing = result.unseen_area + result.outside_area;
  if (missing > 0.0) {
    result.notes.push_back(readable(100.0 * missing / sums.whole_area, 2) +
                           " % of the design lie on ground that no scan has seen");
  }
  return result;
}

CutAndFill cut_and_fill(const DesignSurface& design, const HeightMap& ground,
                        const CutOptions& options) {
  Surface exact;
  exact.height = ground;
  return cut_and_fill(design, exact, options);
}

}  // namespace excavplan
