// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <excavplan/job/job_motion.hpp>
#include <excavplan/job/site_job.hpp>
#include <excavplan/logs/dig_log.hpp>
#include <excavplan/site/site.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "frame/tool.hpp"
#include "plan_site/job_lines.hpp"
#include "plan_site/order_inputs.hpp"
#include "results/job_results.hpp"

namespace excavplan::tools {
namespace {

constexpr int finished_code = 10, stuck_code = 11;

const About about = {
    "plan-site",
    "plans a whole job, from a design and a scan to finished ground, step by step. COMMAND is new "
    "(begins a job in FOLDER), next (the step to do now, the same until it is done), done (what "
    "became of it), scan (takes in a scan that no step asked for), show (how far the job is) or "
    "undo (takes the last done or scan back). FOLDER holds all that the job knows.",
    {{"plan-site new job --trench 15x1x0.5 --from 3,0 --heading 0 --scan scan.tif --soil loam "
      "--windrow 2,1.5,18,1.5,18,5,2,5",
      "a trench from 3 m before the machine, its soil to the left"},
     {"plan-site next job --json", "the next dig, move or scan, with the file of its trajectory"},
     {"plan-site done job --step 7 --payload-mass 540 --energy-kj 160 --scan after.tif",
      "it was done, and this is the ground now"}},
    true,
    false,
    "10 next: the job is finished; 11 next: it is stuck, or nothing is safe"};

struct Inputs {
  std::string command, folder;
  OrderInputs order;
  SiteScanInputs scan;
  std::optional<int> step;
  std::optional<double> payload_mass, energy;
  std::optional<std::string> loads, base;
  bool stalled = false;
};

using Work = Outcome (*)(const Inputs&, Console&);

void declare(Arguments& arguments, Inputs& inputs);

Scan told_scan(const Inputs& inputs) { return scan_of(inputs.scan); }

SiteJob job_in(const std::string& folder) { return SiteJob::resume(folder, load_order(folder)); }

bool holds_job(const std::string& folder) { return std::filesystem::exists(folder + "/job.json"); }

/// Of a job that was ordered and, as its process was killed, not begun.
void forget_scan(const std::string& folder, const JobSettings& settings) {
  excavplan::Site site(folder, settings.site, SiteAccess::write);
  if (!site.is_empty()) site.undo();
}

void add_progress(const SiteJob& job, Outcome& outcome) {
  const JobProgress progress = job.progress();
  outcome.json["progress"] = progress_json(progress);
  for (const std::string& line : progress_lines(progress)) outcome.lines.push_back(line);
}

void add_scan_warnings(const SiteJob& job, Outcome& outcome) {
  for (const Warning& each : job.scan_warnings()) outcome.warnings.push_back(each);
  outcome.json["scan_taken"] =
      std::none_of(outcome.warnings.begin(), outcome.warnings.end(),
                   [](const Warning& each) { return each.code == WarningCode::scan_not_taken; });
}

Outcome work_new(const Inputs& inputs, Console& console) {
  OrderInputs told = inputs.order;
  told.base = inputs.base;
  const Order order = order_of(told, inputs.scan);
  if (holds_job(inputs.folder)) {
    usage_error(inputs.folder + ": holds a job already: go on with it, or take another folder");
  }
  console.progress(0.0, "reading the scan");
  const bool was_begun = std::filesystem::exists(inputs.folder + "/order.json");
  save_order(inputs.folder, order.settings, order.files);
  const JobSettings kept = load_order(inputs.folder);
  if (was_begun) forget_scan(inputs.folder, kept);
  SiteJob job = SiteJob::begin(inputs.folder, kept, order.first, time_of(inputs.scan));
  Outcome outcome;
  outcome.lines.push_back("job          " + inputs.folder + ", design '" + kept.surface.name + "'");
  add_progress(job, outcome);
  for (const std::string& note : order.settings.surface.notes) console.note("design: " + note);
  return outcome;
}

/// Writes the motion of a dig into the folder of its job.
void add_motion(const std::string& folder, const SiteJob& job, JobStep& step, Outcome& outcome) {
  outcome.json["trajectory"] = nullptr;
  if (step.path.poses.empty()) return;
  auto motion = motion_of(load_order(folder), job.ground(), step);
  if (const auto* blocked = std::get_if<BlockedWay>(&motion)) {
    step.warnings.emplace_back(
        WarningCode::no_motion,
        "the step has no motion: something is in the way: " + blocked->message);
  } else {
    const Trajectory& timed = std::get<Trajectory>(motion);
    const std::string file = folder + "/motion-" + std::to_string(step.id) + ".csv";
    write_file(file, to_csv(timed));
    outcome.json["trajectory"] = file;
    step.warnings.insert(step.warnings.end(), timed.warnings.begin(), timed.warnings.end());
  }
  for (const Warning& each : step.warnings) {
    if (each.ends_trust) step.trustworthy = false;
  }
}

Outcome work_next(const Inputs& inputs, Console& /*console*/) {
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
    outcome.exit_code = step.reason == "finished" ? finished_code : stuck_code;
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

StepReport report_of(const Inputs& inputs) {
  StepReport report;
  report.time = time_of(inputs.scan);
  if (inputs.scan.scan) report.scan = told_scan(inputs);
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

Outcome work_done(const Inputs& inputs, Console& /*console*/) {
  if (!inputs.step) usage_error("--step is missing: the step that was done, as next names it");
  SiteJob job = job_in(inputs.folder);
  StepReport report = report_of(inputs);
  const JobStep present = job.next();
  if (inputs.base) {
    report.base = parse_base(*inputs.base);
    report.base->z = present.base.z;
  }
  Outcome outcome;
  const bool is_present = present.id == *inputs.step;
  outcome.json = {{"step", *inputs.step}, {"taken", is_present}};
  if (is_present && present.what == JobAction::scan && !report.scan) {
    usage_error("--scan is missing: step " + std::to_string(present.id) + " is a scan");
  }
  if (is_present) {
    job.done(present.id, report);
    if (report.scan) add_scan_warnings(job, outcome);
  } else {
    outcome.lines.push_back("step         " + std::to_string(*inputs.step) +
                            " is not the present one, " + std::to_string(present.id) +
                            ": nothing is changed");
  }
  add_progress(job, outcome);
  return outcome;
}

Outcome work_scan(const Inputs& inputs, Console& /*console*/) {
  SiteJob job = job_in(inputs.folder);
  job.look(told_scan(inputs), time_of(inputs.scan));
  Outcome outcome;
  add_scan_warnings(job, outcome);
  add_progress(job, outcome);
  return outcome;
}

Outcome work_show(const Inputs& inputs, Console& /*console*/) {
  const SiteJob job = job_in(inputs.folder);
  Outcome outcome;
  add_progress(job, outcome);
  return outcome;
}

Outcome work_undo(const Inputs& inputs, Console& /*console*/) {
  SiteJob job = job_in(inputs.folder);
  job.undo();
  Outcome outcome;
  outcome.json["step"] = job.next().id;
  add_progress(job, outcome);
  return outcome;
}

struct Command {
  const char* word;
  Work work;
};
constexpr Command commands[] = {{"new", work_new},   {"next", work_next}, {"done", work_done},
                                {"scan", work_scan}, {"show", work_show}, {"undo", work_undo}};

std::string command_words() {
  std::string words;
  for (const Command& each : commands) words += (words.empty() ? "" : "|") + std::string(each.word);
  return words;
}

void declare_words(Arguments& arguments, Inputs& inputs) {
  Arguments::Entry command;
  command.name = command.placeholder = "COMMAND";
  command.help = command_words();
  command.positional = command.required = true;
  command.assign = [&inputs](const std::string& text) {
    const bool is_known = std::any_of(std::begin(commands), std::end(commands),
                                      [&](const Command& each) { return text == each.word; });
    if (!is_known) usage_error("COMMAND: '" + text + "' is not one of " + command_words());
    inputs.command = text;
  };
  arguments.add(command);
  Arguments::Entry folder;
  folder.name = folder.placeholder = "FOLDER";
  folder.help = "folder of the job";
  folder.positional = folder.required = folder.place = true;
  folder.assign = [&inputs](const std::string& text) { inputs.folder = text; };
  arguments.add(folder);
}

void declare(Arguments& arguments, Inputs& inputs) {
  const auto is = [&inputs](const std::vector<std::string>& words) {
    return [&inputs, words] {
      return std::find(words.begin(), words.end(), inputs.command) != words.end();
    };
  };
  declare_words(arguments, inputs);
  arguments.only_if({is({"new"}), "it is of plan-site new"},
                    [&] { declare_order(arguments, inputs.order); });
  arguments.only_if({is({"new", "done", "scan"}), "this command takes no scan"},
                    [&] { declare_scan(arguments, inputs.scan); });
  arguments.only_if({is({"new", "done"}), "it is of plan-site new and done"}, [&] {
    arguments.text("base", "X,Y,HEADING", inputs.base,
                   "where the machine stands: of new when the job begins, in the heading in which "
                   "it works (default: before the trench); of done after a move, if not where it "
                   "was sent [m,m,rad]");
  });
  arguments.only_if({is({"done"}), "it is of plan-site done"}, [&] {
    arguments.option("step", inputs.step, "the step that was done, as next names it");
    arguments.option("payload-mass", inputs.payload_mass, Quantity::mass,
                     "that the dig lifted, by the scale");
    Arguments::Entry energy;
    energy.name = "energy-kj";
    energy.placeholder = "NUMBER";
    energy.help = "work of the joints over the whole cycle [kJ]";
    energy.assign = [&inputs](const std::string& text) {
      inputs.energy = 1000.0 * parse_quantity("--energy-kj", text, Quantity::ratio);
    };
    arguments.add(energy);
    arguments.file("loads", inputs.loads,
                   "instead a log of the joints over the whole cycle, CSV: torques and rates, "
                   "pressures and piston speeds, or powers");
    arguments.flag("stalled", inputs.stalled, "the machine could not finish the dig");
  });
}

Outcome work(const Inputs& inputs, Console& console) {
  for (const Command& each : commands) {
    if (inputs.command == each.word) return each.work(inputs, console);
  }
  return {};
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
