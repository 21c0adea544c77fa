// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/density_fit.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// Samples, the forms fitted to them and 95 % of digs about the one to use.
Figure law_figure(const DensityCalibration& calibration);

}  // namespace excavplan
