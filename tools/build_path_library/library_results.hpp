// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/planning/library_build.hpp>

#include "frame/tool.hpp"

/// @file
/// What build-path-library writes and prints.

namespace excavplan::tools {

/// Checks before the search that the libraries of the grid can be written.
/// @throws Error (bad_file)
void require_library_place(const LibraryGrid& grid, const DigObjective& objective,
                           const std::string& out);

/// Writes a library to the file, several to a folder of that name.
Outcome written_libraries(const std::vector<PathLibrary>& libraries, const std::string& out);

/// @param how  the command or option that continues the build
Outcome stopped_build(const LibraryBuild& build, const std::string& folder, const std::string& how);

}  // namespace excavplan::tools
