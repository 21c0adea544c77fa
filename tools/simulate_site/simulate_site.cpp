// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <excavplan/ground/map_files.hpp>
#include <excavplan/trial/trial_history.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "frame/console.hpp"
#include "frame/tool.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/simulator_inputs.hpp"
#include "report/job_report.hpp"
#include "simulate_site/trial_planner.hpp"
#include "trial/trial_json.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "simulate-site",
    "plays a whole job against hidden truth: a planner digs the ground of a plain site, which it "
    "sees only through the site's sensor, with the errors of tracking, scale and moves that the "
    "site hides. Truth is on cells of 2.5 cm with a strength of its own. Scores the ground that is "
    "left.",
    {{"simulate-site sites/T00", "the job by the default planner"},
     {"simulate-site sites/T00 --planner operator --log t.jsonl --ground-after t.asc",
      "by a plain policy, with its log and the ground at the end"},
     {"simulate-site sites/T00 --report t.html", "with a page that plays it"},
     {"simulate-site sites/T00 --bound", "what the job costs at its best: R and B"}},
    false};

struct Inputs {
  std::string site;
  std::string planner = "default";
  std::uint64_t seed = 1;
  std::uint64_t threads = 0;
  SimulatorInputs simulator;
  bool bound = false;
  std::optional<std::string> log;
  std::optional<std::string> ground_after;
  std::optional<std::string> report;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("FOLDER", inputs.site, "plain site with its folder hidden");
  arguments.flag("bound", inputs.bound,
                 "instead of a job the reference R and the bound B of the site");
  arguments.only_if({[&inputs] { return !inputs.bound; }, "--bound plays no job"}, [&] {
    arguments.choice("planner", inputs.planner, planner_words(), "who decides what is done next");
    arguments.option("seed", inputs.seed, "seed of errors and scans");
    arguments.output("log", inputs.log, "file to write the log of the job to, JSON lines");
    arguments.output("ground-after", inputs.ground_after,
                     "file to write the true ground at the end to, an ESRI ASCII grid");
    arguments.require_ending({".asc"});
    arguments.report(inputs.report);
  });
  declare_simulator(arguments, inputs.simulator);
  arguments.only_if({[&inputs] { return inputs.bound; }, "only --bound searches in threads"}, [&] {
    arguments.threads(inputs.threads, "; the result does not depend on it");
  });
}

void write_ground(const std::string& file, const HeightMap& ground) {
  LayeredMap map;
  map.ground = ground;
  map.layers.resize(1);
  map.layers.front().name = "height";
  map.layers.front().values = ground.z;
  write_map(file, map);
}

std::vector<std::string> lines_of(const JobTrial& trial) {
  const JobScore& score = trial.score;
  const auto percent = [](double value) { return readable(value, 3) + " %"; };
  return {std::string(score.finished ? "finished" : "not finished") + ": rms " +
              readable(1e3 * score.rms, 3) + " mm, p95 " + readable(1e3 * score.p95, 3) +
              " mm, beyond twice the tolerance " + percent(100.0 * score.beyond_twice) + ", seen " +
              percent(100.0 * score.seen),
          "left " + percent(score.left_percent()) + ", overdig " +
              percent(score.overdig_percent()) + ", spill " + percent(score.spill_percent()),
          std::to_string(trial.digs) + " digs, " + std::to_string(trial.finishing) +
              " of them finishing, " + std::to_string(trial.moves) + " moves, " +
              std::to_string(trial.scans) + " scans, " + std::to_string(trial.stalls) +
              " stalls, " + std::to_string(trial.untrusted) + " steps not trusted",
          readable(1e-3 * trial.energy_per_design(), 4) + " kJ per m^3 of the design, " +
              readable(trial.time / 60.0, 3) + " min; planned in " +
              readable(trial.planning_time, 3) + " s",
          "end: " + trial.reason};
}

Outcome bound_of(const Inputs& inputs, const HiddenSite& site, const Machine& machine,
                 Console& console) {
  FullDigOptions options;
  options.simulator = simulator_of(inputs.simulator, console);
  options.threads = static_cast<unsigned>(inputs.threads);
  const JobReference reference = job_reference(site, machine, options);
  Outcome outcome;
  outcome.json = reference_json(reference);
  outcome.lines = {"R " + readable(1e-3 * reference.energy, 4) + " kJ per m^3 of the design, " +
                       readable(reference.digs, 3) + " digs, " +
                       readable(reference.time * reference.design_cut / 60.0, 3) + " min",
                   "B " + readable(1e-3 * reference.bound, 4) + " kJ per m^3, " +
                       readable(reference.least_loads, 3) + " loads",
                   "density " + readable(reference.density_percent, 3) + " %, " +
                       readable(reference.design_cut, 4) + " m^3"};
  return outcome;
}

Outcome work(const Inputs& inputs, Console& console) {
  const HiddenSite site = read_hidden_site(inputs.site);
  const Machine machine = machine_named(site.known.machine);
  if (inputs.bound) return bound_of(inputs, site, machine, console);
  console.progress(0.0, "playing the job");
  const auto planner = planner_of(inputs.planner, site, machine);
  std::string log;
  TrialOptions options;
  options.truth.simulator = simulator_of(inputs.simulator, console);
  options.truth.seed = inputs.seed;
  std::optional<TrialRecorder> recorder;
  if (inputs.report) recorder.emplace(site);
  options.each = [&](const TrialStep& step) {
    log += log_lines(step);
    if (recorder) recorder->add(step);
  };
  const JobTrial trial = run_trial(site, machine, *planner, options);
  if (inputs.log) write_file(*inputs.log, log + log_end(trial));
  if (inputs.ground_after) write_ground(*inputs.ground_after, trial.after.surface());
  Outcome outcome;
  outcome.json = trial_json(trial);
  outcome.lines = lines_of(trial);
  if (recorder) {
    outcome.page = page_of(trial_report(trial, {recorder->history(), machine}), *inputs.report);
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
