// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include <excavplan/ground/surface.hpp>

namespace excavplan {

/// A start for align() where the scan after was moved by more than its priors: the shift and turn
/// in plan, within 1.2 m and 6 degrees (ours), that leave the least difference between the reliefs
/// of the two surfaces, both taken about the plane of their ground. The difference counts by its
/// lower quartile, so that the changed ground has no say.
///
/// @param before on one grid with `after`
/// @return takes points of the scan after back to the frame of the scan before; nothing where the
///         surfaces share too little
std::optional<Eigen::Matrix4d> coarse_correction(const Surface& before, const Surface& after);

}  // namespace excavplan
