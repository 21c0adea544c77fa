// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/study.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "experiments/equal_payload.hpp"
#include "experiments/study_row.hpp"
#include "experiments/study_summary.hpp"
#include "experiments/study_survey.hpp"

namespace excavplan {
namespace {

constexpr double lowest_density = 5.0;     // of the runs [%]
constexpr double highest_density = 95.0;   // [%]
constexpr double whatever_density = 50.0;  // of a plan that is not adapted [%]; ours
constexpr int searched_digs = 250;         // of a search at no less payload; ours, docs/results.md
constexpr double rough_length = 0.3;       // over which rough ground is correlated [m]; ours

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

/// One run.
struct StudyTask {
  const Machine& machine;
  const StudySetting& setting;
  const Shelf& shelf;
  double density;
  std::uint64_t seed;

  const SoilKind& soil() const { return shelf.soil(setting); }
  const DensityLaw& law() const { return shelf.law(setting); }
  ExperimentOptions options() const;
};

ExperimentOptions StudyTask::options() const {
  ExperimentOptions made;
  made.survey = [this](const DigScene& scene) {
    return surveyed_density(scene, {setting.sensor, seed}, soil(), law());
  };
  made.fixed_path = setting.fixed_path;
  made.digs = simulator_of_word(setting.digs);
  if (setting.drawn_soil) made.dug_soil = drawn_soil(soil(), {}, seed);
  made.second = setting.second;
  PlanOptions& plan = made.plan;
  plan.search.threads = 1;
  plan.search.seed = seed;
  plan.library = shelf.library(setting);
  if (setting.plan == StudyPlan::search) plan.method = PlanMethod::search;
  if (setting.plan == StudyPlan::not_adapted) made.planned_density = whatever_density;
  if (setting.slope != 0.0 || setting.roughness > 0.0) {
    made.ground = study_ground(machine, setting, usual_cell(machine), seed);
  }
  if (setting.plan == StudyPlan::search && setting.sensor != StudySensor::none) {
    made.seen = [this](const Terrain& ground) {
      return surveyed_ground(ground, machine, {setting.sensor, seed});
    };
  }
  return made;
}

void set_estimate(StudyRun& run, const RelativeDensity& estimate) {
  run.estimate_percent = estimate.percent;
  run.estimate_sd = estimate.sd_percent;
  run.interval = estimate.interval_percent;
  run.trustworthy = estimate.trustworthy;
}

StudyGain gain_of(const ExperimentResult& result) {
  return {result.gain_percent(), result.path_gain_percent(),
          result.planned.payload_mass / result.fixed.payload_mass};
}

/// Of a planned dig: what it throws is in the run.
template <typename Dig>
void attempt(StudyRun& run, Dig dig) {
  try {
    dig();
  } catch (const Error& error) {
    if (run.plan_failure.empty()) run.plan_failure = error.what();
  }
}

void single_dig(const StudyTask& task, StudyRun& run) {
  ExperimentOptions options = task.options();
  bool surveyed = false;
  options.survey = [&, survey = options.survey](const DigScene& scene) {
    RelativeDensity estimate = survey(scene);
    set_estimate(run, estimate);
    surveyed = true;
    return estimate;
  };
  const auto experiment = [&](const ExperimentOptions& made) {
    return run_experiment(task.machine, task.soil(), task.law(), task.density, made);
  };
  std::optional<ExperimentResult> energy;
  attempt(run, [&] { energy = experiment(options); });
  if (!surveyed) throw Error(ErrorKind::bad_input, std::exchange(run.plan_failure, {}));
  if (!energy) return;
  run.held_down = !energy->held_because.empty();
  run.energy = gain_of(*energy);
  if (run.held_down && !task.setting.held_down) return;  // no gain is told
  const auto at_equal = [&](DigObjective::Goal goal) {
    return gain_of(experiment(at_equal_payload(goal, *energy, searched_digs, options)));
  };
  attempt(run, [&] { run.equal = at_equal(DigObjective::Goal::energy); });
  attempt(run, [&] { run.cycle = at_equal(DigObjective::Goal::cycle); });
}

double percent_over(double planned, double fixed) { return 100.0 * (planned / fixed - 1.0); }

void digs_in_a_row(const StudyTask& task, StudyRun& run) {
  const ExperimentOptions options = task.options();
  const ExperimentResult first =
      run_experiment(task.machine, task.soil(), task.law(), task.density, options);
  set_estimate(run, first.estimate);
  run.held_down = !first.held_because.empty();
  ExperimentOptions in_row =
      at_equal_payload(DigObjective::Goal::cycle, first, searched_digs, options);
  const DigRow row(task.machine, task.soil(), task.density, in_row);
  const RowTotal fixed = row.fixed(task.setting.row);
  attempt(run, [&] {
    RelativeDensity last;
    const RowTotal planned = row.planned(fixed.digs, first.estimate, last);
    set_estimate(run, last);
    run.energy.payload = run.cycle.payload = planned.mass / fixed.mass;
    run.energy.gain = percent_over(planned.mass / planned.energy, fixed.mass / fixed.energy);
    run.cycle.gain =
        percent_over(planned.mass / planned.cycle_energy, fixed.mass / fixed.cycle_energy);
  });
}

void estimate_alone(const StudyTask& task, StudyRun& run) {
  const ExperimentOptions options = task.options();
  set_estimate(run, options.survey(first_dig(task.machine, task.soil(), task.density, options)));
}

StudyRun run_once(const Machine& machine, const StudyCondition& condition, const Shelf& shelf,
                  std::uint64_t seed, std::uint64_t index) {
  const StudyTask task = {machine, condition.setting, shelf,
                          density_of_run(condition.setting, index), Random(seed, index).bits()};
  StudyRun run;
  run.density_percent = task.density;
  run.compared = static_cast<int>(index) < condition.compared;
  try {
    const auto make = !run.compared               ? estimate_alone
                      : condition.setting.row > 1 ? digs_in_a_row
                                                  : single_dig;
    make(task, run);
  } catch (const Error& error) {
    run.failure = error.what();
  }
  return run;
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
  require(options.runs > 0.0 && options.runs <= most_study_runs, "study: factor on the runs",
          options.runs, "above 0 and at most 1e4");
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
  summarise(results, options.seed);
  return results;
}

}  // namespace excavplan
