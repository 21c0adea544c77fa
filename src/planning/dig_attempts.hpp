// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// Several searches and single digs on the same ground. Private to the project.

namespace excavplan {

/// A first generation and the polish of its best basins, or without points of the digs given; in
/// the order of AnchoredSearch.
// NOLINTNEXTLINE(bugprone-easily-swappable-parameters)
DigSearchOptions polish_search(int points, int basins, int polish_evaluations);

/// Keeps the best dig of all searches, and counts all digs.
class DigAttempts {
 public:
  /// Called after every dig and batch of digs with how many were made and the last worth told of;
  /// false stops.
  using Progress = std::function<bool(int digs, double best)>;

  /// @param machine, objective, progress  must outlive it
  DigAttempts(const Machine& machine, const DigObjective& objective,
              std::unique_ptr<const SoilSimulator> simulator, Terrain ground,
              const Progress& progress);

  /// Searches on one thread. Does nothing once stopped.
  void search(DigSearchOptions options);

  /// Digs once, from the dig's own start or, where that cannot be driven, from that of a search.
  /// @return worth, 0 if it cannot be dug
  double measure(const PlannedDig& dig);

  const std::optional<PlannedDig>& best() const { return best_; }
  double rank() const { return best_ ? objective_.rank(*best_) : 0.0; }
  bool fills_enough() const { return best_ && best_->fill >= objective_.min_fill; }
  int evaluations() const { return evaluations_; }
  bool stopped() const { return stopped_; }

 private:
  void tell(int digs, double best);

  const Machine& machine_;
  const DigObjective& objective_;
  const std::unique_ptr<const SoilSimulator> simulator_;
  const Terrain ground_;
  const Progress& progress_;
  std::optional<PlannedDig> best_;
  int evaluations_ = 0;
  bool stopped_ = false;
};

}  // namespace excavplan
