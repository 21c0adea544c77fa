// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/efficiency/run_comparison.hpp>
#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/job/site_job.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/recording/recording.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/sensing/survey_plan.hpp>
#include <excavplan/trial/job_trial.hpp>

/// @file
/// Results as one line of JSON, with the keys and units that the tools print with --json
/// (docs/formats.md) but for those of their options. What is not known (NaN) is null.
///
/// Laws, path libraries, trajectories and the answers of a dig cycle have a to_json() of their own,
/// beside their types.

namespace excavplan {

/// What estimate-density finds; stated_density() reads it again.
std::string to_json(const DensityEstimate& estimate);

/// What plan-path plans for a density. @param objective  that the dig was searched for
std::string to_json(const DigPlan& plan, const GroundDensity& density,
                    const DigObjective& objective);

/// What simulate-dig finds. @param scene  with the history of its dig
std::string to_json(const Machine& machine, const DigScene& scene);

/// What measure-efficiency finds in a run.
std::string to_json(const DigEfficiency& run);

/// What measure-efficiency finds between two sets of runs.
std::string to_json(const SetComparison& sets);

/// What inspect-cloud shows of a cloud.
std::string to_json(const CloudSummary& summary);

/// What inspect-cloud shows of a recording. @param file  its name
std::string to_json(const std::string& file, const RecordingContents& contents);

/// What plan-site asks of the machine, and how far its job has come.
std::string to_json(const JobStep& step);
/// As `plan-site show --json` prints it.
std::string to_json(const JobProgress& progress);

/// What simulate-site finds in a job that was played.
std::string to_json(const JobTrial& trial);

/// What plan-site estimates of a job.
std::string to_json(const JobEstimate& estimate, const JobOutline& job,
                    const std::optional<JobCost>& cost = {});

/// Volumes as estimate-density prints them.
std::string to_json(const VolumeChange& change);
/// A density, likewise.
std::string to_json(const RelativeDensity& density);

/// What a survey is expected to measure, and what it needs for an error of the density of so many
/// points.
std::string to_json(const SurveyPlan& plan, const SurveyForecast& forecast,
                    const SurveyNeeds& needs, double target_sd_percent);

}  // namespace excavplan
