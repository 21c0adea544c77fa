// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/dig_parameters.hpp>
#include <excavplan/scans/machine_front.hpp>

#include "base/text.hpp"

/// @file
/// Numbers with units on the command line. `what` names the option in messages.

namespace excavplan::tools {

/// What a number on the command line measures. A bare number is in the SI unit.
enum class Quantity {
  length,
  angle,
  area,
  volume,
  mass,
  time,
  frequency,
  energy,
  density,
  percent,
  ratio
};

const char* placeholder(Quantity quantity);  ///< "LENGTH"
const char* unit(Quantity quantity);         ///< "m"

/// "5cm", "45deg", "0.35" in the SI unit.
/// @throws Error (bad_input) naming `what`, the text and what is understood
double parse_quantity(const std::string& what, const std::string& text, Quantity quantity);

/// The words of a text between separators.
std::vector<std::string> split(const std::string& text, char separator);

/// "40", "10,40,80" or, first:step:last, "0:5:100". @throws Error (bad_input)
std::vector<double> parse_series(const std::string& what, const std::string& text,
                                 Quantity quantity);

/// Densities "0:5:100", "40" or "10,40,80" [%]. @throws Error (bad_input)
std::vector<double> parse_densities(const std::string& what, const std::string& text);

/// What a number in this SI unit measures.
Quantity quantity_of(const std::string& unit);

/// A dig path on the command line, from dig_parameter_table().
struct DigPathForm {
  std::string placeholder;  ///< "ANGLE,LENGTH,LENGTH"
  std::string units;        ///< "rad,m,m"
  std::string names;        ///< "penetration angle, penetration length, drag length"
};
DigPathForm dig_path_form();
/// "45deg,0.35m,1.5m"
std::string dig_path_argument(const DigParameters& parameters);
/// The inverse. @throws Error (bad_input)
DigParameters parse_dig_path(const std::string& what, const std::string& text);

/// `count` lengths between commas; messages call them `form`. @throws Error (bad_input)
std::vector<double> parse_lengths(const std::string& what, const std::string& text,
                                  std::size_t count, const std::string& form);

/// "xmin,ymin,xmax,ymax". @throws Error (bad_input)
Rectangle parse_rectangle(const std::string& what, const std::string& text);

/// "x,y". @throws Error (bad_input)
Eigen::Vector2d parse_point(const std::string& what, const std::string& text);
/// "x,y,z". @throws Error (bad_input)
Eigen::Vector3d parse_place(const std::string& what, const std::string& text);

/// "x,y,z,qx,qy,qz,qw": a translation and a quaternion, as 4 x 4 matrix. @throws Error (bad_input)
Eigen::Matrix4d parse_pose(const std::string& what, const std::string& text);

/// "swing,boom,arm,bucket", angles. @throws Error (bad_input)
MachinePosture parse_posture(const std::string& what, const std::string& text);

}  // namespace excavplan::tools
