// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/soil/density_law.hpp>

namespace excavplan::tools {

/// What else the law was measured on than what is worked with: law_of_other_machine,
/// law_of_other_soil. An empty soil is not compared.
std::vector<Warning> unlike_law(const DensityLaw& law, const std::string& machine,
                                const std::string& soil = {});

}  // namespace excavplan::tools
