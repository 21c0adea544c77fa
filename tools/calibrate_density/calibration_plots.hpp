// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/density_fit.hpp>

#include "inputs/plots.hpp"

namespace excavplan::tools {

/// law: samples, the forms fitted to them and 95 % of digs about the one to use.
const FigureTable<DensityCalibration>& calibration_figures();

}  // namespace excavplan::tools
