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

}  // namespace excavplan
