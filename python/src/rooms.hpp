// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

/// @file
/// What each room of the library adds to the module, in the order in which they build on another.

namespace excavplan::python {

void bind_errors(pybind11::module_& module);
void bind_ground(pybind11::module_& module);
void bind_soil(pybind11::module_& module);
void bind_machine(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_planning(pybind11::module_& module);
void bind_library(pybind11::module_& module);
/// Of the room plan, which takes what planning and library give.
void bind_plan_dig(pybind11::module_& module);
void bind_survey(pybind11::module_& module);
void bind_design(pybind11::module_& module);
/// What takes surveys and plans.
void bind_site(pybind11::module_& module);
/// What a job is ordered with, asks and is told.
void bind_job_steps(pybind11::module_& module);
void bind_jobs(pybind11::module_& module);
void bind_estimates(pybind11::module_& module);
void bind_trial(pybind11::module_& module);

}  // namespace excavplan::python
