// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/soil.hpp>

/// @file What loops over cells and drawn soils need of a soil. Private to the project.

namespace excavplan {

/// Of any soil, also a loose one; ours.
constexpr double most_void_ratio = 20.0;

/// bank_state_of_void_ratio() of a soil and a void ratio that were checked before.
SoilState checked_bank_state(const SoilKind& soil, double void_ratio);

}  // namespace excavplan
