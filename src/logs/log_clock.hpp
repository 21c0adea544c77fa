// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// @file
/// Times of day in logs. Private to the library.

namespace excavplan {

/// A column of times of day.
struct ClockTimes {
  std::vector<double> seconds;  ///< rising, since a midnight; with dates since 1970-01-01
  std::size_t bad_row = 0;      ///< if there is a fault
  std::string fault = {};       ///< "expected a time as ..."; empty if there is none
};

/// Each is "13:05:59.25", with a point or comma, "Z", "AM" or "PM" behind it, and a date or none
/// before it: "2026-11-23", "2026/11/23", "23.11.2026", or "11/23/2026" and "23/11/2026", of which
/// the column must show what the month is. Without dates a time may pass midnight. It is a fault if
/// a time is not later than the one before.
ClockTimes clock_times(const std::vector<std::string>& texts);

}  // namespace excavplan
