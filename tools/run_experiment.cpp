// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <excavplan/library/path_library.hpp>
#include <excavplan/simulation/calibration.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/json.hpp"
#include "shared/results.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "run-experiment",
    "repeats the paper's simulation experiment (section 3): dig once along the fixed path, "
    "estimate "
    "the density from the height maps, dig again along the path planned for it, compare.",
    {{"run-experiment", "soft, medium and hard loam (10, 40, 80 %), paths from the library"},
     {"run-experiment --search --densities 0:10:100", "search each path, eleven densities"},
     {"run-experiment --json", "all figures for a program"}}};

struct Inputs {
  std::string densities = "paper";
  DigParameters path = paper_fixed_path();
  std::string soil = "loam";
  std::string machine = "zx120";
  std::optional<std::string> library;
  std::string law = "default";
  bool search = false;
  double cell_size = 0.05;
  std::uint64_t seed = 1;
  std::uint64_t threads = 0;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c; \"paper\": soft 10, medium 40, hard 80");
  arguments.file("library", inputs.library,
                 "path library (default: the shipped one of the machine and the soil)");
  arguments.text(
      "law", "NAME|FILE", inputs.law,
      "density law: default (the shipped one of the machine and the soil), paper, or a law file");
  arguments.flag("search", inputs.search, "search each path instead of looking it up");
  arguments.option("path", inputs.path, "fixed path");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.option("cell", inputs.cell_size, Quantity::length, "cell of the simulated ground");
  arguments.option("seed", inputs.seed, "seed of the searches");
  arguments.option("threads", inputs.threads, "threads, 0 for one per core");
}

struct Condition {
  std::string name;
  double density = 0.0;
};

/// The densities of the paper's Table 1 are not published as text: these are ours.
std::vector<Condition> conditions_of(const Inputs& inputs) {
  if (inputs.densities == "paper") return {{"soft", 10.0}, {"medium", 40.0}, {"hard", 80.0}};
  std::vector<Condition> conditions;
  for (const double density : parse_densities("--densities", inputs.densities)) {
    conditions.push_back({readable(density) + " %", density});
  }
  return conditions;
}

/// What stays the same for all conditions.
struct Setting {
  Machine machine;
  SoilKind soil;
  DensityLaw law;
  std::optional<PathLibrary> library;
  DigParameters fixed;
  Terrain ground;
};

PlannedDig dig_or_fail(const Setting& setting, const HeightMapSimulator& simulator,
                       const DigParameters& parameters, const StartRule& start = {}) {
  const auto outcome = evaluate_dig(setting.machine, simulator, setting.ground, parameters, start);
  if (const auto* failure = std::get_if<DigFailure>(&outcome)) {
    throw Error(ErrorKind::bad_input, describe(*failure));
  }
  return std::get<PlannedDig>(outcome);
}

PlannedDig planned_dig(const Inputs& inputs, const Setting& setting, double estimated_density) {
  if (setting.library) return look_up(*setting.library, estimated_density);
  DigSearchOptions search;
  search.seed = inputs.seed;
  search.threads = static_cast<unsigned>(inputs.threads);
  const HeightMapSimulator simulator(setting.machine, setting.soil, estimated_density);
  const auto found = search_dig(setting.machine, simulator, setting.ground, search);
  if (!found) {
    throw Error(ErrorKind::bad_input, "no dig can be done at a density of " +
                                          readable(estimated_density) + " %" +
                                          nearest_text(found.nearest));
  }
  return found->dig;
}

/// From its own start; from that of the rule for all if another soil forbids it.
PlannedDig dig_as_planned(const Setting& setting, const HeightMapSimulator& simulator,
                          const PlannedDig& chosen) {
  const auto outcome = evaluate_dig(setting.machine, simulator, setting.ground, chosen.parameters,
                                    StartRule(chosen.start_x));
  if (const auto* dig = std::get_if<PlannedDig>(&outcome)) return *dig;
  return dig_or_fail(setting, simulator, chosen.parameters);
}

/// The rule that puts the start of a planned dig nearest to where it is.
StartRule rule_behind(const Setting& setting, const HeightMapSimulator& simulator,
                      const PlannedDig& planned) {
  const auto distance = [&](const StartRule& rule) {
    return std::abs(dig_or_fail(setting, simulator, planned.parameters, rule).start_x -
                    planned.start_x);
  };
  const StartRule work = StartRule::Kind::least_work;
  const StartRule margin = StartRule::Kind::largest_margin;
  return distance(work) < distance(margin) ? work : margin;
}

double gain_percent(const PlannedDig& of, const PlannedDig& over) {
  return 100.0 * (of.efficiency() / over.efficiency() - 1.0);
}

struct Row {
  nlohmann::ordered_json json;
  std::string line;
};

Row run(const Inputs& inputs, const Setting& setting, const Condition& condition) {
  // 1-2: dig once along the fixed path, measure k from the height maps.
  const Terrain scene = undisturbed(
      flat_ground(scene_extent(setting.machine, default_dump_point()), inputs.cell_size));
  const HeightMapSimulator simulator(setting.machine, setting.soil, condition.density);
  const PlannedDig fixed = dig_or_fail(setting, simulator, setting.fixed);
  const auto path =
      make_dig_path(setting.machine, fixed.parameters, fixed.start_x, boom_plane_profile(scene));
  DigOptions dump;
  dump.dump_at = default_dump_point();
  const DigResult result = simulator.dig(scene, std::get<DigPath>(path), dump);
  const HeightMapVolumes volumes = height_map_volumes(scene, result.after(scene), *dump.dump_at);
  // 3: choose the path for the density estimated from it.
  const RelativeDensity estimate = relative_density(setting.law, {volumes.bulking_factor, 0.0});
  const PlannedDig chosen = planned_dig(inputs, setting, estimate.percent);
  // 4: dig again in the true soil; the fixed path, too, from where the planned one's rule puts it.
  const PlannedDig planned = dig_as_planned(setting, simulator, chosen);
  const StartRule rule = rule_behind(setting, simulator, planned);
  const PlannedDig moved = dig_or_fail(setting, simulator, setting.fixed, rule);
  const double gain = gain_percent(planned, fixed);
  const double start_gain = gain_percent(moved, fixed);
  const double path_gain = gain_percent(planned, moved);

  const nlohmann::ordered_json volume = {{"excavated_m3", volumes.excavated},
                                         {"spilled_m3", volumes.spilled},
                                         {"dumped_m3", volumes.dumped}};
  Row row;
  row.json = {{"name", condition.name},
              {"density_percent", condition.density},
              {"volume", volume},
              {"bulking_factor", volumes.bulking_factor},
              {"density_estimated_percent", estimate.percent},
              {"fixed", dig_json(fixed)},
              {"planned", dig_json(planned)},
              {"gain_percent", gain},
              {"gain_path_percent", path_gain},
              {"gain_start_percent", start_gain},
              {"start_rule", describe(rule)}};
  row.line = condition.name + ": density " + readable(condition.density) + " %, k " +
             readable(volumes.bulking_factor, 4) + ", estimated " + readable(estimate.percent) +
             " %; fixed " + readable(1000.0 * fixed.efficiency()) + " kg/kJ, planned " +
             readable(1000.0 * planned.efficiency()) + " kg/kJ (" + path_text(planned) +
             "), gain " + readable(gain) + " % (path " + readable(path_gain) + " %, start " +
             readable(start_gain) + " %)";
  return row;
}

Setting setting_of(const Inputs& inputs) {
  Setting setting;
  setting.machine = machine_named(inputs.machine);
  setting.soil = soil_named(inputs.soil);
  const std::string pair = setting.machine.name + "-" + setting.soil.name;
  setting.law =
      load_density_law(shipped_or_file("laws", inputs.law == "default" ? pair : inputs.law));
  if (!inputs.search) {
    setting.library = library_of(inputs.library, setting.machine, setting.soil);
  }
  setting.fixed = inputs.path;
  setting.ground = level_planning_ground(setting.machine, inputs.cell_size);
  return setting;
}

Outcome work(const Inputs& inputs, Console& console) {
  const Setting setting = setting_of(inputs);
  const std::vector<Condition> conditions = conditions_of(inputs);
  Outcome outcome;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    console.progress(static_cast<double>(i) / static_cast<double>(conditions.size()),
                     conditions[i].name);
    Row row = run(inputs, setting, conditions[i]);
    outcome.json["conditions"].push_back(std::move(row.json));
    outcome.lines.push_back(std::move(row.line));
  }
  outcome.json["law"] = setting.law.name;
  outcome.json["start_rule"] =
      "fixed path: " + describe(StartRule()) + "; planned path: the start_rule of its condition";
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
