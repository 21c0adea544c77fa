// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/belief/dig_evidence.hpp>

/// @file
/// The rules of evidence. Private to the project.

namespace excavplan {

/// @throws Error (bad_input) if a number of the readings is not finite or out of range
void require_readings(const DigEvidence& dig);

}  // namespace excavplan
