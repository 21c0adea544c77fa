// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// What --soil and --machine name, and what is known of both.

namespace excavplan::tools {

/// The soil or machine that a name or path means. @throws Error (bad_input) or (bad_file)
SoilKind soil_named(const std::string& name_or_path);
Machine machine_named(const std::string& name_or_path);

/// File of the density law of a machine and a soil: that of a kit, or the shipped one; empty if
/// there is none.
std::string law_path(const std::string& machine_word, const Machine& machine,
                     const std::string& soil);
/// The law of that file; without one density_law_of() the soil. @throws Error (bad_file)
DensityLaw law_in(const std::string& path, const SoilKind& soil);

}  // namespace excavplan::tools
