// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <excavplan/trial/job_reference.hpp>
#include <excavplan/trial/job_trial.hpp>

namespace excavplan {

/// The keys of simulate-site.
nlohmann::ordered_json trial_json(const JobTrial& trial);
/// R and B.
nlohmann::ordered_json reference_json(const JobReference& reference);

/// The lines of the log of a job (docs/formats.md#job-log) that a step gives, each with its end.
std::string log_lines(const TrialStep& at);
/// Its last line.
std::string log_end(const JobTrial& trial);

}  // namespace excavplan
