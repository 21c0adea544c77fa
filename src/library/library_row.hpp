// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "library/library_cells.hpp"
#include "library/library_midway.hpp"

namespace excavplan {

/// The densities on one slope for one machine in one soil, side by side.
///
/// A density takes the dig that its own search found, unless the row shows that there is a better
/// one. Where neighbours have digs of different kinds both are dug midway, and the density whose
/// kind is clearly worse there is looked at again, from the digs of the other kind. And a density
/// whose dig is clearly worse than the line through its two neighbours is looked at again from
/// theirs. If that finds a better dig the density takes it, and its neighbours may be next.
class LibraryRow {
 public:
  /// @param row  its density counts for nothing
  LibraryRow(const LibraryCell& row, const std::vector<double>& densities)
      : row_(row), densities_(densities.begin(), densities.end()) {}

  LibraryCell cell(double density) const;
  const std::set<double>& densities() const { return densities_; }

  /// What the density's own search came to; the first word counts.
  void take(double density, const CellOutcome& outcome);

  /// Two neighbouring densities with a dig each, lower one first.
  using Pair = std::pair<double, double>;
  std::vector<Pair> unmeasured() const;
  Midway measure(const Pair& pair, double cell_size) const;
  void take(const Pair& pair, const Midway& midway);

  /// A density to be looked at again, and the neighbour whose kind of dig is better midway; itself
  /// if it is below the line.
  struct Look {
    double density = 0.0;
    double from = 0.0;
  };
  std::vector<Look> looks_due() const;
  /// The digs to begin with, nearest first.
  std::vector<CellOutcome> starts_of(const Look& look) const;
  void take(const Look& look, const CellOutcome& outcome);

  /// Adds densities midway wherever the look-up there gives away more than the share, or nothing
  /// can be told of it.
  /// @return true if any were added
  bool refine(double share);

  void add_to(PathLibrary& library) const;

 private:
  const PathLibraryEntry* entry(double density) const;
  double expected_best(const Pair& pair) const;
  /// The densities that a line to this one goes through, nearest first; none at gaps and among
  /// densities wide apart.
  std::vector<double> line_to(double density) const;
  bool below_the_line(double density) const;
  /// What was measured and tried with the former dig of the density has to be done again.
  void forget_what_used(double density);
  bool worth_refining(const Pair& pair, double share) const;

  LibraryCell row_;
  std::set<double> densities_;
  std::map<double, CellOutcome> outcomes_;
  std::map<Pair, Midway> midways_;
  std::set<Pair> looked_;  ///< looks done: density and from
};

}  // namespace excavplan
