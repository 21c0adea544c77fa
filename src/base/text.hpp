// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// Numbers as text, for files and for messages, text of unknown origin, and checksums of text.
/// Private to the project.

namespace excavplan {

/// The largest whole number of which JSON's double keeps this and all smaller ones, 2^53.
constexpr std::uint64_t most_exact = 9007199254740992;

/// Shortest text of a number that reads back the same, for messages and files.
std::string number_text(double value);

/// The same, whole numbers below 1e15 without an exponent, for messages.
std::string plain_number(double value);
/// The number to two digits after the point, without zeros at the end: "0.35".
std::string hundredths(double value);
/// The number with so many digits after the point: "0.350".
std::string decimals(double value, int digits);
/// A human-readable number: at least so many significant digits, never an exponent; 0 if it is less
/// than 1e-9, which is rounding in any unit that is shown; "unknown" if NaN.
std::string readable(double value, int digits = 3);
/// "0.451 ± 0.012": the standard deviation with two digits, the value with as many decimals.
std::string readable(double value, double sd);

/// Whether a line has no control characters but tabs and carriage returns.
bool is_printable(std::string_view line);

/// The first byte that is no part of a UTF-8 character (RFC 3629), if there is one.
std::optional<std::size_t> first_not_utf8(std::string_view text);
/// A text of unknown origin made fit for a terminal, for JSON and for a message: `?` for every
/// control character, also C1, for what turns the direction of text (U+202A .. U+202E, U+2066 ..
/// U+2069, U+200E, U+200F, U+061C) or ends a line (U+2028, U+2029), and for every byte that is not
/// UTF-8. What is longer than `most` bytes loses its middle.
std::string safe_text(std::string_view text, std::size_t most);
/// The same in quotes, of which the first 40 bytes are shown.
std::string in_quotes(std::string_view text);
/// A field of CSV in quotes (RFC 4180).
std::string csv_field(std::string_view text);
/// Why a text is none that files of ours hold, as the end of "NAME is ..."; nothing if it is one:
/// at most so many bytes of UTF-8, on one line, with nothing that safe_text() would change.
std::optional<std::string> fault_of_line(std::string_view text, std::size_t most);
constexpr std::size_t longest_text = 1000;  ///< of a file of ours by default [byte]; ours
/// A to Z made small; all else stays.
std::string small_letters(std::string_view text);
/// Of some words that which was probably meant, if one of them is near.
std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& words);

/// FNV-1a, 64 bit: detects damage, not manipulation. The text has 16 hexadecimal digits.
std::uint64_t checksum(const std::string& text);
std::string checksum_text(const std::string& text);

}  // namespace excavplan
