// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <excavplan/study/study.hpp>

namespace excavplan {

/// What digs in a row lifted and cost.
struct RowTotal {
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

  /// Digs along the fixed path, each from where the links do least work.
  /// @throws Error (bad_input) where that cannot be driven or stalls
  RowTotal fixed(int digs) const;

  /// Digs each along the path that is planned from the survey of the one before, the first from
  /// `first`, on the ground as it is seen.
  /// @param last  estimate from the last dig
  /// @throws Error (bad_input) where there is no plan, or no estimate
  RowTotal planned(int digs, const RelativeDensity& first, RelativeDensity* last) const;

 private:
  DigScene dug(const Terrain& ground, const DigParameters& path,
               std::optional<double> start_x) const;
  Terrain without_heap(const DigScene& scene) const;
  void add(const DigScene& scene, RowTotal& total) const;

  const Machine& machine_;
  const SoilKind& soil_;
  SoilKind dug_soil_;
  double density_;
  const ExperimentOptions& options_;
  SimulatorKind digs_;
  Terrain ground_;
};

}  // namespace excavplan
