// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/belief/density_belief.hpp>

namespace excavplan {

/// The belief of a site as a file of it (docs/formats.md#site). Every number comes back as it was.
std::string belief_text(const DensityBelief& belief);

/// @param name  of the file, for messages
/// @throws Error (bad_file) naming file, key, value and rule
DensityBelief belief_of(const std::string& name, const std::string& content);

}  // namespace excavplan
