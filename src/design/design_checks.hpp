// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/design/design_surface.hpp>
#include <excavplan/design/job_design.hpp>
#include <excavplan/machine/machine.hpp>

/// @file
/// What of a job cannot be done as its design asks. Private to the project.

namespace excavplan {

/// design_beyond_scan, design_above_ground, design_out_of_reach, dump_on_design, wide_tolerance.
std::vector<Warning> design_warnings(const JobDesign& job, const DesignSurface& design,
                                     const HeightMap& ground, const Machine& machine);

/// Area of a design in plan that a scan does not show, as it lies beyond it [m^2].
double area_beyond(const DesignSurface& design, const DesignCover& cover, const HeightMap& ground);

}  // namespace excavplan
