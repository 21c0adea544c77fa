// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/optimisation/search_analysis.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// Which dig suits the soil: the path of the highest efficiency f = payload mass / energy.

namespace excavplan {

/// A dig with what it is expected to lift and to cost.
struct PlannedDig {
  DigParameters parameters;
  double start_x = 0.0;         ///< [m]
  double payload_mass = 0.0;    ///< moist [kg]
  double payload_volume = 0.0;  ///< loose [m^3]
  double energy = 0.0;          ///< [J]
  double duration = 0.0;        ///< of penetrate, drag and scoop [s]

  double efficiency() const { return energy > 0.0 ? payload_mass / energy : 0.0; }  ///< [kg/J]
};

/// Why a dig cannot be done: the path cannot be driven, or the machine stalls in the soil.
using DigFailure = std::variant<Infeasible, Stall>;
std::string describe(const DigFailure& failure);

/// Where along the boom plane a dig begins. It decides the work of the links, and with it up to a
/// third of the efficiency: paths are compared under one rule (docs/methods.md#start).
struct StartRule {
  enum class Kind {
    largest_margin,  ///< make_dig_path_anywhere()
    /// least positive work of the links' own weight, on known ground and with all joints 2 degrees
    /// off their limits; the largest margin where there is no such start. Starts are compared at
    /// coarse poses, on a grid of 0.2 m and then by halved steps (docs/methods.md#start)
    least_work,
    given,
    searched,  ///< one more number of the search; for search_dig() only
  };
  Kind kind = Kind::largest_margin;
  double x = 0.0;  ///< if given [m]

  StartRule(Kind rule = Kind::largest_margin) : kind(rule) {}   // NOLINT: is a rule
  StartRule(double start_x) : kind(Kind::given), x(start_x) {}  // NOLINT: so is a place
};
std::string describe(const StartRule& rule);

/// Lays out a dig, simulates it, times it.
///
/// Ground of unknown height under the bucket makes the path infeasible (unknown_ground).
///
/// @throws Error (bad_input) if the start is to be searched
std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  const StartRule& start = {});

/// What makes one dig better than another.
struct DigObjective {
  enum class Goal {
    mass_per_energy,  ///< the paper's f [kg/J]
    mass_per_time,    ///< [kg/s]
    priced,           ///< mass / (energy + time_price * time) [kg/J]
  };
  Goal goal = Goal::mass_per_energy;
  double time_price = 0.0;     ///< what a second is worth, if priced [W], >= 0
  double rest_of_cycle = 0.0;  ///< time of swing, dump and return, added to the dig's [s], >= 0

  double worth(const PlannedDig& dig) const;  ///< larger is better; 0 for a dig that costs nothing
};

/// Between which digs a search looks: by default those of dig_parameter_table().
struct DigBounds {
  DigParameters lower;
  DigParameters upper;
  DigBounds();
};

/// An evaluation is a dig, its fitness the dig's worth.
struct DigSearchOptions : SearchSettings {
  std::vector<DigParameters> start = {};  ///< known good digs to begin with
  DigObjective objective = {};
  DigBounds bounds = {};
  StartRule start_rule = StartRule::Kind::least_work;
};

struct DigSearchResult {
  PlannedDig dig;
  double worth = 0.0;  ///< of the dig, by the objective
  int evaluations = 0;
  int refused = 0;       ///< digs that cannot be driven, not simulated
  int infeasible = 0;    ///< of the evaluations: the machine stalled
  bool stopped = false;  ///< by `progress`
  StopReason stopped_by = StopReason::generations;
  SearchInsight insight;  ///< in the order of dig_parameter_table(), the start last if searched
};

/// The dig that a search came nearest to a feasible one with.
struct NearestDig {
  DigParameters parameters;
  std::optional<double> start_x;  ///< [m]; nothing if no start was found for it
  /// What is left of the path where the machine stalls, 0 .. 1; above 1 for a path that cannot be
  /// driven, more the earlier it fails.
  double violation = 0.0;
  std::string reason;  ///< for people
};

/// The result of a search. If no dig was feasible it is empty, and says which came nearest.
template <typename Result>
struct Found : std::optional<Result> {
  using std::optional<Result>::optional;
  std::optional<NearestDig> nearest;  ///< if empty; nothing if it was stopped before the first dig
};

/// Searches the three numbers of a dig for the highest worth. All checks of the path come before
/// the simulation: what cannot be driven costs no evaluation, and its violation is what is left of
/// the path where it fails, so that the search finds its way out.
///
/// @throws Error (bad_input) if an option is out of range
/// @throws Error (bad_file) if a checkpoint is of another search, truncated or altered; another
///         simulator is known by its identity()
Found<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                  const Terrain& terrain, const DigSearchOptions& options = {});

/// One of the soils that the ground may be.
struct PossibleSoil {
  const SoilSimulator* simulator = nullptr;
  double probability = 0.0;  ///< > 0; all of them add up to 1
};

/// The dig that is best on average, and what it would be worth to know the soil.
struct UncertainDigSearchResult {
  /// Its dig has the means of mass, volume, energy and duration, its worth is the mean of the
  /// worths. A soil in which the machine stalls counts as worth 0.
  DigSearchResult expected;
  double worth_if_known = 0.0;  ///< mean of the worths of the best dig for each soil
  int evaluations = 0;          ///< simulated digs, all soils and searches together

  /// Expected value of perfect information, as a share of the expected worth, >= 0.
  double value_of_knowing() const { return worth_if_known / expected.worth - 1.0; }
};

/// Searches the best dig for each soil, and from all of them the dig of the highest expected worth.
/// The stop rules are those of each search; an evaluation of the last is one dig in every soil. The
/// search for the i-th soil has the i-th seed from the one given on.
///
/// Of a checkpoint FILE the search for the first soil keeps FILE.soil1, that for the second
/// FILE.soil2 and so on, the last search FILE itself; without `resume` all of them begin anew. What
/// is stopped before the last search gives the best on average of the digs found so far.
///
/// @throws Error as above, and (bad_input) unless the probabilities are positive and add up to 1
Found<UncertainDigSearchResult> search_dig(const Machine& machine,
                                           const std::vector<PossibleSoil>& soils,
                                           const Terrain& terrain,
                                           const DigSearchOptions& options = {});

/// How much the figures of a dig scatter because the soil is uncertain: standard deviations over
/// the soils in which the machine does not stall.
struct DigSpread {
  double payload_mass = 0.0;       ///< [kg]
  double energy = 0.0;             ///< [J]
  double efficiency = 0.0;         ///< [kg/J]
  double stall_probability = 0.0;  ///< of the soils left out
};

/// Digs a planned dig in all the soils.
/// @throws Error (bad_input) unless the probabilities are positive and add up to 1, or if the path
///         cannot be driven
DigSpread dig_spread(const Machine& machine, const std::vector<PossibleSoil>& soils,
                     const Terrain& terrain, const PlannedDig& dig);

/// A density the ground may have.
struct PossibleDensity {
  double percent = 0.0;
  double probability = 0.0;
};

/// Nodes of the Gauss quadrature for a normal distribution cut off at 0 and 100 %: means over them
/// are exact for polynomials of the density up to degree 2 count - 1
/// (docs/methods.md#uncertain-density).
///
/// @throws Error (bad_input) unless 0 <= mean <= 100, 0 < sd < infinity, 1 <= count <= 20
std::vector<PossibleDensity> possible_densities(double mean_percent, double sd_percent,
                                                int count = 3);

}  // namespace excavplan
