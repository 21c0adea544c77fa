// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan {

/// What a result is doubted for. Stable, for programs, which know each by the text of code_text();
/// docs/guide/warnings.md says what each means.
enum class WarningCode {
  approach_blocked,
  attribution_open,
  blocks,
  bucket_partly_unseen,
  camera_frame,
  clocks_differ,
  coarse_heights,
  condition_failed,
  curved_ground,
  data_sheet_differs,
  density_above_range,
  density_as_fraction,
  density_below_range,
  density_from_elsewhere,
  density_not_trustworthy,
  density_of_unknown_soil,
  dig_below_rest,
  dug_path_doubtful,
  dump_height_lowered,
  dump_out_of_reach,
  earlier_soil,
  early_points,
  fewer_scans,
  flat_water,
  floor_cut,
  force_beyond_stability,
  foreign_plan,
  frame,
  frame_moved,
  gap_in_log,
  grass,
  ground_above_tracks,
  ground_before_dig,
  ground_out_of_reach,
  ground_unlike_library,
  hole_in_shadow,
  idle_above_dig,
  idle_in_dig,
  implausible_energy,
  implausible_fuel,
  law_of_other_machine,
  law_of_other_path,
  law_of_other_soil,
  level_ground,
  library_unreadable,
  little_stable_ground,
  loads_disagree,
  loads_not_used,
  looks_swapped,
  machine_held_down,
  machine_pose,
  many_buckets,
  map_not_written,
  may_stall,
  min_fill_relaxed,
  motion_overload,
  motion_tips,
  no_blocks,
  no_body,
  no_cycle,
  no_dig,
  no_dumped_soil,
  no_finite_points,
  no_hole_found,
  no_library,
  no_motion,
  not_averaged,
  not_in_view,
  not_stamped,
  not_standing,
  object_on_soil,
  object_taken_out,
  obstacle_in_strip,
  optimum_at_bound,
  options_ignored,
  other_change,
  outliers,
  payload_disagrees,
  payload_tips,
  plot_left_out,
  plot_not_written,
  posture_unknown,
  previous_density,
  prior_disagrees,
  prior_not_trustworthy,
  recording_cut_off,
  registration_beyond_prior,
  repeated_run,
  scan_old,
  scans_do_not_fit,
  search_stopped,
  sensor_place_doubtful,
  sensor_place_inferred,
  simulator_failed,
  slope_outside_library,
  soil_assumed,
  sparse_terrain,
  stale_plan,
  stalled,
  start_left,
  stirred_ground,
  surroundings_differ,
  systematic_errors,
  tilted,
  too_wet,
  two_surfaces,
  units,
  unseen_ground,
  unseen_way,
  urdf_angles,
  urdf_frame,
  urdf_placeholder,
  urdf_scaled,
  volume_error_unknown,
  zone_at_border,
  zone_partly_unseen,
  zone_unseen,
};

/// What stands for a code in JSON and in messages: "density_above_range".
std::string code_text(WarningCode code);

/// A doubt about a result that is given all the same.
struct Warning {
  /// It ends trust if the code always does.
  Warning(WarningCode doubt, std::string text);
  /// For codes whose case decides whether they end trust.
  Warning(WarningCode doubt, std::string text, bool is_end);

  WarningCode code;     ///< what it is about
  std::string message;  ///< text: what was found, its value and its meaning
  bool ends_trust;      ///< true: a careful surveyor would not sign for the result
};

}  // namespace excavplan
