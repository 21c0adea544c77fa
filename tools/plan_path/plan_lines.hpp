// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/planning/plan_dig.hpp>

namespace excavplan::tools {

/// A plan for people. @param soil  its name
std::vector<std::string> plan_lines(const DigPlan& plan, const GroundDensity& density,
                                    const std::string& soil, const DigObjective& objective);

}  // namespace excavplan::tools
