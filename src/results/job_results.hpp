// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/job/site_job.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// A step of a job, as plan-site next prints it; "path", "dump" and "predicted" are null where it
/// is no dig, "warnings" are left out.
Json job_step_json(const JobStep& step);

/// How far a job has come, as plan-site show prints it.
Json progress_json(const JobProgress& progress);

}  // namespace excavplan
