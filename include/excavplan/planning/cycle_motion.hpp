// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/motion.hpp>
#include <excavplan/planning/planned_dig.hpp>

/// @file
/// The way of the joints over a working cycle: from where the machine stands to the dig, along it,
/// and on over swing, dump and back, clear of the ground (docs/methods.md#motion).

namespace excavplan {

/// What a dig loads the joints with, and what it leaves.
struct DigLoad {
  std::vector<JointAngles> torques;  ///< DigResult::torques [N m]
  double payload_mass = 0.0;         ///< in the bucket after it [kg], >= 0
  HeightMap ground_after = {};       ///< its surface where the dig may have changed it; empty: none
  double carried = 0.0;              ///< in the bucket before it [kg], >= 0
};

/// What a way holds besides the dig.
struct CycleWayOptions {
  /// Joints from which it begins [rad]; nothing: it begins where the path does.
  std::optional<FrontJoints> start;
  bool whole_cycle = false;  ///< whether it goes on over swing, dump and back
  CycleOptions cycle = {};   ///< swing and dump height, if it does
  /// Of the bucket pin from the swing axis where it dumps [m], if the front reaches it there;
  /// nothing: as far as the boom alone brings it to the dump height.
  std::optional<double> dump_radius = {};
  double lane = 0.0;  ///< of the path to the left of the swing axis; the swing follows it [m]
  bool dumps_first = false;  ///< what is carried, on the way from the start to the dig
};

/// Ground, or its own undercarriage, in the way of the machine.
struct BlockedWay {
  DigPhase phase = DigPhase::approach;              ///< in which
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the ground there [m]
  double clearance = 0.0;                           ///< of the machine above it [m]
  std::string message;                              ///< all of this in one sentence
};

/// @throws Error (bad_input) if an option is out of range for the machine, as way_of_cycle()
void check(const Machine& machine, const CycleWayOptions& options);

/// Lays out the way of a cycle. Off the path of the dig the joints go straight to where they have
/// to be; where that leads within 0.1 m of the ground or of the undercarriage, the boom rises first
/// and comes down last, and a full bucket keeps its attitude. From the dig on, the ground is that
/// after it. Behind the front of the tracks and within the circle through their corners stands the
/// machine itself: no ground is looked at there, but obstacles are, for its tail too.
///
/// Ground that is unknown or off the map counts as the plane of the tracks. Warnings, both of which
/// end trust: unseen_way where boom, arm and bucket pass over such ground, payload_tips where a
/// bucket with soil cannot keep its attitude, as its joint ends. One that goes back with its load
/// opens no further than to where the dig begins.
///
/// @param ground  before the dig: all that the machine can pass over, swing_extent()
/// @return the way, or what blocks it
/// @throws Error (bad_input) as require_machine(), require_terrain() and way_of(); if a joint of
/// the
///         start is not finite or beyond its limits, the payload is negative or not finite, the
///         ground after is no grid, an option of the cycle is out of range, or the machine does not
///         state its swing but has to
std::variant<Way, BlockedWay> way_of_cycle(const Machine& machine, const Terrain& ground,
                                           const DigPath& path, const DigLoad& load,
                                           const CycleWayOptions& options);

/// Likewise of a bucket that only dumps: from the start over the dump and back.
/// @param payload  in it [kg]
/// @param options  with a start
/// @throws Error (bad_input) as way_of_cycle(); if there is no start
std::variant<Way, BlockedWay> way_of_dump(const Machine& machine, const Terrain& ground,
                                          double payload, const CycleWayOptions& options);

}  // namespace excavplan
