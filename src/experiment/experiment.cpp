// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiment/experiment.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <variant>

#include <excavplan/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/scene.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "planning/dig_layout.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

double gain(const DigObjective& objective, const PlannedDig& of, const PlannedDig& over) {
  const double worth = objective.worth(over);
  require(worth > 0.0 && std::isfinite(worth), "worth of the dig compared with", worth,
          "above 0 and finite");
  return 100.0 * (objective.worth(of) / worth - 1.0);
}

/// The digs of one experiment, in soil of one density.
class Experiment {
 public:
  Experiment(const Machine& machine, const SoilKind& soil, double density_percent,
             const ExperimentOptions& options)
      : machine_(machine),
        soil_(soil),
        density_(density_percent),
        options_(options),
        ground_(level_planning_ground(machine, options.plan.cell_size)),
        simulator_(make_simulator(options.plan.simulator, machine, soil, density_percent)) {}

  /// Digs with the machine held down from now on.
  void hold_machine() {
    held_.body.reset();
    simulator_ = make_simulator(options_.plan.simulator, held_, soil_, density_);
  }

  std::variant<PlannedDig, DigFailure> attempt(const DigParameters& parameters,
                                               const StartRule& start) const {
    const auto path = DigLayout(machine_, ground_).path(parameters, start);
    if (const auto* infeasible = std::get_if<Infeasible>(&path)) return DigFailure(*infeasible);
    return dig_along(machine_, *simulator_, ground_, std::get<DigPath>(path),
                     options_.plan.search.objective);
  }

  PlannedDig dig(const DigParameters& parameters, const StartRule& start) const {
    const auto outcome = attempt(parameters, start);
    if (const auto* failure = std::get_if<DigFailure>(&outcome)) {
      throw Error(ErrorKind::bad_input, describe(*failure));
    }
    return std::get<PlannedDig>(outcome);
  }

  HeightMapVolumes volumes(const PlannedDig& fixed) const {
    SceneOptions dig;
    dig.path = fixed.parameters;
    dig.start_x = fixed.start_x;
    dig.simulator = options_.plan.simulator;
    const Terrain ground =
        undisturbed(flat_ground(scene_extent(machine_, dig.dump_at), options_.plan.cell_size));
    return run_scene(held_, soil_, density_, ground, dig).volumes;
  }

  PlannedDig plan(double density) const {
    const DigPlan plan = plan_dig(machine_, soil_, density, options_.plan);
    if (plan.dig) return *plan.dig;
    throw Error(ErrorKind::bad_input,
                "no path for a density of " + readable(density) + " %: " + plan.reason +
                    (plan.nearest ? "; the nearest, " + describe(*plan.nearest) : ""));
  }

  /// From its own start; by the default rule if the true soil forbids that one.
  PlannedDig dig_as_planned(const PlannedDig& plan) const {
    const auto outcome = attempt(plan.parameters, plan.start_x);
    if (const auto* dug = std::get_if<PlannedDig>(&outcome)) return *dug;
    return dig(plan.parameters, {});
  }

  /// The rule that puts the start of a planned dig nearest to where it is.
  StartRule rule_behind(const PlannedDig& planned) const {
    const auto distance = [&](const StartRule& rule) {
      const auto path = DigLayout(machine_, ground_).path(planned.parameters, rule);
      const auto* laid = std::get_if<DigPath>(&path);
      return laid ? std::abs(laid->start_x - planned.start_x)
                  : std::numeric_limits<double>::infinity();
    };
    const StartRule work = StartRule::Kind::least_work;
    const StartRule margin = StartRule::Kind::largest_margin;
    return distance(work) < distance(margin) ? work : margin;
  }

 private:
  const Machine& machine_;
  Machine held_ = machine_;
  const SoilKind& soil_;
  double density_;
  const ExperimentOptions& options_;
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

}  // namespace

double ExperimentResult::gain_percent() const { return gain(objective, planned, fixed); }
double ExperimentResult::path_gain_percent() const { return gain(objective, planned, fixed_moved); }
double ExperimentResult::start_gain_percent() const { return gain(objective, fixed_moved, fixed); }

ExperimentResult run_experiment(const Machine& machine, const SoilKind& soil, const DensityLaw& law,
                                double density_percent, const ExperimentOptions& options) {
  require_machine(machine);
  require_soil(soil);
  require_simulated_cell(options.plan.cell_size);
  Experiment experiment(machine, soil, density_percent, options);
  ExperimentResult result;
  result.held_because = what_moves(experiment, options.fixed_path);
  if (!result.held_because.empty()) experiment.hold_machine();
  result.density_percent = density_percent;
  result.objective = options.plan.search.objective;
  result.fixed = experiment.dig(options.fixed_path, {});
  result.volumes = experiment.volumes(result.fixed);
  result.estimate = relative_density(law, {result.volumes.bulking_factor, 0.0});
  result.planned = experiment.dig_as_planned(experiment.plan(result.estimate.percent));
  result.start_rule = experiment.rule_behind(result.planned);
  result.fixed_moved = experiment.dig(options.fixed_path, result.start_rule);
  return result;
}

}  // namespace excavplan
