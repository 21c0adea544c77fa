// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>

#include <excavplan/base/data_files.hpp>
#include <excavplan/belief/belief_file.hpp>
#include <excavplan/results/result_json.hpp>

#include "bad_files/bad_file.hpp"
#include "base/json.hpp"
#include "fuzz/file_readers.hpp"
#include "job/job_log.hpp"
#include "job/job_record.hpp"
#include "machine/data_sheet_keys.hpp"
#include "site/site_manifest.hpp"
#include "site/stored_belief.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

JobStep dig_step() {
  JobStep step;
  step.id = 3;
  step.what = JobAction::dig;
  step.dump = {-1.0, 2.5, 2.25};
  step.path.approach.resize(1);
  step.path.poses = {{DigPhase::penetrate, {5.5, -0.25, 0.5}, {-0.5, 1.5, 0.25}}};
  step.predicted = {90.0, 1.5e5, 11.5, {60.0, 135.0}, {1e5, 2e5}};
  step.warnings = {{WarningCode::may_stall, "may stall", false}};
  return step;
}

std::string record_with(const std::function<void(JobRecord&)>& change) {
  const TemporaryFolder folder;
  JobRecord record;
  record.learning.datum.scans = 1;
  record.last_step = 3;
  change(record);
  save_record(folder.file(""), record);
  return content_of_file(folder.file(job_file));
}

std::string fresh_record() {
  return record_with([](JobRecord&) {});
}

std::string record_of_dig() {
  return record_with([](JobRecord& record) {
    record.present = dig_step();
    record.planned = PlannedDig{};
    record.unseen = {dig_step()};
    record.barren = {{0.125, 5.5, 0.25, true}};
    record.looks = usual_looks();
    record.carried = CarriedLoad{0.25, {0.0, 0.5, -0.5, 0.25}};
    record.present->carried = record.carried;
    record.off_place = 0.125;
    record.grounds = record.moves_to_dump = record.scans_not_taken = 1;
    record.is_sent_again = record.lacks_dump = true;
  });
}

/// A move, and two digs with the ground after them, of which the last is seen.
std::string job_log() {
  const TemporaryFolder folder;
  const JobHistory start = job_on_flat_ground();
  JobLog log(folder.file(""), start);
  log.begin();
  JobHistory::Ground ground = start.ground(0);
  JobRecord record;
  const auto add = [&](JobEvent event) {
    event.step = ++record.last_step;
    event.at = 30.0 * static_cast<double>(event.step);
    log.append(std::move(event), ground, record);
  };
  JobEvent move;
  move.what = JobAction::move;
  add(move);
  JobEvent dig = event_of(dig_step(), {});
  ground.surface.z.block(1, 2, 2, 3) -= 0.25;
  add(dig);
  dig.what = JobAction::finish;
  dig.truck = 1;
  dig.energy = 2e5;
  dig.payload_mass = 500.0;
  dig.scanned = true;
  ground.surface.z.block(1, 2, 2, 3) -= 0.125;
  ground.seen_at.block(0, 0, 3, 4) = 90.0;
  record.progress.scans = 1;
  add(dig);
  return content_of_file(folder.file("job-log.jsonl"));
}

DensityBelief belief() {
  const ResistanceLaw law = {50.0, 0.02, 0.75};
  DigEvidence dig;
  dig.bank = {{{1.0, 0.25, 0.25}, 0.25}};
  dig.survey = SurveyReading{45.0, 5.0, {{1, 3.0}}};
  dig.payload_percent = Measured{44.0, 8.0};
  dig.resistance = {{0.125, 0.25, law}};
  dig.limits = {{true, 0.125, 0.25, law}};
  return DensityBelief({}, {dig, dig}, dig);
}

std::string manifest() {
  const StoredFile file = {"ground-1.tif", "a87aa188a0c63b3c"};
  SiteManifest site = {1, 1, "loam", "zx120", "zx120-loam", "quarry", 0.05};
  site.ground = site.first = site.belief = site.previous = file;
  site.latest = {{"92dd5b4e19b2194a", 1.0, true}};
  return manifest_text(site);
}

/// With every figure, each of a machine that may be.
std::string data_sheet() {
  DataSheet sheet;
  for (const DataSheetKey& each : data_sheet_keys()) {
    sheet.*each.figure = std::sqrt(each.lowest * each.highest);
  }
  nlohmann::json json = data_sheet_json(sheet);
  json["name"] = "digger";
  return json.dump(1) + "\n";
}

std::string stated_plan() {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  const GroundDensity density = {40.0};
  return to_json(plan_dig(machine, soil, density), density, dig_goals().front().goal);
}

}  // namespace

std::vector<std::string> valid_job_files(const std::string& format) {
  if (format == "job_record") return {fresh_record(), record_of_dig()};
  if (format == "job_log") return {job_log()};
  if (format == "belief") return {to_json(belief())};
  if (format == "stored_belief") return {belief_text(belief())};
  if (format == "site_manifest") return {manifest()};
  if (format == "data_sheet") return {data_sheet()};
  if (format == "stated_dig") {
    const std::string plan = stated_plan();
    return {plan, R"({"tool":"simulate-dig","stalled":true,)" + plan.substr(1)};
  }
  throw std::out_of_range("no valid file of " + format);
}

}  // namespace excavplan::test
