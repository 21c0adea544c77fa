// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/experiment_results.hpp"

#include "base/text.hpp"
#include "shared/goal_inputs.hpp"
#include "shared/results.hpp"

namespace excavplan::tools {

nlohmann::ordered_json experiment_json(const std::string& condition,
                                       const ExperimentResult& result) {
  const HeightMapVolumes& volumes = result.volumes;
  return {{"name", condition},
          {"density_percent", result.density_percent},
          {"volume",
           {{"excavated_m3", volumes.excavated},
            {"spilled_m3", volumes.spilled},
            {"dumped_m3", volumes.dumped}}},
          {"bulking_factor", volumes.bulking_factor},
          {"density_estimated_percent", result.estimate.percent},
          {"fixed", dig_json(result.fixed)},
          {"planned", dig_json(result.planned)},
          {"gain_percent", result.gain_percent()},
          {"gain_path_percent", result.path_gain_percent()},
          {"gain_start_percent", result.start_gain_percent()},
          {"start_rule", describe(result.start_rule)},
          {"machine_held_down", !result.held_because.empty()}};
}

std::string experiment_line(const std::string& condition, const ExperimentResult& result) {
  return condition + ": density " + readable(result.density_percent) + " %, k " +
         readable(result.volumes.bulking_factor, 4) + ", estimated " +
         readable(result.estimate.percent) + " %; fixed " +
         worth_text(result.objective, result.objective.worth(result.fixed)) + ", planned " +
         worth_text(result.objective, result.objective.worth(result.planned)) + " (" +
         path_text(result.planned) + "), gain " + readable(result.gain_percent()) + " % (path " +
         readable(result.path_gain_percent()) + " %, start " +
         readable(result.start_gain_percent()) + " %)";
}

}  // namespace excavplan::tools
