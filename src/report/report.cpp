// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <map>

#include "base/json.hpp"
#include "base/text.hpp"
#include "drawing/drawing.hpp"
#include "report/report_body.hpp"
#include "report/report_figures.hpp"

namespace excavplan {
namespace {

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
  if (!report.state.empty())
    return shown(report.is_done ? "good" : "fair", html(report.state), warnings);
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

/// @param all  with the defaults
std::string setting_section(const std::vector<Setting>& settings, bool all) {
  std::string rows;
  for (const Setting& setting : settings) {
    if (!all && !setting.given) continue;
    rows += std::string("<tr") + (setting.given ? " class=\"given\"" : "") +
            "><th scope=\"row\"><code>" + html(setting.name) + "</code></th><td>" +
            html(setting.value) + "</td><td>" + (setting.given ? "given" : "default") +
            "</td></tr>\n";
  }
  if (rows.empty()) return "";
  return "<section id=\"settings\">\n<h2>Inputs and settings</h2>\n"
         "<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">option</th>"
         "<th scope=\"col\">value</th><th scope=\"col\">origin</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n</section>\n";
}

std::string printed(const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text;
  for (const std::string& line : lines) text += html(line) + '\n';
  return "<details id=\"printed\"><summary>Result as printed</summary>\n<pre>" + text +
         "</pre>\n</details>\n";
}

/// The plot as a part of the page, without the head of a file.
std::string plot_part(const Report& report) {
  const std::size_t start = report.plot.find("<svg");
  if (start == std::string::npos) return "";
  return std::string("<figure class=\"plot") + (report.plot_always ? "" : " fallback") + "\">" +
         report.plot.substr(start) + "</figure>\n";
}

ReportBody body_of(const Report& report) {
  if (report.job) return body_of(*report.job, report.note, report.stream);
  return report.scene.areas.empty() ? plain_body(report.note) : body_of(report.scene, report.note);
}

}  // namespace

nlohmann::ordered_json changing_parts(const Report& report, const ReportedRun& run) {
  const auto result = parse_ordered_json("the result", run.json);
  return {{"verdict", verdict(report, run)},
          {"headline", headline_tiles(result, report.headline)},
          {"figures", figure_tables(result)},
          {"result", run.json}};
}

std::string html_page(const Report& report, const ReportedRun& run) {
  const auto result = parse_ordered_json("the result", run.json);
  const ReportBody body = body_of(report);
  const std::map<std::string, std::string> parts = {
      {"connects", report.stream.empty() ? "" : " connect-src 'self';"},
      {"loads", report.stream.empty() ? "works offline and loads nothing."
                                      : "follows its job as long as it is served."},
      {"key", checksum_text(body.data + report.title)},
      {"title", html(report.title)},
      {"tool", html(run.tool)},
      {"version", html(run.version)},
      {"verdict", verdict(report, run)},
      {"warnings", warning_list(run.warnings)},
      {"headline", headline_tiles(result, report.headline)},
      {"plot", plot_part(report)},
      {"scene", body.markup},
      {"frame", body.frame},
      {"figures", figure_tables(result)},
      {"settings", setting_section(run.settings, body.draws)},
      {"lines", printed(run.lines)},
      {"result", xml_escaped(run.json)},
      {"data", body.data},
      {"style", shipped("vendor/uplot.css") + shipped("style.css")},
      {"contains", body.draws
                       ? " It contains three.js and uPlot (MIT licence, texts in the source of "
                         "the page)."
                       : ""},
      {"vendor", body.draws ? shipped("vendor/vendor.js") : ""},
      {"app", body.scripts}};
  return filled("page.html", parts);
}

}  // namespace excavplan
