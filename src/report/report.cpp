// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <map>

#include "base/json.hpp"
#include "base/text.hpp"
#include "drawing/plot.hpp"
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
  if (!report.state.empty()) {  // its steps have warnings of their own
    return shown(report.is_done ? "good" : "fair", html(report.state), count == 0 ? "" : warnings);
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

std::string setting_table(const std::vector<Setting>& settings, bool given) {
  std::string rows;
  for (const Setting& setting : settings) {
    if (setting.given != given) continue;
    rows += std::string("<tr") + (given ? " class=\"given\"" : "") + "><th scope=\"row\"><code>" +
            html(setting.name) + "</code></th><td>" + html(setting.value) + "</td></tr>\n";
  }
  if (rows.empty()) return "";
  return "<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">option</th>"
         "<th scope=\"col\">value</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

/// What was given; the rest, which matters to few, is folded.
/// @param all  with the defaults
std::string setting_section(const std::vector<Setting>& settings, bool all) {
  const std::string given = setting_table(settings, true);
  const std::string left = all ? setting_table(settings, false) : "";
  if (given.empty() && left.empty()) return "";
  return "<section id=\"settings\">\n<h2>Inputs and settings</h2>\n" + given +
         (left.empty() ? ""
                       : "<details><summary>All others, at their defaults</summary>\n" + left +
                             "</details>\n") +
         "</section>\n";
}

std::string printed(const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text;
  for (const std::string& line : lines) text += html(line) + '\n';
  return "<details id=\"printed\"><summary>Result as printed</summary>\n<pre>" + text +
         "</pre>\n</details>\n";
}

/// Without the head of a file.
std::string svg_of(const std::string& plot) {
  const std::size_t start = plot.find("<svg");
  return start == std::string::npos ? "" : plot.substr(start);
}

/// With names of its own, as those of a page are unique.
std::string renamed(std::string svg) {
  for (const std::string before : {"id=\"", "url(#"}) {
    for (std::size_t at = 0; (at = svg.find(before + "clip", at)) != std::string::npos;) {
      at += before.size();
      svg.insert(at, "narrow-");
    }
  }
  return svg;
}

/// The plot as a part of the page.
std::string plot_part(const Report& report) {
  std::string plot = svg_of(report.plot);
  if (plot.empty()) return "";
  if (!report.narrow_plot.empty()) {
    plot = "<div class=\"spacious\">" + plot + "</div><div class=\"narrow\">" +
           renamed(svg_of(report.narrow_plot)) + "</div>";
  }
  return std::string("<figure class=\"plot") + (report.plot_always ? "" : " fallback") + "\">" +
         plot + "</figure>\n";
}

ReportBody body_of(const Report& report) {
  if (report.job) return body_of(*report.job, report.note, report.stream);
  return report.scene.areas.empty() ? plain_body(report.note) : body_of(report.scene, report.note);
}

}  // namespace

void set_plot(Report& report, const Figure& figure) {
  constexpr double phone = 85.0;  // [mm]
  report.plot = to_svg(lay_out(figure));
  report.narrow_plot = to_svg(lay_out(figure, {phone, {}}));
}

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
