// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// motions [DIGS [FIRST]]: random digs, from the case FIRST on, timed as motions and looked at
// between their points.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "support/motion_cases.hpp"

namespace {

using namespace excavplan;
using namespace excavplan::test;

void take(UsedLimits& most, const UsedLimits& used) {
  most.rate = std::max(most.rate, used.rate);
  most.acceleration = std::max(most.acceleration, used.acceleration);
  most.jerk = std::max(most.jerk, used.jerk);
  most.swing_torque = std::max(most.swing_torque, used.swing_torque);
  most.cylinder_speed = std::max(most.cylinder_speed, used.cylinder_speed);
  most.flow = std::max(most.flow, used.flow);
  most.power = std::max(most.power, used.power);
  most.beyond = std::max(most.beyond, used.beyond);
  most.clearance = std::min(most.clearance, used.clearance);
}

void print(const char* through, const UsedLimits& most) {
  std::printf(
      "%-8s share of the limit: rate %.9f, acceleration %.9f, jerk %.9f, torque of the swing %.9f, "
      "cylinder speed %.9f, flow %.9f, power %.9f; joint beyond its range %.1e rad; bucket off the "
      "dig above the ground %.3f m\n",
      through, most.rate, most.acceleration, most.jerk, most.swing_torque, most.cylinder_speed,
      most.flow, most.power, most.beyond, most.clearance);
}

bool is_kept(const UsedLimits& used) {
  return used.most() <= 1.0 + 1e-6 && used.beyond <= 1e-9 && used.clearance >= -0.05;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const long digs = argc > 1 ? std::atol(argv[1]) : 10000;
  const long first = argc > 2 ? std::atol(argv[2]) : 0;
  UsedLimits by_cubic, by_quintic;
  std::vector<double> longer;
  long timed = 0, tried = 0, kept = 0;
  for (; timed < digs; ++tried) {
    Random random(16, static_cast<std::uint64_t>(first + tried));
    const auto made = any_motion(random);
    if (!made) continue;
    ++timed;
    const Trajectory motion = time_way(made->machine, made->way, made->options);
    const UsedLimits cubics = used_between(*made, motion, cubic);
    const UsedLimits quintics = used_between(*made, motion, quintic);
    take(by_cubic, cubics);
    take(by_quintic, quintics);
    if (is_kept(cubics) && is_kept(quintics))
      ++kept;
    else
      print(("case " + std::to_string(first + tried)).c_str(), quintics);
    if (std::isfinite(made->options.max_jerk) || made->options.rate < 100.0) continue;
    const TrajectoryOptions options{made->options.speed_fraction, made->options.corner_tolerance};
    const std::vector<JointAngles> torques(made->path.poses.size() - 1, made->torque);
    const double points = time_dig_path(made->machine, made->path, options, torques).duration();
    const Way dig = way_of(made->path, torques);
    longer.push_back(time_way(made->machine, dig, made->options).duration() / points);
  }
  std::printf("%ld motions of %ld tried, %ld keep all limits\n", timed, tried, kept);
  print("cubic", by_cubic);
  print("quintic", by_quintic);
  std::sort(longer.begin(), longer.end());
  const auto share = [&](double part) {
    return longer[static_cast<std::size_t>(part * static_cast<double>(longer.size() - 1))];
  };
  if (!longer.empty()) {
    std::printf(
        "duration of the dig over that of time_dig_path(), 100 Hz and more: median %.4f, "
        "%.4f .. %.4f\n",
        share(0.5), share(0.0), share(1.0));
  }
  return kept == timed ? 0 : 1;
}
