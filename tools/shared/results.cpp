// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/results.hpp"

#include <excavplan/error.hpp>

#include "base/text.hpp"
#include "machine/dig_path_text.hpp"
#include "shared/plot.hpp"
#include "shared/quantity.hpp"

namespace excavplan::tools {
nlohmann::ordered_json volumes_json(const VolumeChange& change) {
  nlohmann::ordered_json json;
  const auto add = [&](const char* name, const Measured& volume) {
    json[std::string(name) + "_m3"] = volume.value;
    json[std::string(name) + "_sd_m3"] = volume.sd;
  };
  add("excavated", change.excavated);
  add("spilled", change.spilled);
  add("dumped", change.dumped);
  add("before", change.before);
  add("after", change.after);
  return json;
}

nlohmann::ordered_json dig_json(const PlannedDig& dig) {
  return {
      {"path", path_json(dig.parameters, dig.start_x)},    {"payload_mass_kg", dig.payload_mass},
      {"payload_volume_m3", dig.payload_volume},           {"energy_kj", dig.energy / 1000.0},
      {"efficiency_kg_per_kj", 1000.0 * dig.efficiency()}, {"duration_s", dig.duration}};
}

std::string path_text(const PlannedDig& dig) {
  return excavplan::path_text(dig.parameters, dig.start_x);
}

std::string nearest_text(const std::optional<NearestDig>& nearest) {
  if (!nearest) return "";
  return "; the nearest, " + excavplan::path_text(nearest->parameters, nearest->start_x) + ": " +
         nearest->reason;
}

std::vector<std::string> dig_lines(const PlannedDig& dig, const DigSpread& spread) {
  return {
      "path         " + path_text(dig),
      "payload      " + readable(dig.payload_mass, spread.payload_mass) + " kg, " +
          readable(dig.payload_volume) + " m3 loose",
      "energy       " + readable(dig.energy / 1000.0, spread.energy / 1000.0) + " kJ",
      "efficiency   " + readable(1000.0 * dig.efficiency(), 1000.0 * spread.efficiency) + " kg/kJ",
      "duration     " + readable(dig.duration) + " s"};
}

std::vector<double> parse_densities(const std::string& what, const std::string& text) {
  const std::vector<double> densities = parse_series(what, text, Quantity::percent);
  for (const double density : densities) {
    if (density >= 0.0 && density <= 100.0) continue;
    throw Error(ErrorKind::bad_input,
                what + ": " + number_text(density) + " % is outside 0 .. 100");
  }
  return densities;
}

std::string html_report(const std::string& title, const std::vector<std::string>& svgs,
                        const std::vector<std::string>& lines, const nlohmann::ordered_json& json) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
      xml_escaped(title) +
      "</title>\n<style>body{font:16px/1.5 sans-serif;max-width:1100px;margin:2em auto;"
      "padding:0 1em;color:#222}svg{max-width:100%;height:auto}pre{background:#f4f4f2;"
      "padding:1em;overflow:auto}</style></head><body>\n<h1>" +
      xml_escaped(title) + "</h1>\n<pre>";
  for (const std::string& line : lines) page += xml_escaped(line) + "\n";
  page += "</pre>\n";
  for (const std::string& svg : svgs) page += svg.substr(svg.find("<svg")) + "\n";
  return page + "<h2>All figures</h2>\n<pre>" + xml_escaped(json.dump(2)) +
         "</pre>\n</body></html>\n";
}

}  // namespace excavplan::tools
