// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan {

/// Full path of a file that excavplan ships, such as "machines/zx120.json".
///
/// Looked for in the folder named by the environment variable EXCAVPLAN_DATA, in
/// ../share/excavplan beside the running program, in the folder of the installation, and in the
/// source tree this library was built from, in this order.
///
/// @throws Error (bad_file) naming every folder that was searched
std::string find_data_file(const std::string& relative_path);

/// Path of the file that a name or a path means: "loam" in the folder "soils" is the shipped
/// "soils/loam.json"; what holds a '.' or a '/', or exists, is a path and returned as it is.
///
/// @throws Error (bad_input) if it looks like a name but none of that name is shipped
std::string shipped_or_file(const std::string& folder, const std::string& name_or_path);

}  // namespace excavplan
