// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/plan_dig.hpp>

using namespace excavplan;

int main() {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const GroundDensity density(40.0, 5.0);  // with its standard deviation [%]

  const DigPlan plan = plan_dig(machine, loam, density);
  if (!plan.dig) {
    std::printf("%s\n", plan.reason.c_str());
    return 1;
  }
  std::printf("lifts %.0f kg for %.1f kJ\n", plan.dig->payload_mass, plan.dig->energy / 1000.0);
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    std::printf("%.3f s: boom %.3f, arm %.3f, bucket %.3f rad\n", point.time, point.joints(0),
                point.joints(1), point.joints(2));
  }
}
