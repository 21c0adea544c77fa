// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <excavplan/belief/belief_file.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/data_sheet_file.hpp>
#include <excavplan/results/stated_dig.hpp>

#include "base/files.hpp"
#include "fuzz/file_readers.hpp"
#include "fuzz/fuzz_target.hpp"
#include "job/job_log.hpp"
#include "job/job_record.hpp"
#include "site/site_manifest.hpp"
#include "site/stored_belief.hpp"

namespace excavplan::test {
namespace {

/// A folder whose path begins with that of the file, which lies in it by another name.
std::string folder_with(const std::string& path, const char* name) {
  std::string folder = path + "-job";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(path, folder + '/' + name,
                             std::filesystem::copy_options::overwrite_existing);
  return folder;
}

std::string read_job_record(const std::string& path) {
  const JobRecord record = load_record(folder_with(path, job_file));
  require_that(record.learning.datum.scans > 0, "a record without a scan");
  return Said()
      .add("station", static_cast<double>(record.station))
      .add("scans", record.learning.datum.scans)
      .add("unseen", static_cast<double>(record.unseen.size()))
      .text();
}

/// By both ways to read it, which must agree.
std::string read_job_log(const std::string& path) {
  static const JobHistory start = job_on_flat_ground();
  const std::string folder = folder_with(path, "job-log.jsonl");
  JobRecord record;
  record.last_step = 1000000000000;
  record.progress.scans = 1000000000;
  JobLog followed(folder, start), resumed(folder, start);
  require_that(followed.follow(record), "a new reader finds what it read before");
  resumed.resume(record);
  const std::vector<JobEvent>& events = resumed.history().events;
  require_that(events.size() == followed.history().events.size(), "events differ in number");
  Said said;
  said.add("begin", resumed.history().begin);
  for (const JobEvent& event : events) said.add(name(event.what), event.left_volume);
  const JobHistory::Ground last = resumed.history().ground(events.size());
  return said.all("z", last.surface.z.reshaped()).all("seen", last.seen_at.reshaped()).text();
}

std::string text_of(const DensityBelief& belief) {
  const BelievedDensity density = belief.at({{0.5, 0.0, 0.2}, {30.0, 2.0, 1.0}});
  require_that(density.raw_percent.allFinite() && density.sd_percent.allFinite(),
               "a density is not finite");
  return to_json(belief);
}

std::string read_belief(const std::string& path) { return text_of(load_belief(path)); }

std::string read_stored_belief(const std::string& path) {
  return text_of(belief_of(path, read_file(path)));
}

std::string read_manifest(const std::string& path) {
  return manifest_text(manifest_of(path, read_file(path)));
}

std::string read_data_sheet(const std::string& path) {
  const NamedDataSheet read = load_data_sheet(path);
  return Said().add("name", read.name).add("mass", *read.sheet.operating_mass).text();
}

std::string read_stated_dig(const std::string& path) {
  const StatedDig dig = stated_dig(path);
  return Said().add("density", dig.density_percent).add("work", dig.joint_work).text();
}

}  // namespace

JobHistory job_on_flat_ground() {
  GroundState ground;
  ground.terrain = undisturbed(flat_ground({0.0, 0.0, 2.0, 1.5}, 0.25));
  JobDesign design;
  design.start = BasePose{};
  return history_start(design, ground.terrain.bank, ground, 1.0);
}

std::vector<FileReader> job_readers() {
  return {{"job_record", read_job_record, true},
          {"job_log", read_job_log},
          {"belief", read_belief},
          {"stored_belief", read_stored_belief, true},
          {"site_manifest", read_manifest, true},
          {"data_sheet", read_data_sheet},
          {"stated_dig", read_stated_dig}};
}

}  // namespace excavplan::test
