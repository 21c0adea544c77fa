// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/job/job_progress.hpp>
#include <excavplan/job/job_step.hpp>

#include "job/job_ground.hpp"
#include "job/job_learning.hpp"
#include "job/lane_view.hpp"
#include "scans/sensor_look.hpp"

/// @file
/// What a job remembers beside its ground, and its file. Private to the project.

namespace excavplan {

struct JobRecord {
  std::size_t station = 0;            ///< where the machine works now
  BasePose base;                      ///< where it stands
  double off_place = 0.0;             ///< from where it was sent [m]
  bool is_sent_again = false;         ///< to its present station, which it missed
  int moves_to_dump = 0;              ///< in succession without a dig, as soil had no place
  bool lacks_dump = false;            ///< so many that the soil was given up
  long long last_step = 0;            ///< number of the step that was made last
  std::optional<JobStep> present;     ///< that is not done yet
  std::optional<PlannedDig> planned;  ///< of it, if it is a dig
  DigSigns signs;                     ///< likewise
  std::vector<JobStep> unseen;        ///< digs since the last scan
  long long site_updates = 0;         ///< scans that the site had taken in
  long long grounds = 0;              ///< that were written, one after each scan, taken or not
  double deepest_cut = 0.5;           ///< of one dig [m]; less after a stall
  bool has_arrived = false;           ///< at its present station
  bool wants_scan = false;            ///< before the next dig
  int scans_not_taken = 0;            ///< in succession
  int passes_here = 0;                ///< along the floor from this station
  int bench = 0;                      ///< layer of a wide design that is dug from this station
  int fruitless_digs = 0;             ///< digs for volume in succession that lifted little
  int fruitless = 0;                  ///< finishing passes in succession that lifted little
  std::vector<DigStart> barren;  ///< digs from this station that lifted hardly any, or were blocked
  std::vector<SensorLook> looks;  ///< of the last scan that told its sensor
  double seen_before_look = 0.0;  ///< share of the design, when it last went to look
  std::optional<CarriedLoad> carried;
  FrontJoints rests_at = FrontJoints::Zero();  ///< of the front after the present step [rad]
  double truck_load = 0.0;                     ///< in the present truck [kg]
  int trucks = 1;                              ///< so far
  JobLearning learning;
  JobProgress progress;  ///< what is counted; what is measured of the ground is left out
};

/// @throws Error (bad_file) if it cannot be written
void save_record(const std::string& folder, const JobRecord& record);
/// @throws Error (bad_file) naming file, key, value and rule
JobRecord load_record(const std::string& folder);
bool holds_record(const std::string& folder);

/// That of before the last change, for SiteJob::undo().
void save_earlier_record(const std::string& folder, const JobRecord& record);
/// @throws Error (bad_input) if there is none
JobRecord earlier_record(const std::string& folder);
/// Makes the earlier record the present one.
void go_to_earlier(const std::string& folder, const JobRecord& earlier);
/// The error (bad_input) of SiteJob::undo().
[[noreturn]] void refuse_undo(const std::string& folder);

}  // namespace excavplan
