// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <excavplan/experiments/experiment_options.hpp>

namespace excavplan {

/// What the digs of an experiment are made in: the soil that lies there, its density, and the
/// simulator that makes them.
class ExperimentSite {
 public:
  /// @param soil  planned for, and dug if the options name no other
  ExperimentSite(const SoilKind& soil, double density_percent, const ExperimentOptions& options);

  std::unique_ptr<const SoilSimulator> simulator(const Machine& machine) const;
  /// As large as a scene; the options' ground, or level.
  Terrain scene_ground(const Machine& machine) const;
  /// A dig with its heap on ground of that extent.
  DigScene scene(const Machine& machine, const Terrain& ground, const DigParameters& path,
                 double start_x, const DigPathOptions& rules = {}) const;

 private:
  SoilKind soil_;
  double density_percent_;
  SimulatorKind digs_;
  const ExperimentOptions& options_;
};

}  // namespace excavplan
