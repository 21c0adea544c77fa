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
  explicit TrialRecorder(const HiddenSite& site);
  ~TrialRecorder();
  TrialRecorder(TrialRecorder&&) noexcept;
  TrialRecorder& operator=(TrialRecorder&&) noexcept;

  /// For TrialOptions::each.
  void add(const TrialStep& at);
  const JobHistory& history() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace excavplan
