// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// @file
/// Ground between the returns of a scan, and what counts as seen of it. Private to the project.

namespace excavplan {

/// Standard deviation of a height between returns [m]; ours.
inline constexpr double between_returns_sd = 0.03;

/// Heights of the cells that a scan has no returns of but whose ground it tells all the same; NaN
/// in all others.
///
/// Returns lie on both sides of such a gap, at most 0.25 m apart along x or y, on one surface:
/// where the ground is known both differ from it alike, so that the ground between does too;
/// elsewhere their heights are in line. The shadow behind an edge is no such gap: nothing tells
/// what lies in it but what was known before.
///
/// @param seen   heights of the cells with returns; NaN: none
/// @param known  heights as known before, as large; NaN, or empty: not known
Eigen::ArrayXXd heights_between_returns(const Eigen::ArrayXXd& seen, const Eigen::ArrayXXd& known,
                                        double cell_size);

}  // namespace excavplan
