// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

/// @file
/// Texts for people.

namespace excavplan::python {

/// For people: what is not UTF-8, such as a part of a file's name, is shown as "\xff".
inline pybind11::str text(const std::string& message) {
  auto decoded = pybind11::reinterpret_steal<pybind11::str>(PyUnicode_DecodeUTF8(
      message.data(), static_cast<pybind11::ssize_t>(message.size()), "backslashreplace"));
  if (!decoded) throw pybind11::error_already_set();
  return decoded;
}

/// As Python writes it.
inline std::string number(double value) {
  return pybind11::str(pybind11::repr(pybind11::float_(value)));
}

/// To three digits, or whole: "3.14", "31416"
inline std::string rounded(double value) {
  std::ostringstream text;
  if (std::abs(value) >= 1e3) text << std::fixed;
  text << std::setprecision(std::abs(value) >= 1e3 ? 0 : 3);
  text << (std::abs(value) < 1e-9 ? 0.0 : value);
  return text.str();
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
