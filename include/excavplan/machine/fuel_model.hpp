// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// Fuel that an excavator takes, from the mechanical power of its joints.

namespace excavplan {

/// A Willans line: fuel flow = idle flow + what each watt of the shaft adds (docs/methods.md#fuel).
struct FuelModel {
  std::string name;               ///< "zx120"
  double rated_power = 0.0;       ///< of the shaft [W], > 0
  double rated_flow = 0.0;        ///< fuel at the rated power [mL/s], above the idle flow
  double idle_flow = 0.0;         ///< at working speed, pumps at standby [mL/s], > 0
  double drive_efficiency = 0.0;  ///< power of the joints over that of the shaft [-], in 0 .. 1
  double heating_value = 0.0;     ///< lower, of the fuel [J/mL], > 0

  /// Fuel flow [mL/s] at this positive power of the joints [W]; the engine gives no more than its
  /// rated power.
  double flow(double joint_power) const;
  /// Share of the fuel's energy that is shaft power at the rated power [-].
  double rated_efficiency() const { return rated_power / (rated_flow * heating_value); }
};

/// Reads a fuel model (docs/formats.md#fuel-model). @throws Error (bad_file) naming file, key,
/// value and rule, also if its numbers make an engine with less than 0.2 or more than 0.5 of
/// efficiency
FuelModel load_fuel_model(const std::string& path);

}  // namespace excavplan
