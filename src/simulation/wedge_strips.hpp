// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "earth/dig_kernels.hpp"
#include "soil/cut_soil.hpp"
#include "soil/earthmoving.hpp"

/// @file
/// The wedge that a bucket pushes, strip by strip across its width. As in dig_kernels.hpp each
/// result is of one strip alone, the same bytes however many a processor takes at once.

namespace excavplan {

/// Terms of the wedge's force that do not depend on the depth of the strip.
struct FaceTerms {
  FaceTerms(const RestingSoil& state, const EarthmovingFactors& factors, bool packed);

  RestingSoil soil;
  EarthmovingFactors n;
  double adhesion;
  double friction;       ///< on the face [rad]
  double shear_at_rest;  ///< friction on a vertical plane per vertical stress, at rest [-]
};
struct LayerTerms {
  FaceTerms bank;
  FaceTerms loose;
};

/// What a column of cells has in the rows of the strips.
struct StripColumn {
  double tip = 0.0;               ///< level of the tip [m]
  double passed = 0.0;            ///< share of the column that the lip has passed
  double line = 0.0;              ///< level of the tip's line in the middle of that [m]
  const double* bank = nullptr;   ///< before the dig [m]
  const double* lay = nullptr;    ///< loose soil, before the dig [m]
  const double* lies = nullptr;   ///< loose soil, now [m]
  const double* cover = nullptr;  ///< of the row by the bucket
};

/// What all strips of a wedge have in common.
struct WedgeTerms {
  double fade = 1.0;  ///< share of the wedge that is pushed up; the rest is sheared off
  double rise = 0.0;  ///< of the soil in the bucket above the lip [m]
  double cell = 0.0;  ///< [m]
  FaceTerms dug;      ///< of soil just dug
};

/// Forces of all strips together, in the frame of the motion [N], and sums over the width.
struct StripSums {
  double along = 0.0;        ///< against the motion
  double across = 0.0;       ///< away from the surface
  double on_face = 0.0;      ///< weight over the face
  double bank_depth = 0.0;   ///< times width [m^2]
  double loose_depth = 0.0;  ///< likewise
};

/// The ground above the tip in each row of the swath, and the wedge that is pushed there.
class WedgeStrips {
 public:
  explicit WedgeStrips(std::size_t count);

  std::size_t count() const { return count_; }
  /// What this dig has laid on the cells of a column that the lip is in or has not reached [m].
  const double* find_piles(const StripColumn& column);
  /// The strips above the tip in a column of which the piles were found.
  void find(const StripColumn& column, double cell);
  bool is_empty(std::size_t i) const { return !(at(bank)[i] + at(loose)[i] + at(pile)[i] > 0.0); }

  /// Begins the wedges of so many strips from `first` on with what lies in their first cell.
  void begin(std::size_t first, std::size_t count, const LayerTerms& layers, double cell);
  /// Length of the longest wedge [cells].
  double longest() const;
  /// Adds what lies on so many columns that come next on each wedge.
  void add(const PiledColumns& columns, std::size_t count);
  /// Adds the forces on so many strips from `first` on, in their order.
  void push(std::size_t first, std::size_t count, const LayerTerms& layers, const WedgeTerms& wedge,
            StripSums& sums) const;

 private:
  enum Array {
    width,       ///< [m]
    bank,        ///< depth above the tip [m]
    loose,       ///< that lay there before the dig [m]
    pile,        ///< that this dig has pushed up on it [m]
    in_column,   ///< the same, as far down as it lies
    cells_left,  ///< length of the wedge that is left, in cells
    piled,       ///< on the wedge, so far [m]
    arrays
  };
  double* at(Array array) { return numbers_.data() + array * room_; }
  const double* at(Array array) const { return numbers_.data() + array * room_; }

  std::size_t count_;
  std::size_t room_;  ///< of an array: loops may read beyond its end
  std::vector<double> numbers_;
};

}  // namespace excavplan
