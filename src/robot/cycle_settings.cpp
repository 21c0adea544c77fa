// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <excavplan/base/data_files.hpp>
#include <excavplan/kit/kit_files.hpp>
#include <excavplan/kit/machine_kit.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/planning/goal_words.hpp>
#include <excavplan/robot/dig_cycle_session.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "machine/corner_rules.hpp"
#include "robot/cycle_site.hpp"

namespace excavplan {
namespace {

GoalNumbers numbers_of(const CycleSources& sources) {
  GoalNumbers numbers;
  for (const DigObjectiveParameter& parameter : objective_parameters()) {
    std::optional<double> given;
    if (parameter.field == &DigObjective::swing) given = sources.swing;
    if (parameter.field == &DigObjective::dump_height) given = sources.dump_height;
    if (parameter.field == &DigObjective::min_fill) given = sources.min_fill;
    numbers.push_back(given);
  }
  return numbers;
}

DigObjective objective_of(const CycleSources& sources, const Machine& machine,
                          const GoalNumbers& numbers) {
  DigObjective objective = objective_named(sources.goal);
  if (!sources.dump_height) objective = feasible_objective(machine, objective);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i]) objective.*objective_parameters()[i].field = *numbers[i];
  }
  check(objective, machine);
  return objective;
}

DensityLaw law_of(const CycleSources& sources, const Machine& machine, const SoilKind& soil) {
  if (!sources.law.empty()) return load_density_law(shipped_or_file("laws", sources.law));
  if (const auto kit = kit_law(sources.machine, machine, soil.name)) return load_density_law(*kit);
  std::string file;
  try {
    file = find_data_file(law_file(machine.name, soil.name));
  } catch (const Error&) {
    if (!has_data_folder("laws")) throw;
    refuse("no density law of " + machine.name + " in " + soil.name +
           " is shipped: make one with machine-kit or calibrate-density, or name one");
  }
  return load_density_law(file);
}

/// Null: a search begins without one.
std::shared_ptr<const PathLibrary> library_of(const CycleSources& sources, const Machine& machine,
                                              const SoilKind& soil, const GoalNumbers& numbers,
                                              DigObjective& objective) {
  if (!sources.library.empty()) {
    return std::make_shared<PathLibrary>(load_path_library(sources.library));
  }
  auto library = kit_library(sources.machine, machine, soil.name, numbers, objective);
  if (library || sources.search) return library;
  return std::make_shared<PathLibrary>(shipped_library(machine, soil, objective));
}

void check_site(const DigCycleSettings& settings) {
  base_on_site(settings);
  require(settings.estimate.method == VolumeMethod::surface,
          "site: the ground is known by its surface, not by the paper's method");
  require(!settings.estimate.prior, "site: knows the digs before, there is no other prior");
}

}  // namespace

void check(const DigCycleSettings& settings) {
  require_in("scans", static_cast<double>(settings.scans), 1.0, DigCycleSession::most_scans);
  require(settings.site_from_scan.allFinite(), "site_from_scan: a number is not finite");
  if (!settings.site.empty()) check_site(settings);
  require(settings.oldest_joints > 0.0, "oldest_joints [s]", settings.oldest_joints, "above 0");
  require(settings.oldest_scan > 0.0, "oldest_scan [s]", settings.oldest_scan, "above 0");
  require(settings.search_seconds > 0.0, "search_seconds", settings.search_seconds, "above 0");
  require_density(settings.density);
  require_machine(settings.machine);
  if (settings.surroundings) {
    require(!settings.level_ground,
            "level_ground: is not known where the surroundings were scanned");
    require(
        same_grid(settings.surroundings->bank, level_swing_ground(settings.machine).bank),
        "surroundings: must be of swing_terrain_from_scan() of machine " + settings.machine.name);
  }
  require_soil(settings.soil);
  const RobotJoints& joints = settings.machine.robot_joints;
  const bool named = std::none_of(joints.begin(), joints.begin() + 3,
                                  [](const RobotJoint& joint) { return joint.name.empty(); });
  require(named, "robot_joints: boom, arm and bucket need a name");
  require(!settings.whole_cycle || !joints[3].name.empty(),
          "whole_cycle: the swing joint has no name, so the machine would dump without swinging");
  check(settings.motion);
  const TrajectoryOptions& timing = settings.plan.trajectory;
  check_timing("TrajectoryOptions", timing.speed_fraction, timing.corner_tolerance);
  const DigObjective& objective = settings.plan.search.objective;
  check(objective, settings.machine);
  check(settings.machine, CycleWayOptions{{}, settings.whole_cycle, objective});
  if (!settings.plan.library) return;
  const std::string& own = settings.plan.simulator.name;
  const bool is_own = settings.plan.library->simulator == own;
  require_fit(*settings.plan.library, settings.machine, settings.soil, objective,
              is_own ? own : default_simulator().name);
}

DigCycleSettings cycle_settings(const CycleSources& sources) {
  DigCycleSettings settings;
  MachineFile file = load_machine_file(machine_path(sources.machine));
  settings.machine = std::move(file.machine);
  settings.warnings = std::move(file.warnings);
  settings.soil = load_soil(shipped_or_file("soils", sources.soil));
  settings.law = law_of(sources, settings.machine, settings.soil);
  PlanOptions& plan = settings.plan;
  if (sources.search) plan.method = PlanMethod::search;
  const GoalNumbers numbers = numbers_of(sources);
  plan.search.objective = objective_of(sources, settings.machine, numbers);
  if (!sources.dump_height) {
    for (Warning& each : lowered_height_warnings(plan.search.objective)) {
      settings.warnings.push_back(std::move(each));
    }
  }
  plan.library =
      library_of(sources, settings.machine, settings.soil, numbers, plan.search.objective);
  return settings;
}

}  // namespace excavplan
