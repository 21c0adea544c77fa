// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/machine/data_sheet_file.hpp>
#include <excavplan/machine/machine_file.hpp>

/// @file
/// A machine from the figures of its data sheet: what these do not say is fitted from the shipped
/// machines' proportions (docs/machines.md#from-a-data-sheet).

namespace excavplan {

/// One number of a machine that was fitted.
struct FittedNumber {
  std::string key;     ///< of the machine file, "links.boom.mass_kg"
  double value = 0.0;  ///< in the unit of its key
  std::string how;     ///< from which figures of the data sheet
  /// Root mean square of what the same fit is off for each machine that it is made from, left out
  /// of it: of the number [-], of angles [rad]. Nothing where no two machines state it.
  std::optional<double> spread;
};

/// A machine from a data sheet.
struct FittedMachine {
  MachineFile file;                   ///< each number names its source; warns data_sheet_fitted
  std::vector<FittedNumber> numbers;  ///< each fitted one, with its spread
};

/// The shipped machines: "generic-mini", "zx120", "zx200", "generic-20t".
const std::vector<std::string>& proportion_machines();

/// Fits a machine. Mass, capacity, forces and reach are those of the sheet; the range of the boom
/// is that which reaches its depth and its height, or dump height, as far as a boom turns.
/// check_data_sheet() of the result tells what is not met.
///
/// @param from  shipped names or files to take proportions from, at least two
/// @throws Error (bad_input) if the sheet lacks mass, capacity, reach or depth, or if no machine
/// can be made of it; (bad_file) of a machine in `from`
FittedMachine machine_from_data_sheet(const NamedDataSheet& sheet,
                                      const std::vector<std::string>& from = proportion_machines());

}  // namespace excavplan
