// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <excavplan/figures/figure_images.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"

/// @file
/// What plot(), report() and to_numpy() of results give.

namespace excavplan::python {

/// A figure, as a notebook shows it.
struct Picture {
  std::string svg;
};

/// Draws a figure, and writes it if there is a file, as its ending says.
/// @param draw  is called without the lock of the interpreter
/// @throws Error (bad_input) for another ending than .svg, .png and .pdf
Picture plotted(Call& call, const std::optional<File>& file,
                const std::function<std::string(ImageFormat)>& draw);
/// Of what calls nothing back.
Picture plotted(const std::optional<File>& file,
                const std::function<std::string(ImageFormat)>& draw);

/// 'section', 'forces', 'torques', 'power' or 'cylinders'. @throws Error (bad_input)
DigImage dig_image_of(const std::string& word);

/// Writes a file as Python's open() does. @throws OSError
void write_bytes(const File& file, const std::string& content);

/// Numbers of an object for NumPy: to_numpy() and __array__(). @param rows  of a const Object&
template <typename Bound, typename Rows>
void bind_numbers(Bound& bound, const char* what, const Rows& rows) {
  bound
      .def(
          "to_numpy", [rows](const typename Bound::type& of) { return rows(of); }, what)
      .def(
          "__array__",
          [rows](const typename Bound::type& of, const py::object& type, const py::object& copy) {
            (void)copy;  // the numbers are always a copy
            const py::object numbers = rows(of);
            return type.is_none() ? numbers : py::object(numbers.attr("astype")(type));
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none());
}

void bind_pictures(py::module_& module);

}  // namespace excavplan::python
