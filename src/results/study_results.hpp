// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/experiments/study.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// {mean, interval_95}; null without values. One value has no interval.
Json mean_json(const StudyMean& mean);

/// A condition with its errors of density and its gains.
Json condition_json(const StudyResult& result);

/// A row per run; columns: docs/formats.md#run-experiment.
std::string runs_csv(const std::vector<StudyResult>& results);

}  // namespace excavplan
