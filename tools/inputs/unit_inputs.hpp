// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// An option for the unit of coordinates: m, mm and others.
void declare_unit(Arguments& arguments, const std::string& name, std::string& unit,
                  const std::string& help);

/// Length of the unit that such an option names [m].
double unit_length(const std::string& word);

}  // namespace excavplan::tools
