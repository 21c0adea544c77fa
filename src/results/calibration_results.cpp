// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/calibration_results.hpp"

#include "base/json.hpp"

namespace excavplan {
namespace {

Json difference_json(const BulkingDifference& difference) {
  return {{"density_percent", difference.largest.density_percent},
          {"bulking_factor_true", difference.largest.bulking_factor_true},
          {"bulking_factor_measured", difference.largest.bulking_factor_measured},
          {"fallback_fraction", difference.largest.fallback_fraction},
          {"density_points_percent", difference.density_points},
          {"unexplained", difference.unexplained}};
}

}  // namespace

Json calibration_json(const DensityCalibration& calibration) {
  Json json = parse_ordered_json("the law", to_json(calibration));
  json.erase("format");
  json.erase("version");
  if (const auto difference = bulking_difference(calibration)) {
    json["largest_difference"] = difference_json(*difference);
  }
  return json;
}

}  // namespace excavplan
