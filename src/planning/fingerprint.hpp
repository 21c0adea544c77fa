// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Name and version of the built-in simulator.
std::string simulator_fingerprint();

}  // namespace excavplan
