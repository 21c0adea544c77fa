// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/results/stated_density.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <excavplan/change/volume_change.hpp>

#include "base/json.hpp"
#include "base/text.hpp"
#include "ground/plane_fit.hpp"

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

/// What ground lies below the plane of that about an extent; nothing where less than half of either
/// is seen [m^3].
std::optional<double> hole_in(const HeightMap& ground, const Rectangle& extent) {
  constexpr double about = 0.5;  // [m]; ours
  std::vector<Eigen::Vector3d> inside, around;
  for (Eigen::Index col = 0; col < ground.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < ground.z.rows(); ++row) {
      const Eigen::Vector3d p(ground.x(col), ground.y(row), ground.z(row, col));
      const double beyond = std::max(extent.x_min - p.x(), p.x() - extent.x_max);
      const double aside = std::max(extent.y_min - p.y(), p.y() - extent.y_max);
      if (std::isnan(p.z()) || std::max(beyond, aside) > about) continue;
      (extent.contains(p.x(), p.y()) ? inside : around).push_back(p);
    }
  }
  const double cell = ground.cell_size * ground.cell_size;
  const double width = extent.x_max - extent.x_min, height = extent.y_max - extent.y_min;
  const double whole = width * height;
  const double whole_around = (width + 2.0 * about) * (height + 2.0 * about) - whole;
  const auto seen = [&](const auto& points) { return cell * static_cast<double>(points.size()); };
  if (seen(inside) < 0.5 * whole || seen(around) < 0.5 * whole_around) return std::nullopt;
  const GroundPlane plane = robust_plane(around).plane;
  double sum = 0.0;
  for (const Eigen::Vector3d& p : inside) {
    sum += cell * std::max(0.0, plane.at(p.x(), p.y()) - p.z());
  }
  return sum;
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
  if (result.states("volume")) {
    JsonObject volume = result.object("volume");
    if (volume.states("excavated_m3")) stated.excavated = volume.number("excavated_m3");
  }
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

std::optional<Warning> older_ground(const StatedDensity& stated, const std::string& file,
                                    const HeightMap& ground) {
  constexpr double least = 1.0 / 3.0;  // of the hole; ours
  if (!stated.excavated || stated.holes.empty()) return std::nullopt;
  double seen = 0.0;
  for (const Rectangle& hole : stated.holes) {
    const auto volume = hole_in(ground, hole);
    if (!volume) return std::nullopt;
    seen += *volume;
  }
  if (seen >= least * *stated.excavated) return std::nullopt;
  return Warning{WarningCode::ground_before_dig,
                 file + ": the density was measured in a hole of " + readable(*stated.excavated) +
                     " m3, of which the terrain shows " + readable(seen, 2) +
                     " m3: it is of before that dig, or of another place"};
}

}  // namespace excavplan
