// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/survey_results.hpp"

#include "base/json.hpp"

namespace excavplan {

Json forecast_json(const SurveyPlan& plan, const SurveyForecast& f, const SurveyNeeds& needs,
                   double target_sd_percent) {
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  return {{"sensor", plan.sensor.name},
          {"range_m", f.range},
          {"ray_spacing_m", f.ray_spacing},
          {"excavated_sd_m3", f.excavated_sd},
          {"after_sd_m3", f.after_sd},
          {"bulking_factor_sd", f.bulking_sd},
          {"density_sd_percent", f.density_sd_percent},
          {"datum_sd_m", f.datum_sd},
          {"variance_shares",
           {{"white", f.white_share},
            {"correlated", f.correlated_share},
            {"datum", f.datum_share},
            {"occlusion", f.occlusion_share}}},
          {"hidden_share", f.hidden_share},
          {"in_view", f.in_view},
          {"target_sd_percent", target_sd_percent},
          {"needs",
           {{"range_at_most_m", or_null(needs.range)},
            {"range_at_least_m", needs.nearest_range},
            {"frames_at_least", or_null(needs.frames)},
            {"noise_factor_at_most", or_null(needs.noise)}}}};
}

}  // namespace excavplan
