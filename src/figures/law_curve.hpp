// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/density_law.hpp>

#include "drawing/drawing.hpp"

namespace excavplan {

constexpr const char* bulking_label = "bulking factor k [-]";
constexpr const char* density_label = "relative density [%]";

/// Points (k, d) of a law from 0 to 100 %.
Points law_curve(const DensityForm& form);

/// Area of 95 % of the digs about a law, by its scatter.
Points law_band(const DensityForm& form);

}  // namespace excavplan
