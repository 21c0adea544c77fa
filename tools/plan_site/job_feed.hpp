// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/watch/job_view.hpp>

#include "live/live_feed.hpp"
#include "report/report.hpp"
#include "report/report_job.hpp"

namespace excavplan::tools {

/// The page of a job that another process goes on with.
class JobFeed : public LiveFeed {
 public:
  /// @throws Error (bad_file) as load_order() and JobView()
  explicit JobFeed(const std::string& folder);

  void refresh() override;
  std::string page(const std::string& stream) override;
  int edition() const override { return edition_; }
  std::size_t steps() const override { return steps_.size(); }
  const std::string& step(std::size_t i) const override { return steps_[i]; }
  int state_version() const override { return state_version_; }
  const std::string& state() const override { return state_; }

  const JobView& job() const { return view_; }

 private:
  void begin_edition();
  void take_steps();
  void take_state();
  ReportedRun run() const;
  Report report() const;

  JobView view_;
  int rewritten_ = 0;  ///< JobView::rewritten() of the edition
  std::optional<JobRecorder> played_;
  std::optional<StepCoder> coder_;
  std::vector<std::string> steps_;
  std::string state_;
  std::string fault_;  ///< of the last refresh(); empty without one
  int edition_ = 0, state_version_ = 0;
};

}  // namespace excavplan::tools
