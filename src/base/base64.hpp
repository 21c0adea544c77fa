// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// @file
/// Bytes as text, base64 (RFC 4648); of lists of numbers their 8 bytes each, IEEE 754, the lowest
/// byte first. Private to the project.

namespace excavplan {

std::string base64_of(std::string_view bytes);
std::string base64_of(const double* numbers, std::size_t count);

/// The inverse. @return false if the text is not that of exactly so many numbers
bool read_base64(std::string_view text, double* numbers, std::size_t count);
/// Nothing of a text that is none.
std::optional<std::string> read_base64(std::string_view text);

}  // namespace excavplan
