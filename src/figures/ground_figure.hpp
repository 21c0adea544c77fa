// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// Heights seen from above; of at most 200 cells a side (ours), means of more.
Figure ground_figure(const HeightMap& ground);

}  // namespace excavplan
