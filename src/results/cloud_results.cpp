// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/cloud_results.hpp"

#include "base/json.hpp"

namespace excavplan {
namespace {

Json list_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Json cloud_json(const CloudSummary& summary) {
  return {{"points", summary.points},
          {"width", summary.width},
          {"height", summary.height},
          {"finite_points", summary.finite_points},
          {"left_out_points", summary.left_out},
          {"centroid_m", list_of(summary.centroid)},
          {"min_m", list_of(summary.min)},
          {"max_m", list_of(summary.max)},
          {"density_per_m2", summary.density},
          {"frame_guess", summary.frame_guess}};
}

}  // namespace excavplan
