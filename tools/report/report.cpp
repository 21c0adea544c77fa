// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <map>
#include <set>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "drawing/drawing.hpp"
#include "report/report_figures.hpp"

namespace excavplan::tools {
namespace {

/// A text for a page: no control characters, no bytes that are not UTF-8, no markup.
std::string html(const std::string& text) {
  constexpr std::size_t longest = 4000;  // ours [byte]
  return xml_escaped(safe_text(text, longest));
}

/// JSON that cannot end the element it stands in.
std::string embedded(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    text += c == '<' ? "\\u003c" : std::string(1, c);
  }
  return text;
}

std::string shipped(const std::string& name) { return read_file(find_data_file("report/" + name)); }

/// The scripts of data/report/app in the order of their dependence; they share one scope.
std::string app() {
  std::string text;
  for (const char* part : {"page", "scene", "kinematics", "colours", "ground_model",
                           "machine_model", "view", "section", "charts", "player"}) {
    text += shipped(std::string("app/") + part + ".js");
  }
  return text;
}

/// Fills the template alone. @throws Error (bad_file) unless it names each part, and nothing else
std::string filled(const std::map<std::string, std::string>& parts) {
  const std::string file = find_data_file("report/page.html"), page = read_file(file);
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

std::string verdict(const Report& report, const ReportedRun& run) {
  const auto shown = [](const std::string& kind, const std::string& what, const std::string& why) {
    return "<p class=\"verdict " + kind + "\"><strong>" + what + "</strong> " + why + "</p>";
  };
  const std::size_t count = run.warnings.size();
  const std::string warnings = count == 0   ? "No warnings."
                               : count == 1 ? "1 warning, below."
                                            : std::to_string(count) + " warnings, below.";
  if (run.stopped_early) return shown("bad", "Stopped early.", warnings);
  if (!report.fault.empty()) return shown("bad", html(report.fault), warnings);
  if (!run.trustworthy) {
    return shown("bad", "Do not trust this result.", "The reason is among the warnings below.");
  }
  if (run.judged) return shown("good", "Trustworthy.", warnings);
  return shown(count == 0 ? "good" : "fair", "Done.", warnings);
}

std::string warning_list(const std::vector<Warning>& warnings) {
  if (warnings.empty()) return "";
  std::string list =
      "<section class=\"warnings\" aria-label=\"Warnings\"><h2>Warnings</h2>\n<ul>\n";
  for (const Warning& warning : warnings) {
    list += "<li><code>" + html(code_text(warning.code)) + "</code> " + html(warning.message) +
            "</li>\n";
  }
  return list + "</ul></section>\n";
}

std::string setting_rows(const std::vector<Setting>& settings) {
  std::string rows;
  for (const Setting& setting : settings) {
    rows += std::string("<tr") + (setting.given ? " class=\"given\"" : "") +
            "><th scope=\"row\"><code>" + html(setting.name) + "</code></th><td>" +
            html(setting.value) + "</td><td>" + (setting.given ? "given" : "default") +
            "</td></tr>\n";
  }
  return rows;
}

std::string printed(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += html(line) + '\n';
  return text;
}

/// The plot as a part of the page, without the head of a file.
std::string plot_part(const Report& report) {
  const std::size_t start = report.plot.find("<svg");
  if (start == std::string::npos) return "";
  return std::string("<figure class=\"plot") + (report.plot_always ? "" : " fallback") + "\">" +
         report.plot.substr(start) + "</figure>\n";
}

}  // namespace

std::string html_page(const Report& report, const ReportedRun& run) {
  const auto result = parse_ordered_json("the result", run.json);
  const std::string data = embedded(to_json(report.scene));
  const std::map<std::string, std::string> parts = {
      {"key", checksum_text(data + report.title)},
      {"title", html(report.title)},
      {"tool", html(run.tool)},
      {"version", html(run.version)},
      {"verdict", verdict(report, run)},
      {"warnings", warning_list(run.warnings)},
      {"headline", headline_tiles(result, report.headline)},
      {"plot", plot_part(report)},
      {"note", html(report.note)},
      {"figures", figure_tables(result)},
      {"settings", setting_rows(run.settings)},
      {"lines", printed(run.lines)},
      {"result", xml_escaped(run.json)},
      {"data", data},
      {"style", shipped("vendor/uplot.css") + shipped("style.css")},
      {"vendor", shipped("vendor/vendor.js")},
      {"app", app()}};
  return filled(parts);
}

Page page_of(Report report, const std::string& file) {
  return {file, [report = std::make_shared<const Report>(std::move(report))](
                    const ReportedRun& run) { return html_page(*report, run); }};
}

}  // namespace excavplan::tools
