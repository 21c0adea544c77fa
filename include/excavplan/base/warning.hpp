// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan {

/// A doubt about a result that is given all the same.
struct Warning {
  std::string code;         ///< stable, for programs: "density_above_range"
  std::string message;      ///< text: what was found, its value and its meaning
  bool ends_trust = false;  ///< true: a careful surveyor would not sign for the result
};

}  // namespace excavplan
