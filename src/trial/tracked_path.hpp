// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/trial/hidden_site.hpp>

#include "base/random.hpp"

namespace excavplan {

/// Errors of the tip's height at the poses of a path [m]: the bias, a draw of the dig, and one that
/// varies along the tip's travel, exponentially correlated over 0.5 m. The latter is drawn every
/// 0.25 m and straight between (ours): a front cannot follow a faster one.
std::vector<double> height_errors(const DigPath& path, const HiddenErrors& errors, Random& random);

/// The path that the machine drives instead of one that is asked for.
///
/// Each pose is shifted in height, as far as the joints can follow, in eighths. While it penetrates
/// and drags, the bucket turns about its tip as much as keeps its outline clear of what the tip has
/// cut: pressed on its heel, it would give way. The joints follow by inverse kinematics, in the
/// plane of the path. A path that would begin below the ground begins where its first line comes
/// from above it.
/// @param shift  of each pose [m]
/// @param ground  as it is, in the frame of the path
/// @throws Error (bad_input) unless there are as many as poses
DigPath tracked_path(const Machine& machine, DigPath path, const std::vector<double>& shift,
                     const GroundProfile& ground);

}  // namespace excavplan
