// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/planning/dig_search_options.hpp>
#include <excavplan/planning/dig_search_result.hpp>

#include "optimisation/search_points.hpp"
#include "planning/dig_layout.hpp"

namespace excavplan {

/// @throws Error (bad_input) unless every soil has a simulator and the probabilities are positive
///         and add up to 1
void check(const std::vector<PossibleSoil>& soils);
/// @throws Error (bad_input) if a range breaks its rule, or as check(objective, machine)
void check(const DigSearchOptions& options, const Machine& machine);

/// A dig along one path in each of the soils.
using DigsInEach = std::vector<std::variant<PlannedDig, DigFailure>>;
DigsInEach dig_in_each(const Machine& machine, const std::vector<PossibleSoil>& soils,
                       const Terrain& terrain, const DigPath& path, const CycleOptions& cycle = {});

/// How far a dig is from feasible, >= 0: the share of the path that a stall leaves; more than 1 for
/// a path that cannot be driven, more the earlier it fails.
double violation(const DigFailure& failure, const DigParameters& parameters);

/// The search for a dig as a search of a box. Keeps references to all that it is given.
class DigProblem {
 public:
  /// @throws Error (bad_input) as check(options, machine)
  DigProblem(const Machine& machine, const std::vector<PossibleSoil>& soils, const Terrain& terrain,
             const DigSearchOptions& options);

  SearchResult run();
  /// Of a search that is to be resumed. @throws Error (bad_file) if its checkpoint is of another
  void require_own_checkpoint();

  /// The dig of a result that is feasible, with its figures in every soil.
  struct Best {
    DigSearchResult result;
    DigsInEach digs;
  };
  Best best_of(const SearchResult& found) const;
  /// That dig alone, or why there is none.
  Found<DigSearchResult> result_of(const SearchResult& found) const;
  /// At most so many of the feasible digs simulated, the best first, none near a better one.
  std::vector<KnownDig> best_apart(const SearchResult& found, int count) const;
  /// Of a result without a feasible dig; nothing if it has no point at all.
  std::optional<NearestDig> nearest_of(const SearchResult& found) const;

 private:
  bool start_is_searched() const { return options_.start_rule.kind == StartRule::Kind::searched; }
  SearchBox box() const;
  SearchProblem as_search();
  std::vector<const DigParameterInfo*> at_bound(const DigParameters& best) const;
  Eigen::VectorXd point_of(const KnownDig& known) const;
  std::variant<Eigen::VectorXd, Evaluation> lay_out(const Eigen::VectorXd& point);
  Evaluation simulate(const Eigen::VectorXd& point);
  double mean_worth(const DigsInEach& digs) const;
  PlannedDig mean_dig(const DigsInEach& digs) const;
  std::optional<double> start_of(const Eigen::VectorXd& point) const;
  DigPath path_of(const Eigen::VectorXd& point) const;
  DigPath taken_path(const Eigen::VectorXd& point);
  std::string fingerprint() const;

  const std::vector<PossibleSoil>& soils_;
  const Terrain& terrain_;
  const DigSearchOptions& options_;
  const DigBounds bounds_;
  DigLayout layout_;
  mutable std::mutex mutex_;
  std::map<PointKey, double> starts_;  ///< of the drivable paths asked for
  std::map<PointKey, DigPath> laid_;   ///< those that were not simulated yet
};

/// The same before work that precedes the search, of search_dig() with the same arguments: of
/// several soils the checkpoint of each too.
void require_own_checkpoint(const Machine& machine, const SoilSimulator& simulator,
                            const Terrain& terrain, const DigSearchOptions& options);
void require_own_checkpoint(const Machine& machine, const std::vector<PossibleSoil>& soils,
                            const Terrain& terrain, const DigSearchOptions& options);

// ---- searches in parts --------------------------------------------------------------------------

inline int digs_of(const Found<DigSearchResult>& found) {
  return found ? found->evaluations : found.evaluations;
}
inline bool was_stopped(const Found<DigSearchResult>& found) {
  return found ? found->stopped : found.stopped;
}

/// Progress of a search that so many digs precede, of so many planned in all.
std::function<bool(const SearchProgress&)> as_part_of(
    const std::function<bool(const SearchProgress&)>& progress, int before, int planned);

/// Counts the digs of an earlier search among those of `found`.
void precede(const Found<DigSearchResult>& earlier, Found<DigSearchResult>& found);

/// Searches the path first, with the start of least work: without a fourth number that finds the
/// valley that the search goes on in. Only where the number of digs alone ends a search.
/// @param options  of the search that follows, which goes on from there
/// @return nothing if the search is not divided
std::optional<Found<DigSearchResult>> search_by_least_work(const Machine& machine,
                                                           const SoilSimulator& simulator,
                                                           const Terrain& terrain,
                                                           DigSearchOptions& options);

}  // namespace excavplan
