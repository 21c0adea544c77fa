// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace excavplan {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// Stands for what is not known.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace excavplan
