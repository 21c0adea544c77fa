// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/job/site_job.hpp>

/// @file
/// A job in lines of text.

namespace excavplan::tools {

std::vector<std::string> step_lines(const JobStep& step);
std::vector<std::string> progress_lines(const JobProgress& progress);
std::vector<std::string> estimate_lines(const JobEstimate& estimate, const JobOutline& job,
                                        const std::optional<JobCost>& cost);

}  // namespace excavplan::tools
