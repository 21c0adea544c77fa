// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/job/job_progress.hpp>
#include <excavplan/trial/job_trial.hpp>

#include "report/report.hpp"

/// @file
/// The pages about whole jobs, without file.

namespace excavplan::tools {

/// A job that was played against hidden truth.
Report trial_report(const JobTrial& trial, ReportJob job);

/// A job as far as it has come.
Report progress_report(const JobProgress& progress, ReportJob job);

}  // namespace excavplan::tools
