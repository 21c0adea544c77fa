// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/estimating/job_cost.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// What a job takes, each figure with its 95 % interval as a share of it.
Figure job_estimate_figure(const JobEstimate& estimate, const std::optional<JobCost>& cost);

}  // namespace excavplan
