// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

// The CMake package defines it. Otherwise, as with pkg-config, it is found from where this header
// is installed.
#ifndef EXCAVPLAN_DATA_DIR
#define EXCAVPLAN_DATA_DIR __FILE__ "/../../../../share/excavplan"
#endif

namespace excavplan {

/// Folder of the data of the package that this source file is compiled with; empty if there is
/// none.
constexpr const char* data_folder_of_package = EXCAVPLAN_DATA_DIR;

/// Full path of a file that excavplan ships, such as "machines/zx120.json".
///
/// The first of these folders that holds the file gives it:
///  1. the folder named by the environment variable EXCAVPLAN_DATA;
///  2. share/excavplan of the installation that the shared library is loaded from;
///  3. `package_folder`: programs compiled with the CMake or the pkg-config package know it;
///  4. share/excavplan of the installation that the running program is in (bin/..).
///
/// @throws Error (bad_file) naming every folder that was searched, or EXCAVPLAN_DATA if it names
/// no folder; (bad_input) if the path is absolute or has a part ".."
std::string find_data_file(const std::string& relative_path,
                           const std::string& package_folder = data_folder_of_package);

/// Whether one of the places of find_data_file() has this folder, such as "libraries".
bool has_data_folder(const std::string& folder,
                     const std::string& package_folder = data_folder_of_package);

/// Path of the file that a name or a path means: "loam" in the folder "soils" is the shipped
/// "soils/loam.json"; what holds a '.' or a '/', or exists, is a path and returned as it is.
///
/// @throws Error (bad_input) if it is a plain name but no file of that name is shipped
/// @throws Error (bad_file) as find_data_file() if the folder is not found at all
std::string shipped_or_file(const std::string& folder, const std::string& name_or_path,
                            const std::string& package_folder = data_folder_of_package);

}  // namespace excavplan
