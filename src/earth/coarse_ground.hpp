// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "earth/cell_block.hpp"

namespace excavplan {

/// Ground seen on cells of twice the size, on which soil slides twice as far in one pass. Filled
/// from finer ground, GroundWindow or CoarseGround, and given back to it as what each cell gained.
///
/// Which side of the edge of a wall soil lies on is seen on the finer ground alone: a cell that
/// takes in an edge is as high as its highest part and only receives, and no soil falls over an
/// edge between two cells.
class CoarseGround {
 public:
  /// One of the four cells of the finer ground in a cell.
  struct Part {
    double bank = 0.0;    ///< [m]
    double loose = 0.0;   ///< that may leave, as thick as once it has moved [m]
    double height = 0.0;  ///< of the surface [m]
    bool awake = false;
    bool slides = false;
  };

  /// Makes room for all of the finer ground. The bank is a wall where it falls by more than `wall`
  /// within a cell [m], or twice that between two.
  void lay_out(const CellBlock& finer, double finer_cell_size, double wall);
  /// Sets a cell to what its parts are now.
  void take_in(const std::array<Part, 4>& parts, std::size_t cell);
  /// Thickness that a cell gained since, and so does each of its parts [m].
  double gained(std::size_t cell) const { return loose_[cell] - before_[cell]; }
  /// Share of its loose layer that a cell lost since, and so does each of its parts.
  double lost_share(std::size_t cell) const { return -gained(cell) / before_[cell]; }

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
