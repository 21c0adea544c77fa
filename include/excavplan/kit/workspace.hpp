// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/machine/machine_file.hpp>

/// @file
/// Where a machine reaches, how hard it digs there, and whether its numbers fit one another
/// (docs/machines.md#what-machine-kit-checks).

namespace excavplan {

/// Largest distances of the tip over the ranges of the joints [m].
struct Reach {
  double ground = 0.0;  ///< x of the furthest point on the ground; 0: it does not reach the ground
  double depth = 0.0;   ///< below the ground; negative: its lowest point is above it
  double height = 0.0;  ///< above the ground
  Eigen::Vector2d deepest = Eigen::Vector2d::Zero();  ///< where that is: x, z [m]
  Eigen::Vector2d highest = Eigen::Vector2d::Zero();  ///< likewise
};

/// @throws Error (bad_input) as require_machine()
Reach reach_of(const Machine& machine);

/// Largest height of the tip with the bucket hanging straight down from its pin [m].
/// @throws Error (bad_input) as require_machine()
double dump_height(const Machine& machine);

/// The curve of the tip with the bucket in line with the arm, or as near to it as it goes: boom
/// down with the arm stretched, arm in, boom up, arm out. Closed; x, z [m].
std::vector<Eigen::Vector2d> reach_outline(const Machine& machine);

/// Forces of the tip on the soil, level, towards the machine [N].
struct DiggingForce {
  /// What the joints can give in the best posture with the floor of the bucket within -10 .. 60
  /// deg.
  double joints = 0.0;
  /// What the machine can hold in that posture without lifting or sliding; infinite without a body.
  double held = 0.0;
  /// The smaller.
  double usable() const { return joints < held ? joints : held; }
};

/// With the tip at a place, at rest: each joint may give its limit in either sense. NaN where the
/// tip cannot be in such a posture.
DiggingForce digging_force(const Machine& machine, const Eigen::Vector2d& tip);

/// The digging force of the bucket alone, at the tip, across the line from its pin [N].
double bucket_force(const Machine& machine);
/// The digging force of the arm, at the tip, with bucket and arm in line [N].
double arm_force(const Machine& machine);

/// data_sheet_differs, which ends trust, for each number that the file does not share with the data
/// sheet. @throws Error (bad_input) as require_machine()
std::vector<Warning> check_data_sheet(const Machine& machine, const DataSheet& sheet);

/// What does not fit: ground_out_of_reach *, no_body, no_cycle, force_beyond_stability, and those
/// of check_data_sheet() *. Those marked * end trust.
std::vector<Warning> check_machine(const Machine& machine, const DataSheet& sheet = {});

}  // namespace excavplan
