// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include <Eigen/Core>

#include <excavplan/design/job_design.hpp>
#include <excavplan/machine/machine.hpp>

#include "trial/seen_ground.hpp"

namespace excavplan {

/// Where a dig is dumped.
struct PlainDump {
  Eigen::Vector3d pin;       ///< of the bucket, in the site [m]
  std::optional<int> truck;  ///< from 1
  bool in_reach = false;
};

/// Chooses the place of least swing in the dump areas or the truck of a job; fills one truck after
/// the other.
class DumpPlaces {
 public:
  DumpPlaces(JobDesign job, Machine machine) : job_(std::move(job)), machine_(std::move(machine)) {}

  /// @param heading  of the dig [rad]
  PlainDump from(const BasePose& base, double heading, const LastSeenGround& ground) const;
  /// The payload of the last dig was dumped [kg].
  void loaded(double payload);

 private:
  JobDesign job_;
  Machine machine_;
  int truck_ = 1;
  double load_ = 0.0;     ///< on that truck [kg]
  double largest_ = 0.0;  ///< payload [kg]
};

/// Farthest from the swing axis that a machine can hold its bucket pin at a height [m]; 0 if not.
double pin_reach(const Machine& machine, double height);

}  // namespace excavplan
