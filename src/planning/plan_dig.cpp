// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/plan_dig.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>
#include <variant>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/screened_search.hpp>
#include <excavplan/planning/standing_ground.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "ground/obstacles.hpp"
#include "ground/terrain.hpp"
#include "machine/dig_path_text.hpp"
#include "planning/dig_layout.hpp"
#include "planning/dig_problem.hpp"
#include "planning/simulated_dig.hpp"
#include "planning/start_rule.hpp"
#include "simulation/checked_dig.hpp"
#include "soil/density_doubt.hpp"

namespace excavplan {
namespace {

constexpr double much_steeper =
    0.04;  // than the library's slopes [rad]; ours, docs/formats.md#warning-codes
constexpr double far_below = 0.1;      // the library's efficiency; ours, above its own errors
constexpr double likely_stall = 0.05;  // probability; ours

// Of a search that is screened; ours, docs/methods.md#planning.
constexpr int screened_digs = 900;

struct Task {
  const Machine& machine;  ///< as it stands
  const Machine& filed;    ///< level, as libraries know it
  const SoilKind& soil;
  const GroundDensity& density;
  const Terrain& ground;
  bool level;  ///< no ground was given, and the machine stands level
  const PlanOptions& options;

  bool uncertain() const { return density.sd_percent > 0.0; }
  const DigObjective& objective() const { return options.search.objective; }
};

void warn(DigPlan& plan, Warning warning) {
  if (warning.ends_trust) plan.trustworthy = false;
  plan.warnings.push_back(std::move(warning));
}

void judge_density(const Task& task, DigPlan& plan) {
  const std::string& soil = task.density.soil;
  if (const auto doubt = doubt_of_density(task.density.percent);
      doubt && task.density.sd_percent < 1.0)
    warn(plan, *doubt);
  if (!task.density.trustworthy) {
    warn(plan, {WarningCode::density_not_trustworthy,
                "the density is not trustworthy, so the path may be wrong for the soil", true});
  }
  if (!soil.empty() && soil != task.soil.name) {
    warn(plan, {WarningCode::law_of_other_soil,
                "the density was estimated by the law of " + soil + ", the path is planned in " +
                    task.soil.name,
                true});
  }
}

/// Of a terrain alone it goes without saying that it does not show all that the machine stands on.
void judge_standing(const Task& task, DigPlan& plan) {
  const std::optional<HeightMap>& given = task.options.standing_on;
  const HeightMap ground = given ? *given : task.ground.surface();
  StandingGround found = standing_ground(task.machine, ground);
  plan.on_slope.roll += found.rise_left.value_or(0.0);
  plan.on_slope.pitch -= found.rise_ahead.value_or(0.0);
  for (Warning& each : found.warnings) {
    if (given || each.code != WarningCode::ground_at_tracks_unseen) warn(plan, std::move(each));
  }
}

/// What stands in the strip of the bucket is not dug; the dig is laid out clear of it.
void judge_strip(const Task& task, DigPlan& plan) {
  const Eigen::ArrayXXd& tops = task.ground.obstacles;
  const HeightMap& map = task.ground.bank;
  const double half = 0.5 * task.machine.bucket.width_outside;
  constexpr double beside = 0.3;  // ours: what is hidden of an obstacle counts so far [m]
  for (Eigen::Index col = 0; tops.size() > 0 && col < map.z.cols(); ++col) {
    if (map.x(col) < task.machine.track_front) continue;
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      if (std::abs(map.y(row)) > half || std::isnan(tops(row, col))) continue;
      warn(plan, {WarningCode::obstacle_in_strip,
                  "at x = " + readable(map.x(col)) + " m something stands where the bucket could " +
                      "dig, which is " +
                      text(*highest_obstacle(task.ground, {map.x(col), map.y(row)}, beside)) +
                      ": no dig is planned there"});
      return;
    }
  }
}

std::shared_ptr<const PathLibrary> library_of(const Task& task) {
  const PlanOptions& options = task.options;
  if (!options.library) {
    return std::make_shared<PathLibrary>(
        shipped_library(task.filed, task.soil, task.objective(), options.data_folder));
  }
  const std::string& own = options.simulator.name;
  require_fit(*options.library, task.filed, task.soil, task.objective(),
              options.library->simulator == own ? own : default_simulator().name);
  return options.library;
}

/// The slope of the ground, and as much of it as the library covers.
struct Slope {
  double ground = 0.0;  ///< [rad]; NaN: unknown
  double covered = 0.0;
};

/// @param x_from, x_to  of the ground that counts
Slope slope_in(const PathLibrary& library, const Task& task, double x_from, double x_to) {
  if (task.level || library.entries.empty()) return {};
  const double slope = boom_plane_slope(task.ground, x_from, x_to);
  return {slope, std::clamp(std::isnan(slope) ? 0.0 : slope, library.entries.front().slope,
                            library.entries.back().slope)};
}

Slope slope_ahead(const PathLibrary& library, const Task& task) {
  return slope_in(library, task, task.machine.track_front, std::numeric_limits<double>::infinity());
}

/// A dig, or why the library has none.
std::variant<PlannedDig, std::string> known_dig(const PathLibrary& library, const Task& task,
                                                const Slope& slope) {
  try {
    return look_up(library, task.density.percent, slope.covered);
  } catch (const Error& error) {
    return error.what();
  }
}

/// A dig of the library, and the slope that it is for.
struct KnownOnSlope {
  Slope slope;
  PlannedDig dig;
};

/// The dig for the slope of the ground over which one like `usual` goes that enters it at x.
std::optional<KnownOnSlope> known_at(const PathLibrary& library, const Task& task,
                                     const DigParameters& usual, double x) {
  const double length = usual.penetration_length + usual.drag_length;
  const Slope slope = slope_in(library, task, x - length, x);
  if (std::isnan(slope.ground)) return std::nullopt;
  auto known = known_dig(library, task, slope);
  if (auto* dig = std::get_if<PlannedDig>(&known)) return KnownOnSlope{slope, *dig};
  return std::nullopt;
}

/// A dig from the best of starts along the reach, and from that of least work. Ground may bend: at
/// each start that of its own slope is tried too.
/// @param known  for the slope of all ground ahead; becomes the one that the dig is laid out from
std::variant<PlannedDig, DigFailure> best_start(const Task& task, const DigLayout& layout,
                                                const PathLibrary& library, KnownOnSlope& known,
                                                DigPlan& plan) {
  const Machine& machine = task.machine;
  const auto simulator =
      make_simulator(task.options.simulator, machine, task.soil, task.density.percent);
  std::variant<PlannedDig, DigFailure> best;
  double rank = 0.0;
  const KnownOnSlope ahead = known;
  const auto compare = [&](const std::variant<DigPath, Infeasible>& laid,
                           const KnownOnSlope& source) {
    if (const auto* infeasible = std::get_if<Infeasible>(&laid)) return DigFailure(*infeasible);
    const auto& path = std::get<DigPath>(laid);
    const auto outcome = dig_of_path(machine, *simulator, task.ground, path, task.objective());
    ++plan.evaluations;
    if (const auto* failure = std::get_if<DigFailure>(&outcome)) return *failure;
    const auto& dig = std::get<PlannedDig>(outcome);
    if (task.objective().rank(dig) > rank) {
      rank = task.objective().rank(dig);
      best = dig;
      plan.path = path;
      known = source;
    }
    return DigFailure();
  };
  const DigParameters& usual = ahead.dig.parameters;
  const DigFailure failure = compare(path_by(layout, usual, StartRule::Kind::least_work), ahead);
  for (const double x : starts_along_reach(machine)) {
    compare(layout.path_from(usual, x), ahead);
    const auto here = known_at(library, task, usual, x);
    if (here) compare(layout.path_from(here->dig.parameters, x), *here);
  }
  return rank > 0.0 ? best : std::variant<PlannedDig, DigFailure>(failure);
}

/// What the simulator says of the dig that is planned, its ground at rest.
void set_result(const Task& task, const DigResult& result, DigPlan& plan) {
  plan.torques = result.torques;
  plan.ground_after = result.after(task.ground).surface();
  Eigen::ArrayXXd& after = plan.ground_after.z;
  after = (after == task.ground.surface().z).select(std::nan(""), after).eval();
}

/// A dig of the library laid out where it is needed, and simulated if its figures do not hold
/// there.
std::variant<PlannedDig, DigFailure> dig_here(const Task& task, const PathLibrary& library,
                                              KnownOnSlope& source, DigPlan& plan) {
  const PlannedDig& known = source.dig;
  const SimulatorKind& kind = task.options.simulator;
  const DigLayout layout(task.machine, task.ground);
  if (!task.level && task.options.search.start_rule.kind == StartRule::Kind::searched) {
    return best_start(task, layout, library, source, plan);
  }
  auto path = task.level ? layout.path_near(known.parameters, known.start_x)
                         : path_by(layout, known.parameters, task.options.search.start_rule);
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) return DigFailure(*infeasible);
  plan.path = std::get<DigPath>(std::move(path));
  if (task.level && library.simulator == kind.name) {
    PlannedDig dig = known;
    dig.start_x = plan.path.start_x;
    add_cycle(dig, task.machine, plan.path, task.objective());
    return dig;
  }
  plan.evaluations = 1;
  const auto simulator = make_simulator(kind, task.machine, task.soil, task.density.percent);
  const auto outcome =
      dig_to_rest(task.machine, *simulator, task.ground, plan.path, task.objective());
  if (const auto* failure = std::get_if<DigFailure>(&outcome)) return *failure;
  const auto& [dig, result] = std::get<SimulatedDig>(outcome);
  set_result(task, result, plan);
  return dig;
}

/// Warns where the ground is unlike that of the library. @return whether it is alike
bool suits_ground(const Task& task, const Slope& slope, const PlannedDig& expected, DigPlan& plan) {
  const std::string remedy = "; use a search for this ground";
  if (std::abs(slope.ground - slope.covered) > much_steeper) {
    warn(plan, {WarningCode::slope_outside_library,
                "the slope of the ground is " + readable(slope.ground, 2) +
                    " rad, the look-up used " + readable(slope.covered, 2) + " rad" + remedy});
    return false;
  }
  const DigGoalInfo& goal = info_of(task.objective().goal);
  const double here = task.objective().worth(*plan.dig);
  const double there = task.objective().worth(expected);
  if (here < (1.0 - far_below) * there) {
    warn(plan, {WarningCode::ground_unlike_library,
                "the path from the library reaches " + readable(goal.per_si * here) + " " +
                    goal.unit + " on this ground, but " + readable(goal.per_si * there) + " " +
                    goal.unit + " on the even ground of the library" + remedy});
    return false;
  }
  return true;
}

void look_up_plan(const Task& task, DigPlan& plan) {
  const auto library = library_of(task);
  const Slope slope = slope_ahead(*library, task);
  const auto known = known_dig(*library, task, slope);
  if (const auto* reason = std::get_if<std::string>(&known)) {
    plan.reason = *reason;
    return;
  }
  KnownOnSlope source{slope, std::get<PlannedDig>(known)};
  plan.start_rule = task.level ? "of the library" : describe(task.options.search.start_rule);
  const auto outcome = dig_here(task, *library, source, plan);
  if (const auto* failure = std::get_if<DigFailure>(&outcome)) {
    plan.path = {};
    plan.reason =
        "the library's path does not work here (a search may find one): " + describe(*failure);
    return;
  }
  plan.dig = std::get<PlannedDig>(outcome);
  plan.look_up = PlanLookUp{source.slope.covered, std::nullopt};
  if (task.level || suits_ground(task, source.slope, source.dig, plan)) {
    plan.look_up->error = look_up_error(*library, task.density.percent, source.slope.covered);
  }
}

/// The library's dig to begin with, if there is one.
std::vector<KnownDig> known_start(const Task& task, DigPlan& plan) {
  try {
    const auto library = library_of(task);
    const auto known = known_dig(*library, task, slope_ahead(*library, task));
    if (const auto* dig = std::get_if<PlannedDig>(&known)) return {dig->parameters};
    if (task.options.library) throw Error(ErrorKind::bad_input, std::get<std::string>(known));
  } catch (const Error& error) {
    if (task.options.library) throw;
    if (error.kind() == ErrorKind::bad_file) {
      warn(plan,
           {WarningCode::library_unreadable,
            std::string("the search has no warm start from the shipped library: ") + error.what()});
    }
  }
  return {};
}

/// The paper's algorithm begins at random, unless a dig or a library is given.
bool begins_known(const Task& task) {
  return task.options.library || std::holds_alternative<MemeticSearch>(task.options.search.method);
}

bool is_usual(const MemeticSearch& method) {
  const auto numbers = [](const MemeticSearch& of) {
    return std::make_tuple(of.first_generation, of.generations, of.generation_size, of.immigrants,
                           of.basins, of.polish_evaluations, of.basin_radius, of.polishing,
                           of.restarts);
  };
  return numbers(method) == numbers(std::get<MemeticSearch>(budget_search().method));
}

/// With the digs of the default method, unless the caller said how many.
DigSearchOptions within_budget(const DigSearchOptions& search, bool uncertain) {
  DigSearchOptions options = search;
  auto* memetic = std::get_if<MemeticSearch>(&options.method);
  if (options.stop.evaluations != 0 || !memetic) return options;
  options.stop.evaluations = evaluation_budget(uncertain, !options.start.empty());
  if (!uncertain && is_usual(*memetic)) {  // slopes and pits have more valleys than level ground
    memetic->first_generation = 48;
    memetic->polish_evaluations = 30;
  }
  return options;
}

/// @param best  of what was found, if anything was
template <typename Result>
void take(const Found<Result>& found, const DigSearchResult* best, DigPlan& plan) {
  if (best) {
    plan.dig = best->dig;
    plan.path = best->path;
    plan.evaluations = found->evaluations;
    plan.search = PlanSearch{best->worth, best->stopped_by, best->refused, best->insight.seen,
                             {},          best->ranks};
    if (best->failed > 0) {
      warn(plan, {WarningCode::simulator_failed,
                  std::to_string(best->failed) + " of " + std::to_string(best->evaluations) +
                      " digs failed and were left out, the first: " + best->first_failure});
    }
    for (const DigParameterInfo* info : best->at_bound) {
      warn(plan, {WarningCode::optimum_at_bound,
                  std::string("the best path found lies at an end of the search range of the ") +
                      info->text + ": a wider range may hold a better one"});
    }
  }
  plan.stopped = best ? best->stopped : found.stopped;
  if (!best) plan.evaluations = found.evaluations;
  if (best || plan.stopped) return;
  plan.reason = "no dig inside the search ranges can be done on this ground";
  plan.nearest = found.nearest;
}

void search_as_told(const Task& task, const SoilSimulator& simulator, DigSearchOptions options,
                    DigPlan& plan) {
  require_own_checkpoint(task.machine, simulator, task.ground, options);
  const auto first = search_by_least_work(task.machine, simulator, task.ground, options);
  if (first && was_stopped(*first)) return take(*first, *first ? &**first : nullptr, plan);
  auto found = search_dig(task.machine, simulator, task.ground, options);
  if (first) precede(*first, found);
  take(found, found ? &*found : nullptr, plan);
}

/// Whether a search is the default one in the default simulator, of which two fidelities are known.
bool is_usual(const Task& task) {
  const DigSearchOptions& search = task.options.search;
  const StopRules& stop = search.stop;
  const auto* method = std::get_if<MemeticSearch>(&search.method);
  return stop.evaluations == 0 && stop.stall == 0 && stop.seconds == 0.0 && !stop.target &&
         method && is_usual(*method) && search.start_rule.kind == StartRule::Kind::searched &&
         task.options.simulator.name == default_simulator().name;
}

void search_usual(const Task& task, const SoilSimulator& simulator, DigSearchOptions options,
                  DigPlan& plan) {
  options.stop.evaluations = screened_digs;
  const auto found = search_screened(task.machine, simulator, task.ground, options);
  take(found, found ? &*found : nullptr, plan);
}

void search_certain(const Task& task, const SoilSimulator& simulator,
                    const DigSearchOptions& options, DigPlan& plan) {
  const auto search = is_usual(task) ? search_usual : search_as_told;
  search(task, simulator, options, plan);
}

/// The few digs for each soil do not find the valley on uneven ground: those for the most likely
/// one do, as many as for a density that is known.
DigPlan search_most_likely(const Task& task, const std::vector<PossibleSoil>& soils,
                           const DigSearchOptions& options) {
  const auto& likely = *std::max_element(
      soils.begin(), soils.end(),
      [](const PossibleSoil& a, const PossibleSoil& b) { return a.probability < b.probability; });
  DigSearchOptions certain = within_budget(options, false);
  certain.checkpoint = {};
  DigPlan found;
  search_certain(task, *likely.simulator, certain, found);
  return found;
}

void search_uncertain(const Task& task, const std::vector<PossibleSoil>& soils,
                      DigSearchOptions options, DigPlan& plan) {
  require_own_checkpoint(task.machine, soils, task.ground, within_budget(options, true));
  int digs_of_likely = 0;
  if (!task.level && begins_known(task)) {
    const DigPlan likely = search_most_likely(task, soils, options);
    digs_of_likely = likely.evaluations;
    if (likely.dig) {
      options.start.emplace(options.start.begin(), likely.dig->parameters, likely.dig->start_x);
    }
  }
  options = within_budget(options, true);
  const auto found = search_dig(task.machine, soils, task.ground, options);
  take(found, found ? &found->expected : nullptr, plan);
  plan.evaluations += digs_of_likely;
  if (plan.dig && !plan.stopped) plan.search->value_of_knowing = found->value_of_knowing();
}

void search_plan(const Task& task, const std::vector<PossibleSoil>& soils, DigPlan& plan) {
  DigSearchOptions options = task.options.search;
  options.objective = options.objective.worthwhile();
  if (options.start.empty() && begins_known(task)) options.start = known_start(task, plan);
  plan.start_rule = describe(options.start_rule);
  if (task.uncertain()) {
    search_uncertain(task, soils, options, plan);
  } else {
    options = within_budget(options, false);
    search_certain(task, *soils.front().simulator, options, plan);
  }
}

void add_spread(const Task& task, const std::vector<PossibleSoil>& soils, DigPlan& plan) {
  plan.spread = dig_spread(task.machine, soils, task.ground, *plan.dig, plan.path);
  plan.evaluations += static_cast<int>(soils.size());
  if (plan.spread.stall_probability <= likely_stall) return;
  warn(plan, {WarningCode::may_stall, "the machine stalls with a probability of " +
                                          readable(100.0 * plan.spread.stall_probability, 2) +
                                          " %; the results are those of the digs without a stall"});
}

/// Digs the plan, unless that was done to tell its figures. Those of a library are without the
/// ground; digs that are compared by the thousand do not wait until theirs has come to rest.
void add_result(const Task& task, DigPlan& plan) {
  if (plan.ground_after.z.size() > 0) return;
  const auto simulator =
      make_simulator(task.options.simulator, task.machine, task.soil, task.density.percent);
  set_result(task, checked_dig(*simulator, task.machine, task.ground, plan.path, {}), plan);
}

void add_trajectory(const Task& task, DigPlan& plan) {
  auto approach = DigLayout(task.machine, task.ground).approach(plan.path);
  if (const auto* blocked = std::get_if<Infeasible>(&approach)) {
    warn(plan, {WarningCode::approach_blocked,
                "the trajectory begins on the ground, because the approach is blocked: " +
                    blocked->message});
  } else {
    plan.path.approach = std::get<std::vector<DigPose>>(std::move(approach));
  }
  plan.trajectory = time_dig_path(task.machine, plan.path, task.options.trajectory, plan.torques);
}

/// Takes back a dig that lifts next to nothing.
bool is_worth_making(DigPlan& plan) {
  if (!plan.dig || plan.dig->fill >= worth_making) return plan.dig.has_value();
  plan.reason = "no dig is worth making: the best found, " +
                path_text(plan.dig->parameters, plan.dig->start_x) + ", fills " +
                readable(100.0 * plan.dig->fill, 2) + " % of the bucket";
  plan.dig.reset();
  plan.path = {};
  plan.torques.clear();
  plan.ground_after = {};
  return false;
}

void judge_fill(const Task& task, DigPlan& plan) {
  const double asked = task.objective().min_fill;
  if (plan.dig->fill >= asked) return;
  warn(plan, {WarningCode::min_fill_relaxed,
              "no dig was found that fills " + readable(100.0 * asked) +
                  " % of the heaped capacity of the bucket; the fullest that was found fills " +
                  readable(100.0 * plan.dig->fill) + " %"});
}

DigPlan plan_dig(const Task& task) {
  require_machine(task.machine);
  require_soil(task.soil);
  require_terrain(task.ground, "ground to dig on");
  require_density(task.density);
  check(task.objective(), task.machine);
  const PlanMethod method = task.options.method;
  require(method == PlanMethod::library || method == PlanMethod::search, "method of a plan",
          static_cast<double>(method), "one of PlanMethod");
  require_in("search: stop.evaluations", task.options.search.stop.evaluations, 0, most_evaluations);
  DigPlan plan;
  plan.method = task.options.method;
  plan.attitude = plan.on_slope = task.options.attitude;
  for (const Warning& doubt : task.ground.doubts) warn(plan, doubt);
  judge_density(task, plan);
  if (!task.level || task.options.standing_on) judge_standing(task, plan);
  judge_strip(task, plan);
  std::optional<PossibleGround> ground;  // not for a density taken as known that is looked up
  if (plan.method == PlanMethod::search || task.uncertain()) {
    ground.emplace(task.options.simulator, task.machine, task.soil, task.density);
  }
  if (plan.method == PlanMethod::library) look_up_plan(task, plan);
  if (plan.method == PlanMethod::search) search_plan(task, ground->soils(), plan);
  if (!is_worth_making(plan)) return plan;
  judge_fill(task, plan);
  plan.cycle = cycle_of(task.machine, plan.path, *plan.dig, task.objective());
  if (task.uncertain()) add_spread(task, ground->soils(), plan);
  add_result(task, plan);
  add_trajectory(task, plan);
  return plan;
}

}  // namespace

const char* name(PlanMethod method) { return method == PlanMethod::library ? "library" : "search"; }

PathLibrary shipped_library(const Machine& machine, const SoilKind& soil,
                            const DigObjective& objective, const std::string& data_folder) {
  const std::string goal = info_of(objective.goal).word;
  std::string file;
  try {
    file = find_data_file("libraries/" + file_name_part(machine.name) + "-" +
                              file_name_part(soil.name) + "-" + goal + ".json",
                          data_folder);
  } catch (const Error&) {
    if (!has_data_folder("libraries", data_folder)) throw;
    throw Error(
        ErrorKind::bad_input,
        "no library of " + machine.name + " in " + soil.name + " for the goal " + goal +
            " is shipped: make one with machine-kit or build-path-library, or use a search");
  }
  PathLibrary library = load_path_library(file);
  require_fit(library, machine, soil, objective);
  return library;
}

DigPlan plan_dig(const Machine& machine, const SoilKind& soil, const GroundDensity& density,
                 const Terrain& terrain, const PlanOptions& options) {
  require_terrain(terrain, "ground to dig on");
  const Machine standing = with_attitude(machine, options.attitude);
  return plan_dig(Task{standing, machine, soil, density, with_obstacles(terrain), false, options});
}

DigPlan plan_dig(const Machine& machine, const SoilKind& soil, const GroundDensity& density,
                 const PlanOptions& options) {
  const Terrain level =
      level_planning_ground(machine, options.cell_size.value_or(usual_cell(machine)));
  const Machine standing = with_attitude(machine, options.attitude);
  const bool is_level = standing.attitude.is_level();
  return plan_dig(Task{standing, machine, soil, density, level, is_level, options});
}

}  // namespace excavplan
