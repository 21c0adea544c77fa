// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include <excavplan/ground/ground_state.hpp>
#include <excavplan/ground/height_map.hpp>

/// @file
/// The ground as known after a survey of it (docs/methods.md#known-ground).

namespace excavplan {

/// What a survey says of the ground, on any grid.
struct SeenGround {
  HeightMap surface;          ///< NaN where it was not seen
  Eigen::ArrayXXd deviation;  ///< standard deviation of each height [m]; NaN: common_sd
  /// 1 where a dig changed the ground, 2 where something else did, 0 where nothing did, as large as
  /// the surface. Empty: what differs by more than the errors explain was changed by something
  /// else.
  Eigen::ArrayXXi changed = {};
  Eigen::ArrayXXd swept =
      {};  ///< top of the bank that a bucket left [m]; NaN elsewhere; empty: not told
  /// Surface as the balance of a dig took it, also where it was not seen [m]; NaN: not told; empty:
  /// nowhere.
  Eigen::ArrayXXd filled = {};
  Eigen::ArrayXXd obstacles = {};  ///< tops of what is no soil [m]; NaN elsewhere; empty: none
  double time = 0.0;               ///< since 1970-01-01 UTC [s]
  /// Deviation that neighbouring heights of a survey share: that of the mean of many surveys does
  /// not fall below it [m]; ours.
  double common_sd = 0.003;
};

/// Deviation of a cell that something else than a dig changed, at least: what lies below its
/// surface is not known [m]; ours.
inline constexpr double reopened_sd = 0.05;

/// Likewise of a cell that no survey showed after a dig changed it: neighbours err alike. That it
/// is more than reopened_sd tells such cells apart [m]; ours.
inline constexpr double filled_sd = 0.06;

/// The ground after a survey, on the grid of the state.
///
/// A cell that did not change is the mean of least variance of what was known and what was seen,
/// its loose soil as thick as before. In one that did, the bank is the lowest of what it was, what
/// the bucket left of it and the surface seen; what lies on it is loose. A cell that was never seen
/// is bank. One that was not seen now stays as it is, with its time; where the bucket swept it is
/// left as by the bucket, and what a dig's balance filled is taken over until it is seen, with a
/// deviation of half of what it adds, of filled_sd at least. Under what stands on the ground the
/// layers stay and its top is noted. A cell that something else changed has a deviation of
/// reopened_sd at least.
///
/// @param loose_void_ratio  of soil that was dug now, for states with a void ratio in each cell
/// @throws Error (bad_input) as require_ground_state(), unless the layers of what was seen are
/// empty
///         or as large as its surface and its numbers are in their bounds
GroundState updated_ground(const GroundState& before, const SeenGround& seen,
                           std::optional<double> loose_void_ratio = std::nullopt);

}  // namespace excavplan
