// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame/tool.hpp"
#include "plan_site/job_inputs.hpp"

namespace excavplan::tools {

/// plan-site estimate: what a job is going to take.
Outcome work_estimate(const JobInputs& inputs, Console& console);

}  // namespace excavplan::tools
