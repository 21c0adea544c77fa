// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/results/result_json.hpp>

#include "base/json.hpp"
#include "results/density_results.hpp"
#include "results/efficiency_results.hpp"
#include "results/plan_results.hpp"
#include "results/scan_results.hpp"
#include "results/scene_results.hpp"
#include "results/survey_results.hpp"
#include "results/volume_results.hpp"
#include "trial/trial_json.hpp"

namespace excavplan {

std::string to_json(const DensityEstimate& estimate) {
  Json json = estimate_json(estimate);
  json.update(survey_json(estimate));
  return json_text(json);
}

std::string to_json(const DigPlan& plan, const GroundDensity& density,
                    const DigObjective& objective) {
  return json_text(plan_json(plan, density, objective));
}

std::string to_json(const Machine& machine, const DigScene& scene) {
  return json_text(scene_json(machine, scene));
}

std::string to_json(const DigEfficiency& run) { return json_text(run_json(run)); }

std::string to_json(const SetComparison& sets) { return json_text(comparison_json(sets)); }

std::string to_json(const CloudSummary& summary) { return json_text(cloud_json(summary)); }

std::string to_json(const std::string& file, const RecordingContents& contents) {
  return json_text(recording_json(file, contents));
}

std::string to_json(const JobStep& step) { return json_text(job_step_json(step)); }

std::string to_json(const JobProgress& progress) { return json_text(progress_json(progress)); }

std::string to_json(const JobTrial& trial) { return json_text(trial_json(trial)); }

std::string to_json(const JobEstimate& estimate, const JobOutline& job,
                    const std::optional<JobCost>& cost) {
  return json_text(job_estimate_json(estimate, job, cost));
}

std::string to_json(const VolumeChange& change) { return json_text(volumes_json(change)); }

std::string to_json(const RelativeDensity& density) { return json_text(density_json(density)); }

std::string to_json(const SurveyPlan& plan, const SurveyForecast& forecast,
                    const SurveyNeeds& needs, double target_sd_percent) {
  return json_text(forecast_json(plan, forecast, needs, target_sd_percent));
}

}  // namespace excavplan
