// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/experiments/experiment.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// The conditions of a study (excavplan/experiments/study.hpp).

namespace excavplan {

/// How the first dig is surveyed.
enum class StudySensor {
  none,   ///< height maps of the simulator, without error, as in section 3 of the paper
  lidar,  ///< a scanning lidar on the cab
  d435i,  ///< depth cameras 3 m above dig and heap
  poor    ///< the same cameras with three times the errors
};

/// Which density law the estimate uses.
enum class StudyLaw {
  other_engine,  ///< of digs in the other built-in simulator than the one that digs
  own_engine,    ///< of digs in the simulator that digs
  own_line,      ///< its straight line, the paper's form
  paper,         ///< the line that the paper publishes
  other_path,    ///< of digs along one other path, the paper's field path
  other_soil     ///< of sand, or of loam where sand is dug
};

/// How the second dig is chosen.
enum class StudyPlan {
  look_up,     ///< from the library
  search,      ///< for the ground as the survey shows it
  not_adapted  ///< from the library for 50 %, whatever the survey says
};

/// All that a condition may change; the defaults are those of the reference condition.
struct StudySetting {
  std::optional<double> density_percent = {};  ///< empty: 5 .. 95 %, evenly over the runs
  std::string soil = "loam";                   ///< kind that is dug and planned for
  bool drawn_soil = true;  ///< each run digs another soil of the kind; false: the kind itself
  double slope = 0.0;      ///< of the ground, rising ahead of the tracks [rad]
  double roughness = 0.0;  ///< rms of its height, correlated over 0.3 m [m]
  StudySensor sensor = StudySensor::none;         ///< of the survey of the first dig
  StudyLaw law = StudyLaw::other_engine;          ///< of the estimate
  StudyPlan plan = StudyPlan::look_up;            ///< of the second dig
  std::string digs = "height-map";                ///< word of the simulator that digs
  DigParameters fixed_path = paper_fixed_path();  ///< of the first dig, and the baseline
  SecondGround second = SecondGround::fresh;      ///< where the second dig is made
  /// Gains count although the fixed path would lift or drag the machine, which is held down in both
  /// digs; the second is planned as if it were not.
  bool held_down = false;
  int row = 1;  ///< planned digs in a row, each from the survey of the one before
};

/// A level of a factor.
struct StudyCondition {
  std::string factor;    ///< "slope"
  std::string level;     ///< "+10 deg"
  StudySetting setting;  ///< all of it
  int runs = 30;         ///< number of runs
  int compared = 30;     ///< of them the first, which also plan and dig; the rest only estimate
};

/// The conditions of the default study of this machine. The first is the reference.
std::vector<StudyCondition> default_study(const Machine& machine);

/// The fixed path of the paper's field experiments: [1.023, 0.496 m, 2.487 m] (section 4.1).
DigParameters paper_field_path();

/// The fixed path that is sized to the bucket: the paper's angle and penetration, and a drag that
/// sweeps as much as the heaped capacity holds of soil of 50 %, by its bulking factor. What spills
/// and falls back is not in it: simulated, it fills about half of the bucket.
DigParameters path_sized_to_bucket(const Machine& machine, const SoilKind& soil);

}  // namespace excavplan
