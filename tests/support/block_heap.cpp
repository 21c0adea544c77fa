// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/block_heap.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan::test {

void cover(Heap& heap, double width) {
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

Heap block_heap(const BlockHeapOptions& options, std::uint64_t seed) {
  Random random(seed, 77);
  Heap heap;
  heap.fine = flat_ground(heap_ground, fine_cell);
  const double centre = 0.5 * static_cast<double>(heap.fine.z.rows());
  const double scatter = 0.5 * std::cbrt(options.solids) / fine_cell;
  const BlockDrop drop = {options.size, options.spread, options.repose, options.tries};
  while (heap.solids < options.solids) {
    const BlockShape shape = drawn_block(drop, random);
    const double row = centre + scatter * random.normal();
    const double col = centre + scatter * random.normal();
    if (drop_block(heap.fine, shape, {row, col}, drop, random)) heap.solids += shape.volume();
  }
  heap.solids += options.crumbs * heap.voids();
  if (options.cover > 0.0) cover(heap, options.cover);
  return heap;
}

Eigen::ArrayXXd random_heights(const HeightMap& on, double length, Random random) {
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

Heap loose_heap(const LooseHeapOptions& options, std::uint64_t seed) {
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

HeightMap surveyed(const HeightMap& fine, double cell) {
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
