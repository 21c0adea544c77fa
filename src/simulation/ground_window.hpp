// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/soil/soil.hpp>

#include "simulation/cell_block.hpp"
#include "simulation/coarse_ground.hpp"

namespace excavplan {

/// The soil of a terrain where the terrain states no void ratio.
struct GroundSoil {
  const SoilKind& kind;
  const SoilState& bank;
  const SoilState& loose;
};

/// The part of a terrain on which a dig works: a copy of the cells near it that grows on demand, so
/// that the size of the terrain does not matter. Rows and columns are those of the whole terrain.
///
/// Soil that is dug or slides swells to the loose state; only loose soil that never moved, or was
/// pressed since, is denser.
class GroundWindow {
 public:
  /// @throws Error (bad_input) as cover()
  GroundWindow(const Terrain& whole, const GroundSoil& soil, const CellBlock& cells);

  /// Makes the window hold at least these cells of the map.
  /// @throws Error (bad_input) if a loose layer is not >= 0 or a void ratio out of range there
  void cover(const CellBlock& cells);

  const Terrain& before() const { return whole_; }
  const GroundSoil& soil() const { return soil_; }
  const CellBlock& cells() const { return cells_; }
  double cell_size() const { return whole_.bank.cell_size; }
  CellBlock widened(const CellBlock& block, Eigen::Index margin) const {
    return block.widened(margin, whole_.loose.rows(), whole_.loose.cols());
  }

  /// Index of a cell in the layers, valid until the window grows: the next row is 1 away, the next
  /// column column_step().
  std::size_t at(Eigen::Index row, Eigen::Index col) const {
    return static_cast<std::size_t>((col - cells_.col_begin + 1) * stride_ + row -
                                    cells_.row_begin + 1);
  }
  std::size_t column_step() const { return static_cast<std::size_t>(stride_); }

  double bank(std::size_t cell) const { return bank_[cell]; }
  double bank(Eigen::Index row, Eigen::Index col) const { return bank_[at(row, col)]; }
  double loose(std::size_t cell) const { return loose_[cell]; }
  double loose(Eigen::Index row, Eigen::Index col) const { return loose_[at(row, col)]; }
  /// Of the surface; NaN where no soil enters or leaves: unknown or off the map.
  double height(std::size_t cell) const { return height_[cell]; }
  double height(Eigen::Index row, Eigen::Index col) const { return height_[at(row, col)]; }

  /// Of the bank [-].
  double bank_void_ratio(Eigen::Index row, Eigen::Index col) const;
  bool bank_is_even() const { return whole_.bank_void_ratio.size() == 0; }
  SoilState bank_state(Eigen::Index row, Eigen::Index col) const;
  /// Whether all loose soil is in the state of soil just dug.
  bool loose_is_even() const { return whole_.loose_void_ratio.size() == 0; }
  /// Loose soil that lay on a cell of the window before: thickness [m] and state.
  double lying(Eigen::Index r, Eigen::Index c) const { return lay_ ? whole_.loose(r, c) : 0.0; }
  SoilState lying_state(Eigen::Index row, Eigen::Index col) const;

  /// Loose thickness of a thickness of the bank, or of the loose layer, once it has moved [m].
  double swollen_bank(Eigen::Index row, Eigen::Index col, double thickness) const;
  double swollen_loose(std::size_t cell, double thickness) const {
    return void_ratio_.empty()
               ? thickness
               : thickness * (1.0 + soil_.loose.void_ratio) / (1.0 + void_ratio_[cell]);
  }

  void lower_bank(std::size_t cell, double thickness);
  /// Never below 0.
  void lower_loose(std::size_t cell, double thickness) {
    loose_[cell] = loose_[cell] > thickness ? loose_[cell] - thickness : 0.0;
    changed(cell);
  }
  /// Presses on the loose layer of a cell [Pa]; without void ratios a terrain does not remember it.
  void compact(std::size_t cell, double pressure);
  /// Adds soil that has moved.
  void raise_loose(std::size_t cell, double thickness) {
    if (!void_ratio_.empty()) mix(cell, thickness);
    loose_[cell] += thickness;
    height_[cell] = bank_[cell] + loose_[cell];
    awake_[cell] = 1;
  }
  void raise_loose(Eigen::Index row, Eigen::Index col, double thickness) {
    raise_loose(at(row, col), thickness);
  }

  /// Whether a cell has changed, or one of its four neighbours has become lower, since let_sleep():
  /// a cell that is asleep is at rest.
  bool awake(std::size_t cell) const { return awake_[cell] != 0; }
  void let_sleep(std::size_t cell) { awake_[cell] = 0; }

  /// Whether soil slid off a cell when it was last looked at: what slides onto it will slide on.
  bool slides(std::size_t cell) const { return slides_[cell] != 0; }
  void let_slide(std::size_t cell, bool slides) { slides_[cell] = slides ? 1 : 0; }
  SlumpState& slumping() { return slumping_; }

  /// Dry mass of the known cells above a level, now and before [kg].
  double solids(double above) const;
  double solids_before(double above) const;

  double lowest() const;  ///< of the known bank [m]

  TerrainPatch patch() const;

 private:
  void changed(std::size_t i) {
    height_[i] = bank_[i] + loose_[i];
    const auto column = static_cast<std::size_t>(stride_);
    awake_[i] = awake_[i - 1] = awake_[i + 1] = 1;
    awake_[i - column] = awake_[i + column] = 1;
  }
  void mix(std::size_t cell, double thickness);
  void check(const CellBlock& cells) const;
  double bank_density(Eigen::Index row, Eigen::Index col) const;
  template <typename Cell>
  double mass(Cell&& cell_mass) const;

  static constexpr double unknown_height = std::numeric_limits<double>::quiet_NaN();

  const Terrain& whole_;
  bool lay_ = false;  ///< any loose soil, in the window
  GroundSoil soil_;
  CellBlock cells_;
  Eigen::Index stride_ = 0;
  // The layers have a frame of one cell of unknown ground around them. Flags are not bytes, which
  // may alias all members: the compiler would read these again after each write.
  std::vector<double> bank_;
  std::vector<double> loose_;
  std::vector<double> height_;
  std::vector<double> void_ratio_;  ///< of the loose layer; empty if that of dug soil
  std::vector<std::uint16_t> awake_;
  std::vector<std::uint16_t> slides_;
  SlumpState slumping_;
};

}  // namespace excavplan
