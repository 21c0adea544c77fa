// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// What --soil and --machine name.

namespace excavplan::tools {

/// The soil or machine that a name or path means. @throws Error (bad_input) or (bad_file)
SoilKind soil_named(const std::string& name_or_path);
Machine machine_named(const std::string& name_or_path);

}  // namespace excavplan::tools
