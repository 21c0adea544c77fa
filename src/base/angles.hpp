// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace excavplan {

inline constexpr double pi = 3.14159265358979323846;

}  // namespace excavplan
