// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <excavplan/machine/machine.hpp>

/// @file The rules between the numbers of a machine, for its file and for programs. Private to the
/// project.

namespace excavplan {

inline constexpr double longest_part = 100.0;  ///< a larger length is an error of units [m]

/// Calls `fail`, which does not return, with the key in the `bucket` of a machine file and what is
/// wrong.
void check_shape(const Bucket& bucket, double bucket_length, double boom_length,
                 const std::function<void(const char* key, const std::string& what)>& fail);

/// The same of a machine whose numbers each keep their rules, with keys from the top of the file:
/// relations that every excavator of 1 to 100 t keeps, and that a number in another unit breaks.
void check_units(const Machine& machine,
                 const std::function<void(const std::string& key, const std::string& what)>& fail);

}  // namespace excavplan
