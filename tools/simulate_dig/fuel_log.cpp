// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_dig/fuel_log.hpp"

#include <algorithm>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/dig_cycle.hpp>

#include "base/files.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "results/dig_timing.hpp"

namespace excavplan::tools {
namespace {

/// A time of constant power.
struct Stretch {
  const char* phase;
  double duration = 0.0;  ///< [s]
  double power = 0.0;     ///< of the joints [W]
};

double power_of(const CycleShare& share) {
  return share.time > 0.0 ? share.energy / share.time : 0.0;
}

struct Movement {
  const char* phase;
  const CycleShare& share;
};

/// Two movements, the first from the begin on, the second up to the end.
void add_overlapping(std::vector<Stretch>& stretches, double duration, const Movement& first,
                     const Movement& second) {
  const double begin_of_second = std::max(0.0, duration - second.share.time);
  const double alone = std::min(first.share.time, begin_of_second);
  const double both = std::max(0.0, std::min(first.share.time, duration) - begin_of_second);
  const double power = power_of(first.share);
  const double power_of_second = power_of(second.share);
  stretches.push_back({first.phase, alone, power});
  stretches.push_back({second.phase, both, power + power_of_second});
  stretches.push_back({second.phase, std::max(0.0, duration - alone - both), power_of_second});
}

void add_rest_of_cycle(std::vector<Stretch>& stretches, const DigCycle& cycle) {
  const double back = std::max(cycle.back.time, cycle.lower.time);
  const double to_dump =
      cycle.total.time - cycle.dig.time - cycle.dump.time - back - cycle.rest.time;
  add_overlapping(stretches, to_dump, {"lift", cycle.lift}, {"swing", cycle.swing});
  stretches.push_back({"dump", cycle.dump.time, power_of(cycle.dump)});
  add_overlapping(stretches, back, {"return", cycle.back}, {"return", cycle.lower});
}

std::vector<Stretch> stretches_of(const Machine& machine, const DigScene& scene) {
  constexpr double idle_before = 3.0;  // [s]
  constexpr double idle_after = 4.0;
  std::vector<Stretch> stretches = {{"idle", idle_before, 0.0}};
  for (const TimedStep& step : timed_steps(machine, scene.path, scene.dig)) {
    stretches.push_back({name(step.phase), step.duration, step.power});
  }
  PlannedDig dig;
  dig.parameters = scene.path.parameters;
  dig.start_x = scene.path.start_x;
  dig.payload_mass = scene.dig.payload_mass;
  dig.payload_volume = scene.dig.payload_volume;
  dig.energy = scene.dig.energy.total;
  dig.duration = scene.duration;
  const auto cycle = scene.dig.stall ? std::nullopt : cycle_of(machine, scene.path, dig);
  if (cycle) add_rest_of_cycle(stretches, *cycle);
  stretches.push_back({"idle", idle_after, 0.0});
  return stretches;
}

}  // namespace

std::string fuel_log(const Machine& machine, const DigScene& scene, const FuelModel& fuel,
                     std::uint64_t seed) {
  constexpr double step = 0.1;    // [s]
  constexpr double noise = 0.02;  // of a reading
  constexpr int digits = 4;
  Random random(seed);
  std::string csv = "time_s,fuel_flow_ml_per_s,phase\n";
  int row = 0;
  double in_row = 0.0;  // of the row's time that is gone [s]
  double spent = 0.0;   // in it [mL]
  const std::vector<Stretch> stretches = stretches_of(machine, scene);
  for (const Stretch& stretch : stretches) {
    const double flow = fuel.flow(stretch.power);
    double left = stretch.duration;
    while (in_row + left >= step) {
      spent += flow * (step - in_row);
      left -= step - in_row;
      const double reading = spent / step * (1.0 + noise * random.normal());
      csv += decimals(step * (row + 0.5), 2) + ',' + decimals(reading, digits) + ',' +
             stretch.phase + '\n';
      ++row;
      in_row = 0.0;
      spent = 0.0;
    }
    in_row += left;
    spent += flow * left;
  }
  return csv;
}

void FuelLogInputs::declare(Arguments& arguments) {
  arguments.output("fuel-log", file,
                   "write a recording of fuel flow and phases, CSV, for measure-efficiency");
  arguments.only_if({[this] { return file.has_value(); }, "there is no --fuel-log"}, [&] {
    arguments.text("fuel-model", "NAME|FILE", model, "engine: zx120, or a fuel model file");
  });
}

void FuelLogInputs::write(const Machine& machine, const DigScene& scene, std::uint64_t seed) const {
  if (!file) return;
  const FuelModel fuel = load_fuel_model(shipped_or_file("engines", model));
  write_file(*file, fuel_log(machine, scene, fuel, seed));
}

}  // namespace excavplan::tools
