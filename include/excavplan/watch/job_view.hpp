// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <excavplan/base/measured.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_history.hpp>
#include <excavplan/job/job_progress.hpp>
#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>

namespace excavplan {

/// What a job believes by what came of its steps: factors on what is simulated.
struct JobBelief {
  Measured strength;     ///< of the soil [-]
  Measured payload;      ///< of a dig [-]
  Measured energy;       ///< of a dig [-]
  Measured height_bias;  ///< of the edge over where it should be [m]
};

/// A job as one sees it who has no part in it: it takes no lock and changes nothing, while another
/// process goes on with the job in its folder.
class JobView {
 public:
  /// @param settings  of the job, as load_order() of the folder
  /// @throws Error (bad_file) if there is no job or a file of it is damaged; (bad_input) as
  /// require_job_settings()
  JobView(const std::string& folder, JobSettings settings);
  ~JobView();
  JobView(JobView&&) noexcept;             ///< the other may only be destroyed then
  JobView& operator=(JobView&&) noexcept;  ///< the same

  /// Reads what was done since. @return whether anything was
  /// @throws Error (bad_file) as the constructor; the view is as it was then
  bool refresh();

  const JobSettings& settings() const;  ///< as given
  const JobHistory& history() const;    ///< as SiteJob::history()
  /// How often steps were taken back, so that the history is not the one before with more events.
  int rewritten() const;
  const JobProgress& progress() const;  ///< as SiteJob::progress()
  const Terrain& ground() const;        ///< as SiteJob::ground()
  JobBelief belief() const;             ///< what the job has learnt
  /// That is planned and not done yet.
  const std::optional<JobStep>& present() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace excavplan
