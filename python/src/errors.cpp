// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "calls.hpp"
#include "paths.hpp"
#include "rooms.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

namespace py = pybind11;

// Classes live as long as the interpreter, which ends without asking for them.
PyObject* error_class = nullptr;
PyObject* frame_error_class = nullptr;

PyObject* make_class(py::module_& module, const char* name, const char* text, PyObject* base) {
  PyObject* const made =
      PyErr_NewExceptionWithDoc((std::string("excavplan.") + name).c_str(), text, base, nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.add_object(name, made);
  return made;
}

const char* word(ErrorKind kind) { return kind == ErrorKind::bad_file ? "bad_file" : "bad_input"; }

void raise(PyObject* of, const Error& error) {
  py::object raised = py::reinterpret_borrow<py::object>(of)(error.what());
  raised.attr("kind") = word(error.kind());
  PyErr_SetObject(of, raised.ptr());
}

}  // namespace

bool is_error(const py::error_already_set& error) { return error.matches(error_class); }

Error error_of(const py::error_already_set& error) {
  const py::object value = error.value();
  const std::string kind = py::str(py::getattr(value, "kind", py::str("bad_input")));
  return Error(kind == "bad_file" ? ErrorKind::bad_file : ErrorKind::bad_input, py::str(value));
}

void bind_errors(py::module_& module) {
  error_class = make_class(
      module, "Error",
      "What the caller could have prevented. The text names what is wrong, where, its value and\n"
      "the rule; `kind` is 'bad_input' (an argument) or 'bad_file'.",
      PyExc_Exception);
  py::setattr(error_class, "kind", py::str("bad_input"));
  frame_error_class = make_class(
      module, "FrameError",
      "A scan outside the expected area, mostly because of its frame; an Error of a file.",
      error_class);
  py::setattr(frame_error_class, "kind", py::str("bad_file"));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const FrameError& error) {
      raise(frame_error_class, error);
    } catch (const Error& error) {
      raise(error_class, error);
    }
  });

  py::class_<Warning>(module, "ResultWarning", "A doubt about a result that is given all the same.")
      .def_property_readonly(
          "code", [](const Warning& warning) { return code_text(warning.code); },
          "Stable, for programs: 'density_above_range'.")
      .def_property_readonly(
          "message", [](const Warning& warning) { return text(warning.message); },
          "What was found, its value and its meaning.")
      .def_readonly("ends_trust", &Warning::ends_trust,
                    "True: a careful surveyor would not sign for the result.")
      .def("__repr__", [](const Warning& warning) {
        return text(code_text(warning.code) + ": " + warning.message);
      });
  module.def(
      "data_file", [](const std::string& path) { return File{find_data_file(path)}; },
      py::arg("relative_path"),
      "Full path of a file that excavplan ships, such as 'machines/zx120.json'.");
}

}  // namespace excavplan::python
