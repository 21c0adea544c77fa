// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/soil/density_forms.hpp>

#include "base/json.hpp"

/// @file
/// The forms of a density law as law files hold them. A new form is a struct in DensityForm and a
/// row in density_forms.cpp.

namespace excavplan {

inline constexpr const char* density_law_format = "excavplan-density-law";  ///< of law files

/// Keys of all forms, in the order of law files: "line", "closed_form".
std::vector<std::string> density_form_keys();

/// Reads the form of this key. @throws Error (bad_file)
DensityForm read_density_form(const std::string& key, JsonObject object);

/// @throws Error (bad_input) naming a parameter that is out of the range of law files
void require_form(const DensityForm& form);

nlohmann::ordered_json density_form_json(const DensityForm& form);

}  // namespace excavplan
