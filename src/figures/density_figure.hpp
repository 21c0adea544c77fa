// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/density/density_estimate.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// The estimated density with its 95 % interval, beside it the law with the measured bulking
/// factor; the note says so where there is no density.
Figure density_figure(const DensityEstimate& estimate);

}  // namespace excavplan
