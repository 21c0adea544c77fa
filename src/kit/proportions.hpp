// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <excavplan/machine/machine_file.hpp>

/// @file
/// What the numbers of a machine grow with. Private to the project.

namespace excavplan {

/// The numbers of a machine by their places in its file, "/links/boom/mass_kg".
using MachineNumbers = std::map<std::string, double>;

/// A known machine.
struct Proportioned {
  MachineFile file;
  DataSheet sheet;         ///< what its file states, else what its numbers say
  MachineNumbers numbers;  ///< without cylinders, names of joints, and what is not of every machine
};

/// @param word  shipped name or file
Proportioned proportioned(const std::string& word);

/// The figures of a sheet that another has.
DataSheet as_far_as(const DataSheet& sheet, const DataSheet& other);

/// Each number as that share of the figure it grows with which the known machines have, those of
/// nearly the same mass most. @param length  what lengths grow with, in place of the reach [m]
MachineNumbers in_proportion(const std::vector<const Proportioned*>& known, const DataSheet& sheet,
                             double length);

/// What a number grows with, in words; empty: it is the same for all.
std::string grows_with(const std::string& place, const DataSheet& sheet);

/// "links.boom.mass_kg", "bucket.profile[1].across_m" of a place.
std::string key_of(const std::string& place);

}  // namespace excavplan
