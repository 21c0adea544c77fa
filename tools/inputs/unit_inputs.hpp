// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// An option for the unit of coordinates: m, mm and others.
void declare_unit(Arguments& arguments, const std::string& name, std::string& unit,
                  const std::string& help);

/// --depth-unit: length of a count in depth images, at most 1 cm: of a bare 0.25 the unit is
/// missing.
void declare_depth_unit(Arguments& arguments, std::optional<double>& depth_unit,
                        const std::string& help);

/// Length of the unit that such an option names [m].
double unit_length(const std::string& word);

}  // namespace excavplan::tools
