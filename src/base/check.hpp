// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

/// @file
/// The checks that public functions make of their arguments. Private to the project.

namespace excavplan {

/// @throws Error (bad_input) with this text
[[noreturn]] inline void refuse(const std::string& text) {
  throw Error(ErrorKind::bad_input, text);
}

/// @throws Error (bad_input) with this text unless it holds
inline void require(bool holds, const std::string& text) {
  if (!holds) refuse(text);
}

/// @throws Error (bad_input) "WHAT is VALUE, must be RULE" unless it holds
inline void require(bool holds, std::string_view what, double value, std::string_view rule) {
  if (holds) return;
  throw Error(ErrorKind::bad_input,
              std::string(what) + " is " + plain_number(value) + ", must be " + std::string(rule));
}

/// @throws Error (bad_input) "WHAT is VALUE, must be in LOWEST .. HIGHEST" unless it is; NaN is not
inline void require_in(std::string_view what, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return;
  require(false, what, value, "in " + plain_number(lowest) + " .. " + plain_number(highest));
}

}  // namespace excavplan
