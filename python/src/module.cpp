// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include "arrays.hpp"
#include "rooms.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace excavplan::python;
  module.attr("__version__") = EXCAVPLAN_VERSION;
  // Classes and signatures show the package as users import it.
  const py::object own_name = module.attr("__name__");
  module.attr("__name__") = "excavplan";
  bind_arrays(module);
  bind_errors(module);
  bind_ground(module);
  bind_soil(module);
  bind_machine(module);
  bind_simulation(module);
  bind_planning(module);
  bind_library(module);
  bind_plan_dig(module);
  bind_survey(module);
  module.attr("__name__") = own_name;

  py::list names;
  for (const auto& item : py::dict(module.attr("__dict__"))) {
    const std::string name = py::str(item.first);
    if (name.front() != '_') names.append(name);
  }
  module.attr("__all__") = names;
}
