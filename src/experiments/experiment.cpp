// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/experiment.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "experiments/experiment_site.hpp"
#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"
#include "planning/start_rule.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

double gain(const DigObjective& objective, const PlannedDig& of, const PlannedDig& over) {
  const double worth = objective.worth(over);
  require(worth > 0.0 && std::isfinite(worth), "worth of the dig compared with", worth,
          "above 0 and finite");
  return 100.0 * (objective.worth(of) / worth - 1.0);
}

Terrain ground_of(const Machine& machine, const ExperimentOptions& options) {
  return options.ground
             ? *options.ground
             : level_planning_ground(machine, options.plan.cell_size.value_or(usual_cell(machine)));
}

struct Dug {
  PlannedDig dig;
  DigPath path;
};

/// The digs of one experiment, in soil of one density.
class Experiment {
 public:
  Experiment(const Machine& machine, const SoilKind& soil, double density_percent,
             const ExperimentOptions& options)
      : machine_(machine),
        soil_(soil),
        options_(options),
        site_(soil, density_percent, options),
        ground_(ground_of(machine, options)),
        simulator_(site_.simulator(machine)) {}

  /// Digs with the machine held down from now on.
  void hold_machine() {
    held_.body.reset();
    simulator_ = site_.simulator(held_);
  }

  std::variant<Dug, DigFailure> attempt(const DigParameters& parameters,
                                        const StartRule& start) const {
    auto laid = path_by(DigLayout(machine_, ground_), parameters, start);
    if (const auto* infeasible = std::get_if<Infeasible>(&laid)) return DigFailure(*infeasible);
    auto& path = std::get<DigPath>(laid);
    const auto outcome =
        dig_of_path(machine_, *simulator_, ground_, path, options_.plan.search.objective);
    if (const auto* failure = std::get_if<DigFailure>(&outcome)) return *failure;
    return Dug{std::get<PlannedDig>(outcome), std::move(path)};
  }

  Dug dig(const DigParameters& parameters, const StartRule& start) const {
    auto outcome = attempt(parameters, start);
    if (const auto* failure = std::get_if<DigFailure>(&outcome)) {
      throw Error(ErrorKind::bad_input, describe(*failure));
    }
    return std::get<Dug>(std::move(outcome));
  }

  /// The dig with its heap.
  DigScene scene(const PlannedDig& fixed) const {
    return site_.scene(held_, site_.scene_ground(machine_), fixed.parameters, fixed.start_x);
  }

  /// Goes on where the dig of this scene ended.
  void go_on(const DigScene& scene) {
    if (options_.second == SecondGround::left) ground_ = scene.after;
  }

  PlannedDig plan(double density) const {
    const DigPlan plan = planned_for(density);
    if (plan.dig) return *plan.dig;
    throw Error(ErrorKind::bad_input,
                "no path for a density of " + readable(density) + " %: " + plan.reason +
                    (plan.nearest ? "; the nearest, " + describe(*plan.nearest) : ""));
  }

  /// From its own start; by the default rule if the true soil forbids that one.
  Dug dig_as_planned(const PlannedDig& plan) const {
    auto outcome = attempt(plan.parameters, plan.start_x);
    if (auto* dug = std::get_if<Dug>(&outcome)) return std::move(*dug);
    return dig(plan.parameters, {});
  }

  /// The rule that puts the start of a planned dig nearest to where it is.
  StartRule rule_behind(const PlannedDig& planned) const {
    const auto distance = [&](const StartRule& rule) {
      const auto path = path_by(DigLayout(machine_, ground_), planned.parameters, rule);
      const auto* laid = std::get_if<DigPath>(&path);
      return laid ? std::abs(laid->start_x - planned.start_x)
                  : std::numeric_limits<double>::infinity();
    };
    const StartRule work = StartRule::Kind::least_work;
    const StartRule margin = StartRule::Kind::largest_margin;
    return distance(work) < distance(margin) ? work : margin;
  }

 private:
  DigPlan planned_for(double density) const {
    const PlanOptions& plan = options_.plan;
    if (options_.seen) return plan_dig(machine_, soil_, density, options_.seen(ground_), plan);
    const bool level = !options_.ground && options_.second == SecondGround::fresh;
    return level ? plan_dig(machine_, soil_, density, plan)
                 : plan_dig(machine_, soil_, density, ground_, plan);
  }

  const Machine& machine_;
  Machine held_ = machine_;
  const SoilKind& soil_;
  const ExperimentOptions& options_;
  ExperimentSite site_;
  Terrain ground_;
  std::unique_ptr<const SoilSimulator> simulator_;
};

/// Why the fixed path would lift or drag the machine in this soil; empty if it would not.
std::string what_moves(const Experiment& experiment, const DigParameters& path) {
  for (const StartRule::Kind rule :
       {StartRule::Kind::largest_margin, StartRule::Kind::least_work}) {
    const auto outcome = experiment.attempt(path, rule);
    const auto* failure = std::get_if<DigFailure>(&outcome);
    const auto* stall = failure ? std::get_if<Stall>(failure) : nullptr;
    if (stall && stall->cause != Stall::Cause::torque) return describe(*failure);
  }
  return {};
}

/// Holds the machine down if it would be moved. @return why
std::string hold_if_moved(Experiment& experiment, const DigParameters& path) {
  std::string why = what_moves(experiment, path);
  if (!why.empty()) experiment.hold_machine();
  return why;
}

void check(const Machine& machine, const SoilKind& soil, const ExperimentOptions& options) {
  require_machine(machine);
  require_soil(soil);
  if (options.plan.cell_size) require_simulated_cell(*options.plan.cell_size);
}

}  // namespace

DigScene first_dig(const Machine& machine, const SoilKind& soil, double density_percent,
                   const ExperimentOptions& options) {
  check(machine, soil, options);
  Experiment experiment(machine, soil, density_percent, options);
  hold_if_moved(experiment, options.fixed_path);
  return experiment.scene(experiment.dig(options.fixed_path, {}).dig);
}

double ExperimentResult::gain_percent() const { return gain_percent(objective); }
double ExperimentResult::gain_percent(const DigObjective& by) const {
  return gain(by, planned, fixed);
}
double ExperimentResult::path_gain_percent() const {
  return fixed_moved ? gain(objective, planned, *fixed_moved) : std::nan("");
}
double ExperimentResult::start_gain_percent() const {
  return fixed_moved ? gain(objective, *fixed_moved, fixed) : std::nan("");
}

ExperimentResult run_experiment(const Machine& machine, const SoilKind& soil, const DensityLaw& law,
                                double density_percent, const ExperimentOptions& options) {
  check(machine, soil, options);
  Experiment experiment(machine, soil, density_percent, options);
  ExperimentResult result;
  result.held_because = hold_if_moved(experiment, options.fixed_path);
  result.density_percent = density_percent;
  result.objective = options.plan.search.objective;
  Dug fixed = experiment.dig(options.fixed_path, {});
  result.fixed = fixed.dig;
  result.fixed_path = std::move(fixed.path);
  if (options.estimate && options.second == SecondGround::fresh) {
    result.estimate = *options.estimate;
  } else {
    const DigScene scene = experiment.scene(result.fixed);
    result.volumes = scene.volumes;
    result.estimate = options.estimate ? *options.estimate
                      : options.survey ? options.survey(scene)
                                       : relative_density(law, {scene.volumes.bulking_factor, 0.0});
    experiment.go_on(scene);
  }
  Dug planned = experiment.dig_as_planned(
      experiment.plan(options.planned_density.value_or(result.estimate.percent)));
  result.planned = planned.dig;
  result.planned_path = std::move(planned.path);
  result.start_rule = experiment.rule_behind(result.planned);
  const auto moved = experiment.attempt(options.fixed_path, result.start_rule);
  if (const auto* dug = std::get_if<Dug>(&moved)) result.fixed_moved = dug->dig;
  return result;
}

}  // namespace excavplan
