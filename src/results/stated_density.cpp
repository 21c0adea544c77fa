// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/results/stated_density.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <excavplan/change/volume_change.hpp>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double near_the_hole = 5.0;  // ours [m]

/// What estimate-density always states: of a result that lost one of these, a density would be
/// taken as exact, as trusted or as that of any soil.
void require_whole_estimate(JsonObject& result) {
  if (!result.has("tool")) return;
  for (const char* key : {"density_sd_percent", "density_raw_percent",
                          "density_sd_given_law_percent", "trustworthy", "law_soil"}) {
    if (!result.has(key))
      result.fail(key, "is missing, expected a result of estimate-density --json");
  }
  for (const char* key : {"density_sd_percent", "density_raw_percent"}) result.number(key);
}

/// The soil whose law gave the density; empty if it is not known.
std::string soil_of(JsonObject& result) {
  const std::string of_law = result.states("law_soil") ? result.text("law_soil") : "";
  const std::string told = result.states("soil") ? result.text("soil") : "";
  if (!of_law.empty() && !told.empty() && of_law != told) {
    result.fail("law_soil", "is " + of_law + ", soil is " + told + "; must be the same");
  }
  return told.empty() ? of_law : told;
}

/// Of hole, spill and heap [m^3], where they are stated.
std::vector<double> volumes_in(JsonObject& result) {
  std::vector<double> volumes;
  if (!result.states("volume")) return volumes;
  JsonObject volume = result.object("volume");
  for (const char* key : {"excavated_m3", "spilled_m3", "dumped_m3"}) {
    if (volume.states(key)) volumes.push_back(volume.number(key));
  }
  return volumes;
}

std::vector<Rectangle> holes_in(JsonObject& result) {
  std::vector<Rectangle> holes;
  if (!result.states("zones")) return holes;
  for (JsonObject& zone : result.objects("zones")) {
    const bool is_hole = zone.text("kind") == name(ZoneKind::dig);
    const auto edge = zone.numbers("extent_m", 4);
    if (edge[0] > edge[2] || edge[1] > edge[3]) {
      zone.fail("extent_m", "must be [x_min, y_min, x_max, y_max], each min at most its max");
    }
    if (is_hole) holes.push_back({edge[0], edge[1], edge[2], edge[3]});
  }
  return holes;
}

/// To the nearest of some holes [m]; 0 if there are none.
double distance_to(const std::vector<Rectangle>& holes, const Rectangle& here) {
  double least = std::numeric_limits<double>::infinity();
  for (const Rectangle& hole : holes) {
    const double aside = std::max({hole.y_min - here.y_max, here.y_min - hole.y_max, 0.0});
    const double beyond = std::max({hole.x_min - here.x_max, here.x_min - hole.x_max, 0.0});
    least = std::min(least, std::hypot(beyond, aside));
  }
  return std::isfinite(least) ? least : 0.0;
}

}  // namespace

StatedDensity stated_density(const std::string& file) {
  JsonObject result = JsonObject::result_of("estimate-density", file);
  if (result.has("density_percent") && !result.states("density_percent")) {
    result.fail("density_percent", "is null, as the scans gave no density; its warnings say why");
  }
  StatedDensity stated{result.number("density_percent", 0.0, 100.0)};
  require_whole_estimate(result);
  GroundDensity& density = stated.density;
  if (result.states("density_sd_percent")) {
    density.sd_percent = result.number("density_sd_percent", 0.0, most_density_sd);
  }
  const double sd = density.sd_percent;
  stated.raw_percent = density.percent;
  if (result.states("density_raw_percent")) {
    stated.raw_percent = result.number("density_raw_percent");
    if (std::clamp(stated.raw_percent, 0.0, 100.0) != density.percent ||
        std::abs(stated.raw_percent - density.percent) > sd) {
      result.fail("density_raw_percent",
                  "is " + number_text(stated.raw_percent) +
                      ", must be density_percent, or as far outside 0 .. 100 as its sd at most");
    }
  }
  stated.independent_sd = sd;  // one that nobody splits is of another measurement
  if (result.states("density_sd_given_law_percent")) {
    stated.independent_sd = result.number("density_sd_given_law_percent", 0.0, sd);
  }
  if (result.has("trustworthy")) density.trustworthy = result.flag("trustworthy");
  density.soil = soil_of(result);
  stated.of_any_soil = result.text_or("law", "") == "any soil";
  stated.is_whole = result.has("tool");
  stated.holes = holes_in(result);
  stated.volumes = volumes_in(result);
  return stated;
}

std::optional<Warning> elsewhere(const StatedDensity& stated, const std::string& file,
                                 const Rectangle& here) {
  const double away = distance_to(stated.holes, here);
  if (!(away > near_the_hole)) return std::nullopt;
  return Warning{WarningCode::density_from_elsewhere,
                 file + ": the density was measured " + readable(away) +
                     " m from where this dig begins; it holds for ground near its hole that is of "
                     "the same soil"};
}

}  // namespace excavplan
