// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

/// @file
/// What repr() says.

namespace excavplan::python {

/// As Python writes it.
inline std::string number(double value) {
  return pybind11::str(pybind11::repr(pybind11::float_(value)));
}

/// "Measured(value=1.2, sd=0.1)"
inline std::string shown(const std::string& of,
                         const std::vector<std::pair<const char*, double>>& members) {
  std::string text = of + "(";
  for (const auto& [name, value] : members) {
    text += (text.back() == '(' ? "" : ", ") + std::string(name) + "=" + number(value);
  }
  return text + ")";
}

}  // namespace excavplan::python
