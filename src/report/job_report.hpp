// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/job/job_progress.hpp>
#include <excavplan/trial/job_trial.hpp>

#include "report/report.hpp"

/// @file
/// The pages about whole jobs, without file.

namespace excavplan {

std::string title_of(const JobDesign& design);

/// A job that was played against hidden truth.
Report trial_report(const JobTrial& trial, ReportJob job);

/// A job before its first bucket: a sheet to print, without ground.
Report estimate_report(const JobEstimate& estimate, const std::optional<JobCost>& cost,
                       const EstimatedJob& job);

/// A job as far as it has come.
Report progress_report(const JobProgress& progress, ReportJob job);

}  // namespace excavplan
