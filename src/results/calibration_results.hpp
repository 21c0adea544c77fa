// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/calibration/calibration.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// The law's file without its format, and where true and measured bulking factors differ most.
Json calibration_json(const DensityCalibration& calibration);

}  // namespace excavplan
