// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/dig_trials.hpp>

#include "planning/front_room.hpp"

namespace excavplan {

/// Which columns of a terrain are known over the whole width of the bucket.
class KnownStrip {
 public:
  KnownStrip(const Terrain& terrain, const Machine& machine);

  bool is_known(double x_min, double x_max) const;
  double cell_size() const { return cell_size_; }

 private:
  double origin_;
  double cell_size_;
  std::vector<int> unknown_before_;  ///< per column: how many of those before it are unknown
};

/// Lays out digs on one ground, with all checks that need no simulation.
class DigLayout {
 public:
  /// @throws Error (bad_input) as require_machine() and require_terrain()
  DigLayout(const Machine& machine, const Terrain& terrain, DigPathOptions rules = {});

  std::variant<DigPath, Infeasible> path_from(const DigParameters& parameters,
                                              double start_x) const;
  /// The same by other rules.
  std::variant<DigPath, Infeasible> path_from(const DigParameters& parameters, double start_x,
                                              const DigPathOptions& rules) const;
  /// Of a trial by other rules whether all that path_from() checks holds.
  bool can_be_driven(const DigTrials& trials, double start_x, const DigTrials::Judge& judge) const;
  std::variant<DigPath, Infeasible> path_of_largest_margin(const DigParameters& parameters) const;
  /// The way down to a path, as way_down(), and clear of the ground with boom and arm.
  std::variant<std::vector<DigPose>, Infeasible> approach(const DigPath& path) const;
  /// From this start, or if it cannot be from that of the largest margin.
  std::variant<DigPath, Infeasible> path_near(const DigParameters& parameters,
                                              double start_x) const;

  const Machine& machine() const { return machine_; }
  const GroundProfile& ground() const { return ground_; }
  const DigPathOptions& rules() const { return rules_; }

 private:
  std::variant<DigPath, Infeasible> checked(std::variant<DigPath, Infeasible> found) const;
  std::optional<Infeasible> obstacle(const DigPose& pose, double x_max) const;
  std::optional<Infeasible> front_contact(const DigPose& pose) const;

  const Machine& machine_;
  DigPathOptions rules_;
  GroundProfile ground_;
  KnownStrip strip_;
  FrontRoom room_;
};

/// Where a path whose start is free is tried along the reach [m], 0.25 m apart; ours.
std::vector<double> starts_along_reach(const Machine& machine);

}  // namespace excavplan
