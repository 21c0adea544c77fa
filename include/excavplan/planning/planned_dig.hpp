// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include <excavplan/planning/dig_outcome.hpp>
#include <excavplan/planning/start_rule.hpp>

namespace excavplan {

/// Lays out a dig, simulates it, times it and its cycle with the usual CycleOptions.
///
/// Ground of unknown height under the bucket makes the path infeasible (unknown_ground), and so
/// does known ground in the way of boom or arm (front_contact).
///
/// @throws Error (bad_input) if the start is to be searched
std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  const StartRule& start = {});

}  // namespace excavplan
