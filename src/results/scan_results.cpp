// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/scan_results.hpp"

#include <cmath>
#include <utility>

#include "base/json.hpp"

namespace excavplan {
namespace {

Json list_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

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

Json pose_json(const LevelPose& pose) {
  return {{"method", "level"},
          {"height_m", pose.height},
          {"tilt_rad", pose.tilt},
          {"residual_sd_m", pose.residual_sd},
          {"ground_share", pose.ground_share}};
}

Json pose_json(const PointPose& pose) {
  return {{"method", "points"}, {"residuals_m", pose.residuals}, {"residual_rms_m", pose.rms}};
}

const char* name(ScanMerge merge) {
  switch (merge) {
    case ScanMerge::single:
      return "single";
    case ScanMerge::averaged:
      return "averaged";
    case ScanMerge::joined:
      return "joined";
  }
  return "";
}

Json recorded_scan_json(const std::string& text, const RecordedScan& scan) {
  return {
      {"scan", text},
      {"messages", scan.messages},
      {"first_s", scan.first},
      {"last_s", scan.last},
      {"seen_at_s", scan.seen_at},
      {"merge", name(scan.merge)},
      {"frame", scan.frame},
      {"recorded_frame", scan.recorded_frame},
      {"frame_sd_m", scan.merge == ScanMerge::averaged ? finite_or_null(scan.frame_sd) : Json()}};
}

Json recording_json(const std::string& file, const RecordingContents& contents) {
  auto topics = Json::array();
  for (const RecordingTopic& topic : contents.topics) {
    topics.push_back({{"name", topic.name},
                      {"type", topic.type},
                      {"messages", topic.messages},
                      {"first_s", finite_or_null(topic.first)},
                      {"last_s", finite_or_null(topic.last)},
                      {"frame", topic.frame},
                      {"is_scan", topic.is_scan}});
  }
  return {{"file", file},
          {"start_s", contents.start},
          {"duration_s", contents.duration},
          {"topics", std::move(topics)},
          {"frames", contents.frames},
          {"cut_off", contents.is_cut_off},
          {"damaged_parts", contents.damaged_parts},
          {"first_damage", contents.first_damage},
          {"damage", contents.damage}};
}

}  // namespace excavplan
