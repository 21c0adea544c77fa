// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "earth/ground_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/check.hpp"
#include "base/text.hpp"
#include "earth/dig_kernels.hpp"
#include "ground/map_check.hpp"
#include "soil/loose_soil.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr Index spare = 8;  // cells by which a window grows beyond the requested extent; ours

constexpr double unknown_height = std::numeric_limits<double>::quiet_NaN();

double dry_density(const SoilKind& kind, double void_ratio) {
  return kind.specific_gravity * water_density / (1.0 + void_ratio);
}

/// Of windows that this thread had: their room serves the next ones.
std::vector<GroundLayers>& spare_layers() {
  constexpr std::size_t as_one_grows = 2;
  thread_local std::vector<GroundLayers> spares;
  spares.reserve(as_one_grows);
  return spares;
}

}  // namespace

CellBlock CellBlock::widened(Index margin, Index map_rows, Index map_cols) const {
  if (empty()) return *this;
  return {std::max<Index>(0, row_begin - margin), std::min(map_rows, row_end + margin),
          std::max<Index>(0, col_begin - margin), std::min(map_cols, col_end + margin)};
}

GroundWindow::GroundWindow(const Terrain& whole, const GroundSoil& soil, const CellBlock& cells,
                           bool slides)
    : whole_(whole), slides_(slides), soil_(soil) {
  cover(cells);
}

void GroundWindow::cover(const CellBlock& cells) {
  if (cells_.contains(cells)) return;
  CellBlock wanted = cells_;
  wanted.include(widened(cells, spare));
  check(wanted);
  const CellBlock held = cells_;
  GroundLayers before = std::move(layers_);
  layers_ = GroundLayers();
  lay_out(wanted);
  if (held.empty()) return;
  copy_in(before, held);
  spare_layers().push_back(std::move(before));
}

GroundWindow::~GroundWindow() {
  std::vector<GroundLayers>& spares = spare_layers();
  if (spares.size() < spares.capacity()) spares.push_back(std::move(layers_));
}

/// The ground as it was before.
void GroundWindow::lay_out(const CellBlock& cells) {
  if (std::vector<GroundLayers>& spares = spare_layers(); !spares.empty()) {
    layers_ = std::move(spares.back());
    spares.pop_back();
  }
  cells_ = cells;
  stride_ = cells.rows() + 2;
  const auto stride = static_cast<std::size_t>(stride_);
  const std::size_t size = stride * static_cast<std::size_t>(cells.cols() + 2);
  layers_.bank.resize(size);
  layers_.loose.resize(size);
  layers_.height.resize(size);
  layers_.awake.assign(size, 1);
  layers_.slides.assign(size, 0);
  const bool has_void_ratio = whole_.loose_void_ratio.size() > 0;
  layers_.void_ratio.assign(has_void_ratio ? size : 0, soil_.loose.void_ratio);
  const auto frame = [&](std::size_t first, std::size_t count) {
    std::fill_n(layers_.bank.begin() + static_cast<std::ptrdiff_t>(first), count, unknown_height);
    std::fill_n(layers_.loose.begin() + static_cast<std::ptrdiff_t>(first), count, 0.0);
    std::fill_n(layers_.height.begin() + static_cast<std::ptrdiff_t>(first), count, unknown_height);
  };
  frame(0, stride);
  frame(size - stride, stride);
  const auto rows = static_cast<std::size_t>(cells.rows());
  for (Index col = cells.col_begin; col < cells.col_end; ++col) {
    const std::size_t first = at(cells.row_begin, col);
    frame(first - 1, 1);
    frame(first + rows, 1);
    const double* bank = &whole_.bank.z(cells.row_begin, col);
    const double* loose = &whole_.loose(cells.row_begin, col);
    double* own_bank = &layers_.bank[first];
    double* own_loose = &layers_.loose[first];
    double* height = &layers_.height[first];
    bool lay = false;
    for (std::size_t i = 0; i < rows; ++i) {
      own_bank[i] = bank[i];
      own_loose[i] = loose[i];
      height[i] = bank[i] + loose[i];
      lay |= loose[i] > 0.0;
    }
    lay_ = lay_ || lay;
    if (has_void_ratio) {
      std::copy_n(&whole_.loose_void_ratio(cells.row_begin, col), rows, &layers_.void_ratio[first]);
    }
  }
}

/// The cells of a smaller window as they are there.
void GroundWindow::copy_in(const GroundLayers& from, const CellBlock& held) {
  const auto rows = static_cast<std::size_t>(held.rows());
  const std::size_t stride = rows + 2;
  for (Index col = held.col_begin; col < held.col_end; ++col) {
    const std::size_t first = stride * static_cast<std::size_t>(col - held.col_begin + 1) + 1;
    const std::size_t own = at(held.row_begin, col);
    const auto copy = [&](const auto& layer, auto& into) {
      if (!layer.empty()) std::copy_n(&layer[first], rows, &into[own]);
    };
    copy(from.bank, layers_.bank);
    copy(from.loose, layers_.loose);
    copy(from.height, layers_.height);
    copy(from.void_ratio, layers_.void_ratio);
    copy(from.awake, layers_.awake);
    copy(from.slides, layers_.slides);
  }
}

void GroundWindow::check(const CellBlock& cells) const {
  const auto rows = static_cast<std::size_t>(cells.rows());
  const auto within = [&](const Eigen::ArrayXXd& layer, double low, double high, const char* what) {
    for (Index col = cells.col_begin; col < cells.col_end; ++col) {
      const double* values = &layer(cells.row_begin, col);
      const double* heights = &whole_.bank.z(cells.row_begin, col);
      bool good = true;
      for (std::size_t i = 0; i < rows; ++i) {
        good &=
            (values[i] >= low) & (values[i] <= high) & (std::abs(heights[i]) <= farthest_height);
      }
      for (std::size_t i = 0; !good && i < rows; ++i) {
        const double value = values[i];
        const double height = heights[i];
        if (value >= low && value <= high && std::abs(height) <= farthest_height) continue;
        if (std::isnan(height)) continue;
        const Index row = cells.row_begin + static_cast<Index>(i);
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
  layers_.bank[cell] -= thickness;
  changed(cell);
}

void GroundWindow::lower(std::size_t cell, std::size_t count, const double* bank,
                         const double* loose) {
  const std::size_t last = cell + count - 1;
  double* own_bank = &layers_.bank[last] - (count - 1);
  double* own_loose = &layers_.loose[last] - (count - 1);
  double* height = &layers_.height[last] - (count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    own_bank[i] -= bank[i];
    own_loose[i] = own_loose[i] > loose[i] ? own_loose[i] - loose[i] : 0.0;
    height[i] = own_bank[i] + own_loose[i];
  }
  if (!slides_) return;
  const std::size_t column = column_step();
  std::fill(&layers_.awake[cell - 1], &layers_.awake[last + 1] + 1, std::uint16_t{1});
  for (const std::size_t beside : {cell - column, cell + column}) {
    std::fill(&layers_.awake[beside], &layers_.awake[beside + count - 1] + 1, std::uint16_t{1});
  }
}

SoilState GroundWindow::bank_state(Index row, Index col) const {
  return bank_is_even() ? soil_.bank : checked_bank_state(soil_.kind, bank_void_ratio(row, col));
}

SoilState GroundWindow::lying_state(Index row, Index col) const {
  return loose_is_even() ? soil_.loose
                         : checked_loose_state(soil_.kind, whole_.loose_void_ratio(row, col));
}

void GroundWindow::compact(std::size_t cell, double pressure) {
  if (layers_.void_ratio.empty() || !(layers_.loose[cell] > 0.0)) return;
  const double before = layers_.void_ratio[cell];
  layers_.void_ratio[cell] = checked_compaction(soil_.kind, before, pressure);
  layers_.loose[cell] *= (1.0 + layers_.void_ratio[cell]) / (1.0 + before);
  changed(cell);
}

void GroundWindow::raise_to(const PileShare& pile, std::size_t cell, std::size_t count,
                            const double* base) {
  if (!layers_.void_ratio.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      if (pile.top > base[i]) raise_loose(cell + i, pile.part * (pile.top - base[i]));
    }
    return;
  }
  const std::size_t last = cell + count - 1;
  const std::size_t back = count - 1;
  excavplan::raise_to(pile, base,
                      {count, &layers_.bank[last] - back, &layers_.loose[last] - back,
                       &layers_.height[last] - back});
  if (!slides_) return;
  std::uint16_t* awake = &layers_.awake[last] - back;
  for (std::size_t i = 0; i < count; ++i) {
    if (pile.top > base[i]) awake[i] = 1;
  }
}

void GroundWindow::mix(std::size_t cell, double thickness) {
  const double solids = layers_.loose[cell] / (1.0 + layers_.void_ratio[cell]) +
                        thickness / (1.0 + soil_.loose.void_ratio);
  if (solids > 0.0) {
    layers_.void_ratio[cell] =
        std::min((layers_.loose[cell] + thickness) / solids - 1.0, soil_.loose.void_ratio);
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
    const double loose_density = layers_.void_ratio.empty()
                                     ? soil_.loose.dry_density
                                     : dry_density(soil_.kind, layers_.void_ratio[at(row, col)]);
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
  for (const double bank : layers_.bank) {
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
  patch.bank = array(layers_.bank);
  patch.loose = array(layers_.loose);
  if (!layers_.void_ratio.empty()) patch.loose_void_ratio = array(layers_.void_ratio);
  return patch;
}

}  // namespace excavplan
