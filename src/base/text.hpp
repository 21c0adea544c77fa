// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// Numbers as text, for files and for messages, and checksums of text. Private to the project.

namespace excavplan {

/// The largest whole number of which JSON's double keeps this and all smaller ones, 2^53.
constexpr std::uint64_t most_exact = 9007199254740992;

/// Shortest text of a number that reads back the same, for messages and files.
std::string number_text(double value);
/// The number with so many digits after the point: "0.350".
std::string decimals(double value, int digits);
/// A human-readable number: at least so many significant digits, never an exponent; "unknown" if
/// NaN.
std::string readable(double value, int digits = 3);
/// "0.451 ± 0.012": the standard deviation with two digits, the value with as many decimals.
std::string readable(double value, double sd);

/// A text of unknown origin made fit for a message: in quotes, cut, without control characters.
std::string quoted(std::string_view text);
/// Of some words that which was probably meant, if one of them is near.
std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& words);

/// FNV-1a, 64 bit: detects damage, not manipulation. The text has 16 hexadecimal digits.
std::uint64_t checksum(const std::string& text);
std::string checksum_text(const std::string& text);

}  // namespace excavplan
