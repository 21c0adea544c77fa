// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/field_experiment.hpp>

#include <atomic>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "experiments/equal_payload.hpp"
#include "experiments/study_survey.hpp"

namespace excavplan {
namespace {

constexpr int frames = 30;        // of the camera, averaged; ours
constexpr int equal_digs = 1000;  // of the search at no less payload; ours

constexpr int most_digs = 10000;  // ours

/// The same dig, its soil in blocks where it is hard; dug with the machine held down, as it was if
/// need be.
DigScene in_blocks(Machine machine, const DigScene& scene, const SoilKind& soil,
                   const SimulatorKind& simulator, std::uint64_t seed) {
  machine.body.reset();
  SceneOptions options;
  options.path = scene.path.parameters;
  options.start_x = scene.path.start_x;
  options.dump_at = scene.dump_at;
  options.simulator = simulator;
  options.blocks.emplace();
  options.blocks->seed = seed;
  return run_scene(machine, soil, scene.density_percent, scene.before, options);
}

class FieldExperiment {
 public:
  FieldExperiment(const Machine& machine, const SoilKind& soil, const DensityLaw& law,
                  const FieldOptions& options)
      : machine_(machine), soil_(soil), law_(law), options_(options) {}

  FieldRun run(double density, std::uint64_t index) const {
    FieldRun run;
    try {
      dig(density, Random(options_.seed, index).bits(), run);
    } catch (const Error& error) {
      run.failure = error.what();
    }
    return run;
  }

 private:
  void dig(double density, std::uint64_t seed, FieldRun& run) const {
    ExperimentOptions options = options_.experiment;
    const SoilKind dug = drawn_soil(soil_, {}, seed);
    options.dug_soil = dug;
    options.plan.search.threads = 1;
    options.survey = [&](const DigScene& first) {
      const SimulatorKind digs = options.digs.value_or(options.plan.simulator);
      return survey(in_blocks(machine_, first, dug, digs, seed), seed, run);
    };
    const ExperimentResult found = run_experiment(machine_, soil_, law_, density, options);
    const ExperimentResult equal =
        run_experiment(machine_, soil_, law_, density,
                       at_equal_payload(found.objective.goal, found, equal_digs, options));
    run.estimate = found.estimate;
    run.held_down = !found.held_because.empty();
    run.energy_gain = found.gain_percent();
    run.equal_energy_gain = equal.gain_percent();
    run.equal_path_gain = equal.path_gain_percent();
    run.fixed = fuelled(found.fixed, options_.fuel);
    run.planned = fuelled(found.planned, options_.fuel);
    run.equal = fuelled(equal.planned, options_.fuel);
  }

  RelativeDensity survey(const DigScene& scene, std::uint64_t seed, FieldRun& run) const {
    const DensityEstimate estimate =
        surveyed_dig(scene, {StudySensor::d435i, seed, frames}, soil_, law_);
    RelativeDensity density = *estimate.density;
    density.trustworthy = estimate.trustworthy;
    run.bulking_factor = estimate.bulking->value;
    run.warnings = estimate.warnings;
    run.density_raw = density.raw_percent;
    return density;
  }

  const Machine& machine_;
  const SoilKind& soil_;
  const DensityLaw& law_;
  const FieldOptions& options_;
};

void summarise(FieldResult& result, std::uint64_t seed) {
  std::vector<const FieldRun*> telling;
  for (const FieldRun& run : result.runs) {
    if (!run.failure.empty()) {
      ++result.failed;
      continue;
    }
    result.trusted += run.estimate.trustworthy ? 1 : 0;
    if (run.held_down) {
      ++result.held_down;
      continue;
    }
    telling.push_back(&run);
  }
  const auto mean = [&](auto value) {
    std::vector<double> values;
    values.reserve(telling.size());
    for (const FieldRun* run : telling) values.push_back(value(*run));
    return bootstrap_mean(values, seed);
  };
  const auto gain_of = [&](FuelledDig FieldRun::*dig) {
    return mean([=](const FieldRun& run) { return fuel_gain_percent(run.*dig, run.fixed); });
  };
  const auto volume_of = [&](FuelledDig FieldRun::*dig) {
    return mean([=](const FieldRun& run) {
      return (run.*dig).dig.payload_volume / run.fixed.dig.payload_volume;
    });
  };
  result.gain = gain_of(&FieldRun::planned);
  result.volume_ratio = volume_of(&FieldRun::planned);
  result.equal_gain = gain_of(&FieldRun::equal);
  result.equal_volume_ratio = volume_of(&FieldRun::equal);
  result.energy_gain = mean([](const FieldRun& run) { return run.energy_gain; });
  result.equal_energy_gain = mean([](const FieldRun& run) { return run.equal_energy_gain; });
  result.equal_path_gain = mean([](const FieldRun& run) { return run.equal_path_gain; });
}

}  // namespace

FuelledDig fuelled(const PlannedDig& dig, const FuelModel& fuel) {
  const double idle = fuel.idle_flow * dig.duration;
  return {dig, idle, fuel.flow(dig.energy / dig.duration) * dig.duration - idle};
}

double fuel_gain_percent(const FuelledDig& planned, const FuelledDig& fixed) {
  return 100.0 * (planned.efficiency() / fixed.efficiency() - 1.0);
}

std::vector<FieldResult> run_field_experiment(const Machine& machine, const SoilKind& soil,
                                              const DensityLaw& law,
                                              const std::vector<double>& densities_percent,
                                              const FieldOptions& options) {
  require_machine(machine);
  require_soil(soil);
  require_in("field experiment: digs", options.digs, 1, most_digs);
  const auto digs = static_cast<std::size_t>(options.digs);
  std::vector<FieldResult> results;
  for (const double density : densities_percent) {
    results.push_back({});
    results.back().density_percent = density;
    results.back().runs.resize(digs);
  }
  const FieldExperiment experiment(machine, soil, law, options);
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  parallel_for(results.size() * digs, options.threads, [&](std::size_t task) {
    if (stopped) return;
    FieldResult& result = results[task / digs];
    result.runs[task % digs] = experiment.run(result.density_percent, task % digs);
    const double share = static_cast<double>(++done) / static_cast<double>(results.size() * digs);
    if (options.progress && !options.progress(share)) stopped = true;
  });
  if (stopped) return {};
  for (FieldResult& result : results) summarise(result, options.seed);
  return results;
}

}  // namespace excavplan
