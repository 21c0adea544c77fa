// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>

#include "earth/ground_window.hpp"
#include "simulation/swath.hpp"

/// @file
/// The ground of SectionSimulator: mean heights over the bucket's width, one column of cells each.
/// Areas are [m^2] in the boom plane and stand for a volume over that width. The bucket digs
/// towards the machine: "ahead" is towards smaller x.

namespace excavplan {

struct Column {
  double bank_before = 0.0;       ///< mean over the width [m]
  double loose_before = 0.0;      ///< [m]
  double void_ratio = 0.0;        ///< of the bank, mean over the width [-]
  double loose_void_ratio = 0.0;  ///< of the loose soil that lay here, likewise [-]
  double bank = 0.0;
  double loose = 0.0;       ///< rest of the loose soil that lay here
  double swept_from = 0.0;  ///< the tip has passed from here [m] ..
  double swept_to = 0.0;    ///< .. to here [m]
  double floor = 0.0;       ///< mean level of the bank where the tip has passed
  double windrow = 0.0;     ///< loose, beside the bucket on both sides together [m^2]
  double settled = 0.0;     ///< loose, come to rest here [m]

  double swept() const { return swept_to - swept_from; }
  double top_before() const { return bank_before + loose_before; }
  double top() const { return bank + loose + settled; }
};

/// Areas as they lay, and of both together after they have swollen.
struct CutArea {
  double bank = 0.0;
  double loose = 0.0;
  double swollen = 0.0;
};

/// A straight line through the ground ahead of a point.
struct GroundAhead {
  double bank = 0.0;  ///< at the point [m]
  double surface = 0.0;
  double gradient = 0.0;    ///< dz / dx: positive downhill along the travel
  double void_ratio = 0.0;  ///< of the bank
  double loose_void_ratio = 0.0;
};

/// Where a tip works.
struct TipReach {
  double x_min = 0.0;
  double x_max = 0.0;
  double behind = 0.0;  ///< how far the bucket extends behind its tip
};

/// Columns are numbered as on the map. Cut soil is removed from the map at once; soil that comes to
/// rest stays on the section until write_back().
class SoilSection {
 public:
  /// Covers known ground around the reach.
  /// @throws Error (bad_input) if a cell the bucket passes is off the map or unknown
  SoilSection(const Terrain& terrain, const GroundSoil& soil, double width, const TipReach& reach);

  GroundWindow& ground() { return ground_; }
  double width() const { return width_; }
  const Swath& swath() const { return swath_; }
  double rows() const { return rows_; }  ///< sum of what the bucket covers of each [-]
  Eigen::Index first_col() const { return first_col_; }
  Eigen::Index end_col() const { return first_col_ + static_cast<Eigen::Index>(columns_.size()); }
  const Column& column(Eigen::Index col) const { return columns_[index(col)]; }
  double left(Eigen::Index col) const { return origin_ + cell_size_ * static_cast<double>(col); }
  double middle(Eigen::Index col) const { return left(col) + 0.5 * cell_size_; }
  Eigen::Index column_at(double x) const;  ///< the nearest column outside the section

  /// States of bank and loose soil where their void ratio is this.
  SoilState bank_of(double void_ratio) const;
  SoilState loose_of(double void_ratio) const;
  /// The tip has come here.
  void pass(const Eigen::Vector2d& tip);

  /// Removes exactly the soil above the line from p to q; the tip has come to q.
  CutArea cut(Eigen::Vector2d p, Eigen::Vector2d q);
  /// Through the ground up to 0.25 m ahead.
  GroundAhead ahead(double x) const;
  /// Levels of bank and surface before the dig, between the middles of columns.
  double bank_before(double x) const;
  double surface_before(double x) const;
  /// The ground under the bucket from the tip backwards, last point first.
  const std::vector<Eigen::Vector2d>& left_behind() const { return left_behind_; }

  /// Length of a pile's level top [m], its height there [m], and the fall from there on per metre.
  struct PileProfile {
    double level, high, fall;
  };
  /// Sheds the sides of a pile at x into windrows. Returns the area that it loses.
  double shed(double x, const PileProfile& pile, double slope);

  enum class Side { ahead, behind, both };
  struct Heap {
    Side side = Side::both;  ///< the only one on which it lies
    double x = 0.0;          ///< of its top
    double slope = 0.0;      ///< to both sides of that
  };
  /// Lets an area come to rest as a heap on one side of a place.
  void settle(double place, const Heap& heap, double area);

 private:
  std::size_t index(Eigen::Index col) const { return static_cast<std::size_t>(col - first_col_); }
  Column& at(Eigen::Index col) { return columns_[index(col)]; }
  void cover_columns(const TipReach& reach);
  bool grow_ahead();
  bool grow_behind();
  Column mean_column(Eigen::Index col);
  template <typename Level>
  double between(double x, const Level& level) const;
  double take_bank(Eigen::Index col, double thickness);
  double take_loose(Eigen::Index col, double thickness);
  void raise(const Heap& heap, double area, Eigen::Index begin, Eigen::Index end);

  Swath swath_;
  GroundWindow ground_;
  double width_;
  double cell_size_;
  double origin_;
  double rows_ = 0.0;
  Eigen::Index first_col_ = 0;
  std::vector<Column> columns_;
  std::vector<Eigen::Vector2d> left_behind_;
};

/// Loose soil that lies on the map after a dig [m^3].
struct LooseSoil {
  double in_cut = 0.0;
  double elsewhere = 0.0;
};

/// Writes the soil at rest to the map: it lies on the rows under the bucket and slopes off beside
/// them, with windrows beside; walls that are too high break. `slope` is that of loose soil, a
/// tangent.
LooseSoil write_back(SoilSection& section, double slope);

}  // namespace excavplan
