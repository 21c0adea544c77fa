// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/job/site_job.hpp>
#include <excavplan/planning/plan_dig.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// Why there is no dig, with what came nearest to one.
std::string reason_of(const DigPlan& plan);

/// All keys of plan-path but those of its inputs and the time it took; "path" is null if there is
/// no dig. @param objective  that the dig was searched for
Json plan_json(const DigPlan& plan, const GroundDensity& density, const DigObjective& objective);

/// A step of a job, as plan-site next prints it; "path", "dump" and "predicted" are null where it
/// is no dig, "warnings" are left out.
Json job_step_json(const JobStep& step);

/// How far a job has come, as plan-site show prints it.
Json progress_json(const JobProgress& progress);

/// What a job is going to take, as plan-site estimate prints it; digs and loads are whole ones.
Json job_estimate_json(const JobEstimate& estimate, const JobOutline& job,
                       const std::optional<JobCost>& cost = {});

/// Key `search` of a result: all that a search was set to.
Json search_settings_json(const Machine& machine, const DigSearchOptions& options);

}  // namespace excavplan
