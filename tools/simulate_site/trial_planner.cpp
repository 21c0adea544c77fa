// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_site/trial_planner.hpp"

#include <filesystem>
#include <random>

#include <excavplan/job/site_job.hpp>
#include <excavplan/trial/job_score.hpp>
#include <excavplan/trial/plain_planners.hpp>
#include <excavplan/trial/true_site.hpp>

#include "inputs/named_kinds.hpp"

namespace excavplan::tools {
namespace {

/// A folder that goes when the object does.
class PassingFolder {
 public:
  PassingFolder() {
    std::random_device random;
    path_ = std::filesystem::temp_directory_path() /
            ("simulate-site-" + std::to_string(random()) + std::to_string(random()));
    std::filesystem::create_directory(path_);
  }
  ~PassingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  std::string job() const { return (path_ / "job").string(); }

 private:
  std::filesystem::path path_;
};

/// The job that the program itself would plan.
class OwnPlanner : public JobPlanner {
 public:
  OwnPlanner(const JobSettings& settings, const Scan& first)
      : job_(SiteJob::begin(folder_.job(), settings, first, trial_begin)) {}
  JobStep next() override { return job_.next(); }
  void done(long long step, const StepReport& report) override { job_.done(step, report); }

 private:
  PassingFolder folder_;
  SiteJob job_;
};

}  // namespace

std::vector<std::string> planner_words() {
  std::vector<std::string> words = {"default", "known"};
  for (const PlainPolicy& policy : plain_policies()) words.push_back(policy.word);
  return words;
}

std::unique_ptr<JobPlanner> planner_of(const std::string& word, const HiddenSite& site,
                                       const Machine& machine) {
  for (const PlainPolicy& policy : plain_policies()) {
    if (policy.word == word) return plain_planner(policy, site.known, site.first_scan, machine);
  }
  const bool knows = word == "known";
  const SoilKind& soil = site.known.soil;
  const std::string law = law_path(site.known.machine, machine, soil.name);
  JobSettings settings = settings_of(site.known, machine, law_in(law, soil));
  if (knows) {
    settings.site.soil = site.soil;
    settings.density_percent = mean_density(site);
  }
  return std::make_unique<OwnPlanner>(settings, first_scan(settings.design));
}

}  // namespace excavplan::tools
