// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/json.hpp"
#include "kit/proportions.hpp"

/// @file Private to the project.

namespace excavplan {

/// Gives a machine file the cylinders of the known machine nearest in mass that states them, in its
/// size, and turned so that the middles of the ranges fall together. None if no machine states
/// them or if their dead points lie in the ranges of this one; its sources say which.
void add_cylinders(const std::vector<const Proportioned*>& known, const Machine& machine,
                   nlohmann::json& file);

}  // namespace excavplan
