// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <excavplan/simulation/soil_simulator.hpp>

#include "soil_layers.hpp"

/// @file
/// The ground of SectionSimulator: mean heights over the bucket's width, one column of cells each.
/// Areas are [m^2] in the boom plane and stand for a volume over that width. The bucket digs
/// towards the machine: "ahead" is towards smaller x.

namespace excavplan {

/// The half plane z <= height + slope * x.
struct Below {
  double height = 0.0;
  double slope = 0.0;

  double at(double x) const { return height + slope * x; }
};

struct Column {
  double bank_before = 0.0;   ///< mean over the width [m]
  double loose_before = 0.0;  ///< [m]
  double bank = 0.0;
  double loose = 0.0;       ///< what is left of the loose soil that lay here
  double swept_from = 0.0;  ///< the tip has passed from here ..
  double swept_to = 0.0;    ///< .. to here [m]
  double floor = 0.0;       ///< mean level of the bank where the tip has passed
  double windrow = 0.0;     ///< loose, beside the bucket on both sides together [m^2]
  double settled = 0.0;     ///< loose, come to rest here [m]

  double swept() const { return swept_to - swept_from; }
  double top_before() const { return bank_before + loose_before; }
  double top() const { return bank + loose + settled; }
};

struct CutArea {
  double bank = 0.0;
  double loose = 0.0;
};

/// Level and slope of the ground ahead of a point; slope positive uphill along the travel.
struct GroundAhead {
  double bank = 0.0;
  double surface = 0.0;
  double slope = 0.0;
};

class SoilSection {
 public:
  /// Covers at least x_min .. x_max and as much known ground around it as a pile can need.
  /// @throws Error (bad_input) if a cell the bucket passes is off the map or unknown
  SoilSection(const Terrain& terrain, double width, double x_min, double x_max);

  double width() const { return width_; }
  double cell() const { return cell_; }
  Eigen::Index first_col() const { return first_col_; }
  Eigen::Index first_row() const { return first_row_; }
  const std::vector<double>& coverage() const { return coverage_; }  ///< of the rows
  const std::vector<Column>& columns() const { return columns_; }
  double left(std::size_t i) const {
    return origin_ + cell_ * static_cast<double>(first_col_ + static_cast<Eigen::Index>(i));
  }
  double middle(std::size_t i) const { return left(i) + 0.5 * cell_; }
  std::size_t column_at(double x) const;  ///< the nearest column outside the section

  /// Takes out what lies above the line from p to q, exactly.
  CutArea cut(Eigen::Vector2d p, Eigen::Vector2d q);

  /// A straight line through the ground up to 0.25 m ahead.
  GroundAhead ahead(double x) const;

  /// Sheds what stands too steep at the sides of a pile that leans against x, `high` there and
  /// falling by `fall` per metre, into windrows; the area that the pile loses.
  double shed(double x, double high, double fall, double slope);

  /// Heaps an area on the columns from `first` to `last` inclusive, under slopes that fall off to
  /// both sides of x.
  void settle(double x, double area, double slope, std::size_t first, std::size_t last);

 private:
  void cover_rows(const HeightMap& map);
  void cover_columns(const Terrain& terrain, double x_min, double x_max);
  bool known(const HeightMap& map, Eigen::Index col) const;
  Column mean_column(const Terrain& terrain, Eigen::Index col) const;

  double width_;
  double cell_;
  double origin_;
  Eigen::Index first_col_ = 0;
  Eigen::Index first_row_ = 0;
  std::vector<double> coverage_;
  std::vector<Column> columns_;
};

/// Loose soil that lies on the map after a dig [m^3].
struct LooseSoil {
  double in_cut = 0.0;
  double elsewhere = 0.0;
};

/// Writes a section back: what was cut comes off the rows under the bucket, what came to rest lies
/// on them and slopes off beside them, windrows lie beside, walls that are too high break.
LooseSoil write_back(const SoilSection& section, const SlopeLimits& limits, Terrain& terrain);

}  // namespace excavplan
