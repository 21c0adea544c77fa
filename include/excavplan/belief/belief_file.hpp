// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/belief/density_belief.hpp>

/// @file
/// Beliefs as files (docs/formats.md#belief).

namespace excavplan {

/// The text of a belief file. Read again it is the same belief, bit by bit.
std::string to_json(const DensityBelief& belief);

/// Writes it, whole or not at all. @throws Error (bad_file) if it cannot be written
void save_belief(const std::string& path, const DensityBelief& belief);

/// @throws Error (bad_file) naming file, key, value and rule
DensityBelief load_belief(const std::string& path);

}  // namespace excavplan
