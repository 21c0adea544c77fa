// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "simulation/cell_block.hpp"

namespace excavplan {

/// Ground seen on cells of twice the size, on which soil slides twice as far in one pass. Filled
/// from finer ground, GroundWindow or CoarseGround, and given back to it as what each cell gained.
///
/// Which side of the edge of a wall soil lies on is seen on the finer ground alone: a cell that
/// takes in an edge is as high as its highest part and only receives, and no soil falls over an
/// edge between two cells.
class CoarseGround {
 public:
  /// Takes in the cells of `block` (rows and columns half those of `finer`) as they are now; the
  /// bank is a wall where it falls by more than `wall` within a cell [m], or twice that between
  /// two. Finer: GroundWindow or CoarseGround.
  template <typename Finer>
  void look_at(const Finer& finer, const CellBlock& block, double wall);

  /// Moves as much soil on the finer ground: each part of a cell gains as much, or loses the same
  /// share of its loose layer. Returns the cells of the finer ground that changed.
  template <typename Finer>
  CellBlock give_back(Finer& finer, const CellBlock& block) const;

  /// The cells that take in any of a block of the finer ground, and those that lie all in it.
  static CellBlock half(const CellBlock& block) {
    return {block.row_begin / 2, (block.row_end + 1) / 2, block.col_begin / 2,
            (block.col_end + 1) / 2};
  }
  static CellBlock whole(const CellBlock& block) {
    return {(block.row_begin + 1) / 2, block.row_end / 2, (block.col_begin + 1) / 2,
            block.col_end / 2};
  }

  const CellBlock& cells() const { return cells_; }
  double cell_size() const { return cell_size_; }
  /// Room for the same ground on yet larger cells.
  CoarseGround& coarser() {
    if (coarser_.empty()) coarser_.emplace_back();
    return coarser_.front();
  }

  std::size_t at(Eigen::Index row, Eigen::Index col) const {
    return static_cast<std::size_t>((col - cells_.col_begin + 1) * stride_ + row -
                                    cells_.row_begin + 1);
  }
  std::size_t column_step() const { return static_cast<std::size_t>(stride_); }
  double bank(std::size_t cell) const { return bank_[cell]; }
  /// Whether a wall of the bank falls from a cell to another beside it.
  bool wall_between(std::size_t cell, std::size_t other) const {
    return bank_[cell] - bank_[other] > 2.0 * wall_;
  }
  double loose(std::size_t cell) const { return loose_[cell]; }
  double height(std::size_t cell) const { return height_[cell]; }
  static double swollen_loose(std::size_t /*cell*/, double thickness) { return thickness; }
  void lower_loose(std::size_t cell, double thickness) {
    change(cell, loose_[cell] > thickness ? -thickness : -loose_[cell]);
    const auto column = static_cast<std::size_t>(stride_);
    awake_[cell - 1] = awake_[cell + 1] = 1;
    awake_[cell - column] = awake_[cell + column] = 1;
  }
  void raise_loose(std::size_t cell, double thickness) { change(cell, thickness); }
  bool awake(std::size_t cell) const { return awake_[cell] != 0; }
  void let_sleep(std::size_t cell) { awake_[cell] = 0; }
  bool slides(std::size_t cell) const { return slides_[cell] != 0; }
  void let_slide(std::size_t cell, bool slides) { slides_[cell] = slides ? 1 : 0; }

 private:
  void lay_out(const CellBlock& cells);
  template <typename Finer>
  void take_in(const Finer& finer, std::size_t part, std::size_t i);
  void change(std::size_t i, double thickness) {
    loose_[i] += thickness;
    height_[i] += thickness;
    awake_[i] = 1;
  }

  CellBlock cells_;
  Eigen::Index stride_ = 0;
  double cell_size_ = 0.0;
  double wall_ = 0.0;           ///< [m]
  std::vector<double> bank_;    ///< NaN where a wall is taken in
  std::vector<double> loose_;   ///< that may leave, as thick as once it has moved
  std::vector<double> before_;  ///< loose_ when it was looked at
  std::vector<double> height_;
  std::vector<std::uint16_t> awake_;
  std::vector<std::uint16_t> slides_;
  std::vector<CoarseGround> coarser_;  ///< one at most
};

/// What slumping keeps of a ground from pass to pass.
struct SlumpState {
  int passes = 0;                              ///< so far
  int slid = std::numeric_limits<int>::max();  ///< cells that slid in the last pass
  CoarseGround coarser;
};

}  // namespace excavplan
