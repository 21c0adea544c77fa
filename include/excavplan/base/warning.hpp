// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/base/warning_code.hpp>

namespace excavplan {

/// What stands for a code in JSON and in messages: "density_above_range".
std::string code_text(WarningCode code);

/// A doubt about a result that is given all the same.
struct Warning {
  /// It ends trust if the code always does.
  Warning(WarningCode doubt, std::string text);
  /// For codes whose case decides whether they end trust.
  Warning(WarningCode doubt, std::string text, bool is_end);

  WarningCode code;     ///< what it is about
  std::string message;  ///< text: what was found, its value and its meaning
  bool ends_trust;      ///< true: a careful surveyor would not sign for the result
};

/// Whether one of them ends trust.
bool any_ends_trust(const std::vector<Warning>& warnings);

/// Adds those that are not there yet with the same code and message.
void add_new(const std::vector<Warning>& more, std::vector<Warning>& warnings);

}  // namespace excavplan
