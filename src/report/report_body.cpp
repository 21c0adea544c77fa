// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report_body.hpp"

#include <set>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "drawing/drawing.hpp"

namespace excavplan {
namespace {

/// JSON that cannot end the element it stands in.
std::string embedded(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    text += c == '<' ? "\\u003c" : std::string(1, c);
  }
  return text;
}

/// Scripts of data/report/app in the order of their dependence; they share one scope.
std::string app(const std::vector<const char*>& parts) {
  std::string text;
  for (const char* part : parts) text += shipped(std::string("app/") + part + ".js");
  return text;
}

/// The view in three dimensions of what is shown, with a note below.
std::string stage_of(const char* shown, const std::string& note) {
  return filled("stage.html", {{"shown", shown}, {"note", html(note)}});
}

}  // namespace

std::string html(const std::string& text) {
  constexpr std::size_t longest = 4000;  // ours [byte]
  return xml_escaped(safe_text(text, longest));
}

std::string shipped(const std::string& name) { return read_file(find_data_file("report/" + name)); }

std::string filled(const std::string& name, const std::map<std::string, std::string>& parts) {
  const std::string file = find_data_file("report/" + name), page = read_file(file);
  std::string text;
  std::size_t at = 0;
  std::set<std::string> used;
  for (std::size_t open = page.find("{{"); open != std::string::npos; open = page.find("{{", at)) {
    const std::size_t close = page.find("}}", open);
    const auto part = parts.find(page.substr(open + 2, close - open - 2));
    if (close == page.npos || part == parts.end()) break;
    text += page.substr(at, open - at) + part->second;
    used.insert(part->first);
    at = close + 2;
  }
  if (used.size() == parts.size() && page.find("{{", at) == page.npos)
    return text + page.substr(at);
  throw Error(ErrorKind::bad_file, file + ": is not the template of the reports");
}

ReportBody body_of(const ReportScene& scene, const std::string& note) {
  return {filled("dig.html", {{"stage", stage_of("ground", note)}}),
          "Site frame: origin on the swing axis of the machine at ground level, x forward in the "
          "boom plane, y left, z up; lengths in metres.",
          embedded(to_json(scene)),
          app({"page", "data", "colours", "scene", "kinematics", "legend", "stage", "ground_mesh",
               "ground_model", "machine_model", "view", "axes", "section", "charts", "dig_charts",
               "player", "dig_page", "end", "copy"})};
}

ReportBody plain_body(const std::string& note) {
  return {"", html(note), "{}", app({"page", "copy"}), false};
}

ReportBody body_of(const ReportJob& job, const std::string& note, const std::string& stream) {
  nlohmann::ordered_json data = to_json(job);
  std::vector<const char*> parts = {"page",        "data",          "cells",    "colours",
                                    "job_scene",   "kinematics",    "legend",   "stage",
                                    "ground_mesh", "machine_model", "job_view", "job_map",
                                    "axes",        "job_section",   "charts",   "job_charts",
                                    "player",      "job_page",      "end",      "copy"};
  if (!stream.empty()) {
    data["stream"] = stream;
    parts.push_back("live");
  }
  return {
      filled("job.html", {{"stage", stage_of("site", note)}, {"steps", step_rows(job.history)}}),
      "Frame: that of the site, x east, y north, z up; headings counter-clockwise from x; "
      "lengths in metres.",
      embedded(data), app(parts)};
}

}  // namespace excavplan
