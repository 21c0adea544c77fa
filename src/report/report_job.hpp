// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/job/job_history.hpp>
#include <excavplan/machine/machine.hpp>

/// @file
/// What a report shows of a whole job.

namespace excavplan {

struct ReportJob {
  JobHistory history;
  Machine machine;
};

/// For data/report/app: the ground where something is or happened, in codes of millimetres
/// (src/job/cell_codes.hpp), and of each step what it changed of it. More than 250000 cells are
/// coarsened.
nlohmann::ordered_json to_json(const ReportJob& job);

/// Rows of HTML, one for each step.
std::string step_rows(const JobHistory& history);

}  // namespace excavplan
