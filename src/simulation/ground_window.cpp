// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/ground_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/check.hpp"
#include "base/text.hpp"
#include "ground/map_check.hpp"
#include "soil/loose_soil.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr Index spare = 8;  // cells by which a window grows beyond the requested extent; ours

double dry_density(const SoilKind& kind, double void_ratio) {
  return kind.specific_gravity * water_density / (1.0 + void_ratio);
}

}  // namespace

CellBlock CellBlock::widened(Index margin, Index map_rows, Index map_cols) const {
  if (empty()) return *this;
  return {std::max<Index>(0, row_begin - margin), std::min(map_rows, row_end + margin),
          std::max<Index>(0, col_begin - margin), std::min(map_cols, col_end + margin)};
}

GroundWindow::GroundWindow(const Terrain& whole, const GroundSoil& soil, const CellBlock& cells)
    : whole_(whole), soil_(soil) {
  cover(cells);
}

void GroundWindow::cover(const CellBlock& cells) {
  if (cells_.contains(cells)) return;
  CellBlock wanted = cells_;
  wanted.include(widened(cells, spare));
  check(wanted);
  const GroundWindow old = *this;
  cells_ = wanted;
  stride_ = wanted.rows() + 2;
  const auto size = static_cast<std::size_t>(stride_ * (wanted.cols() + 2));
  const bool has_void_ratio = whole_.loose_void_ratio.size() > 0;
  bank_.assign(size, unknown_height);
  loose_.assign(size, 0.0);
  height_.assign(size, unknown_height);
  awake_.assign(size, 1);
  slides_.assign(size, 0);
  void_ratio_.assign(has_void_ratio ? size : 0, soil_.loose.void_ratio);
  for (Index col = wanted.col_begin; col < wanted.col_end; ++col) {
    for (Index row = wanted.row_begin; row < wanted.row_end; ++row) {
      const bool held = old.cells_.contains(row, col);
      const std::size_t i = at(row, col);
      bank_[i] = held ? old.bank(row, col) : whole_.bank.z(row, col);
      loose_[i] = held ? old.loose(row, col) : whole_.loose(row, col);
      lay_ = lay_ || loose_[i] > 0.0;
      height_[i] = bank_[i] + loose_[i];
      if (held) {
        awake_[i] = old.awake_[old.at(row, col)];
        slides_[i] = old.slides_[old.at(row, col)];
      }
      if (has_void_ratio) {
        void_ratio_[i] =
            held ? old.void_ratio_[old.at(row, col)] : whole_.loose_void_ratio(row, col);
      }
    }
  }
}

void GroundWindow::check(const CellBlock& cells) const {
  const auto within = [&](const Eigen::ArrayXXd& layer, double low, double high, const char* what) {
    for (Index col = cells.col_begin; col < cells.col_end; ++col) {
      for (Index row = cells.row_begin; row < cells.row_end; ++row) {
        const double value = layer(row, col);
        const double height = whole_.bank.z(row, col);
        if (value >= low && value <= high && std::abs(height) <= farthest_height) continue;
        if (std::isnan(height)) continue;
        require_in("dig: the bank [m]", height, -farthest_height, farthest_height);
        require(false,
                std::string("dig: ") + what +
                    " in the cell at x = " + number_text(whole_.bank.x(col)) +
                    " m, y = " + number_text(whole_.bank.y(row)) + " m",
                value, "in " + number_text(low) + " .. " + number_text(high));
      }
    }
  };
  const SoilKind& kind = soil_.kind;
  within(whole_.loose, 0.0, farthest_height, "the loose layer");
  if (whole_.bank_void_ratio.size() > 0) {
    within(whole_.bank_void_ratio, kind.void_ratio_min, kind.void_ratio_max,
           "the void ratio of the bank");
  }
  if (whole_.loose_void_ratio.size() > 0) {
    within(whole_.loose_void_ratio, kind.void_ratio_min, kind.void_ratio_loose,
           "the void ratio of the loose layer");
  }
}

double GroundWindow::bank_void_ratio(Index row, Index col) const {
  return bank_is_even() ? soil_.bank.void_ratio : whole_.bank_void_ratio(row, col);
}

double GroundWindow::swollen_bank(Index row, Index col, double thickness) const {
  return thickness * (1.0 + soil_.loose.void_ratio) / (1.0 + bank_void_ratio(row, col));
}

void GroundWindow::lower_bank(std::size_t cell, double thickness) {
  bank_[cell] -= thickness;
  changed(cell);
}

SoilState GroundWindow::bank_state(Index row, Index col) const {
  return bank_is_even() ? soil_.bank : checked_bank_state(soil_.kind, bank_void_ratio(row, col));
}

SoilState GroundWindow::lying_state(Index row, Index col) const {
  return loose_is_even() ? soil_.loose
                         : checked_loose_state(soil_.kind, whole_.loose_void_ratio(row, col));
}

void GroundWindow::compact(std::size_t cell, double pressure) {
  if (void_ratio_.empty() || !(loose_[cell] > 0.0)) return;
  const double before = void_ratio_[cell];
  void_ratio_[cell] = checked_compaction(soil_.kind, before, pressure);
  loose_[cell] *= (1.0 + void_ratio_[cell]) / (1.0 + before);
  changed(cell);
}

void GroundWindow::mix(std::size_t cell, double thickness) {
  const double solids =
      loose_[cell] / (1.0 + void_ratio_[cell]) + thickness / (1.0 + soil_.loose.void_ratio);
  if (solids > 0.0) {
    void_ratio_[cell] = std::min((loose_[cell] + thickness) / solids - 1.0, soil_.loose.void_ratio);
  }
}

template <typename Cell>
double GroundWindow::mass(Cell&& cell_mass) const {
  double mass = 0.0;
  for (Index col = cells_.col_begin; col < cells_.col_end; ++col) {
    double sum = 0.0;
    for (Index row = cells_.row_begin; row < cells_.row_end; ++row) {
      const double here = cell_mass(row, col);
      if (!std::isnan(here)) sum += here;
    }
    mass += sum;
  }
  return mass * cell_size() * cell_size();
}

double GroundWindow::bank_density(Index row, Index col) const {
  return bank_is_even() ? soil_.bank.dry_density
                        : dry_density(soil_.kind, whole_.bank_void_ratio(row, col));
}

double GroundWindow::solids(double above) const {
  return mass([&](Index row, Index col) {
    const double loose_density = void_ratio_.empty()
                                     ? soil_.loose.dry_density
                                     : dry_density(soil_.kind, void_ratio_[at(row, col)]);
    return (bank(row, col) - above) * bank_density(row, col) + loose(row, col) * loose_density;
  });
}

double GroundWindow::solids_before(double above) const {
  const bool even = whole_.loose_void_ratio.size() == 0;
  return mass([&](Index row, Index col) {
    const double loose_density =
        even ? soil_.loose.dry_density : dry_density(soil_.kind, whole_.loose_void_ratio(row, col));
    return (whole_.bank.z(row, col) - above) * bank_density(row, col) +
           whole_.loose(row, col) * loose_density;
  });
}

double GroundWindow::lowest() const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const double bank : bank_) {
    if (bank < lowest) lowest = bank;
  }
  return lowest;
}

TerrainPatch GroundWindow::patch() const {
  const auto array = [&](const std::vector<double>& layer) {
    using Framed = Eigen::Map<const Eigen::ArrayXXd>;
    return Eigen::ArrayXXd(
        Framed(layer.data(), stride_, cells_.cols() + 2).block(1, 1, cells_.rows(), cells_.cols()));
  };
  TerrainPatch patch;
  patch.row = cells_.row_begin;
  patch.col = cells_.col_begin;
  patch.bank = array(bank_);
  patch.loose = array(loose_);
  if (!void_ratio_.empty()) patch.loose_void_ratio = array(void_ratio_);
  return patch;
}

}  // namespace excavplan
