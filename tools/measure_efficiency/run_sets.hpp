// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "inputs/logged_dig.hpp"

namespace excavplan::tools {

/// One of a set of runs.
struct SetRun {
  RunInputs inputs;
  std::string place;         ///< "runs.csv: line 3: ", of a table of runs; else empty
  OptionNames columns = {};  ///< options that the table states, and by which column
};

/// The runs of a set: a table with the column `file` and columns named as the options of a run
/// ("volume_m3", "mass_kg", "from_s" and so on), a folder with a table runs.csv, or a folder of
/// logs. What the table does not say is `common` to all. Names of files are from the table's
/// folder.
/// @throws Error (bad_file) naming line and column
std::vector<SetRun> runs_of(const std::string& table_or_folder, const RunInputs& common);

}  // namespace excavplan::tools
