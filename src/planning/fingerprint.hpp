// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// 16 hexadecimal digits that change with every number of a machine or soil that decides a dig; the
/// name does not count.
std::string fingerprint(const Machine& machine);
std::string fingerprint(const SoilKind& soil);

/// Name and version of the built-in simulator.
std::string simulator_fingerprint();

}  // namespace excavplan
