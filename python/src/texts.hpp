// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

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

/// To three digits, or whole: "3.14", "31416"
inline std::string rounded(double value) {
  std::ostringstream text;
  if (std::abs(value) >= 1e3) text << std::fixed;
  text << std::setprecision(std::abs(value) >= 1e3 ? 0 : 3);
  text << (std::abs(value) < 1e-9 ? 0.0 : value);
  return text.str();
}

}  // namespace excavplan::python
