// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <excavplan/machine/machine.hpp>
#include <excavplan/planning/dig_goal.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// Best digs computed beforehand, and the one for a density and a slope looked up among them
/// (docs/methods.md#library). How libraries are made: library_build.hpp.

namespace excavplan {

/// How far a path looked up between two entries is off, found by digging it midway.
struct MidwayError {
  /// Fraction of the best worth there that is lost [0, 1]; 1 if it cannot be dug. The best is
  /// estimated from the entries around.
  double loss = 0.0;
  /// The worth that look_up() expects, against the one simulated: their ratio less 1.
  double expectation = 0.0;
};

/// From one entry to the next.
struct Interpolation {
  MidwayError midway;  ///< of the dig looked up between the two
  /// What is looked up between the two.
  Between between = Between::mix;
};

/// The best dig for one density on one slope.
struct PathLibraryEntry {
  double density_percent = 0.0;  ///< 0 .. 100
  double slope = 0.0;   ///< of the ground in the boom direction, rising away from the machine [rad]
  PlannedDig dig;       ///< the best one found
  int evaluations = 0;  ///< digs simulated for it
  Interpolation to_next_density;  ///< on the same slope; nothing for the last
  Interpolation to_next_slope;    ///< at the same density; nothing on the last
};

/// A density at which no dig is feasible on its slope.
struct PathLibraryGap {
  double density_percent = 0.0;  ///< 0 .. 100
  double slope = 0.0;            ///< [rad]
};

/// Best digs of one machine in one soil.
struct PathLibrary {
  std::string machine;                    ///< name of the machine
  std::string soil;                       ///< name of the soil
  std::string machine_fingerprint;        ///< fingerprint() of the machine
  std::string soil_fingerprint;           ///< fingerprint() of the soil
  std::string simulator;                  ///< name and version
  double cell_size = 0.0;                 ///< of the ground it was computed on [m]
  std::uint64_t seed = 0;                 ///< of the searches
  DigObjective objective = {};            ///< that the digs are best for
  std::string search;                     ///< how they were searched, for people
  std::vector<PathLibraryEntry> entries;  ///< slope rising, then density; at least one
  std::vector<PathLibraryGap> gaps;       ///< in the same order
  std::string file = {};                  ///< that it was read from; empty: none

  int evaluations() const;  ///< digs simulated for all entries
};

/// Reads a library file (docs/formats.md#path-library).
/// @throws Error (bad_file) naming file, key, value and rule
PathLibrary load_path_library(const std::string& path);

/// MACHINE-SOIL-GOAL.json, the names as every file system takes them.
std::string file_name(const PathLibrary& library);

/// The text of a library file; the same library gives the same bytes.
/// @throws Error (bad_input) naming a number that is not finite or a text that is not UTF-8
std::string to_json(const PathLibrary& library);

/// Refuses a library that was computed for another machine, soil, objective or simulator.
/// @param simulator  SimulatorKind::name
/// @throws Error (bad_input) naming the file and all that differs
void require_fit(const PathLibrary& library, const Machine& machine, const SoilKind& soil,
                 const DigObjective& objective,
                 const std::string& simulator = default_simulator().name);

/// The dig for a density and a slope: parameters and expectations linear between the entries
/// around, or those of one of them (Interpolation::between).
///
/// @throws Error (bad_input) if density or slope are outside the library, or in a gap of it
PlannedDig look_up(const PathLibrary& library, double density_percent, double slope = 0.0);

/// How far what look_up() returns may be off: the error found midway between the two densities,
/// less near an entry (by the square of the distance, as the error of a line between two points),
/// the larger of the two slopes around; and likewise that midway between the two slopes, the larger
/// of the two densities around. The two add up.
///
/// @throws Error as look_up()
MidwayError look_up_error(const PathLibrary& library, double density_percent, double slope = 0.0);

}  // namespace excavplan
