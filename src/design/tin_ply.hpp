// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/design/design_surface.hpp>

/// @file Private to the project.

namespace excavplan {

/// A binary PLY file of a surface, in doubles and in its own frame, as read_design() reads it.
std::string ply_of(const Tin& tin);

}  // namespace excavplan
