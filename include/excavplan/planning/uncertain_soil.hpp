// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// Digs in soil that is known only with a probability (docs/methods.md#uncertain-density).

namespace excavplan {

/// The dig of highest expected worth, and the value of knowing the soil.
struct UncertainDigSearchResult {
  /// Its dig has the means of mass, volume, energy and duration, its worth is the mean of the
  /// worths. A soil in which the machine stalls counts as worth 0.
  DigSearchResult expected;
  double worth_if_known = 0.0;  ///< mean of the worths of the best dig for each soil
  int evaluations = 0;          ///< simulated digs, all soils and searches together

  /// Expected value of perfect information, as a share of the expected worth, >= 0.
  double value_of_knowing() const { return worth_if_known / expected.worth - 1.0; }
};

/// FILE.soil1 for the first soil, 0, of a search with the checkpoint FILE, and so on; empty: none.
std::string checkpoint_of_soil(const std::string& checkpoint, std::size_t soil);

/// Searches the best dig for each soil, and from all of them the dig of the highest expected worth.
/// The stop rules are those of each search; an evaluation of the last is one dig in every soil. The
/// search for the i-th soil has the i-th seed from the one given on.
///
/// The search for each soil keeps its checkpoint_of_soil(), the last search the checkpoint itself;
/// without `resume` all of them start again. What is stopped before the last search gives the best
/// on average of the digs found so far.
///
/// @throws Error as for one soil, and (bad_input) unless the probabilities are positive and add up
///         to 1, and (bad_file) if in the place of the checkpoint of a soil there is another file
Found<UncertainDigSearchResult> search_dig(const Machine& machine,
                                           const std::vector<PossibleSoil>& soils,
                                           const Terrain& terrain,
                                           const DigSearchOptions& options = {});

/// Standard deviations of the results of a dig because the soil is uncertain, over the soils in
/// which the machine does not stall.
struct DigSpread {
  double payload_mass = 0.0;       ///< [kg]
  double energy = 0.0;             ///< [J]
  double efficiency = 0.0;         ///< [kg/J]
  double stall_probability = 0.0;  ///< of the soils left out
};

/// Digs a planned dig in all the soils.
/// @param path  of the dig, as it was laid out on the terrain
/// @throws Error (bad_input) unless the probabilities are positive and add up to 1
DigSpread dig_spread(const Machine& machine, const std::vector<PossibleSoil>& soils,
                     const Terrain& terrain, const PlannedDig& dig, const DigPath& path);

/// A density the ground may have.
struct PossibleDensity {
  double percent = 0.0;      ///< 0 .. 100
  double probability = 0.0;  ///< > 0; all of them add up to 1
};

/// Nodes of the Gauss quadrature for a normal distribution cut off at 0 and 100 %: means over them
/// are exact for polynomials of the density up to degree 2 count - 1.
///
/// @throws Error (bad_input) unless 0 <= mean <= 100, 0 < sd < infinity, 1 <= count <= 20
std::vector<PossibleDensity> possible_densities(double mean_percent, double sd_percent,
                                                int count = 3);

/// @throws Error (bad_input) unless the density is in 0 .. 100 % and its sd finite and >= 0
void require_density(const GroundDensity& density);

/// The soils that ground of a density may be, each with its simulator.
class PossibleGround {
 public:
  /// At the possible_densities(), or at the one density if that is taken as known.
  /// @throws Error (bad_input) as require_density()
  PossibleGround(const SimulatorKind& simulator, const Machine& machine, const SoilKind& soil,
                 const GroundDensity& density);

  /// Valid as long as this is.
  const std::vector<PossibleSoil>& soils() const { return soils_; }

 private:
  std::vector<std::unique_ptr<const SoilSimulator>> simulators_;
  std::vector<PossibleSoil> soils_;
};

}  // namespace excavplan
