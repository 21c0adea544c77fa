// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// Errors of the ranges of a sensor.

namespace excavplan {

/// What is stated of the errors of a sensor's ranges.
struct SensorErrors {
  double own = 0.0;          ///< sd at 1 m, of each return by itself [m], >= 0
  double shared = 0.0;       ///< sd at 1 m of what neighbouring returns share [m], >= 0
  double range_power = 0.0;  ///< both grow with the range to this power, in 0 .. 4
};

}  // namespace excavplan
