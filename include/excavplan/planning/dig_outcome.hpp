// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// What a dig is expected to bring and to cost, or why it cannot be done.

namespace excavplan {

/// What follows a dig before the next one begins.
struct CycleOptions {
  /// From dig to dump, to the left, or below 0 to the right, which costs as much; 90 deg as in
  /// production tables [rad].
  double swing = 1.5707963267948966;
  /// Of the bucket pin when it dumps, above the ground under the machine, or that at which the
  /// bucket is clear of the ground if that is more: over a truck's side of 2.3-2.6 m; ours [m].
  double dump_height = 3.0;
  double rest_of_cycle = 0.0;  ///< waiting time [s]
  /// The bucket goes back to where a dig begins with its load: no swing, no dump.
  bool keeps_load = false;
  double carried = 0.0;  ///< by the bucket before the dig, which lifts it too, >= 0 [kg]
};

/// What stands for the best digs between two known ones.
enum class Between {
  mix,      ///< linear in all numbers
  nearest,  ///< of the two, as they differ so much that their mix is worse
  lower,    ///< the one of the lower density or slope, as the others are worse or stall
  upper,    ///< the other one
};

/// A dig with its expected payload and cost.
struct PlannedDig {
  DigParameters parameters;     ///< of its path
  double start_x = 0.0;         ///< [m]
  double payload_mass = 0.0;    ///< moist [kg]
  double payload_volume = 0.0;  ///< loose [m^3]
  double energy = 0.0;          ///< [J]
  double duration = 0.0;        ///< of penetrate, drag and scoop [s]
  double fill = 0.0;            ///< payload volume over heaped_capacity()
  double cycle_energy = 0.0;    ///< of the whole cycle (cycle_of()); 0: not known [J]
  double cycle_time = 0.0;      ///< likewise [s]

  double efficiency() const { return energy > 0.0 ? payload_mass / energy : 0.0; }  ///< [kg/J]
};

/// Why a dig cannot be done: the path cannot be driven, or the machine stalls in the soil.
using DigFailure = std::variant<Infeasible, Stall>;

/// The failure in words, for people.
std::string describe(const DigFailure& failure);

}  // namespace excavplan
