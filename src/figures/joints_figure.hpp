// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// A machine as it is understood: with all joints of its robot at zero, their ranges, which way
/// each of them counts, and where the root of its URDF is.
Figure joints_figure(const Machine& machine);

}  // namespace excavplan
