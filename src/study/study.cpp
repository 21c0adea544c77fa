// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/study/study.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <excavplan/data_files.hpp>
#include <excavplan/simulation/calibration.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "study/equal_payload.hpp"
#include "study/study_row.hpp"
#include "study/study_survey.hpp"

namespace excavplan {
namespace {

constexpr double lowest_density = 5.0;    // of the runs [%]
constexpr double highest_density = 95.0;  // [%]
constexpr double rough_length = 0.3;      // over which rough ground is correlated [m]; ours

// Of a condition; ours.
constexpr double steepest = 0.6;  // [rad]
constexpr double roughest = 0.5;  // [m]
constexpr int most_in_row = 100;

/// Soils, laws and libraries of a study, each made once.
class Shelf {
 public:
  Shelf(const Machine& machine, const StudyOptions& options)
      : machine_(machine), draws_(options.draws), threads_(options.threads) {}

  /// Call for all conditions before the runs begin, which then only read.
  void prepare(const StudySetting& setting) {
    simulator_of_word(setting.digs);
    require_in("study: slope [rad]", setting.slope, -steepest, steepest);
    require_in("study: roughness [m]", setting.roughness, 0.0, roughest);
    require_in("study: digs in a row", setting.row, 1, most_in_row);
    const SoilKind& soil =
        soils_.emplace(setting.soil, load_soil(shipped_or_file("soils", setting.soil)))
            .first->second;
    libraries_.emplace(setting.soil, std::make_shared<PathLibrary>(shipped_library(
                                         machine_, soil, DigObjective::Goal::energy)));
    const auto key = key_of(setting);
    if (laws_.count(key) == 0) laws_.emplace(key, make_law(setting, soil));
  }
  const SoilKind& soil(const StudySetting& setting) const { return soils_.at(setting.soil); }
  const DensityLaw& law(const StudySetting& setting) const { return laws_.at(key_of(setting)); }
  std::shared_ptr<const PathLibrary> library(const StudySetting& setting) const {
    return libraries_.at(setting.soil);
  }

 private:
  using Key = std::tuple<StudyLaw, std::string, std::string>;
  static Key key_of(const StudySetting& setting) {
    return {setting.law, setting.soil, setting.digs};
  }

  const DensityCalibration& calibrated(const SoilKind& soil, const std::string& simulator) {
    const std::pair key(soil.name, simulator);
    const auto made = calibrations_.find(key);
    if (made != calibrations_.end()) return made->second;
    CalibrationOptions options;
    options.simulator = simulator_of_word(simulator);
    options.draws = draws_;
    options.threads = threads_;
    return calibrations_.emplace(key, calibrate_density(machine_, soil, options)).first->second;
  }

  DensityLaw make_law(const StudySetting& setting, const SoilKind& soil) {
    switch (setting.law) {
      case StudyLaw::other_engine:
        return law_of(calibrated(soil, setting.digs == "section" ? "height-map" : "section"));
      case StudyLaw::own_engine:
        return law_of(calibrated(soil, setting.digs));
      case StudyLaw::own_line: {
        DensityCalibration calibration = calibrated(soil, setting.digs);
        calibration.use = std::string("line") + as_measured;
        return law_of(calibration);
      }
      case StudyLaw::paper:
        return load_density_law(shipped_or_file("laws", "paper"));
      case StudyLaw::other_path:
        return law_of(calibrate_path(machine_, soil, paper_field_path(), threads_));
      case StudyLaw::other_soil:
        return load_density_law(
            shipped_or_file("laws", machine_.name + (setting.soil == "sand" ? "-loam" : "-sand")));
    }
    refuse("study: a law that is none of StudyLaw");
  }

  const Machine& machine_;
  int draws_;
  unsigned threads_;
  std::map<std::string, SoilKind> soils_;
  std::map<std::pair<std::string, std::string>, DensityCalibration> calibrations_;
  std::map<Key, DensityLaw> laws_;
  std::map<std::string, std::shared_ptr<const PathLibrary>> libraries_;
};

/// A height of zero mean and unit rms: a sum of waves of random direction and phase, whose
/// covariance falls as exp(-d^2 / (2 L^2)).
class RoughGround {
 public:
  explicit RoughGround(std::uint64_t seed) {
    Random random(seed, 7);
    for (Wave& wave : waves_) {
      wave.kx = random.normal() / rough_length;
      wave.ky = random.normal() / rough_length;
      wave.phase = 2.0 * pi * random.uniform();
    }
  }
  double height(double x, double y) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::cos(wave.kx * x + wave.ky * y + wave.phase);
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::array<Wave, 200> waves_;  // ours
};

Terrain study_ground(const Machine& machine, const StudySetting& setting, double cell_size,
                     std::uint64_t seed) {
  HeightMap map = flat_ground(scene_extent(machine, default_dump_point()), cell_size);
  const RoughGround rough(seed);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    map.z.col(col) += std::tan(setting.slope) * std::max(0.0, map.x(col) - machine.track_front);
    for (Eigen::Index row = 0; setting.roughness > 0.0 && row < map.z.rows(); ++row) {
      map.z(row, col) += setting.roughness * rough.height(map.x(col), map.y(row));
    }
  }
  return undisturbed(map);
}

/// Van der Corput's sequence of the golden section: even over any first runs.
double density_of_run(const StudySetting& setting, std::uint64_t index) {
  constexpr double golden = 0.6180339887498949;
  double whole = 0.0;
  const double share = std::modf(0.5 + golden * static_cast<double>(index), &whole);
  return setting.density_percent.value_or(lowest_density +
                                          (highest_density - lowest_density) * share);
}

ExperimentOptions options_of(const Machine& machine, const StudySetting& setting,
                             const Shelf& shelf, std::uint64_t seed) {
  ExperimentOptions options;
  options.survey = [&setting, &shelf, seed](const DigScene& scene) {
    return surveyed_density(scene, setting.sensor, shelf.soil(setting), shelf.law(setting), seed);
  };
  options.fixed_path = setting.fixed_path;
  options.digs = simulator_of_word(setting.digs);
  if (setting.drawn_soil) options.dug_soil = drawn_soil(shelf.soil(setting), {}, seed);
  options.second = setting.second;
  PlanOptions& plan = options.plan;
  plan.search.threads = 1;
  plan.search.seed = seed;
  plan.library = shelf.library(setting);
  if (setting.plan == StudyPlan::search) plan.method = PlanMethod::search;
  if (setting.slope != 0.0 || setting.roughness > 0.0) {
    options.ground = study_ground(machine, setting, plan.cell_size, seed);
  }
  if (setting.plan == StudyPlan::search && setting.sensor != StudySensor::none) {
    options.seen = [&machine, sensor = setting.sensor, seed](const Terrain& ground) {
      return surveyed_ground(ground, machine, sensor, seed);
    };
  }
  return options;
}

StudyRun run_with(const RelativeDensity& estimate) {
  StudyRun run;
  run.estimate_percent = estimate.percent;
  run.estimate_sd = estimate.sd_percent;
  run.interval = estimate.interval_percent;
  run.trustworthy = estimate.trustworthy;
  return run;
}

StudyRun single_dig(const Machine& machine, const StudySetting& setting, const Shelf& shelf,
                    double density, std::uint64_t seed) {
  const SoilKind& soil = shelf.soil(setting);
  const DensityLaw& law = shelf.law(setting);
  const ExperimentOptions options = options_of(machine, setting, shelf, seed);
  const ExperimentResult energy = run_experiment(machine, soil, law, density, options);
  StudyRun run = run_with(energy.estimate);
  const auto at_equal = [&](DigObjective::Goal goal) {
    return run_experiment(machine, soil, law, density, at_equal_payload(goal, energy, options));
  };
  const ExperimentResult equal = at_equal(DigObjective::Goal::energy);
  const ExperimentResult cycle = at_equal(DigObjective::Goal::cycle);
  run.held_down = !energy.held_because.empty();
  run.energy_gain = energy.gain_percent();
  run.path_gain = energy.path_gain_percent();
  run.energy_payload = energy.planned.payload_mass / energy.fixed.payload_mass;
  run.equal_gain = equal.gain_percent();
  run.equal_payload = equal.planned.payload_mass / equal.fixed.payload_mass;
  run.cycle_gain = cycle.gain_percent();
  run.cycle_payload = cycle.planned.payload_mass / cycle.fixed.payload_mass;
  return run;
}

double percent_over(double planned, double fixed) { return 100.0 * (planned / fixed - 1.0); }

StudyRun digs_in_a_row(const Machine& machine, const StudySetting& setting, const Shelf& shelf,
                       double density, std::uint64_t seed) {
  const SoilKind& soil = shelf.soil(setting);
  const DensityLaw& law = shelf.law(setting);
  const ExperimentOptions options = options_of(machine, setting, shelf, seed);
  const ExperimentResult first = run_experiment(machine, soil, law, density, options);
  ExperimentOptions in_row = at_equal_payload(DigObjective::Goal::cycle, first, options);
  in_row.survey = options.survey;
  const DigRow row(machine, soil, density, in_row);
  const RowTotal fixed = row.fixed(setting.row);
  RelativeDensity last;
  const RowTotal planned = row.planned(fixed.digs, first.estimate, last);
  StudyRun run = run_with(last);
  run.held_down = !first.held_because.empty();
  run.energy_gain = percent_over(planned.mass / planned.energy, fixed.mass / fixed.energy);
  run.path_gain = run.equal_gain = run.energy_gain;
  run.energy_payload = planned.mass / fixed.mass;
  run.cycle_gain =
      percent_over(planned.mass / planned.cycle_energy, fixed.mass / fixed.cycle_energy);
  run.cycle_payload = run.equal_payload = run.energy_payload;
  return run;
}

StudyRun estimate_alone(const Machine& machine, const StudySetting& setting, const Shelf& shelf,
                        double density, std::uint64_t seed) {
  const ExperimentOptions options = options_of(machine, setting, shelf, seed);
  StudyRun run =
      run_with(options.survey(first_dig(machine, shelf.soil(setting), density, options)));
  run.compared = false;
  return run;
}

StudyRun run_once(const Machine& machine, const StudyCondition& condition, const Shelf& shelf,
                  std::uint64_t seed, std::uint64_t index) {
  const StudySetting& setting = condition.setting;
  const double density = density_of_run(setting, index);
  const std::uint64_t own_seed = Random(seed, index).bits();
  StudyRun run;
  try {
    const auto kind = static_cast<int>(index) >= condition.compared ? estimate_alone
                      : setting.row > 1                             ? digs_in_a_row
                                                                    : single_dig;
    run = kind(machine, setting, shelf, density, own_seed);
  } catch (const Error& error) {
    run.failure = error.what();
  }
  run.density_percent = density;
  return run;
}

void summarise(StudyResult& result, std::uint64_t seed) {
  std::vector<double> energy, path, equal, cycle, energy_payload, equal_payload, cycle_payload;
  double squares = 0.0, sum = 0.0, inside = 0.0;
  for (const StudyRun& run : result.runs) {
    if (!run.failure.empty()) {
      ++result.failed;
      continue;
    }
    const double error = run.estimate_percent - run.density_percent;
    squares += error * error;
    sum += error;
    inside += run.density_percent >= run.interval[0] && run.density_percent <= run.interval[1];
    result.untrusted += run.trustworthy ? 0 : 1;
    if (!run.compared) continue;
    ++result.compared;
    if (run.held_down && !result.condition.setting.held_down) {
      ++result.held_down;
      continue;
    }
    energy.push_back(run.energy_gain);
    path.push_back(run.path_gain);
    energy_payload.push_back(run.energy_payload);
    equal.push_back(run.equal_gain);
    equal_payload.push_back(run.equal_payload);
    cycle.push_back(run.cycle_gain);
    cycle_payload.push_back(run.cycle_payload);
  }
  const auto count = static_cast<double>(result.runs.size()) - result.failed;
  result.rms = std::sqrt(squares / count);
  result.bias = sum / count;
  result.inside = inside / count;
  result.energy_gain = bootstrap_mean(energy, seed);
  result.path_gain = bootstrap_mean(path, seed);
  result.equal_gain = bootstrap_mean(equal, seed);
  result.equal_payload = bootstrap_mean(equal_payload, seed);
  result.cycle_gain = bootstrap_mean(cycle, seed);
  result.energy_payload = bootstrap_mean(energy_payload, seed);
  result.cycle_payload = bootstrap_mean(cycle_payload, seed);
}

}  // namespace

DigParameters paper_field_path() { return {1.023, 0.496, 2.487}; }

DigParameters path_sized_to_bucket(const Machine& machine, const SoilKind& soil) {
  constexpr double density = 50.0;  // of the soil that it is sized for [%]
  DigParameters path = paper_fixed_path();
  const double bank = heaped_capacity(machine) / bulking_of_density(soil, density);
  const double section = bank / machine.bucket.width_outside;
  const double depth = path.penetration_length * std::sin(path.penetration_angle);
  const double wedge = 0.5 * depth * path.penetration_length * std::cos(path.penetration_angle);
  path.drag_length = std::max(0.0, (section - wedge) / depth);
  return path;
}

std::vector<StudyResult> run_study(const Machine& machine,
                                   const std::vector<StudyCondition>& conditions,
                                   const StudyOptions& options) {
  require_machine(machine);
  require(options.runs > 0.0 && options.runs <= 1e4, "study: factor on the runs", options.runs,
          "above 0 and at most 1e4");
  Shelf shelf(machine, options);
  std::vector<StudyResult> results;
  std::vector<std::pair<std::size_t, std::uint64_t>> tasks;
  for (const StudyCondition& condition : conditions) {
    shelf.prepare(condition.setting);
    const double runs = std::max(1.0, std::round(options.runs * condition.runs));
    results.push_back({condition, std::vector<StudyRun>(static_cast<std::size_t>(runs))});
    for (std::uint64_t i = 0; i < results.back().runs.size(); ++i) {
      tasks.emplace_back(results.size() - 1, i);
    }
  }
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  parallel_for(tasks.size(), options.threads, [&](std::size_t task) {
    if (stopped) return;
    const auto [which, index] = tasks[task];
    StudyResult& result = results[which];
    result.runs[index] = run_once(machine, result.condition, shelf, options.seed, index);
    const double share = static_cast<double>(++done) / static_cast<double>(tasks.size());
    const std::string name = result.condition.factor + " " + result.condition.level;
    if (options.progress && !options.progress(share, name)) stopped = true;
  });
  if (stopped) return {};
  for (StudyResult& result : results) summarise(result, options.seed);
  return results;
}

}  // namespace excavplan
