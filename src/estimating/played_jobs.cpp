// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/estimating/played_jobs.hpp>

#include "base/json.hpp"

namespace excavplan {
namespace {

constexpr double least_ratio = 0.1;  // of a job over its reference; ours
constexpr double most_ratio = 100.0;

PlayedJob read_job(JsonObject file) {
  PlayedJob job;
  job.soil = file.text("soil");
  job.density_percent = file.number("density_percent", 0.0, 100.0);
  job.digs = file.number("digs_over_reference", least_ratio, most_ratio);
  job.time = file.number("time_over_reference", least_ratio, most_ratio);
  job.energy = file.number("energy_over_reference", least_ratio, most_ratio);
  job.work = file.number("work_over_reference", least_ratio, most_ratio);
  file.done();
  return job;
}

}  // namespace

PlayedJobs load_played_jobs(const std::string& path) {
  constexpr double longest = 1e4;  // [m]
  JsonObject file = JsonObject::open(path, "excavplan-played-jobs");
  file.ignore("description");
  PlayedJobs played;
  played.machine = file.text("machine");
  played.length = file.number("length_m", 0.1, longest);
  played.width = file.number("width_m", 0.1, longest);
  played.depth = file.number("depth_m", 0.01, longest);
  for (JsonObject& job : file.objects("jobs")) played.jobs.push_back(read_job(job));
  if (played.jobs.size() < 2) file.fail("jobs", "must be two at least, for their spread");
  file.done();
  return played;
}

}  // namespace excavplan
