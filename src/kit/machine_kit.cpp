// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/machine_kit.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/error.hpp>
#include <excavplan/library/library_build.hpp>
#include <excavplan/machine/kinematics.hpp>
#include <excavplan/simulation/calibration.hpp>
#include <excavplan/simulation/dig_ground.hpp>

namespace excavplan {
namespace {

DensityCalibration law_of(const Machine& machine, const SoilKind& soil, const KitOptions& options) {
  CalibrationOptions calibration;
  calibration.draws = options.draws;
  calibration.threads = options.threads;
  return calibrate_density(machine, soil, calibration);
}

}  // namespace

DigObjective feasible_objective(const Machine& machine, DigObjective objective) {
  constexpr double share = 0.9;  // ours
  const JointAngles highest(machine.limits[0].lower, machine.limits[1].lower, 0.0);
  const double pin = link_positions(machine, highest).bucket_pin.y();
  objective.dump_height = std::clamp(share * pin, 0.0, objective.dump_height);
  return objective;
}

KitSoil make_kit(const Machine& machine, const SoilKind& soil, const KitOptions& options) {
  KitSoil kit;
  const auto tell = [&](double done, const std::string& what) {
    return !options.progress || options.progress(done, what + " of " + soil.name);
  };
  kit.stopped = !tell(0.0, "density law");
  if (kit.stopped) return kit;
  kit.law = law_of(machine, soil, options);

  LibraryBuildOptions build;
  build.search.objective = options.objective;
  build.search.cell_size = usual_cell(machine);
  build.search.seed = options.seed;
  build.threads = options.threads;
  build.progress = [&](const LibraryProgress& now) {
    const auto all = static_cast<double>(std::max<std::size_t>(now.entries, 1));
    return tell(static_cast<double>(now.entries_done) / all, "path library");
  };
  const LibraryGrid grid = {{machine}, {soil}, options.slopes, options.densities_percent};
  require_buildable(grid, build.search);
  try {
    LibraryBuild made = build_path_libraries(grid, build);
    kit.stopped = made.stopped;
    if (!made.libraries.empty()) kit.library = std::move(made.libraries.front());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    kit.reason = error.what();
  }
  return kit;
}

}  // namespace excavplan
