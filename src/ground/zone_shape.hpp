// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/surveyed_area.hpp"

namespace excavplan {

/// Form of a zone, weighted by its change of height.
struct ZoneShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();   ///< along its length
  double length = 0.0;    ///< of the strip of even height with its second moments [m]
  double width = 0.0;     ///< of that strip [m]
  double height = 0.0;    ///< mean of |D| weighted by |D| [m]
  double steepest = 0.0;  ///< slope that a tenth of its cells exceed [-]
  double lasting = 1.0;   ///< of a tail: mean |D| of its far half over that of its near half [-]

  bool is_strip() const { return length > 3.0 * width; }
};

/// The shape of every zone of an area.
std::vector<ZoneShape> shapes_of(const Area& area);

}  // namespace excavplan
