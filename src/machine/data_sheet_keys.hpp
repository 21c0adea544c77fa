// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <excavplan/machine/data_sheet.hpp>

#include "base/json.hpp"

/// @file Private to the project.

namespace excavplan {

/// A figure of a data sheet, and what machines of 0.5 to 200 t have; limits ours, at least twice
/// as wide as the machines.
struct DataSheetKey {
  const char* key;
  std::optional<double> DataSheet::*figure;
  double lowest, highest;
  const char* hint;  ///< what is most often wrong with a number outside
  bool required = false;
};

const std::array<DataSheetKey, 13>& data_sheet_keys();

/// `data_sheet` of a machine file. @throws Error (bad_file)
DataSheet read_data_sheet(JsonObject file);
/// The same, without what is not stated.
nlohmann::json data_sheet_json(const DataSheet& sheet);

}  // namespace excavplan
