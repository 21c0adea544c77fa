// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// Which changes of the ground belong to the dig (`docs/methods.md#attribution`).

namespace excavplan {

/// A figure with its standard deviation.
struct Measured {
  double value = 0.0;  ///< in the unit of the figure
  double sd = 0.0;     ///< standard deviation, likewise
};

/// A change that was left out of the volumes and might belong to the dig, or was counted and might
/// not.
struct AttributedChange {
  std::string what;          ///< text: what it looks like and where
  Measured volume;           ///< of the change, > 0 where the ground rose [m^3]
  bool counted = false;      ///< it is part of hole, spill or heap
  double probability = 0.0;  ///< that it belongs to the dig, 0 .. 1
};

/// The bulking factor if one of the open changes is attributed the other way.
struct Reading {
  std::string what;     ///< text: what is taken to be so
  double weight = 0.0;  ///< its probability; those of all readings add up to 1
  Measured bulking;     ///< k with the error of the scans [-]
};

}  // namespace excavplan
