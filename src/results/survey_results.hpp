// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/sensing/survey_plan.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// What a survey is expected to measure, and what it needs for an error of the density of so much.
Json forecast_json(const SurveyPlan& plan, const SurveyForecast& forecast, const SurveyNeeds& needs,
                   double target_sd_percent);

}  // namespace excavplan
