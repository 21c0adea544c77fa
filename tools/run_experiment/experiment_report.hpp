// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/report.hpp"
#include "results/experiment_results.hpp"

namespace excavplan::tools {

/// The page, without its file: both digs of each condition, dug once more on level ground, and bars
/// of what they are worth.
Report experiment_report(const Machine& machine, const SoilKind& soil, const PlanOptions& options,
                         const Experiments& experiments);

}  // namespace excavplan::tools
