// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "report/reported_run.hpp"

namespace excavplan {
struct Report;
}

namespace excavplan::tools {

/// What --report writes of a run.
struct Page {
  std::string file;  ///< to write
  std::function<std::string(const ReportedRun& run)> text;
};

/// The page of a report, for Outcome::page.
Page page_of(Report report, const std::string& file);

}  // namespace excavplan::tools
