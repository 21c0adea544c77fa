// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/experiments/sensitivity.hpp>

#include "base/json_fwd.hpp"

namespace excavplan {

/// The best dig under an assumption at a density, and what is lost by it.
Json assumption_json(const AssumptionResult& result, const DigObjective& objective);

}  // namespace excavplan
