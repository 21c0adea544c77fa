// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// The machine as understood: its pins, the lengths between them, the ranges of its joints, and the
/// profile of its bucket.
Figure measures_figure(const Machine& machine);

}  // namespace excavplan
