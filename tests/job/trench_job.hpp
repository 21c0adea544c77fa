// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/job/job_order.hpp>
#include <excavplan/job/site_job.hpp>
#include <excavplan/trial/true_site.hpp>

#include "support/plain_site_folder.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {

/// The job of a plain site and its true ground, which is known to the planner but for its errors.
class TrenchJob {
 public:
  /// @param cell  of the true ground [m]
  explicit TrenchJob(const PlainSiteFolder& site, double cell = 0.05)
      : hidden(site.read(cell)), truth(hidden, zx120()) {
    settings.site.soil = hidden.known.soil;
    settings.site.machine = zx120();
    settings.site.law =
        load_density_law(std::string(EXCAVPLAN_DATA_SOURCE) + "/laws/zx120-loam.json");
    settings.design = hidden.known.job;
    settings.surface = hidden.known.design;
    settings.density_percent = 40.0;
    first.files = {hidden.known.job.scan_file};
    first.z_is_up = true;
  }

  explicit TrenchJob(const PlainSiteFolder&&, double = 0.0) = delete;  // its files must stay

  SiteJob begin() const { return SiteJob::begin(path(), settings, first, trial_begin); }
  SiteJob resume() const { return SiteJob::resume(path(), settings); }
  std::string path() const { return folder_.file("job"); }
  std::string record() const { return content_of(path() + "/job.json"); }

  /// Does the present step on the true ground, and hands on what came of it.
  JobStep make_step(SiteJob& job) {
    const JobStep step = job.next();
    report = truth.execute(step).report;
    job.done(step.id, report);
    return step;
  }

  HiddenSite hidden;
  TrueSite truth;
  JobSettings settings;
  Scan first;
  StepReport report;  ///< of the last step

 private:
  TemporaryFolder folder_;
};

/// A short trench in loam of 40 %.
struct ShortTrench : PlainSiteFolder {
  ShortTrench() { site["design"]["length_m"] = 2.5; }
};

}  // namespace excavplan::test
