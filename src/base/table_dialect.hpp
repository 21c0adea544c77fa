// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// @file
/// How a table is written, from its text. Private to the project.

namespace excavplan {

/// The number that a field is, with this decimal mark; nothing unless it is one and finite.
std::optional<double> number_of(std::string_view field, char decimal_mark);

/// The delimiter with which all of the first records have as many fields as the line of names, and
/// most of them are numbers; a comma if none has.
/// @throws Error (bad_file) if two delimiters do
char find_delimiter(const std::string& path, std::string_view text);

/// The decimal mark that the numbers prove: '1,5' proves a comma, '1,234' may be 1.234 or 1234.
/// @throws Error (bad_file) if they prove both or leave it open
char find_decimal_mark(const std::string& path, std::string_view text, char delimiter);

}  // namespace excavplan
