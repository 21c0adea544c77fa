// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/job_commands.hpp"

#include <algorithm>
#include <filesystem>

#include <excavplan/job/job_motion.hpp>
#include <excavplan/job/site_job.hpp>
#include <excavplan/logs/dig_log.hpp>
#include <excavplan/watch/job_view.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "inputs/site_folder.hpp"
#include "live/page_server.hpp"
#include "plan_site/estimate.hpp"
#include "plan_site/job_feed.hpp"
#include "plan_site/job_lines.hpp"
#include "report/job_report.hpp"
#include "results/plan_results.hpp"
#include "site/site_folder.hpp"
#include "soil/density_doubt.hpp"

namespace excavplan::tools {
namespace {

constexpr int finished_code = 10, stuck_code = 11;

SiteJob job_in(const std::string& folder) { return SiteJob::resume(folder, load_order(folder)); }

bool holds_job(const std::string& folder) { return std::filesystem::exists(folder + "/job.json"); }

void add_progress(const JobProgress& progress, Outcome& outcome) {
  outcome.json["progress"] = progress_json(progress);
  for (const std::string& line : progress_lines(progress)) outcome.lines.push_back(line);
}

/// What became of a scan.
void add_scan(const ScanReport& report, const SiteJob& job, Outcome& outcome) {
  outcome.json["recordings"] = report.recordings;
  outcome.lines.insert(outcome.lines.end(), report.lines.begin(), report.lines.end());
  for (const Warning& each : job.scan_warnings()) outcome.warnings.push_back(each);
  outcome.json["scan_taken"] =
      std::none_of(outcome.warnings.begin(), outcome.warnings.end(),
                   [](const Warning& each) { return each.code == WarningCode::scan_not_taken; });
}

Outcome work_new(const JobInputs& inputs, Console& console) {
  OrderInputs told = inputs.order;
  told.base = inputs.base;
  const Order order = order_of(told, inputs.scan);
  require_job_settings(order.settings);
  const SiteFolder ordering(inputs.folder, true, "order.lock");
  if (holds_job(inputs.folder)) {
    usage_error(inputs.folder + ": holds a job already: go on with it, or take another folder");
  }
  console.progress(0.0, "reading the scan");
  save_order(inputs.folder, order.settings, order.files);
  const JobSettings kept = load_order(inputs.folder);
  const SiteJob job = SiteJob::begin(inputs.folder, kept, order.first.scan, order.first.time);
  Outcome outcome;
  outcome.lines.push_back("job          " + inputs.folder + ", design '" + kept.surface.name + "'");
  add_scan(order.first.report, job, outcome);
  add_progress(job.progress(), outcome);
  if (const auto doubt = doubt_of_density(kept.density_percent)) outcome.warnings.push_back(*doubt);
  for (const auto& warnings : {job.design_warnings(), job.wall_warnings()})
    outcome.warnings.insert(outcome.warnings.end(), warnings.begin(), warnings.end());
  outcome.json["trustworthy"] = true;  // unless a warning ends it
  for (const std::string& note : order.settings.surface.notes) console.note("design: " + note);
  return outcome;
}

/// Writes the motion of a step into the folder of its job.
void add_motion(const std::string& folder, const SiteJob& job, JobStep& step, Outcome& outcome) {
  outcome.json["trajectory"] = nullptr;
  if (!step.moves_front()) return;
  auto motion = motion_of(load_order(folder), job.ground(), step);
  if (const auto* blocked = std::get_if<BlockedWay>(&motion)) {
    step.warnings.emplace_back(
        WarningCode::no_motion,
        "the step has no motion: something is in the way: " + blocked->message);
  } else {
    const Trajectory& timed = std::get<Trajectory>(motion);
    const std::string file = folder + "/motion-" + std::to_string(step.id) + ".csv";
    write_own_file(file, to_csv(timed));
    outcome.json["trajectory"] = file;
  }
  if (any_ends_trust(step.warnings)) step.trustworthy = false;
}

Outcome work_next(const JobInputs& inputs, Console& /*console*/) {
  SiteJob job = job_in(inputs.folder);
  JobStep step = job.next();
  Outcome outcome;
  add_motion(inputs.folder, job, step, outcome);
  const nlohmann::ordered_json trajectory = outcome.json["trajectory"];
  outcome.json = job_step_json(step);
  outcome.json["trajectory"] = trajectory;
  outcome.lines = step_lines(step);
  if (trajectory.is_string()) {
    outcome.lines.push_back("trajectory   " + trajectory.get<std::string>());
  }
  outcome.warnings = step.warnings;
  outcome.trustworthy = step.trustworthy;
  if (step.what == JobAction::stop) {
    outcome.exit_code = step.ends_finished() ? finished_code : stuck_code;
  }
  return outcome;
}

/// Work of the joints in a log of a whole cycle [J].
double work_in(const std::string& file, const Machine& machine) {
  DigLogSource source;
  source.file = file;
  source.pistons = piston_areas(machine);
  const DigLog log = read_dig_log(source);
  if (!log.of_joints) usage_error("--loads: " + file + " is no log of the joints");
  return log.integral(log.whole);
}

StepReport report_of(const JobInputs& inputs, const std::optional<TimedScan>& scan) {
  StepReport report;
  report.time = scan ? scan->time : time_of(inputs.scan.time, {});
  if (scan) report.scan = scan->scan;
  report.payload_mass = inputs.payload_mass;
  if (inputs.energy) report.joint_work = *inputs.energy;
  if (inputs.loads) {
    if (inputs.energy)
      usage_error("--loads excludes --energy-kj: both tell the work of the joints");
    report.joint_work = work_in(*inputs.loads, load_order(inputs.folder).site.machine);
  }
  report.stalled = inputs.stalled;
  return report;
}

Outcome work_done(const JobInputs& inputs, Console& /*console*/) {
  if (!inputs.step) usage_error("--step is missing: the step that was done, as next names it");
  SiteJob job = job_in(inputs.folder);
  std::optional<TimedScan> scan;
  if (inputs.scan.scan) scan = scan_of(inputs.scan);
  StepReport report = report_of(inputs, scan);
  const JobStep present = job.present() ? *job.present() : JobStep();
  if (inputs.base) {
    report.base = parse_base(*inputs.base);
    report.base->z = present.base.z;
  }
  Outcome outcome;
  const bool is_present = present.id == *inputs.step && present.what != JobAction::stop;
  outcome.json = {{"step", *inputs.step}, {"taken", is_present}};
  if (is_present && present.what == JobAction::scan && !report.scan) {
    usage_error("--scan is missing: step " + std::to_string(present.id) + " is a scan");
  }
  if (is_present) {
    job.done(present.id, report);
    if (scan) add_scan(scan->report, job, outcome);
  } else {
    const std::string what = "step         " + std::to_string(*inputs.step);
    const bool is_end = present.what == JobAction::stop && present.id == *inputs.step;
    const std::string which = present.id == 0 ? "" : ", which is " + std::to_string(present.id);
    outcome.lines.push_back(
        what + (is_end ? " is the end of the job" : " is not the present one" + which) +
        ": nothing is changed");
  }
  add_progress(job.progress(), outcome);
  return outcome;
}

Outcome work_scan(const JobInputs& inputs, Console& /*console*/) {
  SiteJob job = job_in(inputs.folder);
  const TimedScan scan = scan_of(inputs.scan);
  job.look(scan.scan, scan.time);
  Outcome outcome;
  add_scan(scan.report, job, outcome);
  add_progress(job.progress(), outcome);
  return outcome;
}

/// Shows a job in a browser while it goes on, until the tool is to stop.
Outcome work_serve(const JobInputs& inputs, Console& console) {
  if (inputs.report) usage_error("--serve excludes --report: the page is in the browser");
  const ServeAddress address = parse_serve(*inputs.serve);
  JobFeed feed(inputs.folder);
  console.let_stop();
  serve(feed, address,
        {[&] { return console.stop_requested(); },
         [&](const std::string& url) { console.note("the job is shown at " + url); }});
  Outcome outcome;
  add_progress(feed.job().progress(), outcome);
  return outcome;
}

Outcome work_show(const JobInputs& inputs, Console& console) {
  if (inputs.serve) return work_serve(inputs, console);
  const JobView job(inputs.folder, load_order(inputs.folder));
  Outcome outcome;
  add_progress(job.progress(), outcome);
  if (inputs.report) {
    const ReportJob drawn = {job.history(), job.settings().site.machine};
    outcome.page = page_of(progress_report(job.progress(), drawn), *inputs.report);
  }
  return outcome;
}

Outcome work_undo(const JobInputs& inputs, Console& /*console*/) {
  SiteJob job = job_in(inputs.folder);
  job.undo();
  Outcome outcome;
  outcome.json["step"] = job.next().id;
  add_progress(job.progress(), outcome);
  return outcome;
}

}  // namespace

const std::vector<JobCommand>& job_commands() {
  static const std::vector<JobCommand> rows = {
      {"new", work_new},   {"next", work_next}, {"done", work_done},        {"scan", work_scan},
      {"show", work_show}, {"undo", work_undo}, {"estimate", work_estimate}};
  return rows;
}

}  // namespace excavplan::tools
