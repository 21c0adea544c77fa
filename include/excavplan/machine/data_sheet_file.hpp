// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/base/error.hpp>
#include <excavplan/machine/data_sheet.hpp>

/// @file
/// Data sheets as files (docs/machines.md#from-a-data-sheet).

namespace excavplan {

/// A data sheet in a file of its own.
struct NamedDataSheet {
  std::string name;  ///< of the machine
  DataSheet sheet;   ///< with mass, capacity, reach and depth
};

/// Reads a JSON file of `name` and the keys of `data_sheet` in a machine file.
/// @throws Error (bad_file) naming file, key, value and rule; all missing keys at once; numbers
/// that no excavator of 0.5 to 200 t has, most often a wrong unit
NamedDataSheet load_data_sheet(const std::string& path);

}  // namespace excavplan
