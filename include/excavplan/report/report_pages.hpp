// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/job/job_history.hpp>
#include <excavplan/job/job_progress.hpp>
#include <excavplan/planning/rehearsal.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/trial/job_trial.hpp>

/// @file
/// Results as pages of HTML, as the tools write them with --report (docs/report.md): each has all
/// that it needs inside and loads nothing. Equal results give equal bytes.
///
/// All of them @throws Error (bad_file) if the data of the pages cannot be read.

namespace excavplan {

/// What was measured of a dig.
std::string report_page(const DensityEstimate& estimate);

/// A simulated dig. @param scene  with the history of its dig
std::string report_page(const Machine& machine, const DigScene& scene);

/// A plan, simulated once more if it has a dig. @param objective  that it was searched for
/// @throws Error as rehearse()
std::string report_page(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                        const GroundDensity& density, const DigObjective& objective);

/// A job before its first bucket, a sheet to print.
std::string report_page(const JobEstimate& estimate, const JobOutline& job,
                        const std::optional<JobCost>& cost, const EstimatedJob& about);

/// A job as far as it has come.
std::string report_page(const JobProgress& progress, const JobHistory& history,
                        const Machine& machine);

/// A job that was played. @param history  of its TrialRecorder
std::string report_page(const JobTrial& trial, const JobHistory& history, const Machine& machine);

}  // namespace excavplan
