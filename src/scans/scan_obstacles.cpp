// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ground/grid_cells.hpp"
#include "ground/obstacles.hpp"
#include "ground/window.hpp"
#include "scans/scan_reading.hpp"
#include "scans/scan_wires.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Ours:
constexpr double around_map = 3.0;     // the map, where the shape of things is seen too [m]
constexpr double hidden = 0.3;         // behind a face: as wide as the gaps that are filled [m]
constexpr double one_level = 0.15;     // of returns that are one level of a face [m]
constexpr double next_ray = 1.2;       // times the distance of two levels: to the next above
constexpr double highest_step = 1.0;   // [m]
constexpr double low = 0.3;            // above the ground: what is below is the ground [m]
constexpr double largest_cell = 0.25;  // [m]
constexpr double wire_width = 0.1;     // to both sides of the line of a wire [m]
constexpr double widest_wire = 1.0;    // to which its direction is known [m]
constexpr double above_wire = 1.0;     // [m]
constexpr double thin_post = 0.1;      // of its returns in plan, from end to end [m]
constexpr Index fewest_returns = 3;    // of what hangs, within 0.3 m: not outliers
constexpr double no_return = -std::numeric_limits<double>::infinity();

/// Cells of a map, of which each holds some of the cells of a finer one, and 3 m around these.
class ObstacleCells {
 public:
  ObstacleCells(const HeightMap& grid, double spacing) {
    const double wanted = std::min(std::max(spacing, grid.cell_size), largest_cell);
    parts_ = std::max<Index>(1, static_cast<Index>(std::ceil(wanted / grid.cell_size - 1e-9)));
    highest_.cell_size = static_cast<double>(parts_) * grid.cell_size;
    rim_ = static_cast<Index>(std::ceil(around_map / highest_.cell_size));
    highest_.origin =
        grid.origin - Vector2d::Constant(static_cast<double>(rim_) * highest_.cell_size);
    const Index rows = (grid.z.rows() + parts_ - 1) / parts_ + 2 * rim_;
    const Index cols = (grid.z.cols() + parts_ - 1) / parts_ + 2 * rim_;
    highest_.z = x_ = y_ = below_ = ArrayXXd::Constant(rows, cols, no_return);
  }

  Rectangle extent() const { return highest_.extent(); }

  void add(const Vector3d& p) {
    const auto at = cell_at(highest_, p.x(), p.y());
    if (!at || p.z() <= highest_.z(at->row, at->col)) return;
    highest_.z(at->row, at->col) = p.z();
    x_(at->row, at->col) = p.x();
    y_(at->row, at->col) = p.y();
  }

  /// After all were added. @return whether there is any obstacle
  bool find() {
    top_ = highest_within(highest_.z, 1);
    found_ = find_obstacles(shape());
    return found_.any();
  }
  void add_below(const Vector3d& p) {
    const auto at = cell_at(highest_, p.x(), p.y());
    if (!at || p.z() > top_(at->row, at->col) - one_level) return;
    double& below = below_(at->row, at->col);
    below = std::max(below, p.z());
  }

  /// The tops of obstacles on the cells of the map that these were made for.
  void put_obstacles(const HeightMap& grid, SeenTops& tops) const {
    const ArrayXXd& z = highest_.z;
    const CellMask seen = found_ && z > no_return;
    const ArrayXXd next = highest_within(below_, 1);
    const ArrayXXd above = (next_ray * (top_ - next)).min(highest_step);
    const CellMask hangs = hanging(next);
    Layers all;
    all.tops = widened(seen.select(z + above, no_return));
    all.returns = widened(seen.select(z, no_return));
    all.thin = widened((several(hangs) || posts(seen, next)).select(z, no_return));
    for (const Wire& wire : find_wires(returns_of(hangs))) enter(wire, all);
    tops.obstacles = on(grid, all.tops);
    tops.returns = on(grid, all.returns);
    tops.thin = on(grid, all.thin).isFinite();
  }

 private:
  /// Each `nothing` where there is none.
  struct Layers {
    ArrayXXd tops, returns, thin;
  };

  /// The highest of each cell, or of those beside it; NaN where there is none.
  HeightMap shape() const {
    HeightMap shape = highest_;
    shape.z = (highest_.z > no_return).select(highest_.z, top_);
    shape.z = (shape.z > no_return).select(shape.z, std::nan("")).eval();
    return shape;
  }

  ArrayXXd on(const HeightMap& grid, const ArrayXXd& values) const {
    ArrayXXd fine(grid.z.rows(), grid.z.cols());
    for (Index col = 0; col < fine.cols(); ++col) {
      for (Index row = 0; row < fine.rows(); ++row) {
        const double value = values(rim_ + row / parts_, rim_ + col / parts_);
        fine(row, col) = value > no_return ? value : std::nan("");
      }
    }
    return fine;
  }

  /// The cells of a mask for which `holds`.
  template <typename Holds>
  static CellMask those(const CellMask& mask, Holds holds) {
    CellMask some = mask;
    for_each_cell(mask, [&](Cell at) { some(at.row, at.col) = mask(at.row, at.col) && holds(at); });
    return some;
  }

  CellMask several(const CellMask& hangs) const {
    return those(hangs, [&](Cell at) {
      Index count = 0;
      for_each_around(hangs, at, cells(hidden), [&](Cell n) { count += hangs(n.row, n.col); });
      return count >= fewest_returns;
    });
  }

  /// Obstacles with returns between the highest and the ground, all within the thickness of a post.
  CellMask posts(const CellMask& seen, const ArrayXXd& next) const {
    return those(seen && next > ground() + low, [&](Cell at) {
      Vector2d least(x_(at.row, at.col), y_(at.row, at.col)), most = least;
      for_each_around(seen, at, cells(hidden), [&](Cell n) {
        if (!seen(n.row, n.col)) return;
        least = least.cwiseMin(Vector2d(x_(n.row, n.col), y_(n.row, n.col)));
        most = most.cwiseMax(Vector2d(x_(n.row, n.col), y_(n.row, n.col)));
      });
      return (most - least).norm() <= thin_post;
    });
  }

  /// The lowest around, infinite where nothing is seen.
  ArrayXXd ground() const {
    const ArrayXXd known = (highest_.z > no_return).select(highest_.z, -no_return);
    return lowest_within(known, cells(1.0));
  }

  /// Obstacles with nothing below them but the ground, and ground all around: not the edge of a
  /// roof.
  /// @param next  level below the highest of each cell and those beside it
  CellMask hanging(const ArrayXXd& next) const {
    const ArrayXXd& z = highest_.z;
    const ArrayXXd ground = this->ground();
    const CellMask hangs = found_ && z > top_ - one_level && next < ground + low;
    const ArrayXXd bodies = (found_ && !hangs).select(ArrayXXd::Ones(z.rows(), z.cols()), 0.0);
    const ArrayXXd beside_body = highest_within(bodies, cells(0.35));
    return those(hangs && beside_body <= 0.0,
                 [&](Cell at) { return ground_around(at, ground(at.row, at.col) + low); });
  }

  std::vector<Vector3d> returns_of(const CellMask& some) const {
    std::vector<Vector3d> points;
    for (Index col = 0; col < some.cols(); ++col) {
      for (Index row = 0; row < some.rows(); ++row) {
        if (some(row, col)) points.emplace_back(x_(row, col), y_(row, col), highest_.z(row, col));
      }
    }
    return points;
  }

  /// Each as wide as may be hidden behind it.
  ArrayXXd widened(const ArrayXXd& tops) const {
    ArrayXXd wide = tops;
    const Index near = cells(hidden);
    const double most = std::pow(hidden / highest_.cell_size, 2);
    for (Index col = near; col + near < tops.cols(); ++col) {
      for (Index row = near; row + near < tops.rows(); ++row) {
        const double top = tops(row, col);
        if (top == no_return) continue;
        for (Index right = -near; right <= near; ++right) {
          for (Index down = -near; down <= near; ++down) {
            if (static_cast<double>(right * right + down * down) > most) continue;
            double& z = wide(row + down, col + right);
            z = std::max(z, top);
          }
        }
      }
    }
    return wide;
  }

  Index cells(double length) const {
    return static_cast<Index>(std::ceil(length / highest_.cell_size));
  }

  /// Whether ground was seen within 0.5 m in at least seven of eight directions.
  bool ground_around(const Cell& cell, double highest) const {
    const Index near = cells(0.5);
    unsigned seen = 0;
    for (Index down = -near; down <= near; ++down) {
      for (Index right = -near; right <= near; ++right) {
        const Index r = cell.row + down, c = cell.col + right;
        if (r < 0 || c < 0 || r >= highest_.z.rows() || c >= highest_.z.cols()) continue;
        const double z = highest_.z(r, c);
        if (z == no_return || z > highest) continue;
        const unsigned octant = (down > 0 ? 1U : 0U) + (right > 0 ? 2U : 0U) +
                                (std::abs(down) > std::abs(right) ? 4U : 0U);
        seen |= 1U << octant;
      }
    }
    return __builtin_popcount(seen) >= 7;
  }

  void enter(const Wire& wire, Layers& all) const {
    for (Index col = 0; col < all.tops.cols(); ++col) {
      for (Index row = 0; row < all.tops.rows(); ++row) {
        const Vector2d d = Vector2d(highest_.x(col), highest_.y(row)) - wire.middle;
        const double along = std::abs(d.dot(wire.direction));
        const double off = std::abs(wire.direction.x() * d.y() - wire.direction.y() * d.x());
        const double unsure = wire.turn * std::max(0.0, along - wire.half);
        const double half = wire_width + 0.5 * highest_.cell_size + unsure;
        if (unsure > widest_wire || off > half) continue;
        all.tops(row, col) = std::max(all.tops(row, col), wire.top + above_wire);
        for (ArrayXXd* layer : {&all.returns, &all.thin}) {
          (*layer)(row, col) = std::max((*layer)(row, col), wire.top);
        }
      }
    }
  }

  HeightMap highest_;
  Index parts_ = 1, rim_ = 0;
  ArrayXXd x_, y_;  ///< of the highest return
  ArrayXXd top_;    ///< of a cell and those beside it
  CellMask found_;  ///< obstacles
  ArrayXXd below_;  ///< highest return of a cell a level below that
};

}  // namespace

SeenTops seen_tops(const Scan& scan, const HeightMap& grid, const TopsOptions& options) {
  ObstacleCells cells(grid, options.spacing);
  SeenTops tops;
  tops.highest = ArrayXXd::Constant(grid.z.rows(), grid.z.cols(), no_return);
  const Rectangle fine = grid.extent(), wide = cells.extent();
  const auto counts = [&](const Vector3d& p) {
    return p.allFinite() && p.z() <= options.ceiling && wide.contains(p.x(), p.y()) &&
           !(options.own && options.own->contains(p.x(), p.y()));
  };
  visit_scan(scan, [&](const std::vector<Vector3d>& points) {
    for (const Vector3d& p : points) {
      if (!counts(p)) continue;
      cells.add(p);
      if (!fine.contains(p.x(), p.y())) continue;
      const auto col = static_cast<Index>((p.x() - grid.origin.x()) / grid.cell_size);
      const auto row = static_cast<Index>((p.y() - grid.origin.y()) / grid.cell_size);
      double& z = tops.highest(std::min(row, grid.z.rows() - 1), std::min(col, grid.z.cols() - 1));
      z = std::max(z, p.z());
    }
  });
  tops.highest = (tops.highest > no_return).select(tops.highest, std::nan("")).eval();
  if (!cells.find()) {
    tops.obstacles = tops.returns = ArrayXXd::Constant(grid.z.rows(), grid.z.cols(), std::nan(""));
    tops.thin = CellMask::Constant(grid.z.rows(), grid.z.cols(), false);
    return tops;
  }
  visit_scan(scan, [&](const std::vector<Vector3d>& points) {
    for (const Vector3d& p : points) {
      if (counts(p)) cells.add_below(p);
    }
  });
  cells.put_obstacles(grid, tops);
  return tops;
}

}  // namespace excavplan
