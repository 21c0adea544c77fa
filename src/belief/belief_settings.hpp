// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/belief/belief_settings.hpp>

/// @file
/// The rules of a belief's settings. Private to the project.

namespace excavplan {

/// @throws Error (bad_input) if one is out of range
void require_settings(const BeliefSettings& settings);

}  // namespace excavplan
