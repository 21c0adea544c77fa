// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drawing/plot.hpp"
#include "figures/dug_dig.hpp"
#include "figures/machine_outline.hpp"

namespace excavplan {

/// The whole machine, and the dig: ground before and after, path of the tip by phase, the bucket
/// with its soil at the ends of the phases.
Figure section_figure(const DugDig& dug);

/// Its body and front without the bucket.
void draw_machine(Panel& panel, const MachineOutline& machine);

}  // namespace excavplan
