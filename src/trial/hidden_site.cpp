// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/hidden_site.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/design/design_file.hpp>
#include <excavplan/ground/ascii_grid.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr double least_even = 10.0, most_even = 90.0;  // of a field without a gradient [%]

JsonObject opened(const std::string& path) {
  return JsonObject::of_others(path, read_file(path, most_foreign_bytes));
}

/// The file that a key names. @param folder  "soils"
std::string shipped(JsonObject& site, const char* key, const char* folder) {
  const std::string name = site.text(key);
  try {
    return shipped_or_file(folder, name);
  } catch (const Error& error) {
    site.fail(key, error.what());
  }
}

/// The product's soil of that name with the numbers that the site states in their place. Dug soil
/// keeps its relative density.
SoilKind nominal_soil(JsonObject site) {
  SoilKind soil = load_soil(shipped(site, "name", "soils"));
  const double looseness =
      (soil.void_ratio_max - soil.void_ratio_loose) / (soil.void_ratio_max - soil.void_ratio_min);
  const bool own_voids = site.states("e_max") || site.states("e_min");
  soil.specific_gravity = site.number_or("specific_gravity", soil.specific_gravity, 0.5, 10.0);
  soil.water_content = site.number_or("water", soil.water_content, 0.0, 10.0);
  const double e_max = site.number_or("e_max", soil.void_ratio_max, 0.01, 20.0);
  const double e_min = site.number_or("e_min", soil.void_ratio_min, 0.01, 20.0);
  if (own_voids && (e_max != soil.void_ratio_max || e_min != soil.void_ratio_min)) {
    soil.void_ratio_loose = e_max - looseness * (e_max - e_min);
  }
  soil.void_ratio_max = e_max;
  soil.void_ratio_min = e_min;
  soil.void_ratio_loose = site.number_or("e_loose", soil.void_ratio_loose, 0.01, 20.0);
  soil.angle_of_repose =
      degree * site.number_or("repose_deg", soil.angle_of_repose / degree, 3.0, 80.0);
  try {
    require_soil(soil);
  } catch (const Error& error) {
    site.fail("name", std::string("with the numbers beside it is no soil: ") + error.what());
  }
  return soil;
}

SiteSensor sensor_of(JsonObject site) {
  SiteSensor sensor;
  sensor.name = site.text("name");
  sensor.noise = site.number("noise_sd_at_1m_m", 0.0, 10.0);
  sensor.pattern = site.number_or("pattern_sd_at_1m_m", 0.0, 0.0, 10.0);
  sensor.range_power = site.number_or("range_power", 0.0, 0.0, 4.0);
  const std::string mount = site.text("mount");
  if (mount != "boom" && mount != "cab" && mount != "mast") {
    site.fail("mount", "is " + in_quotes(mount) + ", must be boom, cab or mast");
  }
  sensor.on_boom = mount == "boom";
  sensor.height = site.number("height_m", 0.1, 100.0);
  sensor.tilt = degree * site.number("tilt_deg", -90.0, 90.0);
  const std::vector<double> view = site.numbers("field_of_view_deg", 2);
  if (!(std::min(view[0], view[1]) > 0.0 && view[0] <= 360.0 && view[1] <= 180.0)) {
    site.fail("field_of_view_deg", "must be above 0 and at most 360 and 180");
  }
  sensor.view = degree * Eigen::Vector2d(view[0], view[1]);
  sensor.height_sd = site.number_or("registration_sd_m", 0.0, 0.0, 10.0);
  sensor.tilt_sd = degree * site.number_or("registration_sd_deg", 0.0, 0.0, 45.0);
  return sensor;
}

/// The ground on finer cells.
HeightMap refined(const HeightMap& coarse, double cell_size) {
  HeightMap fine = flat_ground(coarse.extent(), cell_size);
  for_each_cell(fine.z, [&](Cell at) {
    fine.z(at.row, at.col) = height_at(coarse, fine.x(at.col), fine.y(at.row));
  });
  return fine;
}

/// Mean height along the line of the design, or without words of all ground.
double mean_on_axis(const std::optional<DesignWords>& words, const HeightMap& ground) {
  double sum = 0.0;
  int count = 0;
  const auto add = [&](double height) {
    if (std::isnan(height)) return;
    sum += height;
    ++count;
  };
  if (words) {
    const int steps = std::max(1, static_cast<int>(std::ceil(words->length / ground.cell_size)));
    for (int i = 0; i <= steps; ++i) {
      const double along = words->length * i / steps;
      add(height_at(ground, words->from.x() + along * std::cos(words->heading),
                    words->from.y() + along * std::sin(words->heading)));
    }
  } else {
    for (const double height : ground.z.reshaped()) add(height);
  }
  return count > 0 ? sum / count : 0.0;
}

SoilKind true_soil(SoilKind soil, double strength, double water) {
  soil.cohesion_loosest *= strength;  // the adhesion is a share of it
  soil.cone_index_reference *= strength;
  soil.water_content = std::min(water, soil.void_ratio_min / soil.specific_gravity);
  require_soil(soil);
  return soil;
}

}  // namespace

double TrueDensity::at(double x, double y, double z) const {
  const double even = height_at(percent, x, y);
  if (gradient == 0.0) return std::clamp(even, least_even, most_even);
  return std::clamp(even + gradient * (datum - z), 0.0, 100.0);
}

void set_void_ratios(const TrueDensity& density, const SoilKind& soil, Terrain& ground) {
  const double span = soil.void_ratio_max - soil.void_ratio_min;
  ground.bank_void_ratio = ground.bank.z;
  for_each_cell(ground.bank.z, [&](Cell at) {
    const double z = ground.bank.z(at.row, at.col);
    if (std::isnan(z)) return;
    const double d = density.at(ground.bank.x(at.col), ground.bank.y(at.row), z);
    ground.bank_void_ratio(at.row, at.col) = soil.void_ratio_max - d / 100.0 * span;
  });
}

SiteBrief read_site_brief(const std::string& file_or_folder) {
  const bool is_folder = std::filesystem::is_directory(file_or_folder);
  const std::string path = file_or_folder + (is_folder ? "/site.json" : "");
  SiteBrief brief;
  brief.job = read_plain_site(path);
  JsonObject site = opened(path);
  brief.soil = nominal_soil(site.object("soil"));
  brief.sensor = sensor_of(site.object("sensor"));
  if (site.states("machine")) {
    JsonObject machine = site.object("machine");
    (void)shipped(machine, "class", "machines");
    brief.machine = machine.text("class");
  }
  if (site.states("prior")) {
    JsonObject prior = site.object("prior");
    brief.density = {prior.number("density_mean_percent", 0.0, 100.0),
                     prior.number("density_sd_percent", 0.0, 100.0)};
  }
  if (!brief.job.start) site.fail("start_pose", "is not there, must be x, y and heading_rad");
  if (brief.job.scan_file.empty()) site.fail("files", "must name a first_scan");
  if (!brief.job.design_file.empty()) {
    brief.design = read_design(brief.job.design_file);
  } else if (brief.job.words) {
    brief.design = design_of_words(*brief.job.words, read_ascii_grid(brief.job.scan_file));
  } else {
    site.fail("design", "is not there, must be words or files.design");
  }
  return brief;
}

JobSettings settings_of(const SiteBrief& site, const Machine& machine, const DensityLaw& law) {
  JobSettings settings;
  settings.site.soil = site.soil;
  settings.site.machine = machine;
  settings.site.law = law;
  settings.design = site.job;
  settings.surface = site.design;
  settings.density_percent = site.density.percent;
  return settings;
}

HiddenSite read_hidden_site(const std::string& folder, double cell_size) {
  require_in("true ground: cell size [m]", cell_size, 0.005, 0.25);
  HiddenSite site;
  site.known = read_site_brief(folder + "/site.json");
  site.first_scan = read_ascii_grid(site.known.job.scan_file);
  const HeightMap ground = read_ascii_grid(folder + "/hidden/ground.asc");
  site.density.percent = read_ascii_grid(folder + "/hidden/density.asc");
  JsonObject truth = opened(folder + "/hidden/truth.json");
  site.density.gradient = truth.number_or("depth_gradient_percent_per_m", 0.0, -1e3, 1e3);
  site.density.datum = mean_on_axis(site.known.job.words, ground);
  HiddenErrors& errors = site.errors;
  errors.payload_scale = truth.number_or("payload_scale_error", 0.0, -0.9, 10.0);
  errors.payload_noise = truth.number_or("payload_noise", errors.payload_noise, 0.0, 1.0);
  errors.height_bias = truth.number_or("tracking_height_bias_m", 0.0, -1.0, 1.0);
  errors.height_sd = truth.number_or("tracking_height_sd_m", errors.height_sd, 0.0, 1.0);
  errors.side_sd = truth.number_or("tracking_side_sd_m", errors.side_sd, 0.0, 1.0);
  site.soil =
      true_soil(site.known.soil, truth.number_or("strength_factor", 1.0, 0.01, 100.0),
                truth.number_or("water_content_true", site.known.soil.water_content, 0.0, 10.0));
  site.ground = undisturbed(refined(ground, cell_size));
  const Eigen::ArrayXXd known = site.ground.bank.z.isNaN().cast<double>();
  for_each_cell(known, [&](Cell at) {
    const double d =
        height_at(site.density.percent, site.ground.bank.x(at.col), site.ground.bank.y(at.row));
    if (known(at.row, at.col) > 0.0 || std::isfinite(d)) return;
    throw Error(ErrorKind::bad_file,
                folder + "/hidden/density.asc: does not cover all of hidden/ground.asc");
  });
  set_void_ratios(site.density, site.soil, site.ground);
  return site;
}

}  // namespace excavplan
