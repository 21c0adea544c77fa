// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/soil.hpp>

/// @file States of a soil for loops over cells. Private to the project.

namespace excavplan {

/// bank_state_of_void_ratio() of a soil and a void ratio that were checked before.
SoilState checked_bank_state(const SoilKind& soil, double void_ratio);

}  // namespace excavplan
