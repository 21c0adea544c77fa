// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "report/report_job.hpp"
#include "report/report_scene.hpp"

/// @file
/// Files of data/report put together.

namespace excavplan {

/// A text for a page: no control characters, no bytes that are not UTF-8, no markup.
std::string html(const std::string& text);

/// The content of a file of data/report. @throws Error (bad_file)
std::string shipped(const std::string& name);
/// Fills a template alone. @throws Error (bad_file) unless it names each part, and nothing else
std::string filled(const std::string& name, const std::map<std::string, std::string>& parts);

/// What the page draws, and how.
struct ReportBody {
  std::string markup, frame, data, scripts;
  bool draws = true;  ///< in three dimensions and charts
};
/// @param note  what ground and loads are
ReportBody body_of(const ReportScene& scene, const std::string& note);
/// @param stream  of events that it follows; empty: none
ReportBody body_of(const ReportJob& job, const std::string& note, const std::string& stream);
/// Of a page without ground.
ReportBody plain_body(const std::string& note);

}  // namespace excavplan
