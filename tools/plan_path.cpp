// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/path_library.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "figures.hpp"
#include "json_file.hpp"
#include "results.hpp"
#include "site.hpp"
#include "tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "plan-path",
    "plans the dig that lifts most soil per energy in soil of a relative density: looked up in a "
    "path library, or searched by digging the simulator.",
    {{"plan-path --density 40", "look the path up in the shipped library"},
     {"plan-path --density-from result.json --trajectory dig.csv",
      "go on from estimate-density --json, write joint angles over time"},
     {"plan-path --density 40 --search --terrain after.pcd", "search on the ground as scanned"}},
    true,
    true};

struct Inputs {
  std::optional<double> density;
  std::optional<std::string> density_from;
  std::optional<std::string> library;
  bool search = false;
  TerrainInput terrain;
  std::string soil = "loam";
  std::string machine = "zx120";
  double cell = 0.05;
  GeneticAlgorithm genetic;
  std::uint64_t seed = DigSearchOptions{}.seed;
  std::uint64_t threads = 0;
  std::optional<std::string> trajectory;
  std::optional<std::string> plot;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.option("density", inputs.density, Quantity::percent, "relative density of the ground");
  arguments.file("density-from", inputs.density_from,
                 "take the density from this result of estimate-density --json");
  arguments.file("library", inputs.library,
                 "path library (default: the shipped one of the machine and the soil)");
  arguments.flag("search", inputs.search, "search the path instead of looking it up");
  arguments.file("terrain", inputs.terrain.cloud,
                 "cloud of the ground in the site frame (default: level)");
  arguments.file("terrain-frame", inputs.terrain.frame,
                 "4 x 4 matrix that takes the terrain cloud into the site frame");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.option("cell", inputs.cell, Quantity::length, "cell of the simulated ground");
  arguments.option("population", inputs.genetic.population, "individuals of a generation");
  arguments.option("generations", inputs.genetic.generations, "generations of the search");
  arguments.option("seed", inputs.seed, "seed of the search");
  arguments.option("threads", inputs.threads, "threads, 0 for one per core; same path for any");
  arguments.file("trajectory", inputs.trajectory,
                 "write the joint trajectory, CSV, or JSON as .json");
  arguments.plot(inputs.plot, "the section of the dig");
}

/// The density asked for, and whether its source trusts it.
struct Density {
  double percent = 0.0;
  bool trustworthy = true;
};

Density density_of(const Inputs& inputs) {
  if (inputs.density.has_value() == inputs.density_from.has_value()) {
    throw Error(ErrorKind::bad_input, "give --density or --density-from, one of the two");
  }
  if (inputs.density) {
    if (!(*inputs.density >= 0.0 && *inputs.density <= 100.0)) {
      throw Error(ErrorKind::bad_input,
                  "--density: " + number_text(*inputs.density) + " % is outside 0 .. 100");
    }
    return {*inputs.density, true};
  }
  const std::string& file = *inputs.density_from;
  const auto json = nlohmann::json::parse(read_file(file), nullptr, false);
  const auto field = json.is_object() ? json.find("density_percent") : json.end();
  if (!json.is_object() || field == json.end() || !field->is_number() ||
      !(field->get<double>() >= 0.0 && field->get<double>() <= 100.0)) {
    throw Error(ErrorKind::bad_file,
                file + ": density_percent must be a number in 0 .. 100" +
                    (json.is_object() && field != json.end() ? ", it is " + field->dump()
                                                             : ", it is missing") +
                    "; expected a result of estimate-density --json");
  }
  const auto trustworthy = json.find("trustworthy");
  return {field->get<double>(), trustworthy == json.end() || *trustworthy == true};
}

PathLibrary library_of(const Inputs& inputs, const Machine& machine, const SoilKind& soil) {
  const std::string file = inputs.library
                               ? *inputs.library
                               : shipped_or_file("libraries", machine.name + "-" + soil.name);
  PathLibrary library = load_path_library(file);
  require_fit(library, machine, soil, file);
  return library;
}

/// A path of the library if one fits, to start the search from.
std::optional<DigParameters> known_good(const Inputs& inputs, const Machine& machine,
                                        const SoilKind& soil, double density) {
  try {
    return look_up(library_of(inputs, machine, soil), density).parameters;
  } catch (const Error&) {
    if (inputs.library) throw;
    return std::nullopt;  // none is shipped for this machine and soil: search from nothing
  }
}

struct Plan {
  PlannedDig dig;
  DigPath path;
  std::string source;
  int evaluations = 0;
  bool stopped = false;
};

/// The path of a dig on its ground; the start point moves if the planned one does not work.
DigPath lay_out(const Machine& machine, const PlannedDig& dig, const GroundProfile& ground) {
  auto path = make_dig_path(machine, dig.parameters, dig.start_x, ground);
  if (std::holds_alternative<Infeasible>(path)) {
    path = make_dig_path_anywhere(machine, dig.parameters, ground);
  }
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input,
                "the library's path cannot be driven here (--search may find "
                "one): " +
                    infeasible->message);
  }
  return std::get<DigPath>(std::move(path));
}

Plan look_up_plan(const Inputs& inputs, const Machine& machine, const SoilKind& soil,
                  double density, const Site& site) {
  Plan plan;
  plan.source = "library";
  plan.dig = look_up(library_of(inputs, machine, soil), density);
  if (!inputs.terrain.cloud) {
    plan.path = lay_out(machine, plan.dig, [](double) { return 0.0; });
    plan.dig.start_x = plan.path.start_x;
    return plan;
  }
  const HeightMapSimulator simulator(machine, soil, density);
  const auto outcome = evaluate_dig(machine, simulator, site.ground, plan.dig.parameters);
  plan.evaluations = 1;
  if (const auto* failure = std::get_if<DigFailure>(&outcome)) {
    throw Error(
        ErrorKind::bad_input,
        "the library's path does not work here (--search may find one): " + describe(*failure));
  }
  plan.dig = std::get<PlannedDig>(outcome);
  plan.path = lay_out(machine, plan.dig, boom_plane_profile(site.ground));
  return plan;
}

Plan search_plan(const Inputs& inputs, const Machine& machine, const SoilKind& soil, double density,
                 const Site& site, Console& console) {
  DigSearchOptions options;
  options.method = inputs.genetic;
  options.seed = inputs.seed;
  options.threads = static_cast<unsigned>(inputs.threads);
  if (const auto good = known_good(inputs, machine, soil, density)) options.start = {*good};
  options.progress = [&](const SearchProgress& p) {
    console.progress(static_cast<double>(p.evaluations) / p.planned,
                     "generation " + std::to_string(p.generation) + ": best " +
                         readable(1000.0 * p.best) + ", mean " + readable(1000.0 * p.mean) +
                         " kg/kJ, " + std::to_string(p.evaluations) + " digs");
    return !console.stop_requested();
  };
  const HeightMapSimulator simulator(machine, soil, density);
  const auto found = search_dig(machine, simulator, site.ground, options);
  if (!found) {
    throw Error(ErrorKind::bad_input,
                "no dig inside the search ranges can be driven on this ground");
  }
  const GroundProfile ground = boom_plane_profile(site.ground);
  return {found->dig, lay_out(machine, found->dig, ground), "search", found->evaluations,
          found->stopped};
}

nlohmann::ordered_json plan_json(const Plan& plan, double density, double seconds) {
  nlohmann::ordered_json json = {{"density_percent", density}};
  json.update(dig_json(plan.dig));
  json["source"] = plan.source;
  json["evaluations"] = plan.evaluations;
  json["wall_time_s"] = seconds;
  return json;
}

/// From above the ground to above the ground, JSON or CSV by the name of the file.
void write_trajectory(const std::string& file, const Machine& machine, DigPath path,
                      const GroundProfile& ground, std::vector<Warning>& warnings) {
  auto approach = way_down(machine, path, ground);
  if (const auto* blocked = std::get_if<Infeasible>(&approach)) {
    warnings.push_back(
        {"approach_blocked",
         "the trajectory begins on the ground, the way down is blocked: " + blocked->message});
  } else {
    path.approach = std::get<std::vector<DigPose>>(std::move(approach));
  }
  const Trajectory trajectory = time_dig_path(machine, path);
  const bool json = file.size() >= 5 && file.compare(file.size() - 5, 5, ".json") == 0;
  write_file(file, json ? to_json(trajectory) : to_csv(trajectory));
}

Outcome work(const Inputs& inputs, Console& console) {
  const Stopwatch watch;
  const Density density = density_of(inputs);
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  const Site site = make_site(inputs.terrain, planning_extent(machine), inputs.cell);
  const Plan plan = inputs.search
                        ? search_plan(inputs, machine, soil, density.percent, site, console)
                        : look_up_plan(inputs, machine, soil, density.percent, site);
  Outcome outcome;
  outcome.stopped_early = plan.stopped;
  outcome.trustworthy = density.trustworthy;
  outcome.warnings = site.warnings;
  if (!density.trustworthy) {
    outcome.warnings.push_back({"density_not_trustworthy",
                                *inputs.density_from + ": its density is not trustworthy, so the "
                                                       "path may not suit the soil"});
  }
  outcome.lines = {"density      " + readable(density.percent) + " % in " + soil.name};
  for (const std::string& line : dig_lines(plan.dig)) outcome.lines.push_back(line);
  outcome.lines.push_back(
      "source       " + plan.source +
      (plan.evaluations > 0 ? ", " + std::to_string(plan.evaluations) + " digs simulated" : ""));
  if (inputs.trajectory) {
    write_trajectory(*inputs.trajectory, machine, plan.path, boom_plane_profile(site.ground),
                     outcome.warnings);
  }
  if (inputs.plot) {
    write_file(*inputs.plot, dig_figure(machine, plan.path, {boom_plane_profile(site.ground)},
                                        "Planned dig in " + soil.name + " at " +
                                            readable(density.percent) + " % relative density",
                                        outcome.lines));
  }
  outcome.json = plan_json(plan, density.percent, watch.seconds());
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
