// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include <excavplan/planning/plan_dig.hpp>

#include "calls.hpp"

/// @file
/// How digs are planned, as Python says it.

namespace excavplan::python {

/// DigSearchOptions of Python, with the callback, which only the thread of Python may touch.
struct SearchOptionsInPython {
  DigSearchOptions options = budget_search();
  py::object progress = py::none();
};

/// What a plan was made with: for its picture, its page and its JSON.
struct PlanContext {
  Machine machine;
  SoilKind soil;
  GroundDensity density;
  Terrain ground;
  std::shared_ptr<const py::object> simulator;
  DigObjective objective;
};

/// DigPlan of Python.
struct PlanInPython : DigPlan {
  std::shared_ptr<const PlanContext> made_with;
};

/// Arguments that all calls share that plan a dig.
struct PlanArguments {
  std::string method;
  std::optional<PathLibrary> library;
  std::optional<SearchOptionsInPython> search;
  py::object simulator;
  double speed_fraction;
};

/// Of one call. @throws Error (bad_input), TypeError
PlanOptions plan_options(const std::shared_ptr<Call>& call, const PlanArguments& given);

}  // namespace excavplan::python
