// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/soil.hpp>

/// @file
/// Soil that has been dug: its strength, and how it compacts under a pressure
/// (docs/methods.md#soil).

namespace excavplan {

/// State of dug soil that was compacted to this void ratio; loose_state() at void_ratio_loose.
///
/// Digging has broken what bound the grains; it has the strength that compaction adds. With s = 0
/// at void_ratio_loose and 1 at void_ratio_min, c = cohesion_loosest * (exp(cohesion_growth * s) -
/// 1) and phi = friction_loosest + friction_gain * s; ours.
/// @throws Error (bad_input) unless void_ratio_min <= e <= void_ratio_loose
SoilState loose_state_of_void_ratio(const SoilKind& soil, double void_ratio);

/// Void ratio of dug soil once a pressure [Pa] has acted on it: one-dimensional compression,
/// e = void_ratio_loose - C_c log10(pressure / 5 kPa), C_c = 0.30 (void_ratio_loose - 0.27) (Hough
/// 1957). Never looser than before, nor denser than void_ratio_min.
/// @throws Error (bad_input) as loose_state_of_void_ratio(), or unless the pressure is >= 0 and
///         finite
double compacted_void_ratio(const SoilKind& soil, double void_ratio, double pressure);

}  // namespace excavplan
