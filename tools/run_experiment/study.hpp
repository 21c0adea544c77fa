// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/experiments/study.hpp>

#include "frame/tool.hpp"
#include "inputs/plots.hpp"

/// @file
/// run-experiment --study: the files of a study, and what is printed of it.

namespace excavplan::tools {

struct StudyInputs {
  std::optional<std::string> folder;
  double runs = 1.0;  ///< factor on their number
};

/// " (41.2 .. 44.0)"; empty for one value.
std::string interval_text(const StudyMean& mean);

void declare_study(Arguments& arguments, StudyInputs& inputs);

/// Runs the default study, with the seed and the threads of the options, and writes its files into
/// the folder: study.json with an entry per condition, runs.csv with a row per run, study.md with
/// the table to read, study.svg with the figure.
Outcome study(const Machine& machine, const StudyInputs& inputs, const Plots& plots,
              StudyOptions options, Console& console);

}  // namespace excavplan::tools
