// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <pybind11/pybind11.h>

/// @file
/// Names of files, as Python's own functions take them.

namespace excavplan::python {

namespace py = pybind11;

/// A file or folder: in from str, bytes or os.PathLike, out as str, by the encoding of the file
/// system (os.fsencode(), os.fsdecode()).
struct File {
  std::string path;
};

/// Whether an object names a file.
inline bool is_file(const py::handle& object) {
  return PyUnicode_Check(object.ptr()) != 0 || PyBytes_Check(object.ptr()) != 0 ||
         py::hasattr(object, "__fspath__");
}

/// The file that it names. @throws py::error_already_set unless it names one
inline File file_of(const py::handle& object) {
  PyObject* encoded = nullptr;
  if (PyUnicode_FSConverter(object.ptr(), &encoded) == 0) throw py::error_already_set();
  return {std::string(py::reinterpret_steal<py::bytes>(encoded))};
}

}  // namespace excavplan::python

namespace pybind11::detail {

template <>
struct type_caster<excavplan::python::File> {
  PYBIND11_TYPE_CASTER(excavplan::python::File, const_name("File"));

  bool load(handle source, bool /*convert*/) {
    if (!source || !excavplan::python::is_file(source)) return false;
    value = excavplan::python::file_of(source);
    return true;
  }
  static handle cast(const excavplan::python::File& file, return_value_policy /*policy*/,
                     handle /*parent*/) {
    return PyUnicode_DecodeFSDefaultAndSize(file.path.data(),
                                            static_cast<ssize_t>(file.path.size()));
  }
};

}  // namespace pybind11::detail
