// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include "arrays.hpp"
#include "pictures.hpp"
#include "rooms.hpp"

namespace excavplan::python {
namespace {

/// Objects come from their class or from functions: one of X.__new__(X), as copy() makes it, would
/// hold a value that was never made. SoilSimulator is left out, as users derive from it.
void forbid_empty_objects(const py::module_& module) {
  const py::cpp_function refuse([](const py::object& type, const py::args&, const py::kwargs&) {
    throw py::type_error(std::string(py::str(type.attr("__name__"))) +
                         " cannot be made without its constructor, nor copied or pickled");
  });
  for (const auto& item : py::dict(module.attr("__dict__"))) {
    if (!PyType_Check(item.second.ptr()) || item.second.is(module.attr("SoilSimulator"))) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(item.second.ptr());
    if (py::detail::get_type_info(type) == nullptr) continue;
    // Into the dictionary alone: the constructor goes on by the slot.
    PyDict_SetItemString(type->tp_dict, "__new__", py::staticmethod(refuse).ptr());
    PyType_Modified(type);
  }
}

}  // namespace
}  // namespace excavplan::python

PYBIND11_MODULE(_core, module) {
  using namespace excavplan::python;
  module.attr("__version__") = EXCAVPLAN_VERSION;
  // Classes and signatures show the package as users import it.
  const py::object own_name = module.attr("__name__");
  module.attr("__name__") = "excavplan";
  bind_arrays(module);
  bind_errors(module);
  bind_pictures(module);
  bind_ground(module);
  bind_soil(module);
  bind_machine(module);
  bind_simulation(module);
  bind_planning(module);
  bind_library(module);
  bind_plan_dig(module);
  bind_survey(module);
  bind_design(module);
  bind_site(module);
  bind_job_steps(module);
  bind_jobs(module);
  bind_estimates(module);
  bind_trial(module);
  module.attr("__name__") = own_name;
  forbid_empty_objects(module);

  py::list names;
  for (const auto& item : py::dict(module.attr("__dict__"))) {
    const std::string name = py::str(item.first);
    if (name.front() != '_') names.append(name);
  }
  module.attr("__all__") = names;
}
