// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

/// @file
/// Times of day in logs. Private to the library.

namespace excavplan {

/// Seconds since midnight of "13:05:59.25", with or without a date before it ("2026-05-04 ",
/// "2026-05-04T"), a decimal comma, and "Z" behind it; with a date since 1970-01-01.
std::optional<double> seconds_of_clock(std::string_view text);

}  // namespace excavplan
