// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/machine/data_sheet.hpp>
#include <excavplan/machine/machine.hpp>

/// @file
/// Files of machines: our own (docs/formats.md#machine) and the URDF of robots
/// (docs/machines.md#urdf).

namespace excavplan {

/// A machine, and what its file says besides.
struct MachineFile {
  Machine machine;       ///< as load_machine() reads it
  DataSheet data_sheet;  ///< what of it the file states
  std::string text;      ///< of a machine file of ours that gives the same machine
  /// Of a URDF: urdf_scaled (numbers that neither it nor the JSON beside it states are those of the
  /// zx120, scaled), urdf_placeholder (numbers of it that no machine of this size has, and that
  /// were replaced), urdf_angles (its angles are not those of ours), urdf_frame (its root frame is
  /// not the site frame).
  std::vector<Warning> warnings = {};
};

/// Reads a machine file of ours, or, if it begins with '<', a URDF with the JSON beside it:
/// NAME.json beside NAME.urdf, if it is there.
/// @throws Error (bad_file) as load_machine(); of a URDF naming its line
MachineFile load_machine_file(const std::string& path);

}  // namespace excavplan
