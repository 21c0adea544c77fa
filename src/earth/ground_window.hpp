// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>

#include "earth/cell_block.hpp"
#include "earth/coarse_ground.hpp"
#include "earth/dig_kernels.hpp"
#include "earth/ground_layers.hpp"

namespace excavplan {

/// The part of a terrain on which a dig works: a copy of the cells near it that grows on demand, so
/// that the size of the terrain does not matter. Rows and columns are those of the whole terrain.
///
/// Soil that is dug or slides swells to the loose state; only loose soil that never moved, or was
/// pressed since, is denser.
class GroundWindow {
 public:
  /// @param slides  false: slump() is never called, which cells may slide is not noted
  /// @throws Error (bad_input) as cover()
  GroundWindow(const Terrain& whole, const GroundSoil& soil, const CellBlock& cells,
               bool slides = true);
  ~GroundWindow();
  GroundWindow(const GroundWindow&) = delete;
  GroundWindow& operator=(const GroundWindow&) = delete;

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

  double bank(std::size_t cell) const { return layers_.bank[cell]; }
  double bank(Eigen::Index row, Eigen::Index col) const { return layers_.bank[at(row, col)]; }
  double loose(std::size_t cell) const { return layers_.loose[cell]; }
  double loose(Eigen::Index row, Eigen::Index col) const { return layers_.loose[at(row, col)]; }
  /// Of the surface; NaN where no soil enters or leaves: unknown or off the map.
  double height(std::size_t cell) const { return layers_.height[cell]; }
  double height(Eigen::Index row, Eigen::Index col) const { return layers_.height[at(row, col)]; }

  /// loose() and height() of so many cells in succession, at least one.
  const double* looses(std::size_t cell, std::size_t count) const {
    return &layers_.loose[cell + count - 1] - (count - 1);
  }
  const double* heights(std::size_t cell, std::size_t count) const {
    return &layers_.height[cell + count - 1] - (count - 1);
  }

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
    return layers_.void_ratio.empty()
               ? thickness
               : thickness * (1.0 + soil_.loose.void_ratio) / (1.0 + layers_.void_ratio[cell]);
  }

  void lower_bank(std::size_t cell, double thickness);
  /// Lowers both layers of so many cells in succession, as lower_bank() and lower_loose() do.
  void lower(std::size_t cell, std::size_t count, const double* bank, const double* loose);
  /// Never below 0.
  void lower_loose(std::size_t cell, double thickness) {
    layers_.loose[cell] = layers_.loose[cell] > thickness ? layers_.loose[cell] - thickness : 0.0;
    changed(cell);
  }
  /// Presses on the loose layer of a cell [Pa]; without void ratios a terrain does not remember it.
  void compact(std::size_t cell, double pressure);
  /// Adds soil that has moved.
  void raise_loose(std::size_t cell, double thickness) {
    if (!layers_.void_ratio.empty()) mix(cell, thickness);
    layers_.loose[cell] += thickness;
    layers_.height[cell] = layers_.bank[cell] + layers_.loose[cell];
    layers_.awake[cell] = 1;
  }

  /// Raises so many cells in succession as excavplan::raise_to() does.
  void raise_to(const PileShare& pile, std::size_t cell, std::size_t count, const double* base);

  /// Whether a cell has changed, or one of its four neighbours has become lower, since let_sleep():
  /// a cell that is asleep is at rest.
  bool awake(std::size_t cell) const { return layers_.awake[cell] != 0; }
  void let_sleep(std::size_t cell) { layers_.awake[cell] = 0; }

  /// Whether soil slid off a cell when it was last looked at: what slides onto it will slide on.
  bool slides(std::size_t cell) const { return layers_.slides[cell] != 0; }
  void let_slide(std::size_t cell, bool slides) { layers_.slides[cell] = slides ? 1 : 0; }
  SlumpState& slumping() { return slumping_; }

  /// Dry mass of the known cells above a level, now and before [kg].
  double solids(double above) const;
  double solids_before(double above) const;

  double lowest() const;  ///< of the known bank [m]

  TerrainPatch patch() const;

 private:
  void changed(std::size_t i) {
    layers_.height[i] = layers_.bank[i] + layers_.loose[i];
    const auto column = static_cast<std::size_t>(stride_);
    layers_.awake[i] = layers_.awake[i - 1] = layers_.awake[i + 1] = 1;
    layers_.awake[i - column] = layers_.awake[i + column] = 1;
  }
  void mix(std::size_t cell, double thickness);
  void check(const CellBlock& cells) const;
  double bank_density(Eigen::Index row, Eigen::Index col) const;
  template <typename Cell>
  double mass(Cell&& cell_mass) const;

  const Terrain& whole_;
  bool slides_;
  bool lay_ = false;  ///< any loose soil, in the window
  GroundSoil soil_;
  CellBlock cells_;
  Eigen::Index stride_ = 0;
  void lay_out(const CellBlock& cells);
  void copy_in(const GroundLayers& from, const CellBlock& held);
  GroundLayers layers_;
  SlumpState slumping_;
};

}  // namespace excavplan
