// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <excavplan/machine/fuel_model.hpp>
#include <excavplan/sensing/scene.hpp>

#include "frame/arguments.hpp"

/// @file
/// A recording of a simulated dig as a fuel flow meter would make it.

namespace excavplan::tools {

/// CSV of time_s, fuel_flow_ml_per_s and phase, ten rows a second: 3 s of idling, the dig, the rest
/// of its cycle if the machine states its swing and engine and the dig did not stall, 4 s of
/// idling. Each reading has a random error of 2 %. Numbers are ours.
/// @param scene  with the history of its dig
std::string fuel_log(const Machine& machine, const DigScene& scene, const FuelModel& fuel,
                     std::uint64_t seed);

/// The recording that is to be written, if any.
struct FuelLogInputs {
  std::optional<std::string> file;
  std::string model = "zx120";  ///< name or file of a fuel model

  /// --fuel-log and --fuel-model.
  void declare(Arguments& arguments);
  /// @throws Error (bad_input) or (bad_file)
  void write(const Machine& machine, const DigScene& scene, std::uint64_t seed) const;
};

}  // namespace excavplan::tools
