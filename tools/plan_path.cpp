// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <variant>

#include <excavplan/library/path_library.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "shared/figures.hpp"
#include "shared/results.hpp"
#include "shared/search_inputs.hpp"
#include "shared/site.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "plan-path",
    "plans the dig that lifts most soil per energy in soil of a relative density: looked up in a "
    "path library, or searched by digging the simulator.",
    {{"plan-path --density 40", "look the path up in the shipped library"},
     {"plan-path --density-from result.json --trajectory dig.csv",
      "go on from estimate-density --json, write joint angles over time"},
     {"plan-path --density 40 --search --terrain after.pcd", "search on the ground as scanned"},
     {"plan-path --density 40 --density-sd 8 --search",
      "the path best on average, and what knowing the density would be worth"}},
    true,
    true};

// Digs of a search unless told otherwise.
/// Enough for 99 % of the optimum from any seed (docs/methods.md#planning).
constexpr int evaluations_alone = 400;
/// For each of the soils that an uncertain density may mean, and for all together: from the
/// library's dig, and from nothing.
constexpr int evaluations_each = 100;
constexpr int evaluations_each_from_nothing = 200;

struct Inputs {
  std::optional<double> density;
  std::optional<std::string> density_from;
  std::optional<std::string> library;
  bool search = false;
  std::optional<double> density_sd;
  TerrainInput terrain;
  std::string soil = "loam";
  std::string machine = "zx120";
  double cell_size = 0.05;
  SearchInputs dig_search;
  std::optional<std::string> trajectory;
  std::optional<std::string> plot;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.option("density", inputs.density, Quantity::percent, "relative density of the ground");
  arguments.option(
      "density-sd", inputs.density_sd, Quantity::percent,
      "standard deviation of the density: how much the figures scatter; with --search the path "
      "that is best on average");
  arguments.file(
      "density-from", inputs.density_from,
      "take the density and its uncertainty from this result of estimate-density --json");
  arguments.file("library", inputs.library,
                 "path library (default: the shipped one of the machine and the soil)");
  arguments.flag("search", inputs.search, "search the path instead of looking it up");
  arguments.file("terrain", inputs.terrain.cloud,
                 "cloud of the ground in the site frame (default: level)");
  arguments.file("terrain-frame", inputs.terrain.frame,
                 "4 x 4 matrix that takes the terrain cloud into the site frame");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.option("cell", inputs.cell_size, Quantity::length, "cell of the simulated ground");
  declare_search(arguments, inputs.dig_search);
  arguments.file("trajectory", inputs.trajectory,
                 "write the joint trajectory, CSV, or JSON as .json");
  arguments.plot(inputs.plot, "the section of the dig");
}

/// The density asked for, and whether its source trusts it.
struct Density {
  double percent = 0.0;
  double sd = 0.0;  ///< [points]; 0: taken as known
  bool trustworthy = true;
  std::string soil = {};  ///< that it was estimated for; empty: not told
};

[[noreturn]] void refuse(const std::string& text) { throw Error(ErrorKind::bad_input, text); }

/// Of the result of an estimate; 0 if it states none.
double sd_in(const nlohmann::json& result, const std::string& file) {
  const auto field = result.find("density_sd_percent");
  if (field == result.end() || field->is_null()) return 0.0;
  if (field->is_number() && field->get<double>() >= 0.0) return field->get<double>();
  throw Error(ErrorKind::bad_file, file +
                                       ": density_sd_percent must be a number of at least 0, it "
                                       "is " +
                                       field->dump());
}

Density density_of(const Inputs& inputs) {
  if (inputs.density.has_value() == inputs.density_from.has_value()) {
    throw Error(ErrorKind::bad_input, "give --density or --density-from, one of the two");
  }
  if (inputs.density) {
    if (!(*inputs.density >= 0.0 && *inputs.density <= 100.0)) {
      throw Error(ErrorKind::bad_input,
                  "--density: " + number_text(*inputs.density) + " % is outside 0 .. 100");
    }
    return {*inputs.density, inputs.density_sd.value_or(0.0), true};
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
  const auto soil = json.find("law_soil");
  return {field->get<double>(), inputs.density_sd ? *inputs.density_sd : sd_in(json, file),
          trustworthy == json.end() || *trustworthy == true,
          soil != json.end() && soil->is_string() ? soil->get<std::string>() : ""};
}

void warn_of_density(const Density& density, const Inputs& inputs, const SoilKind& soil,
                     Site& site) {
  if (!density.trustworthy) {
    site.warnings.push_back({"density_not_trustworthy",
                             *inputs.density_from + ": its density is not trustworthy, so the "
                                                    "path may not suit the soil"});
  }
  if (!density.soil.empty() && density.soil != soil.name) {
    site.warnings.push_back(
        {"law_of_other_soil", *inputs.density_from + ": its density was found by the law of " +
                                  density.soil + ", the path is planned in " + soil.name});
  }
}

/// The slope of the scanned ground, and as much of it as the library goes.
struct Slope {
  double ground = 0.0;  ///< [rad]; NaN: unknown
  double looked_up = 0.0;
};

Slope slope_in(const PathLibrary& library, const Inputs& inputs, const Machine& machine,
               const Site& site) {
  if (!inputs.terrain.cloud) return {};
  const double slope = boom_plane_slope(site.ground, machine.track_front);
  return {slope, std::clamp(std::isnan(slope) ? 0.0 : slope, library.entries.front().slope,
                            library.entries.back().slope)};
}

/// A path of the library if one fits, to start the search from. Its paths are those of most mass
/// per energy: a search for something else would stay near the wrong one.
std::vector<DigParameters> known_good(const Inputs& inputs, const Machine& machine,
                                      const SoilKind& soil, double density, Site& site) {
  try {
    const PathLibrary library = library_of(inputs.library, machine, soil);
    const Slope slope = slope_in(library, inputs, machine, site);
    return {look_up(library, density, slope.looked_up).parameters};
  } catch (const Error& error) {
    if (inputs.library) throw;
    if (error.kind() == ErrorKind::bad_file) {
      site.warnings.push_back(
          {"library_unreadable",
           std::string("the search starts from nothing, not from the shipped library: ") +
               error.what()});
    }
    return {};  // none is shipped that fits
  }
}

struct Plan {
  PlannedDig dig;
  DigSpread spread;
  DigPath path;
  std::string source;
  std::string start_rule;
  int evaluations = 0;
  bool stopped = false;
  bool trustworthy = true;
  nlohmann::ordered_json details = nlohmann::ordered_json::object();  ///< keys of its source
  std::vector<std::string> lines;
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

void add_look_up_error(const MidwayError& error, double slope, Plan& plan) {
  plan.details["look_up_slope_rad"] = slope;
  plan.details["look_up_loss"] = nullptr;
  plan.details["look_up_expectation_error"] = nullptr;
  if (!plan.trustworthy) return;
  plan.details["look_up_loss"] = error.loss;
  plan.details["look_up_expectation_error"] = error.expectation;
  if (error.loss == 0.0 && slope == 0.0) return;
  plan.lines.push_back(
      "looked up    " + (slope != 0.0 ? "on a slope of " + readable(slope, 2) + " rad" : "") +
      (slope != 0.0 && error.loss != 0.0 ? ", " : "") +
      (error.loss != 0.0 ? "between entries, which gives away up to " +
                               readable(100.0 * error.loss, 2) + " % of the best efficiency"
                         : ""));
}

/// Where the library knows no ground like this.
/// @param expected  efficiency by the library, for the slope looked up
void warn_of_ground(const Slope& slope, double expected, Plan& plan, Site& site) {
  constexpr double much = 0.04;  // [rad]; ours, docs/libraries.md
  constexpr double far = 0.1;    // of the efficiency; ours, more than any error between entries
  const std::string remedy = "; --search finds a path that suits the ground";
  if (std::abs(slope.ground - slope.looked_up) > much) {
    site.warnings.push_back(
        {"slope_outside_library", "the ground slopes by " + readable(slope.ground, 2) +
                                      " rad, the library is looked up at " +
                                      readable(slope.looked_up, 2) + " rad" + remedy});
  } else if (plan.dig.efficiency() < (1.0 - far) * expected) {
    site.warnings.push_back({"ground_unlike_library",
                             "the path looked up does " + readable(1000.0 * plan.dig.efficiency()) +
                                 " kg/kJ here, against " + readable(1000.0 * expected) +
                                 " kg/kJ on the even ground of the library" + remedy});
  } else {
    return;
  }
  plan.trustworthy = false;
}

Plan look_up_plan(const Inputs& inputs, const Machine& machine, const SoilKind& soil,
                  double density, Site& site) {
  Plan plan;
  plan.source = "library";
  const PathLibrary library = library_of(inputs.library, machine, soil);
  const Slope slope = slope_in(library, inputs, machine, site);
  plan.dig = look_up(library, density, slope.looked_up);
  const double expected = plan.dig.efficiency();
  const MidwayError error = look_up_error(library, density, slope.looked_up);
  plan.start_rule = "of the library";
  if (!inputs.terrain.cloud) {
    add_look_up_error(error, slope.looked_up, plan);
    plan.path = lay_out(machine, plan.dig, [](double) { return 0.0; });
    plan.dig.start_x = plan.path.start_x;
    return plan;
  }
  const HeightMapSimulator simulator(machine, soil, density);
  const StartRule start = start_rule_of(inputs.dig_search);
  plan.start_rule = describe(start);
  const auto outcome = evaluate_dig(machine, simulator, site.ground, plan.dig.parameters, start);
  plan.evaluations = 1;
  if (const auto* failure = std::get_if<DigFailure>(&outcome)) {
    throw Error(
        ErrorKind::bad_input,
        "the library's path does not work here (--search may find one): " + describe(*failure));
  }
  plan.dig = std::get<PlannedDig>(outcome);
  warn_of_ground(slope, expected, plan, site);
  add_look_up_error(error, slope.looked_up, plan);
  plan.path = lay_out(machine, plan.dig, boom_plane_profile(site.ground));
  return plan;
}

/// What the search says beyond the dig.
void add_search(const DigSearchResult& found, const DigObjective& objective, Plan& plan) {
  const bool per_time = objective.goal == DigObjective::Goal::mass_per_time;
  plan.dig = found.dig;
  plan.source = "search";
  plan.evaluations = found.evaluations;
  plan.stopped = found.stopped;
  plan.details["stopped_by"] = name(found.stopped_by);
  plan.details["refused"] = found.refused;
  plan.details["worth"] = (per_time ? 1.0 : 1000.0) * found.worth;
  plan.details["worth_unit"] = per_time ? "kg/s" : "kg/kJ";
  for (std::size_t i = 0; i < dig_parameter_table().size() && i < found.insight.seen.size(); ++i) {
    const ParameterRange& range = found.insight.seen[i];
    plan.details["ranges_98_percent"][dig_parameter_table()[i].name] = {range.low, range.high};
  }
  if (objective.goal != DigObjective::Goal::mass_per_energy) {
    plan.lines.push_back("worth        " + readable((per_time ? 1.0 : 1000.0) * found.worth) +
                         (per_time ? " kg/s" : " kg/kJ, energy and time"));
  }
}

void add_uncertainty(const UncertainDigSearchResult& found, double sd, Plan& plan) {
  plan.evaluations = found.evaluations;
  const nlohmann::ordered_json worth = plan.details["worth"];
  if (plan.details["worth_unit"] == "kg/kJ") plan.details["expected_efficiency_kg_per_kj"] = worth;
  std::string line = "expected     " + readable(worth.get<double>()) + " " +
                     plan.details["worth_unit"].get<std::string>() + " on average over " +
                     readable(sd) + " points of standard deviation";
  if (!plan.stopped) {
    const double value = 100.0 * found.value_of_knowing();
    plan.details["value_of_knowing_percent"] = value;
    line += "; knowing the density would add " + readable(value, 2) + " %";
  }
  plan.lines.push_back(line);
}

/// Nothing if the search was interrupted, else why there is none.
std::nullopt_t no_plan(const std::optional<NearestDig>& nearest, const Console& console) {
  if (console.stop_requested()) return std::nullopt;
  refuse("no dig inside the search ranges can be done on this ground" + nearest_text(nearest));
}

/// The soils that the ground may be.
class PossibleGround {
 public:
  PossibleGround(const Machine& machine, const SoilKind& soil, const Density& density) {
    const auto densities = possible_densities(density.percent, density.sd);
    for (const auto& [percent, probability] : densities) {
      simulators_.emplace_back(machine, soil, percent);
      soils_.push_back({nullptr, probability});
    }
    for (std::size_t i = 0; i < soils_.size(); ++i) soils_[i].simulator = &simulators_[i];
  }
  PossibleGround(const PossibleGround&) = delete;
  PossibleGround& operator=(const PossibleGround&) = delete;

  const std::vector<PossibleSoil>& soils() const { return soils_; }

 private:
  std::vector<HeightMapSimulator> simulators_;
  std::vector<PossibleSoil> soils_;
};

/// @return nothing if the search was interrupted before it found a dig
std::optional<Plan> search_plan(const Inputs& inputs, const Machine& machine, const SoilKind& soil,
                                const Density& density, Site& site, Console& console) {
  const bool uncertain = density.sd > 0.0;
  std::vector<DigParameters> start;
  if (inputs.dig_search.goal == SearchInputs{}.goal) {
    start = known_good(inputs, machine, soil, density.percent, site);
  }
  const int each = start.empty() ? evaluations_each_from_nothing : evaluations_each;
  DigSearchOptions options =
      search_options(inputs.dig_search, uncertain ? each : evaluations_alone, console);
  options.start = start;
  Plan plan;
  plan.start_rule = describe(options.start_rule);
  if (uncertain) {
    const PossibleGround ground(machine, soil, density);
    const auto found = search_dig(machine, ground.soils(), site.ground, options);
    if (!found) return no_plan(found.nearest, console);
    add_search(found->expected, options.objective, plan);
    add_uncertainty(*found, density.sd, plan);
  } else {
    const HeightMapSimulator simulator(machine, soil, density.percent);
    const auto found = search_dig(machine, simulator, site.ground, options);
    if (!found) return no_plan(found.nearest, console);
    add_search(*found, options.objective, plan);
  }
  plan.path = lay_out(machine, plan.dig, boom_plane_profile(site.ground));
  return plan;
}

void add_spread(const Machine& machine, const SoilKind& soil, const Density& density, Site& site,
                Plan& plan) {
  constexpr double likely = 0.05;  // ours
  const PossibleGround ground(machine, soil, density);
  plan.spread = dig_spread(machine, ground.soils(), site.ground, plan.dig);
  plan.evaluations += static_cast<int>(ground.soils().size());
  plan.details["density_sd_percent"] = density.sd;
  plan.details["payload_mass_sd_kg"] = plan.spread.payload_mass;
  plan.details["energy_sd_kj"] = plan.spread.energy / 1000.0;
  plan.details["efficiency_sd_kg_per_kj"] = 1000.0 * plan.spread.efficiency;
  plan.details["stall_probability"] = plan.spread.stall_probability;
  if (plan.spread.stall_probability > 0.0) {
    plan.lines.push_back("stalls       with a probability of " +
                         readable(100.0 * plan.spread.stall_probability, 2) + " %");
  }
  if (plan.spread.stall_probability <= likely) return;
  plan.trustworthy = false;
  site.warnings.push_back({"may_stall", "the machine stalls with a probability of " +
                                            readable(100.0 * plan.spread.stall_probability, 2) +
                                            " %; the figures are of the digs in which it does "
                                            "not"});
}

nlohmann::ordered_json plan_json(const Plan& plan, double density, double seconds) {
  nlohmann::ordered_json json = {{"density_percent", density}};
  json.update(dig_json(plan.dig));
  json["source"] = plan.source;
  json["start_rule"] = plan.start_rule;
  json["evaluations"] = plan.evaluations;
  json.update(plan.details);
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

std::vector<std::string> lines_of(const Plan& plan, const Density& density, const SoilKind& soil) {
  std::vector<std::string> lines = {"density      " + readable(density.percent, density.sd) +
                                    " % in " + soil.name};
  for (const std::string& line : dig_lines(plan.dig, plan.spread)) lines.push_back(line);
  for (const std::string& line : plan.lines) lines.push_back(line);
  lines.push_back(
      "source       " + plan.source +
      (plan.evaluations > 0 ? ", " + std::to_string(plan.evaluations) + " digs simulated" : "") +
      "; start: " + plan.start_rule);
  return lines;
}

Outcome nothing_found(const Density& density, const std::vector<Warning>& warnings) {
  Outcome outcome;
  outcome.warnings = warnings;
  outcome.stopped_early = true;
  outcome.trustworthy = density.trustworthy;
  outcome.json = {{"density_percent", density.percent}, {"source", "search"}, {"path", nullptr}};
  outcome.lines = {"stopped before any dig was found"};
  return outcome;
}

void check(const Inputs& inputs) {
  if (inputs.density_sd && *inputs.density_sd < 0.0) {
    refuse("--density-sd: " + number_text(*inputs.density_sd) + " must be at least 0");
  }
  if (start_rule_of(inputs.dig_search).kind == StartRule::Kind::searched && !inputs.search) {
    refuse("--start search needs --search");
  }
  for (const auto& file : {inputs.trajectory, inputs.plot}) {
    if (file) require_folder_of(*file);  // now, not after the search
  }
  check(inputs.dig_search);
}

Outcome work(const Inputs& inputs, Console& console) {
  const Stopwatch watch;
  check(inputs);
  const Density density = density_of(inputs);
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  Site site = make_site(inputs.terrain, planning_extent(machine), inputs.cell_size);
  const SearchUse use = inputs.search          ? SearchUse::all
                        : inputs.terrain.cloud ? SearchUse::start_only
                                               : SearchUse::none;
  for (Warning& warning : warnings_of(inputs.dig_search, use)) {
    site.warnings.push_back(std::move(warning));
  }
  warn_of_density(density, inputs, soil, site);
  std::optional<Plan> found = inputs.search
                                  ? search_plan(inputs, machine, soil, density, site, console)
                                  : look_up_plan(inputs, machine, soil, density.percent, site);
  if (!found) return nothing_found(density, site.warnings);
  Plan& plan = *found;
  if (density.sd > 0.0) add_spread(machine, soil, density, site, plan);
  Outcome outcome;
  outcome.stopped_early = plan.stopped;
  outcome.trustworthy = density.trustworthy && plan.trustworthy;
  outcome.warnings = site.warnings;
  outcome.lines = lines_of(plan, density, soil);
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
