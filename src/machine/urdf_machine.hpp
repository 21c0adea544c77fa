// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>

#include "base/json.hpp"

/// @file Private to the project.

namespace excavplan {

/// A URDF as a machine file.
struct UrdfDraft {
  nlohmann::json json;  ///< of a machine file, with the source of each number
  std::vector<Warning> warnings;
  std::string beside;  ///< the JSON beside it; empty: there is none
};

/// @param path  of the URDF, for messages and for the JSON beside it
UrdfDraft draft_of_urdf(const std::string& path, const std::string& content);

}  // namespace excavplan
