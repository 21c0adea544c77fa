// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

/// @file
/// The numbers that describe one dig, and the table of them: searches, path libraries, JSON and
/// command line options follow the table. make_dig_path() (dig_path.hpp) gives them their meaning.

namespace excavplan {

/// The paper's three numbers (section 2.3.2).
///
///     machine              start
///       |<----- start_x ----->*
///     --+--------------------/------ ground
///          scoop   drag     /  penetrate
///            (____<--------/
struct DigParameters {
  double penetration_angle = 0.0;   ///< of the line of penetration below the horizontal [rad]
  double penetration_length = 0.0;  ///< along that line [m]
  double drag_length = 0.0;         ///< horizontal, towards the machine [m]
};

/// The paper's fixed path of its simulation experiments: [pi/4, 0.35 m, 1.5 m] (section 3.1).
DigParameters paper_fixed_path();

/// One number of DigParameters.
struct DigParameterInfo {
  const char* name;    ///< key in JSON, ends in the unit: "penetration_angle_rad"
  const char* unit;    ///< "rad" or "m"
  const char* text;    ///< readable name: "penetration angle"
  const char* option;  ///< word of the option for the search range: "angle" of --angle-range
  double DigParameters::*field;  ///< where it is kept
  double lower;                  ///< of usual digs of a machine of 12 t; ours
  double upper;                  ///< likewise
};

/// One row per number, in order. How far two digs are apart is measured by the usual ranges
/// (0.2-1.4 rad, 0.1-0.9 m, 0.3-3.0 m); the paper's own search range is in its Table 3, which is
/// not published as text.
const std::vector<DigParameterInfo>& dig_parameter_table();

/// The numbers in the order of the table, as a search moves them.
Eigen::VectorXd to_vector(const DigParameters& parameters);

/// The inverse. @param numbers  at least one per row of the table; what follows is not read
DigParameters to_dig_parameters(const Eigen::VectorXd& numbers);

}  // namespace excavplan
