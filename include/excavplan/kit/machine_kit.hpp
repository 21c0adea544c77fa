// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/soil/density_fit.hpp>

/// @file
/// All that a machine needs before it can be planned for: density laws and path libraries of its
/// own, in a minute (docs/machines.md).

namespace excavplan {

/// How a kit is made. The library is coarser than the shipped ones: fewer densities and slopes, as
/// many digs for each.
struct KitOptions {
  DigObjective objective = dig_goals().front().goal;  ///< what digs are best for
  std::vector<double> densities_percent = {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100};  ///< rising
  /// Rising away from the machine, in order [rad].
  std::vector<double> slopes = {-0.2617993877991494, -0.1308996938995747, 0.0, 0.1308996938995747,
                                0.2617993877991494};
  int draws = 200;         ///< digs in drawn soils, for the scatter of the law
  unsigned threads = 0;    ///< 0: one per core; the result is the same for any number
  std::uint64_t seed = 1;  ///< of the searches
  /// Called now and then from any thread, one call at a time, with the share done of this soil and
  /// what is made; false stops.
  std::function<bool(double done, const std::string& what)> progress;
};

/// Of one soil.
struct KitSoil {
  DensityCalibration law;   ///< as calibrate_density(), of digs of the machine's size
  PathLibrary library;      ///< without entries if there is none
  std::string reason = {};  ///< why there is no library: no dig is feasible
  bool stopped = false;     ///< by `progress`; law and library are then not complete
};

/// The goal with what the machine cannot do taken back: a dump height of at most nine tenths of
/// what its bucket pin reaches.
DigObjective feasible_objective(const Machine& machine, DigObjective objective);

/// dump_height_lowered, if the goal of a feasible_objective() has a dump height and it is not the
/// usual one.
std::vector<Warning> lowered_height_warnings(const DigObjective& objective);

/// @throws Error (bad_input) as calibrate_density() and build_path_libraries(), and if the bucket
/// is shorter than 0.2 m: its digs would take millions of cells
KitSoil make_kit(const Machine& machine, const SoilKind& soil, const KitOptions& options = {});

}  // namespace excavplan
