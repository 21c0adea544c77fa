// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drawing/plot.hpp"
#include "figures/dug_dig.hpp"

/// @file
/// Loads of a dig over its time.

namespace excavplan {

/// Force of the soil on the bucket, and the soil in it.
Figure forces_figure(const DugDig& dug);
/// Torque of each joint with its limit.
Figure torques_figure(const DugDig& dug);
/// Power of the joints, and energy.
Figure power_figure(const DugDig& dug);
/// Force of each cylinder with that of its joint's limit, or its pressure where the machine's file
/// has pistons; the axes say so where it has no cylinders.
Figure cylinders_figure(const DugDig& dug);

}  // namespace excavplan
