// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/page.hpp"

#include <memory>
#include <utility>

#include "report/report.hpp"

namespace excavplan::tools {

Page page_of(Report report, const std::string& file) {
  return {file, [report = std::make_shared<const Report>(std::move(report))](
                    const ReportedRun& run) { return html_page(*report, run); }};
}

}  // namespace excavplan::tools
