// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/soil/density_forms.hpp>

#include "base/json.hpp"

/// @file
/// The forms of a density law as law files hold them. A new form is a struct in DensityForm and a
/// row in density_forms.cpp; its fit is in density_fit.cpp.

namespace excavplan {

inline constexpr const char* density_law_format = "excavplan-density-law";  ///< of law files
inline constexpr double smallest_r = 1e-6;                                  ///< of a closed form

/// Keys of all forms, in the order of law files: "line", "closed_form".
std::vector<std::string> density_form_keys();

/// One of these keys.
std::string key_of(const DensityForm& form);
/// Number of the parameters that a fit of the form has.
std::size_t parameters_of(const DensityForm& form);

/// Reads the form of this key. @throws Error (bad_file)
DensityForm read_density_form(const std::string& key, JsonObject object);

/// @throws Error (bad_input) naming a parameter that is out of the range of law files
void require_form(const DensityForm& form);

nlohmann::ordered_json density_form_json(const DensityForm& form);

}  // namespace excavplan
