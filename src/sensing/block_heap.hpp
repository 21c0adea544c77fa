// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/sensing/block_layer.hpp>

#include "base/random.hpp"

/// @file
/// Blocks of soil that are dropped one by one on a height map, roll down and come to rest. The
/// method and its numbers are ours (docs/methods.md#rehearsal).

namespace excavplan {

/// A box in some attitude as a field of lower and upper surfaces about its centre.
class Block {
 public:
  /// @param cell of the height maps that it falls on [m]
  Block(const Eigen::Vector3d& half_edges, const Eigen::Quaterniond& attitude, double cell);

  /// Height of its centre where it comes to rest above a cell; above 1e8 over the border [m].
  double rest(const Eigen::ArrayXXd& top, Eigen::Index row, Eigen::Index col) const;
  void place(Eigen::ArrayXXd& top, Eigen::Index row, Eigen::Index col) const;

 private:
  struct Column {
    Eigen::Index row;
    Eigen::Index col;
    double low;
    double high;
  };
  std::vector<Column> columns_;
};

/// How blocks are made and fall.
struct BlockDrop {
  double size = 0.20;    ///< mean edge of a block [m]
  double spread = 0.25;  ///< of the logarithm of the edges [-]
  double repose = 0.55;  ///< gradient down which a block still rolls [-]
  int tries = 100;       ///< places and attitudes near by, of which a block rests in the lowest
};

/// A box, not yet in an attitude.
struct BlockShape {
  double size = 0.0;  ///< mean edge of its kind [m]
  Eigen::Vector3d half_edges = Eigen::Vector3d::Zero();
  double volume() const { return 8.0 * half_edges.prod(); }
};

BlockShape drawn_block(const BlockDrop& drop, Random& random);

Eigen::Quaterniond random_attitude(Random& random);

/// Drops a block above a cell. @return false, and nothing changed, if it would lie over the border
bool drop_block(HeightMap& ground, const BlockShape& shape, const Eigen::Vector2d& cell,
                const BlockDrop& drop, Random& random);

/// Replaces what rose between two surfaces by this volume of soil [m^3]: blocks, dropped where it
/// rose, and the fines in the voids between them, which nobody sees from above. Ground that fell or
/// is not known takes none.
/// @throws Error (bad_input) if an option is out of range or the blocks find no room
BlockLayer blocks_of_rise(const HeightMap& before, const HeightMap& after, double soil,
                          const BlockSettings& settings);

}  // namespace excavplan
