// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace excavplan {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double degree = pi / 180.0;  // [rad]

/// The same direction within half a turn of 0 [rad].
inline double wrapped(double angle) { return std::remainder(angle, 2.0 * pi); }

}  // namespace excavplan
