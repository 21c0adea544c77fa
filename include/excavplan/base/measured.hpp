// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace excavplan {

/// A figure with its standard deviation.
struct Measured {
  double value = 0.0;  ///< in the unit of the figure
  double sd = 0.0;     ///< standard deviation, likewise
};

}  // namespace excavplan
