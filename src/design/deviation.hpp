// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// @file
/// How far ground is from its design. Private to the project.

namespace excavplan {

struct Deviation;

/// @param off  of the ground over its design, NaN where it does not count or is not seen [m]
Deviation deviation_of(const Eigen::ArrayXXd& off, double cell_size, double tolerance);

}  // namespace excavplan
