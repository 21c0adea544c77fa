// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/experiment/experiment.hpp>

/// @file
/// What run-experiment writes and prints.

namespace excavplan::tools {

nlohmann::ordered_json experiment_json(const std::string& condition,
                                       const ExperimentResult& result);
std::string experiment_line(const std::string& condition, const ExperimentResult& result);

}  // namespace excavplan::tools
