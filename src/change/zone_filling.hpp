// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "change/change_zones.hpp"

namespace excavplan {

struct ZoneFilling {
  Eigen::ArrayXXd difference;    ///< less the datum, filled wherever a zone is [m]
  std::vector<double> variance;  ///< of the sum of the filled cells, by zone [m^2]
};

/// Fills the unknown cells of the zones. A hole of one scan is filled in that scan, so that the
/// other keeps its heights there, or in the difference, which is free of the relief that both
/// share: whichever errs less where it is tried on known cells.
ZoneFilling fill_zones(Eigen::ArrayXXd before, Eigen::ArrayXXd after, const ChangedGround& ground);

}  // namespace excavplan
