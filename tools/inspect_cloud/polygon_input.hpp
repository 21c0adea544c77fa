// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/scans/scan_surface.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"

namespace excavplan::tools {

/// --volume; no corners: none is asked for.
void declare_volume(Arguments& arguments, std::vector<Eigen::Vector2d>& polygon);

/// Adds volume_over() the polygon, if there is one, to the outcome, as `volume`.
void add_volume(const Scan& scan, const std::vector<Eigen::Vector2d>& polygon, Outcome& outcome);

}  // namespace excavplan::tools
