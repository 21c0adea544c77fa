// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "frame/tool.hpp"
#include "plan_site/job_inputs.hpp"

namespace excavplan::tools {

/// What plan-site can be told to do.
struct JobCommand {
  const char* word;
  Outcome (*work)(const JobInputs& inputs, Console& console);
};
const std::vector<JobCommand>& job_commands();

}  // namespace excavplan::tools
