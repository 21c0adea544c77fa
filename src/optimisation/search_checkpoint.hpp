// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/optimisation/search_problem.hpp>

#include "optimisation/search_points.hpp"

namespace excavplan {

/// All settings that decide the course of a method, as text.
std::string describe(const GeneticAlgorithm& method);

/// Makes sure that a file, if there is one, is empty or begins as a checkpoint does, of whatever
/// search and whole or not.
/// @throws Error (bad_file) if it holds something else or cannot be read
void require_checkpoint_place(const std::string& file);

/// The outcomes of a search's evaluations, in memory and in a file
/// (docs/formats.md#search-checkpoint). A search is determined by its options and these outcomes,
/// so that nothing else need be kept.
class SearchCheckpoint {
 public:
  /// Reads the file if the search is to be resumed and the file exists.
  /// @throws Error (bad_file, bad_input)
  SearchCheckpoint(const SearchProblem& problem, const SearchOptions& options);

  /// Evaluates the best point of an earlier run again: the file may have been changed, and its
  /// checksum with it.
  /// @throws Error (bad_file) if the outcome is another
  void verify_best(const Objective& objective) const;
  /// The outcome an earlier run noted for a point.
  const Evaluation* find(const Eigen::VectorXd& point) const;
  void add(const Eigen::VectorXd& point, const Evaluation& outcome);
  /// Writes the file, whole or not at all; does nothing without a checkpoint file or new
  /// evaluations.
  void save();

 private:
  using Outcomes = std::map<PointKey, Evaluation>;

  void load(const SearchBox& box);
  std::string text() const;

  std::string file_;
  std::string problem_;
  std::string search_;  ///< what decides the search apart from the problem
  Outcomes earlier_;    ///< of the file
  Outcomes fresh_;
  bool changed_ = false;
};

}  // namespace excavplan
