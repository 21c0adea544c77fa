// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

#include "base/json.hpp"

/// @file Private to the project.

namespace excavplan {

/// The machine of a file whose format was checked. @throws Error (bad_file)
Machine read_machine(JsonObject file);

}  // namespace excavplan
