// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include "simulation/bucket_cavity.hpp"

namespace excavplan::test {

/// What lifting the payload from the level of the ground at z = 0 takes, over the energy of the dig
/// and what the weight of the links gives: at most 1 (docs/methods.md#energy).
double share_of_lifting(const Machine& machine, const DigPath& path, const DigResult& result);

}  // namespace excavplan::test
