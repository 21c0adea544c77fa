// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/planning/dig_outcome.hpp>

/// @file
/// The whole working cycle around a dig (docs/methods.md#cycle): dig, lift, swing, dump, swing back
/// and lower to the start of the dig.

namespace excavplan {

/// Energy and time of a cycle or a part of it.
struct CycleShare {
  double energy = 0.0;  ///< [J]
  double time = 0.0;    ///< [s]
};

/// Where energy and time of a cycle go.
struct DigCycle {
  CycleShare dig;    ///< penetrate, drag and scoop
  CycleShare lift;   ///< loaded, to the dump height
  CycleShare swing;  ///< loaded; begins once the bucket is clear of the ground
  CycleShare dump;   ///< opening of the bucket
  CycleShare back;   ///< swing back, while the bucket is lowered
  CycleShare lower;  ///< empty, to the start of the dig
  CycleShare rest;   ///< waiting time, and the idle power over the whole cycle
  CycleShare total;  ///< time: of parts that overlap the longer counts
};

/// @param dig   along the path: its payload, energy and duration
/// @return nothing if the machine does not state its swing and its engine
/// @throws Error (bad_input) as require_machine(); if the path has no pose, or a number of the dig
///         or an option is negative, not finite or absurd
std::optional<DigCycle> cycle_of(const Machine& machine, const DigPath& path, const PlannedDig& dig,
                                 const CycleOptions& options = {});

/// Energy and time of a bucket that only dumps what it carries: from where it is held over the dump
/// and back. @return, @throws as cycle_of()
std::optional<CycleShare> dump_of(const Machine& machine, const JointAngles& held,
                                  const CycleOptions& options);

/// @throws Error (bad_input) naming the sections that the machine's file lacks, or the height it
///         can dump from if that is less than asked for
void require_cycle(const Machine& machine, const CycleOptions& options);

}  // namespace excavplan
