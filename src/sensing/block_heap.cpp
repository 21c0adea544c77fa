// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "sensing/block_heap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double border = 1e9;      // height of what no block may touch [m]
constexpr double no_rest = 1e8;     // above it a block touches the border [m]
constexpr int most_refused = 2000;  // drops in a row that find no room

/// A place where a block rests.
struct Rest {
  Eigen::Index row = 0;
  Eigen::Index col = 0;
  double height = border;
};

/// Rolls down in steps of half a block for as long as that is steeper than the repose.
Rest rolled_down(const HeightMap& ground, const Block& block, Rest at, const BlockDrop& drop) {
  const auto step = static_cast<Eigen::Index>(std::max(1.0, 0.5 * drop.size / ground.cell_size));
  for (int rolls = 0; rolls < 100; ++rolls) {
    Rest best = at;
    double steepest = drop.repose;
    for (const auto& [r, c] :
         {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
      Rest next{at.row + r * step, at.col + c * step, 0.0};
      next.height = block.rest(ground.z, next.row, next.col);
      const double away = static_cast<double>(step) * ground.cell_size * std::hypot(r, c);
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

/// The surface under the blocks, with a border round what may take none.
HeightMap bed_of(const HeightMap& before, const HeightMap& after) {
  HeightMap bed = before;
  for (Eigen::Index i = 0; i < bed.z.size(); ++i) {
    if (!(after.z(i) >= before.z(i))) bed.z(i) = border;
  }
  return bed;
}

/// Sums of the rise up to each cell; a place is drawn in proportion to what rose there.
std::vector<double> running_rise(const HeightMap& before, const HeightMap& after) {
  std::vector<double> sums;
  double sum = 0.0;
  for (Eigen::Index i = 0; i < before.z.size(); ++i) {
    const double rise = after.z(i) - before.z(i);
    if (rise > 0.0) sum += rise;
    sums.push_back(sum);
  }
  return sums;
}

Eigen::Vector2d drawn_cell(const std::vector<double>& sums, Eigen::Index rows, Random& random) {
  const auto at = std::upper_bound(sums.begin(), sums.end(), sums.back() * random.uniform());
  const auto index = static_cast<Eigen::Index>(at - sums.begin());
  const Eigen::Index row = index % rows, col = index / rows;
  return {static_cast<double>(row), static_cast<double>(col)};
}

/// Between the surfaces, but for the border.
double volume_between(const BlockLayer& layer) {
  const Eigen::ArrayXXd rise = layer.after.z - layer.before.z;
  return (layer.after.z > no_rest).select(0.0, rise).sum() * layer.before.cell_size *
         layer.before.cell_size;
}

void require_settings(const BlockSettings& settings, double cell) {
  require(settings.size >= 4.0 * cell && settings.size <= 1.0, "blocks: size", settings.size,
          "at least " + number_text(4.0 * cell) + " m, at most 1 m");
  require(settings.fines >= 0.0 && settings.fines < 1.0, "blocks: fines", settings.fines,
          "in 0 .. 1");
}

}  // namespace

Block::Block(const Eigen::Vector3d& half_edges, const Eigen::Quaterniond& attitude, double cell) {
  const Eigen::Matrix3d turn = attitude.toRotationMatrix().transpose();
  const Eigen::Vector3d way = turn.col(2);
  const auto reach = static_cast<int>(half_edges.norm() / cell);
  for (int col = -reach; col <= reach; ++col) {
    for (int row = -reach; row <= reach; ++row) {
      const Eigen::Vector3d start = turn * Eigen::Vector3d(col * cell, row * cell, 0.0);
      double low = -border;
      double high = border;
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

double Block::rest(const Eigen::ArrayXXd& top, Eigen::Index row, Eigen::Index col) const {
  double height = -border;
  for (const Column& c : columns_) {
    const Eigen::Index r = row + c.row;
    const Eigen::Index q = col + c.col;
    if (r < 0 || q < 0 || r >= top.rows() || q >= top.cols()) return border;
    height = std::max(height, top(r, q) - c.low);
  }
  return height;
}

void Block::place(Eigen::ArrayXXd& top, Eigen::Index row, Eigen::Index col) const {
  const double height = rest(top, row, col);
  for (const Column& c : columns_) {
    double& cell = top(row + c.row, col + c.col);
    cell = std::max(cell, height + c.high);
  }
}

BlockShape drawn_block(const BlockDrop& drop, Random& random) {
  BlockShape shape;
  shape.size = drop.size * std::exp(drop.spread * random.normal());
  for (int axis = 0; axis < 3; ++axis) {
    shape.half_edges(axis) = 0.5 * shape.size * random.uniform(0.7, 1.3);
  }
  return shape;
}

Eigen::Quaterniond random_attitude(Random& random) {
  Eigen::Quaterniond attitude;  // drawn one by one: the order of arguments is the compiler's
  for (double* const part : {&attitude.z(), &attitude.y(), &attitude.x(), &attitude.w()}) {
    *part = random.normal();
  }
  attitude.normalize();
  return attitude;
}

bool drop_block(HeightMap& ground, const BlockShape& shape, const Eigen::Vector2d& cell,
                const BlockDrop& drop, Random& random) {
  const auto drawn = [&] {
    return Block(shape.half_edges, random_attitude(random), ground.cell_size);
  };
  Rest best{static_cast<Eigen::Index>(cell.x()), static_cast<Eigen::Index>(cell.y())};
  Block resting = drawn();
  best.height = resting.rest(ground.z, best.row, best.col);
  if (best.height > no_rest) return false;
  const Rest at = rolled_down(ground, resting, best, drop);
  best = at;
  const double jitter = 1.2 * shape.size / ground.cell_size;
  for (int attempt = 0; attempt < drop.tries; ++attempt) {
    const Block other = drawn();
    Rest next{at.row + static_cast<Eigen::Index>(jitter * random.uniform(-1.0, 1.0)),
              at.col + static_cast<Eigen::Index>(jitter * random.uniform(-1.0, 1.0))};
    next.height = other.rest(ground.z, next.row, next.col);
    if (next.height < best.height) {
      best = next;
      resting = other;
    }
  }
  resting.place(ground.z, best.row, best.col);
  return true;
}

BlockLayer blocks_of_rise(const HeightMap& before, const HeightMap& after, double soil,
                          const BlockSettings& settings) {
  require_settings(settings, before.cell_size);
  const BlockDrop drop{settings.size};
  const std::vector<double> sums = running_rise(before, after);
  BlockLayer layer{before, bed_of(before, after)};
  Random random(settings.seed, 77);
  double blocks = 0.0;
  int refused = 0;
  const auto missing = [&] {
    return soil - blocks - settings.fines * (volume_between(layer) - blocks);
  };
  while (missing() > 1e-9 * soil) {
    BlockShape shape = drawn_block(drop, random);
    shape.half_edges *= std::min(1.0, std::cbrt((soil - blocks) / shape.volume()));
    const Eigen::Vector2d cell = drawn_cell(sums, before.z.rows(), random);
    if (drop_block(layer.after, shape, cell, drop, random)) {
      refused = 0;
      blocks += shape.volume();
      ++layer.count;
    } else if (++refused == most_refused) {
      throw Error(ErrorKind::bad_input, "blocks: blocks of " + number_text(settings.size) +
                                            " m find no room where soil rose");
    }
  }
  layer.soil = soil;
  layer.voids = volume_between(layer) - soil;
  layer.after.z = (layer.after.z > no_rest).select(after.z, layer.after.z);
  return layer;
}

}  // namespace excavplan
