// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <excavplan/job/job_step.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/trial/hidden_site.hpp>

namespace excavplan::tools {

/// All planners, the first is the default.
std::vector<std::string> planner_words();

/// A planner by its word. It is given what is known of the site and nothing else; "known" is given
/// density and strength as they are beside it.
std::unique_ptr<JobPlanner> planner_of(const std::string& word, const HiddenSite& site,
                                       const Machine& machine);

}  // namespace excavplan::tools
