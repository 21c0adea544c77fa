// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <excavplan/job/job_history.hpp>
#include <excavplan/trial/job_trial.hpp>

namespace excavplan {

/// The history of a trial with its true ground, on cells of at least 5 cm (ours): means of those of
/// the truth. Volumes are those of the truth.
class TrialRecorder {
 public:
  /// Of a trial on that site.
  explicit TrialRecorder(const HiddenSite& site);
  ~TrialRecorder();
  TrialRecorder(TrialRecorder&&) noexcept;             ///< the other may only be destroyed then
  TrialRecorder& operator=(TrialRecorder&&) noexcept;  ///< the same

  /// For TrialOptions::each.
  void add(const TrialStep& at);
  /// Of all that was recorded.
  const JobHistory& history() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace excavplan
