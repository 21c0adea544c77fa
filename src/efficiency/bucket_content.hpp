// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/efficiency/efficiency.hpp>

/// @file
/// What the bucket lifted, from what is known of it. Private to the library.

namespace excavplan {

/// The content of the bucket.
struct LiftedSoil {
  Payload payload;                      ///< loose volume, or mass
  std::optional<Measured> bank_volume;  ///< [m^3], if a bulking factor is known
  std::vector<Warning> warnings;        ///< of scans
};

/// @throws Error as measure_efficiency()
LiftedSoil lifted_soil(const LoggedDig& dig);

}  // namespace excavplan
