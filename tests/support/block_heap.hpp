// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <excavplan/ground/height_map.hpp>
#include "base/random.hpp"

/// @file
/// Heaps for tests whose solids are known: blocks dropped one by one, which roll down to where they
/// rest, and loose soil. Fine grids of 1 cm, averaged to the cells of a survey afterwards.

namespace excavplan::test {

constexpr double fine_cell = 0.01;
constexpr Rectangle heap_ground = {0.0, 0.0, 4.5, 4.5};

struct Heap {
  HeightMap fine;       ///< what is seen from above
  double solids = 0.0;  ///< volume of the blocks, or of the loose soil as a whole [m^3]
  double envelope() const { return fine.z.sum() * fine_cell * fine_cell; }
  double voids() const { return envelope() - solids; }
};

/// A box in some attitude as a field of lower and upper surfaces about its centre.
class Block {
 public:
  Block(const Eigen::Vector3d& half_edges, const Eigen::Quaterniond& attitude) {
    const Eigen::Matrix3d turn = attitude.toRotationMatrix().transpose();
    const auto reach = static_cast<int>(half_edges.norm() / fine_cell);
    for (int col = -reach; col <= reach; ++col) {
      for (int row = -reach; row <= reach; ++row) {
        const Eigen::Vector3d start = turn * Eigen::Vector3d(col * fine_cell, row * fine_cell, 0.0);
        const Eigen::Vector3d way = turn.col(2);
        double low = -1e9;
        double high = 1e9;
        for (int axis = 0; axis < 3; ++axis) {
          const double a = (-half_edges(axis) - start(axis)) / way(axis);
          const double b = (half_edges(axis) - start(axis)) / way(axis);
          low = std::max(low, std::min(a, b));
          high = std::min(high, std::max(a, b));
        }
        if (low < high) columns_.push_back({row, col, low, high});
      }
    }
  }

  /// Height of its centre where it comes to rest above a cell; infinite over the border.
  double rest(const Eigen::ArrayXXd& top, Eigen::Index row, Eigen::Index col) const {
    double height = -1e9;
    for (const Column& c : columns_) {
      const Eigen::Index r = row + c.row;
      const Eigen::Index q = col + c.col;
      if (r < 0 || q < 0 || r >= top.rows() || q >= top.cols()) return 1e9;
      height = std::max(height, top(r, q) - c.low);
    }
    return height;
  }
  void place(Eigen::ArrayXXd& top, Eigen::Index row, Eigen::Index col) const {
    const double height = rest(top, row, col);
    for (const Column& c : columns_) {
      double& cell = top(row + c.row, col + c.col);
      cell = std::max(cell, height + c.high);
    }
  }

 private:
  struct Column {
    int row;
    int col;
    double low;
    double high;
  };
  std::vector<Column> columns_;
};

inline Eigen::Quaterniond random_attitude(Random& random) {
  Eigen::Quaterniond attitude(random.normal(), random.normal(), random.normal(), random.normal());
  attitude.normalize();
  return attitude;
}

struct BlockHeapOptions {
  double size = 0.20;    ///< mean edge of a block [m]
  double spread = 0.25;  ///< of the logarithm of the edges [-]
  double solids = 0.40;  ///< volume of the blocks [m^3]
  double repose = 0.55;  ///< gradient down which a block still rolls [-]
  int tries = 100;       ///< places and attitudes near by, of which a block rests in the lowest
  double crumbs = 0.0;   ///< share of the voids between blocks that fine soil fills [-]
  double cover = 0.0;    ///< fine soil evens out what is narrower than this [m]
};

/// A place where a block rests.
struct Rest {
  Eigen::Index row = 0;
  Eigen::Index col = 0;
  double height = 1e9;
};

/// Rolls down in steps of half a block for as long as that is steeper than the repose.
inline Rest rolled_down(const Eigen::ArrayXXd& top, const Block& block, Rest at,
                        const BlockHeapOptions& options) {
  const auto step = static_cast<Eigen::Index>(std::max(1.0, 0.5 * options.size / fine_cell));
  for (int rolls = 0; rolls < 100; ++rolls) {
    Rest best = at;
    double steepest = options.repose;
    for (const auto& [r, c] :
         {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
      Rest next{at.row + r * step, at.col + c * step, 0.0};
      next.height = block.rest(top, next.row, next.col);
      const double away = static_cast<double>(step) * fine_cell * std::hypot(r, c);
      if ((at.height - next.height) / away > steepest) {
        steepest = (at.height - next.height) / away;
        best = next;
      }
    }
    if (best.height == at.height) return at;
    at = best;
  }
  return at;
}

/// Fine soil in what lies lower than the mean of its surroundings.
inline void cover(Heap& heap, double width) {
  const double before = heap.envelope();
  const auto reach = static_cast<Eigen::Index>(0.5 * width / fine_cell);
  const Eigen::ArrayXXd top = heap.fine.z;
  for (Eigen::Index col = reach; col < top.cols() - reach; ++col) {
    for (Eigen::Index row = reach; row < top.rows() - reach; ++row) {
      if (top(row, col) <= 0.0) continue;
      const double mean = top.block(row - reach, col - reach, 2 * reach + 1, 2 * reach + 1).mean();
      heap.fine.z(row, col) = std::max(top(row, col), mean);
    }
  }
  heap.solids += heap.envelope() - before;
}

/// Blocks dropped near the middle of `heap_ground`.
inline Heap block_heap(const BlockHeapOptions& options, std::uint64_t seed) {
  Random random(seed, 77);
  Heap heap;
  heap.fine = flat_ground(heap_ground, fine_cell);
  Eigen::ArrayXXd& top = heap.fine.z;
  const double drop_radius = 0.5 * std::cbrt(options.solids);
  while (heap.solids < options.solids) {
    const double size = options.size * std::exp(options.spread * random.normal());
    Eigen::Vector3d half;
    for (int axis = 0; axis < 3; ++axis) half(axis) = 0.5 * size * random.uniform(0.7, 1.3);
    const double centre = 0.5 * static_cast<double>(top.rows());
    const double scatter = drop_radius / fine_cell;
    Rest at{static_cast<Eigen::Index>(centre + scatter * random.normal()),
            static_cast<Eigen::Index>(centre + scatter * random.normal()), 1e9};
    Block block(half, random_attitude(random));
    at.height = block.rest(top, at.row, at.col);
    if (at.height > 1e8) continue;
    at = rolled_down(top, block, at, options);
    Rest best = at;
    Block resting = block;
    for (int attempt = 0; attempt < options.tries; ++attempt) {
      const double jitter = 1.2 * size / fine_cell;
      const Block other(half, random_attitude(random));
      Rest next{at.row + static_cast<Eigen::Index>(jitter * random.uniform(-1.0, 1.0)),
                at.col + static_cast<Eigen::Index>(jitter * random.uniform(-1.0, 1.0)), 0.0};
      next.height = other.rest(top, next.row, next.col);
      if (next.height < best.height) {
        best = next;
        resting = other;
      }
    }
    resting.place(top, best.row, best.col);
    heap.solids += 8.0 * half.prod();
  }
  heap.solids += options.crumbs * heap.voids();
  if (options.cover > 0.0) cover(heap, options.cover);
  return heap;
}

/// Smooth random heights of standard deviation 1 with a wavelength of some `length` [m].
inline Eigen::ArrayXXd random_heights(const HeightMap& on, double length, Random random) {
  constexpr int waves = 60;
  Eigen::ArrayXXd z = Eigen::ArrayXXd::Zero(on.z.rows(), on.z.cols());
  for (int wave = 0; wave < waves; ++wave) {
    const double heading = random.uniform(0.0, 6.283185307179586);
    const double number = 6.283185307179586 / (length * random.uniform(0.6, 1.6));
    const double phase = random.uniform(0.0, 6.283185307179586);
    Eigen::ArrayXd along(z.cols());
    Eigen::ArrayXd across(z.rows());
    for (Eigen::Index col = 0; col < z.cols(); ++col) {
      along(col) = number * std::cos(heading) * on.x(col) + phase;
    }
    for (Eigen::Index row = 0; row < z.rows(); ++row) {
      across(row) = number * std::sin(heading) * on.y(row);
    }
    z += (across.cos().matrix() * along.sin().matrix().transpose() +
          across.sin().matrix() * along.cos().matrix().transpose())
             .array();
  }
  return z * std::sqrt(2.0 / waves);
}

struct LooseHeapOptions {
  double volume = 0.60;      ///< [m^3]
  double repose = 0.62;      ///< [rad]
  double roughness = 0.008;  ///< rms of its clods [m]
  double clod = 0.08;        ///< wavelength of them [m]
  int cones = 1;             ///< one behind the other, half a radius apart
};

/// Cones of loose soil with clods on them.
inline Heap loose_heap(const LooseHeapOptions& options, std::uint64_t seed) {
  Heap heap;
  heap.fine = flat_ground(heap_ground, fine_cell);
  const double slope = std::tan(options.repose);
  const double radius =
      std::cbrt(3.0 * options.volume / (3.141592653589793 * slope * options.cones));
  const Eigen::ArrayXXd clods =
      options.roughness * random_heights(heap.fine, options.clod, Random(seed, 5));
  for (Eigen::Index col = 0; col < heap.fine.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < heap.fine.z.rows(); ++row) {
      double away = 1e9;
      for (int cone = 0; cone < options.cones; ++cone) {
        const double along = (cone - 0.5 * (options.cones - 1)) * 0.5 * radius;
        away = std::min(away, std::hypot(heap.fine.x(col) - 2.25 - along, heap.fine.y(row) - 2.25));
      }
      if (away < radius) {
        heap.fine.z(row, col) = std::max(0.0, slope * (radius - away) + clods(row, col));
      }
    }
  }
  heap.solids = heap.envelope();
  return heap;
}

/// Mean heights over the cells of a survey.
inline HeightMap surveyed(const HeightMap& fine, double cell) {
  HeightMap map = flat_ground(fine.extent(), cell);
  const auto n = static_cast<Eigen::Index>(std::lround(cell / fine_cell));
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      const Eigen::Index rows = std::min(n, fine.z.rows() - row * n);
      const Eigen::Index cols = std::min(n, fine.z.cols() - col * n);
      map.z(row, col) = fine.z.block(row * n, col * n, rows, cols).mean();
    }
  }
  return map;
}

}  // namespace excavplan::test
