// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/goal_words.hpp>
#include <excavplan/planning/plan_motion.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/results/result_json.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "plans.hpp"
#include "rooms.hpp"
#include "simulators.hpp"
#include "texts.hpp"
#include "words.hpp"

namespace excavplan::python {
namespace {

using py::arg;

// ---- what is searched ---------------------------------------------------------------------------

DigObjective objective_of(const std::string& word, const std::optional<double>& min_fill,
                          double swing, double dump_height, double rest_of_cycle,
                          double time_price) {
  const DigGoalInfo* const goal = goal_of_word(word);
  if (!goal) {
    std::string known;
    for (const DigGoalInfo& each : dig_goals()) known += (known.empty() ? "" : ", ") + each.word;
    throw Error(ErrorKind::bad_input, "the goal: '" + word + "' is none of " + known);
  }
  DigObjective objective(goal->goal);
  objective.min_fill = min_fill.value_or(objective.min_fill);
  objective.swing = swing;
  objective.dump_height = dump_height;
  objective.rest_of_cycle = rest_of_cycle;
  objective.time_price = time_price;
  return objective;
}

/// A word, a place [m] or nothing.
using Start = std::optional<std::variant<std::string, double>>;

StartRule start_rule_of(const Start& start, const StartRule& usual) {
  if (!start) return usual;
  if (const double* const x = std::get_if<double>(&*start)) return *x;
  const auto& word = std::get<std::string>(*start);
  if (const auto rule = start_rule_of_word(word)) return *rule;
  std::string known;
  for (const StartRuleInfo& info : start_rules()) known += ", " + info.word;
  throw Error(ErrorKind::bad_input, "the start rule: '" + word + "' is none of" + known.substr(1) +
                                        " and no x in metres");
}

SearchOptionsInPython made_options(const std::optional<DigObjective>& objective, int evaluations,
                                   double seconds, std::uint64_t seed, unsigned threads,
                                   const std::vector<DigParameters>& start, const Start& start_rule,
                                   const std::string& method, const File& checkpoint, bool resume,
                                   const py::object& progress) {
  SearchOptionsInPython made;
  DigSearchOptions& options = made.options;
  options.objective = objective.value_or(options.objective);
  options.stop.evaluations = evaluations;
  options.stop.seconds = seconds;
  options.seed = seed;
  options.threads = threads;
  options.start.assign(start.begin(), start.end());
  if (of_word<bool>("the method", method, {{"default", false}, {"paper", true}})) {
    options.method = GeneticAlgorithm{};
    options.start_rule = StartRule::Kind::least_work;
  }
  options.start_rule = start_rule_of(start_rule, options.start_rule);
  options.checkpoint = checkpoint.path;
  options.resume = resume;
  if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) {
    throw py::type_error("progress: expected a function or None");
  }
  made.progress = progress;
  return made;
}

/// Of one call: asks its callback, and whether it was interrupted.
DigSearchOptions options_in(const std::shared_ptr<Call>& call,
                            const std::optional<SearchOptionsInPython>& given,
                            const py::object& simulator) {
  const SearchOptionsInPython own = given.value_or(SearchOptionsInPython{});
  DigSearchOptions options = own.options;
  options.threads = threads_with(simulator, options.threads);
  options.progress = [call, progress = shared(own.progress)](const SearchProgress& state) {
    return !call->failed() && goes_on(*call, *progress, state);
  };
  return options;
}

void bind_search(py::module_& module) {
  const CycleOptions usual;
  py::class_<DigObjective>(module, "DigObjective", "What the best dig is best for.")
      .def(py::init(&objective_of), arg("goal") = "cycle", py::kw_only(),
           arg("min_fill") = py::none(), arg("swing") = usual.swing,
           arg("dump_height") = usual.dump_height, arg("rest_of_cycle") = usual.rest_of_cycle,
           arg("time_price") = 0.0,
           "goal: 'cycle' (mass per energy of the cycle), 'energy' (of the dig alone, as in the\n"
           "paper), 'time' (mass per time) or 'priced'; min_fill: least share of the heaped\n"
           "capacity, else usual for the goal; swing [rad], dump_height [m], rest_of_cycle [s];\n"
           "time_price: what a second is worth, if priced [W].")
      .def_property_readonly("goal", [](const DigObjective& o) { return info_of(o.goal).word; })
      .def_property_readonly(
          "unit", [](const DigObjective& o) { return info_of(o.goal).unit; },
          "In which the tools show its worth: 'kg/kJ'.")
      .def_readonly("min_fill", &DigObjective::min_fill, "[-]")
      .def("worth", &DigObjective::worth, arg("dig"), "Of a dig, in SI; larger is better.")
      .def("__repr__", [](const DigObjective& o) { return "<DigObjective " + describe(o) + ">"; });
  py::class_<SearchProgress>(module, "SearchProgress", "How far a search is.")
      .def_readonly("generation", &SearchProgress::generation, "0: the first.")
      .def_readonly("evaluations", &SearchProgress::evaluations, "Made so far.")
      .def_readonly("planned", &SearchProgress::planned, "Evaluations in all, at most.")
      .def_readonly("best", &SearchProgress::best, "Fitness; NaN while nothing was found.")
      .def_readonly("mean", &SearchProgress::mean, "Of the feasible of the last generation.")
      .def_readonly("seconds", &SearchProgress::seconds, "Since the search began [s].")
      .def_readonly("seconds_left", &SearchProgress::seconds_left, "Estimate [s]; NaN: unknown.");
  py::class_<SearchOptionsInPython>(module, "DigSearchOptions", "How digs are searched.")
      .def(py::init(&made_options), py::kw_only(), arg("objective") = py::none(),
           arg("evaluations") = 0, arg("seconds") = 0.0, arg("seed") = 1, arg("threads") = 0,
           arg("start") = std::vector<DigParameters>{}, arg("start_rule") = py::none(),
           arg("method") = "default", arg("checkpoint") = "", arg("resume") = false,
           arg("progress") = py::none(),
           "objective: DigObjective; evaluations: digs at most, 0 is usual; seconds: at most [s],\n"
           "0: no limit; seed: same seed, same result; threads: 0 is one per core, 1 with a\n"
           "simulator in Python; start: known digs to begin with; start_rule: 'search', 'work',\n"
           "'margin' or the x of the start [m]; method: 'default' or 'paper'; checkpoint, resume:\n"
           "a file that holds the digs made; progress: is called with a SearchProgress, and what\n"
           "it returns ends the search if it is false and not None.")
      .def_property_readonly(
          "objective", [](const SearchOptionsInPython& o) { return o.options.objective; },
          "DigObjective.")
      .def_property_readonly(
          "evaluations", [](const SearchOptionsInPython& o) { return o.options.stop.evaluations; },
          "Digs at most; 0: as usual.")
      .def_property_readonly(
          "seconds", [](const SearchOptionsInPython& o) { return o.options.stop.seconds; },
          "At most [s]; 0: no limit.")
      .def_property_readonly(
          "seed", [](const SearchOptionsInPython& o) { return o.options.seed; },
          "Same seed, same result.")
      .def_property_readonly(
          "threads", [](const SearchOptionsInPython& o) { return o.options.threads; },
          "0: one per core.")
      .def_property_readonly(
          "checkpoint", [](const SearchOptionsInPython& o) { return File{o.options.checkpoint}; },
          "File of the digs made; empty: none.");
}

// ---- digs ---------------------------------------------------------------------------------------

void bind_digs(py::module_& module) {
  py::class_<PlannedDig>(module, "PlannedDig", "A dig with its expected payload and cost.")
      .def_readonly("parameters", &PlannedDig::parameters, "Of its path.")
      .def_readonly("start_x", &PlannedDig::start_x, "Where the tip meets the ground [m].")
      .def_readonly("payload_mass", &PlannedDig::payload_mass, "Moist [kg].")
      .def_readonly("payload_volume", &PlannedDig::payload_volume, "Loose [m^3].")
      .def_readonly("energy", &PlannedDig::energy, "[J]")
      .def_readonly("duration", &PlannedDig::duration, "Of penetrate, drag and scoop [s].")
      .def_readonly("fill", &PlannedDig::fill, "Payload volume over the heaped capacity [-].")
      .def_readonly("cycle_energy", &PlannedDig::cycle_energy, "[J]; 0: not known.")
      .def_readonly("cycle_time", &PlannedDig::cycle_time, "[s]; 0: not known.")
      .def_property_readonly("efficiency", &PlannedDig::efficiency, "Mass per energy [kg/J].");
  py::class_<NearestDig>(module, "NearestDig", "What came nearest to a dig. It is false.")
      .def_readonly("parameters", &NearestDig::parameters, "Of its path.")
      .def_readonly("start_x", &NearestDig::start_x, "[m]; None if no start was found.")
      .def_readonly("reason", &NearestDig::reason)
      .def("__bool__", [](const NearestDig&) { return false; })
      .def("__repr__", [](const NearestDig& dig) { return "<NearestDig: " + describe(dig) + ">"; });
  py::class_<ParameterRange>(module, "ParameterRange", "Values of one parameter.")
      .def_readonly("low", &ParameterRange::low, "Smallest.")
      .def_readonly("high", &ParameterRange::high, "Largest.");
  py::class_<DigSearchResult>(module, "DigSearchResult", "The best dig found.")
      .def_readonly("dig", &DigSearchResult::dig)
      .def_readonly("path", &DigSearchResult::path, "Of the dig, without an approach.")
      .def_readonly("worth", &DigSearchResult::worth, "By the objective, in SI.")
      .def_readonly("evaluations", &DigSearchResult::evaluations, "Digs simulated.")
      .def_readonly("refused", &DigSearchResult::refused, "Not simulated: cannot be driven.")
      .def_readonly("infeasible", &DigSearchResult::infeasible, "The machine stalled.")
      .def_readonly("failed", &DigSearchResult::failed, "The simulator failed.")
      .def_readonly("first_failure", &DigSearchResult::first_failure)
      .def_readonly("stopped", &DigSearchResult::stopped, "By `progress`.")
      .def_property_readonly(
          "stopped_by", [](const DigSearchResult& r) { return name(r.stopped_by); },
          "What ended the search.")
      .def_property_readonly(
          "ranks",
          [](const DigSearchResult& r) {
            return array_of(r.ranks, [](double rank) { return rank; });
          },
          "Of each dig simulated, shape (N,); NaN: it stalled or failed.");
}

using Evaluated = std::variant<PlannedDig, Infeasible, Stall>;

Evaluated evaluated(const Machine& machine, const py::object& simulator, const Terrain& terrain,
                    const DigParameters& parameters, const Start& start) {
  const auto own = std::make_shared<Call>();
  const SimulatorInCall digger(simulator, own);
  const StartRule rule = start_rule_of(start, StartRule{});
  auto found = own->run([&] { return evaluate_dig(machine, digger, terrain, parameters, rule); });
  if (auto* dig = std::get_if<PlannedDig>(&found)) return *dig;
  return std::visit([](const auto& why) -> Evaluated { return why; }, std::get<DigFailure>(found));
}

using Searched = std::optional<std::variant<DigSearchResult, NearestDig>>;

Searched searched(const Machine& machine, const py::object& simulator, const Terrain& terrain,
                  const std::optional<SearchOptionsInPython>& given) {
  const auto own = std::make_shared<Call>();
  const SimulatorInCall digger(simulator, own);
  DigSearchOptions options = options_in(
      own, given, is_in_python(simulator.cast<const SoilSimulator&>()) ? simulator : py::none());
  if (options.stop.evaluations == 0) {
    options.stop.evaluations = evaluation_budget(false, !options.start.empty());
  }
  auto found = own->run([&] { return search_dig(machine, digger, terrain, options); });
  if (found) return *found;
  if (found.nearest) return *found.nearest;
  return std::nullopt;
}

// ---- plan ---------------------------------------------------------------------------------------

void bind_cycle(py::module_& module) {
  py::class_<CycleShare>(module, "CycleShare", "Energy and time of a cycle or a part of it.")
      .def_readonly("energy", &CycleShare::energy, "[J]")
      .def_readonly("time", &CycleShare::time, "[s]");
  py::class_<DigCycle>(module, "DigCycle", "Where energy and time of a cycle go.")
      .def_readonly("dig", &DigCycle::dig, "Penetrate, drag and scoop.")
      .def_readonly("lift", &DigCycle::lift, "Loaded, to the dump height.")
      .def_readonly("swing", &DigCycle::swing, "Loaded.")
      .def_readonly("dump", &DigCycle::dump, "Opening of the bucket.")
      .def_readonly("back", &DigCycle::back, "Swing back, while the bucket is lowered.")
      .def_readonly("lower", &DigCycle::lower, "Empty, to the start of the dig.")
      .def_readonly("rest", &DigCycle::rest, "Waiting, and the idle power over the whole cycle.")
      .def_readonly("total", &DigCycle::total, "Of parts that overlap the longer counts.");
}

using PlanClass = py::class_<PlanInPython>;

/// What `work` gives, which is told where to dig the plan once more.
template <typename Work>
auto rehearsed(const PlanInPython& plan, const Work& work) {
  const auto own = std::make_shared<Call>();
  const PlanContext& with = *plan.made_with;
  const SimulatorKind simulator = simulator_kind(*with.simulator, own);
  const PlanSite site = {with.soil, with.density.percent, with.ground, simulator};
  return work(*own, site);
}

Picture plot_of_plan(const PlanInPython& plan, const std::string& what,
                     const std::optional<File>& file) {
  if (!plan.dig) throw Error(ErrorKind::bad_input, "there is no dig to draw: " + plan.reason);
  const DigImage image = dig_image_of(what);
  return rehearsed(plan, [&](Call& own, const PlanSite& site) {
    return plotted(own, file, [&](ImageFormat format) {
      return dig_image(plan.made_with->machine, plan, site, image, format);
    });
  });
}

void write_report(const PlanInPython& plan, const File& file) {
  const PlanContext& with = *plan.made_with;
  write_bytes(file, rehearsed(plan, [&](Call& own, const PlanSite& site) {
                return own.run([&] {
                  return report_page(with.machine, plan, site, with.density, with.objective);
                });
              }));
}

void bind_plan_views(PlanClass& bound) {
  bound
      .def("plot", &plot_of_plan, arg("what") = "section", arg("file") = py::none(),
           "A Picture of the dig, simulated once more.\n\n"
           "what: 'section', 'forces', 'torques', 'power' or 'cylinders'; file: also written to,\n"
           ".svg, .png or .pdf.")
      .def("report", &write_report, arg("file"), "Writes the page of plan-path --report.")
      .def(
          "to_json",
          [](const PlanInPython& plan, const std::optional<GroundDensity>& density,
             const std::optional<DigObjective>& objective) {
            return to_json(plan, density.value_or(plan.made_with->density),
                           objective.value_or(plan.made_with->objective));
          },
          arg("density") = py::none(), arg("objective") = py::none(),
          "The text that plan-path prints with --json, but for its options.\n\n"
          "density, objective: else those that were planned for.");
}

void bind_plan(py::module_& module) {
  py::class_<DigSpread>(module, "DigSpread",
                        "Standard deviations of a dig's results as the density is uncertain.")
      .def_readonly("payload_mass", &DigSpread::payload_mass, "[kg]")
      .def_readonly("energy", &DigSpread::energy, "[J]")
      .def_readonly("efficiency", &DigSpread::efficiency, "[kg/J]")
      .def_readonly("stall_probability", &DigSpread::stall_probability, "[-]");
  py::class_<PlanSearch>(module, "PlanSearch", "Results of the search of a plan.")
      .def_readonly("worth", &PlanSearch::worth,
                    "Of the dig by the objective, in SI; the mean for an uncertain density.")
      .def_property_readonly(
          "stopped_by", [](const PlanSearch& s) { return name(s.stopped_by); },
          "What ended the search.")
      .def_readonly("refused", &PlanSearch::refused, "Digs not simulated: cannot be driven.")
      .def_readonly("ranges", &PlanSearch::ranges,
                    "Numbers worth 98 % of the best: angle, penetration, drag, start if searched.")
      .def_readonly("value_of_knowing", &PlanSearch::value_of_knowing,
                    "What knowing an uncertain density would add, as a share of the worth; None\n"
                    "for a density taken as known.")
      .def_property_readonly(
          "ranks",
          [](const PlanSearch& s) { return array_of(s.ranks, [](double rank) { return rank; }); },
          "Of each dig simulated, shape (N,); NaN: it stalled or failed.");
  py::class_<PlanLookUp>(module, "PlanLookUp", "Details of a look-up.")
      .def_readonly("slope", &PlanLookUp::slope, "Of the ground, as far as the library goes [rad].")
      .def_readonly("error", &PlanLookUp::error, "None on ground unlike the library's.");
  py::class_<PlanInPython> bound(module, "DigPlan", "The next dig, or why there is none.");
  bind_plan_views(bound);
  bound.def_readonly("dig", &DigPlan::dig, "Expected figures; None if there is no dig.")
      .def_readonly("spread", &DigPlan::spread, "From the density's standard deviation.")
      .def_readonly("path", &DigPlan::path, "Of the dig, with its approach.")
      .def_readonly("cycle", &DigPlan::cycle, "None if the machine does not state what it needs.")
      .def_readonly("trajectory", &DigPlan::trajectory, "Of that path.")
      .def_property_readonly(
          "method", [](const PlanInPython& plan) { return name(plan.method); },
          "'library' or 'search'.")
      .def_readonly("start_rule", &DigPlan::start_rule, "Of the start, for people.")
      .def_readonly("evaluations", &DigPlan::evaluations, "Digs simulated for the plan.")
      .def_readonly("search", &DigPlan::search, "If searched.")
      .def_readonly("look_up", &DigPlan::look_up, "If looked up.")
      .def_readonly("stopped", &DigPlan::stopped, "The search was cancelled.")
      .def_readonly("trustworthy", &DigPlan::trustworthy, "False: see the warnings.")
      .def_readonly("warnings", &DigPlan::warnings)
      .def_readonly("reason", &DigPlan::reason, "Why there is no dig; empty if there is one.")
      .def_readonly("nearest", &DigPlan::nearest, "If a search found no dig.")
      .def_property_readonly(
          "attitude",
          [](const PlanInPython& plan) {
            return Eigen::Vector2d(plan.attitude.roll, plan.attitude.pitch);
          },
          "(roll, pitch) of the machine that it was planned for [rad].");
}

PlanInPython planned(const Machine& machine, const SoilKind& soil, const GroundDensity& density,
                     const std::optional<Terrain>& terrain, const std::string& method,
                     const std::optional<PathLibrary>& library,
                     const std::optional<SearchOptionsInPython>& search,
                     const py::object& simulator, double speed_fraction,
                     std::optional<double> cell_size, const Eigen::Vector2d& attitude,
                     const std::optional<HeightMap>& standing_on) {
  const auto own = std::make_shared<Call>();
  PlanOptions options = plan_options(own, {method, library, search, simulator, speed_fraction});
  options.cell_size = cell_size;
  options.attitude = {attitude.x(), attitude.y()};
  options.standing_on = standing_on;
  const Terrain ground =
      terrain ? *terrain : level_planning_ground(machine, cell_size.value_or(usual_cell(machine)));
  PlanInPython made;
  static_cast<DigPlan&>(made) = own->run([&] {
    return terrain ? plan_dig(machine, soil, density, ground, options)
                   : plan_dig(machine, soil, density, options);
  });
  made.made_with = std::make_shared<const PlanContext>(
      PlanContext{machine, soil, density, ground, shared(simulator), options.search.objective});
  return made;
}

std::variant<Trajectory, BlockedWay> motion_of(const Machine& machine, const DigPlan& plan,
                                               const std::optional<Terrain>& terrain,
                                               const std::optional<FrontJoints>& start,
                                               bool whole_cycle, double swing, double dump_height,
                                               const MotionOptions& motion) {
  CycleWayOptions way = {start, whole_cycle};
  way.cycle.swing = swing;
  way.cycle.dump_height = dump_height;
  return call([&] {
    return terrain ? plan_motion(machine, *terrain, plan, way, motion)
                   : plan_motion(machine, plan, way, motion);
  });
}

void bind_motion(py::module_& module) {
  py::class_<BlockedWay>(module, "BlockedWay", "Ground in the way of a motion. It is false.")
      .def_property_readonly(
          "phase", [](const BlockedWay& way) { return name(way.phase); }, "In which.")
      .def_readonly("place", &BlockedWay::place, "(x, y, z) of the ground there [m].")
      .def_readonly("clearance", &BlockedWay::clearance, "Of the machine above it [m].")
      .def_readonly("message", &BlockedWay::message, "All of this in one sentence.")
      .def("__bool__", [](const BlockedWay&) { return false; })
      .def("__repr__", [](const BlockedWay& way) { return "<BlockedWay: " + way.message + ">"; });
  const CycleOptions cycle;
  const MotionOptions usual;
  module.def(
      "plan_motion",
      [](const Machine& machine, const PlanInPython& plan, const std::optional<Terrain>& terrain,
         const std::optional<FrontJoints>& start, bool whole_cycle, double swing,
         double dump_height, double rate, double speed_fraction, double corner_tolerance,
         double max_jerk) {
        return motion_of(machine, plan, terrain, start, whole_cycle, swing, dump_height,
                         {rate, speed_fraction, corner_tolerance, max_jerk});
      },
      arg("machine"), arg("plan"), arg("terrain") = py::none(), py::kw_only(),
      arg("start") = py::none(), arg("whole_cycle") = false, arg("swing") = cycle.swing,
      arg("dump_height") = cycle.dump_height, arg("rate") = usual.rate,
      arg("speed_fraction") = usual.speed_fraction,
      arg("corner_tolerance") = usual.corner_tolerance, arg("max_jerk") = usual.max_jerk,
      "The motion of a plan for a controller, or what blocks the way; it keeps the limits of the\n"
      "machine between its points. terrain: the ground before the dig that it must be clear of,\n"
      "of swing_extent(); where it is unknown or ends, Trajectory.warnings has unseen_way. None:\n"
      "level ground, nothing else that stands on the site is looked at;\n"
      "start: boom, arm, bucket, swing [rad] from which it begins; whole_cycle: over swing, dump\n"
      "and back; swing [rad], dump_height [m]: as of DigObjective; rate: points per second;\n"
      "corner_tolerance [m]; max_jerk: of each joint [rad/s^3].");
}

}  // namespace

PlanOptions plan_options(const std::shared_ptr<Call>& call, const PlanArguments& given) {
  PlanOptions options;
  options.method =
      of_word<PlanMethod>("the method", given.method,
                          {{"library", PlanMethod::library}, {"search", PlanMethod::search}});
  if (given.library) options.library = std::make_shared<PathLibrary>(*given.library);
  options.search = options_in(call, given.search, given.simulator);
  options.simulator = simulator_kind(given.simulator, call);
  options.trajectory.speed_fraction = given.speed_fraction;
  return options;
}

void bind_planning(py::module_& module) {
  bind_digs(module);
  bind_search(module);
  py::class_<PossibleDensity>(module, "PossibleDensity", "A density the ground may have.")
      .def_readonly("percent", &PossibleDensity::percent, "[%]")
      .def_readonly("probability", &PossibleDensity::probability, "All of them add up to 1.");
  module.def("possible_densities", &possible_densities, arg("mean_percent"), arg("sd_percent"),
             arg("count") = 3,
             "Nodes of the Gauss quadrature for a normal distribution cut off at 0 and 100 %.");
  module.def("evaluate_dig", &evaluated, arg("machine"), arg("simulator"), arg("terrain"),
             arg("parameters"), arg("start") = py::none(),
             "Lays out a dig, simulates and times it: its figures, or why it cannot be done.\n"
             "simulator: a SoilSimulator; start: 'work', 'margin' or its x [m].");
  module.def(
      "search_dig", &searched, arg("machine"), arg("simulator"), arg("terrain"),
      arg("options") = py::none(),
      "Searches the best dig in the soil of a SoilSimulator. If none can be done, what came\n"
      "nearest, or None if it was stopped before.");
}

void bind_plan_dig(py::module_& module) {
  bind_cycle(module);
  bind_plan(module);
  bind_motion(module);
  module.def(
      "plan_dig", &planned, arg("machine"), arg("soil"), arg("density"),
      arg("terrain") = py::none(), py::kw_only(), arg("method") = "library",
      arg("library") = py::none(), arg("search") = py::none(), arg("simulator") = py::none(),
      arg("speed_fraction") = TrajectoryOptions{}.speed_fraction, arg("cell_size") = py::none(),
      arg("attitude") = Eigen::Vector2d::Zero().eval(), arg("standing_on") = py::none(),
      "Plans the next dig on the ground given, or on level ground, as plan-path does.\n\n"
      "density: a number [%] or a GroundDensity, whose standard deviation counts; terrain:\n"
      "Terrain or HeightMap in the site frame; method: 'library' or 'search'; library: else\n"
      "the shipped one; search: DigSearchOptions; simulator: word or class; speed_fraction:\n"
      "of the limits of the machine; cell_size: of level ground, else as the machine\n"
      "needs it [m]; attitude: (roll, pitch) of the machine, left side up and front down,\n"
      "the terrain being in its frame [rad]; standing_on: ground under and about the\n"
      "tracks, of standing_ground_from_scan(), else as far as the terrain goes.");
}

}  // namespace excavplan::python
