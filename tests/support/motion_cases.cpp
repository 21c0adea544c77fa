// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/motion_cases.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "support/machine_file.hpp"

namespace excavplan::test {

Machine shipped_machine(const std::string& name) {
  return load_machine(find_data_file("machines/" + name + ".json"));
}

DigPath fixed_path() {
  const auto flat = [](double) { return 0.0; };
  DigPath path = std::get<DigPath>(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat));
  path.approach = std::get<std::vector<DigPose>>(way_down(zx120(), path, flat));
  return path;
}

Machine any_machine(Random& random) {
  static const std::array<Machine, 4> all = {shipped_machine("zx120"), shipped_machine("zx200"),
                                             shipped_machine("generic-20t"),
                                             shipped_machine("generic-mini")};
  Machine machine = all[random.index(all.size())];
  const auto times = [&](double& number) { number *= std::exp(random.uniform(-0.9, 0.9)); };
  for (JointLimits& limits : machine.limits) {
    times(limits.speed);
    times(limits.acceleration);
  }
  for (double* number : {&machine.engine->power, &machine.swing->speed, &machine.swing->torque}) {
    times(*number);
  }
  if (random.uniform() < 0.3) machine.swing->acceleration = random.uniform(0.1, 1.0);
  if (random.uniform() < 0.3) {
    machine.swing->lower = random.uniform(-3.0, -0.5);
    machine.swing->upper = random.uniform(0.5, 3.0);
  }
  if (random.uniform() < 0.1) machine.engine.reset();
  if (!machine.hydraulics) return machine;
  times(machine.hydraulics->pump_flow);
  for (Piston& piston : machine.hydraulics->pistons) {
    if (random.uniform() < 0.5) piston.speed = random.uniform(0.1, 0.6);
  }
  return machine;
}

MotionOptions any_options(Random& random) {
  const double rates[] = {20.0, 50.0, 100.0, 100.0, 125.0, 250.0};
  MotionOptions options;
  options.rate = rates[random.index(6)];
  options.speed_fraction = random.uniform() < 0.2 ? 1.0 : random.uniform(0.2, 1.0);
  options.corner_tolerance = random.uniform() < 0.2 ? 0.0 : random.uniform(0.0, 0.01);
  if (random.uniform() < 0.3) options.max_jerk = std::exp(random.uniform(0.0, 5.0));
  return options;
}

std::optional<DigPath> any_path(const Machine& machine, const AnyGround& ground, Random& random) {
  const double size = machine.full_length() / 8.349;  // of the zx120
  DigParameters dig;
  dig.penetration_angle = random.uniform(0.2, 1.4);
  dig.penetration_length = size * random.uniform(0.1, 0.9);
  dig.drag_length = size * random.uniform(0.3, 3.0);
  DigPathOptions rules;
  rules.step = size * random.uniform(0.01, 0.1);
  const auto along = [&](double x) { return ground.highest(x, machine.bucket.width_outside); };
  auto path = make_dig_path(machine, dig, size * random.uniform(4.0, 7.5), along, rules);
  if (!std::holds_alternative<DigPath>(path)) return std::nullopt;
  auto down = way_down(machine, std::get<DigPath>(path), along);
  if (auto* poses = std::get_if<std::vector<DigPose>>(&down)) {
    std::get<DigPath>(path).approach = std::move(*poses);
  }
  return std::get<DigPath>(std::move(path));
}

CycleWayOptions any_cycle(const Machine& machine, Random& random) {
  const double lower = std::max(machine.swing->lower, -3.1);
  const double upper = std::min(machine.swing->upper, 3.1);
  CycleWayOptions options;
  options.whole_cycle = random.uniform() < 0.6;
  options.cycle.swing = random.uniform(lower, upper);
  options.cycle.dump_height = random.uniform(0.0, 0.5) * machine.full_length();
  if (random.uniform() < 0.2) return options;
  options.start.emplace();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
    (*options.start)[i] = random.uniform(limits.lower, limits.upper);
  }
  const bool turns = machine.swing->turns_round();
  (*options.start)[3] = random.uniform() < 0.4 ? 0.0
                        : turns                ? random.uniform(-20.0, 20.0)
                                               : random.uniform(lower, upper);
  return options;
}

std::optional<MotionCase> any_motion(Random& random) {
  MotionCase made;
  made.machine = any_machine(random);
  made.options = any_options(random);
  const AnyGround ground(made.machine, random);
  auto path = any_path(made.machine, ground, random);
  if (!path) return std::nullopt;
  made.path = std::move(*path);
  for (Eigen::Index i = 0; i < 3; ++i) {
    made.torque[i] =
        made.machine.limits[static_cast<std::size_t>(i)].torque * random.uniform(-0.3, 0.6);
  }
  DigLoad load;
  load.torques.assign(made.path.poses.size() - 1, made.torque);
  load.payload_mass = made.payload = random.uniform(0.0, 1600.0) * heaped_capacity(made.machine);
  auto way = way_of_cycle(made.machine, ground.terrain(made.machine), made.path, load,
                          any_cycle(made.machine, random));
  if (!std::holds_alternative<Way>(way)) return std::nullopt;
  made.way = std::get<Way>(std::move(way));
  made.height = [ground](double x, double y) { return ground.height(x, y); };
  return made;
}

}  // namespace excavplan::test
