// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate_density/difference_lines.hpp"

#include <cmath>

#include "base/text.hpp"

namespace excavplan::tools {

std::vector<std::string> difference_lines(const BulkingDifference& difference) {
  const DensityCalibration::Sample& at = difference.largest;
  if (std::abs(difference.density_points) < 0.05) {
    return {"true and measured k      agree at every density within 0.05 points of density"};
  }
  return {"true and measured k      largest difference at " + readable(at.density_percent) +
              " %: " + readable(at.bulking_factor_true, 4) + " by dry mass, " +
              readable(at.bulking_factor_measured, 4) + " from the height maps; density " +
              readable(std::abs(difference.density_points), 2) + " points too " +
              (difference.density_points > 0.0 ? "high" : "low"),
          "why                      " + readable(100.0 * at.fallback_fraction) +
              " % of the cut soil fell back into the hole, where height maps cannot measure it",
          "                         corrected for it, k is within " +
              (difference.unexplained < 1e-5 ? "0.00001" : readable(difference.unexplained, 2)) +
              " of the true one at every density"};
}

}  // namespace excavplan::tools
