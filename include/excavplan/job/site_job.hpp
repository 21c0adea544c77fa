// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_history.hpp>
#include <excavplan/job/job_progress.hpp>
#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>

/// @file
/// A job from its design to finished ground, step by step (docs/guide/job.md).

namespace excavplan {

/// Decides the steps of a job. All that it knows is in a folder, written at once after every step:
/// it goes on where it was after the process was killed. A change that cannot be written is none;
/// where not even what was there before can be restored, every other one is refused (bad_file).
///
/// The machine works backwards from the far end of the design. From each place it digs layers down
/// to the tolerance over the design, scans, and passes along the floor until the ground has the
/// shape of the design; then it moves on. Worth of a dig: volume of the design gained, less what is
/// dug too deep or spilled, per energy and priced time of its cycle.
class SiteJob : public JobPlanner {
 public:
  /// Begins a job in a folder that holds none.
  /// @param first  scan of the ground before the job, in the site's frame
  /// @param time  of it, since 1970-01-01 UTC [s]
  /// @throws Error (bad_input) as require_job_settings(), or if the folder holds a job; as
  /// Site::update(). Nothing is begun then
  static SiteJob begin(const std::string& folder, JobSettings settings, const Scan& first,
                       double time);
  /// Goes on with the job of a folder.
  /// @param settings  that it was begun with
  /// @throws Error (bad_file) if it holds none, or a file of it is damaged or not of this job;
  /// (bad_input) if the job cannot be of these settings
  static SiteJob resume(const std::string& folder, JobSettings settings);
  ~SiteJob() override;
  SiteJob(SiteJob&&) noexcept;             ///< the other may only be destroyed then
  SiteJob& operator=(SiteJob&&) noexcept;  ///< the same

  JobStep next() override;
  /// The step that next() gave last, if it is not done; also of an earlier process.
  std::optional<JobStep> present() const;
  /// @throws Error (bad_input) as require_report() and Site::update(); (bad_file) if it cannot be
  /// written. Nothing is changed then.
  void done(long long step, const StepReport& report) override;
  /// Takes in a scan that no step asked for. A step that is not done yet is then planned anew with
  /// a new number, but for a move.
  /// @param time  of it, since 1970-01-01 UTC [s] @throws Error as Site::update()
  void look(const Scan& scan, double time);
  /// Takes the last done() or look() back; of all of them the last is kept.
  /// @throws Error (bad_input) if there is none
  void undo();
  /// Of the last scan that this object took in, such as scan_not_taken.
  const std::vector<Warning>& scan_warnings() const;
  /// An unstable_wall, if a wall of the design would not stand in the soil as it is surely known,
  /// with the spoil that lies beside it; its message tells of the weakest one. A dig at such a wall
  /// has it among its warnings, with the load of the tracks.
  std::vector<Warning> wall_warnings() const;

  /// What of the design cannot be done or is not asked for rightly: design_above_ground,
  /// design_beyond_scan, design_out_of_reach, dump_on_design, wide_tolerance.
  std::vector<Warning> design_warnings() const;

  /// How far the job is, by the ground as it is expected.
  JobProgress progress() const;
  /// What was done so far, with the ground as expected after each step.
  const JobHistory& history() const;
  const Terrain& ground() const;  ///< as expected now: as scanned, and what was dug since

 private:
  struct State;
  explicit SiteJob(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace excavplan
