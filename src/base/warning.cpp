// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/warning.hpp>

#include <array>
#include <utility>

namespace excavplan {
namespace {

/// Of a result with a warning.
enum class Trust {
  kept,
  depends,  ///< on the case: where it is made
  ended,
};

struct CodeRow {
  WarningCode code;
  const char* text;
  Trust trust;
};

/// In the order of the codes.
constexpr std::array code_rows = {
    CodeRow{WarningCode::approach_blocked, "approach_blocked", Trust::kept},
    CodeRow{WarningCode::attribution_open, "attribution_open", Trust::depends},
    CodeRow{WarningCode::blocks, "blocks", Trust::ended},
    CodeRow{WarningCode::bucket_partly_unseen, "bucket_partly_unseen", Trust::ended},
    CodeRow{WarningCode::camera_frame, "camera_frame", Trust::kept},
    CodeRow{WarningCode::clocks_differ, "clocks_differ", Trust::ended},
    CodeRow{WarningCode::coarse_heights, "coarse_heights", Trust::ended},
    CodeRow{WarningCode::condition_failed, "condition_failed", Trust::kept},
    CodeRow{WarningCode::curved_ground, "curved_ground", Trust::ended},
    CodeRow{WarningCode::data_sheet_differs, "data_sheet_differs", Trust::ended},
    CodeRow{WarningCode::density_above_range, "density_above_range", Trust::depends},
    CodeRow{WarningCode::density_as_fraction, "density_as_fraction", Trust::ended},
    CodeRow{WarningCode::density_below_range, "density_below_range", Trust::depends},
    CodeRow{WarningCode::density_from_elsewhere, "density_from_elsewhere", Trust::ended},
    CodeRow{WarningCode::density_not_trustworthy, "density_not_trustworthy", Trust::depends},
    CodeRow{WarningCode::density_of_unknown_soil, "density_of_unknown_soil", Trust::kept},
    CodeRow{WarningCode::dig_below_rest, "dig_below_rest", Trust::ended},
    CodeRow{WarningCode::drop_at_tracks, "drop_at_tracks", Trust::ended},
    CodeRow{WarningCode::dug_path_doubtful, "dug_path_doubtful", Trust::ended},
    CodeRow{WarningCode::dump_height_lowered, "dump_height_lowered", Trust::kept},
    CodeRow{WarningCode::dump_out_of_reach, "dump_out_of_reach", Trust::kept},
    CodeRow{WarningCode::earlier_soil, "earlier_soil", Trust::depends},
    CodeRow{WarningCode::early_points, "early_points", Trust::kept},
    CodeRow{WarningCode::fewer_scans, "fewer_scans", Trust::kept},
    CodeRow{WarningCode::flat_water, "flat_water", Trust::depends},
    CodeRow{WarningCode::floor_cut, "floor_cut", Trust::ended},
    CodeRow{WarningCode::force_beyond_stability, "force_beyond_stability", Trust::kept},
    CodeRow{WarningCode::foreign_plan, "foreign_plan", Trust::ended},
    CodeRow{WarningCode::frame, "frame", Trust::ended},
    CodeRow{WarningCode::frame_moved, "frame_moved", Trust::ended},
    CodeRow{WarningCode::gap_in_log, "gap_in_log", Trust::ended},
    CodeRow{WarningCode::grass, "grass", Trust::ended},
    CodeRow{WarningCode::ground_above_tracks, "ground_above_tracks", Trust::ended},
    CodeRow{WarningCode::ground_at_tracks_unseen, "ground_at_tracks_unseen", Trust::kept},
    CodeRow{WarningCode::ground_before_dig, "ground_before_dig", Trust::ended},
    CodeRow{WarningCode::ground_below_tracks, "ground_below_tracks", Trust::ended},
    CodeRow{WarningCode::ground_out_of_reach, "ground_out_of_reach", Trust::ended},
    CodeRow{WarningCode::ground_tilted, "ground_tilted", Trust::ended},
    CodeRow{WarningCode::ground_unlike_library, "ground_unlike_library", Trust::ended},
    CodeRow{WarningCode::hole_in_shadow, "hole_in_shadow", Trust::ended},
    CodeRow{WarningCode::idle_above_dig, "idle_above_dig", Trust::ended},
    CodeRow{WarningCode::idle_in_dig, "idle_in_dig", Trust::ended},
    CodeRow{WarningCode::implausible_energy, "implausible_energy", Trust::ended},
    CodeRow{WarningCode::implausible_fuel, "implausible_fuel", Trust::ended},
    CodeRow{WarningCode::law_of_other_machine, "law_of_other_machine", Trust::ended},
    CodeRow{WarningCode::law_of_other_path, "law_of_other_path", Trust::kept},
    CodeRow{WarningCode::law_of_other_soil, "law_of_other_soil", Trust::depends},
    CodeRow{WarningCode::level_ground, "level_ground", Trust::depends},
    CodeRow{WarningCode::library_unreadable, "library_unreadable", Trust::kept},
    CodeRow{WarningCode::little_stable_ground, "little_stable_ground", Trust::depends},
    CodeRow{WarningCode::loads_disagree, "loads_disagree", Trust::ended},
    CodeRow{WarningCode::loads_not_used, "loads_not_used", Trust::kept},
    CodeRow{WarningCode::looks_swapped, "looks_swapped", Trust::depends},
    CodeRow{WarningCode::machine_held_down, "machine_held_down", Trust::kept},
    CodeRow{WarningCode::machine_pose, "machine_pose", Trust::depends},
    CodeRow{WarningCode::many_buckets, "many_buckets", Trust::kept},
    CodeRow{WarningCode::map_not_written, "map_not_written", Trust::kept},
    CodeRow{WarningCode::may_stall, "may_stall", Trust::ended},
    CodeRow{WarningCode::min_fill_relaxed, "min_fill_relaxed", Trust::kept},
    CodeRow{WarningCode::motion_overload, "motion_overload", Trust::ended},
    CodeRow{WarningCode::motion_tips, "motion_tips", Trust::ended},
    CodeRow{WarningCode::no_blocks, "no_blocks", Trust::kept},
    CodeRow{WarningCode::no_body, "no_body", Trust::kept},
    CodeRow{WarningCode::no_cycle, "no_cycle", Trust::kept},
    CodeRow{WarningCode::no_dig, "no_dig", Trust::ended},
    CodeRow{WarningCode::no_dumped_soil, "no_dumped_soil", Trust::depends},
    CodeRow{WarningCode::no_finite_points, "no_finite_points", Trust::kept},
    CodeRow{WarningCode::no_hole_found, "no_hole_found", Trust::depends},
    CodeRow{WarningCode::no_library, "no_library", Trust::ended},
    CodeRow{WarningCode::no_motion, "no_motion", Trust::ended},
    CodeRow{WarningCode::not_averaged, "not_averaged", Trust::kept},
    CodeRow{WarningCode::not_in_view, "not_in_view", Trust::kept},
    CodeRow{WarningCode::not_stamped, "not_stamped", Trust::kept},
    CodeRow{WarningCode::not_standing, "not_standing", Trust::ended},
    CodeRow{WarningCode::object_on_soil, "object_on_soil", Trust::depends},
    CodeRow{WarningCode::object_taken_out, "object_taken_out", Trust::depends},
    CodeRow{WarningCode::obstacle_at_dump, "obstacle_at_dump", Trust::kept},
    CodeRow{WarningCode::obstacle_in_strip, "obstacle_in_strip", Trust::kept},
    CodeRow{WarningCode::optimum_at_bound, "optimum_at_bound", Trust::kept},
    CodeRow{WarningCode::options_ignored, "options_ignored", Trust::kept},
    CodeRow{WarningCode::other_change, "other_change", Trust::kept},
    CodeRow{WarningCode::outliers, "outliers", Trust::depends},
    CodeRow{WarningCode::payload_disagrees, "payload_disagrees", Trust::ended},
    CodeRow{WarningCode::payload_tips, "payload_tips", Trust::ended},
    CodeRow{WarningCode::plot_left_out, "plot_left_out", Trust::kept},
    CodeRow{WarningCode::plot_not_written, "plot_not_written", Trust::kept},
    CodeRow{WarningCode::posture_unknown, "posture_unknown", Trust::kept},
    CodeRow{WarningCode::previous_density, "previous_density", Trust::kept},
    CodeRow{WarningCode::prior_disagrees, "prior_disagrees", Trust::ended},
    CodeRow{WarningCode::prior_not_trustworthy, "prior_not_trustworthy", Trust::kept},
    CodeRow{WarningCode::recording_cut_off, "recording_cut_off", Trust::depends},
    CodeRow{WarningCode::registration_beyond_prior, "registration_beyond_prior", Trust::depends},
    CodeRow{WarningCode::repeated_run, "repeated_run", Trust::ended},
    CodeRow{WarningCode::scan_old, "scan_old", Trust::ended},
    CodeRow{WarningCode::scans_do_not_fit, "scans_do_not_fit", Trust::ended},
    CodeRow{WarningCode::search_stopped, "search_stopped", Trust::kept},
    CodeRow{WarningCode::sensor_place_doubtful, "sensor_place_doubtful", Trust::ended},
    CodeRow{WarningCode::sensor_place_inferred, "sensor_place_inferred", Trust::kept},
    CodeRow{WarningCode::simulator_failed, "simulator_failed", Trust::kept},
    CodeRow{WarningCode::slope_outside_library, "slope_outside_library", Trust::ended},
    CodeRow{WarningCode::soil_assumed, "soil_assumed", Trust::kept},
    CodeRow{WarningCode::soil_under_tracks, "soil_under_tracks", Trust::ended},
    CodeRow{WarningCode::sparse_terrain, "sparse_terrain", Trust::kept},
    CodeRow{WarningCode::stale_plan, "stale_plan", Trust::ended},
    CodeRow{WarningCode::stalled, "stalled", Trust::kept},
    CodeRow{WarningCode::start_left, "start_left", Trust::ended},
    CodeRow{WarningCode::stirred_ground, "stirred_ground", Trust::depends},
    CodeRow{WarningCode::surroundings_differ, "surroundings_differ", Trust::ended},
    CodeRow{WarningCode::systematic_errors, "systematic_errors", Trust::kept},
    CodeRow{WarningCode::tilted, "tilted", Trust::depends},
    CodeRow{WarningCode::too_wet, "too_wet", Trust::ended},
    CodeRow{WarningCode::two_surfaces, "two_surfaces", Trust::depends},
    CodeRow{WarningCode::units, "units", Trust::ended},
    CodeRow{WarningCode::unseen_ground, "unseen_ground", Trust::kept},
    CodeRow{WarningCode::unseen_way, "unseen_way", Trust::ended},
    CodeRow{WarningCode::urdf_angles, "urdf_angles", Trust::kept},
    CodeRow{WarningCode::urdf_frame, "urdf_frame", Trust::kept},
    CodeRow{WarningCode::urdf_placeholder, "urdf_placeholder", Trust::kept},
    CodeRow{WarningCode::urdf_scaled, "urdf_scaled", Trust::kept},
    CodeRow{WarningCode::volume_error_unknown, "volume_error_unknown", Trust::ended},
    CodeRow{WarningCode::zone_at_border, "zone_at_border", Trust::ended},
    CodeRow{WarningCode::zone_partly_unseen, "zone_partly_unseen", Trust::ended},
    CodeRow{WarningCode::zone_unseen, "zone_unseen", Trust::depends},
};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < code_rows.size(); ++i) {
    if (code_rows[i].code != static_cast<WarningCode>(i)) return false;
  }
  return true;
}
static_assert(is_in_order());

const CodeRow& row_of(WarningCode code) { return code_rows.at(static_cast<std::size_t>(code)); }

}  // namespace

std::string code_text(WarningCode code) { return row_of(code).text; }

Warning::Warning(WarningCode doubt, std::string text)
    : Warning(doubt, std::move(text), row_of(doubt).trust == Trust::ended) {}

Warning::Warning(WarningCode doubt, std::string text, bool is_end)
    : code(doubt), message(std::move(text)), ends_trust(is_end) {}

}  // namespace excavplan
