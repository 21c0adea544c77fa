// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace excavplan::tools {

/// What the command line says of a file.
struct UsedFile {
  std::string option;  ///< as messages name it
  std::string text;    ///< may be a list, or name a place in the file
  bool output = false;
};

/// Names of one file, also through links and as ./FILE, are found; pipes and devices may be shared.
/// @throws Error (bad_input) if a file to write is also written or read by another option, or is
/// that of standard output by another name than /dev/stdout
void refuse_shared_files(const std::vector<UsedFile>& files);

}  // namespace excavplan::tools
