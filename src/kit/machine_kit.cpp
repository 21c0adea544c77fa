// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/machine_kit.hpp>

#include <algorithm>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/machine/kinematics.hpp>
#include <excavplan/planning/library_build.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

// Pin to tip [m]; ours. Below it the ground of a dig has millions of cells, and a kit takes hours.
constexpr double shortest_bucket = 0.2;

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

std::vector<Warning> lowered_height_warnings(const DigObjective& objective) {
  const double usual = CycleOptions{}.dump_height;
  if (objective.dump_height == usual || !info_of(objective.goal).of_cycle) return {};
  return {{WarningCode::dump_height_lowered,
           "the dump height is " + readable(objective.dump_height) + " m, not the usual " +
               number_text(usual) + " m, to which the bucket pin hardly rises, if at all"}};
}

KitSoil make_kit(const Machine& machine, const SoilKind& soil, const KitOptions& options) {
  require(machine.bucket_length >= shortest_bucket, "machine kit: the length of the bucket [m]",
          machine.bucket_length, "at least " + number_text(shortest_bucket));
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
