// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

#include <excavplan/machine/machine.hpp>

/// @file
/// What the pages about digs and jobs write alike for data/report/app.

namespace excavplan {

/// Rounded to 1e-6, far below what can be seen; null if not finite.
inline nlohmann::ordered_json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e6) / 1e6 + 0.0;  // no minus zero
}

/// Cells of a drawn one, along x and y, so that at most 250000 are drawn (ours).
Eigen::Index coarsening(Eigen::Index rows, Eigen::Index cols);

nlohmann::ordered_json machine_json(const Machine& machine);

}  // namespace excavplan
