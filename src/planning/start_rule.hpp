// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/planning/start_rule.hpp>

#include "planning/dig_layout.hpp"

namespace excavplan {

/// Lays out a dig that begins by a rule.
/// @throws Error (bad_input) if the start is to be searched
std::variant<DigPath, Infeasible> path_by(const DigLayout& layout, const DigParameters& parameters,
                                          const StartRule& start);

}  // namespace excavplan
