// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <utility>

#include <excavplan/job/site_job.hpp>

#include "calls.hpp"

namespace excavplan::python {

/// A job that threads of Python share: one after the other, without the lock of the interpreter.
class JobInPython : public JobPlanner {
 public:
  JobInPython(JobSettings settings, SiteJob job)
      : settings_(std::move(settings)), job_(std::move(job)) {}

  JobStep next() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return job_.next();
  }
  void done(long long step, const StepReport& report) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    job_.done(step, report);
  }
  template <typename Work>
  auto with(const Work& work) -> decltype(work(std::declval<SiteJob&>())) {
    return call([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return work(job_);
    });
  }
  const JobSettings& settings() const { return settings_; }

 private:
  std::mutex mutex_;
  JobSettings settings_;
  SiteJob job_;
};

}  // namespace excavplan::python
