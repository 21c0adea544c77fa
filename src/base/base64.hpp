// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// @file
/// Lists of numbers as text without loss: base64 (RFC 4648) of their 8 bytes each, IEEE 754, the
/// lowest byte first. Private to the project.

namespace excavplan {

std::string base64_of(const double* numbers, std::size_t count);

/// The inverse. @return false if the text is not that of exactly so many numbers
bool read_base64(std::string_view text, double* numbers, std::size_t count);

}  // namespace excavplan
