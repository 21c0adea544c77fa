// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/kit/data_sheet_machine.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/soil/soil.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// Reach, forces, capacity and joints of a machine. @param folder  of its kit
Json examined_json(const Machine& machine, const std::string& folder);

/// What was fitted to a data sheet.
Json fitted_json(const std::vector<FittedNumber>& numbers);

/// The entry of a library on level ground at the density nearest to a usual one.
const PathLibraryEntry& shown_entry(const PathLibrary& library);

/// Law and library of a soil. @param law_file  and the other from the kit's folder
/// @param library  without entries there is none
Json kit_json(const SoilKind& soil, const std::string& law_file, const PathLibrary& library,
              const std::string& library_file);

}  // namespace excavplan
