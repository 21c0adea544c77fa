// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "experiments/experiment_site.hpp"

namespace excavplan {

/// What digs in a row lifted and cost.
struct RowTotal {
  int digs = 0;               ///< that were made
  double mass = 0.0;          ///< [kg]
  double energy = 0.0;        ///< of the digs [J]
  double cycle_energy = 0.0;  ///< [J]
};

/// Digs in a row on one piece of ground; each heap is carried off before the next dig.
class DigRow {
 public:
  /// @param options  as of an experiment: ground, soils, simulators, survey, plan
  DigRow(const Machine& machine, const SoilKind& soil, double density_percent,
         const ExperimentOptions& options);

  /// Digs along the fixed path, each from where it lifts most, until it cannot be dug any more.
  /// @throws Error (bad_input) if it cannot be dug at all
  RowTotal fixed(int digs) const;

  /// Digs each along the path that is planned from the survey of the one before, the first from
  /// `first`, on the ground as it is seen.
  /// @param last  estimate from the last dig
  /// @throws Error (bad_input) where there is no plan, or no estimate
  RowTotal planned(int digs, const RelativeDensity& first, RelativeDensity& last) const;

 private:
  DigScene dug(const Terrain& ground, const DigParameters& path, double start_x) const;
  DigScene dug_as_planned(const Terrain& ground, const RelativeDensity& estimate) const;
  std::optional<double> fullest_start(const Terrain& ground) const;
  Terrain without_heap(const DigScene& scene) const;
  void add(const DigScene& scene, RowTotal& total) const;

  const Machine& machine_;
  const SoilKind& soil_;
  const ExperimentOptions& options_;
  ExperimentSite site_;
  std::unique_ptr<const SoilSimulator> simulator_;
  Terrain ground_;
};

}  // namespace excavplan
