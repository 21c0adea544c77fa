// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/ground/registration.hpp>

/// @file
/// What motions do to heights, and what functions ask of an alignment. Private to the project.

namespace excavplan {

/// How a motion changes the height of a cell at `place` from the centre of rotation, by the
/// gradient of the ground there.
inline Motion motion_effect(const Eigen::Vector3d& place, const Eigen::Vector2d& gradient) {
  Motion effect;
  effect << -gradient.x(), -gradient.y(), 1.0, place.y() + gradient.y() * place.z(),
      -place.x() - gradient.x() * place.z(), gradient.x() * place.y() - gradient.y() * place.x();
  return effect;
}

/// @throws Error (bad_input) "WHAT: ..." unless the numbers of its motion are finite
void require_alignment(const Alignment& alignment, const char* what);

}  // namespace excavplan
