// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>

/// @file Numbers off the front of a text, with every standard library. Private to the project.

namespace excavplan {

/// std::from_chars() of a double, which libc++ has from version 20 on.
std::from_chars_result read_double(const char* begin, const char* end, double& value);

}  // namespace excavplan
