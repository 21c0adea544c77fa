// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// A machine, how far its tip comes and how hard it digs there.
Figure reach_figure(const Machine& machine);

}  // namespace excavplan
