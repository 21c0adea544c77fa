// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

#include "support/errors.hpp"

namespace excavplan::test {

std::string zx120_path();

/// The shipped machine.
const Machine& zx120();

/// The shipped soil that most tests dig in.
const SoilKind& loam();

/// The shipped machine, but no force of the soil lifts or drags it.
Machine zx120_held_down();

/// What load_machine says about a machine file, without the file's name; "no error" if nothing.
std::string complaint_about_file(const nlohmann::json& file);

}  // namespace excavplan::test
