// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

/// @file
/// The figures that the maker of a machine publishes (docs/machines.md#from-a-data-sheet).

namespace excavplan {

/// What the maker says of a machine, for comparison; nothing here affects a dig.
struct DataSheet {
  std::optional<double> operating_mass;   ///< [kg]
  std::optional<double> bucket_capacity;  ///< heaped 1:1 [m^3]
  std::optional<double> bucket_force;     ///< digging force of the bucket [N]
  std::optional<double> arm_force;        ///< digging force of the arm [N]
  std::optional<double> ground_reach;     ///< largest reach on the ground [m]
  std::optional<double> depth;            ///< largest digging depth [m]
  std::optional<double> height;           ///< largest height of the tip [m]
  std::optional<double> dump_height;      ///< largest height of the tip, hanging from its pin [m]
  std::optional<double> bucket_width;     ///< over its side plates, without side cutters [m]
  std::optional<double> engine_power;     ///< net [W]
  std::optional<double> swing_rate;       ///< highest [rad/s]
  std::optional<double> track_gauge;      ///< from middle to middle of the tracks [m]
  std::optional<double> track_length;     ///< of the tracks, over all [m]
};

}  // namespace excavplan
