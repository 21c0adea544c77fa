// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_order.hpp>

#include <filesystem>
#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/design/design_file.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/density_law.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "design/tin_ply.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

// The description of a plain site, with what that does not hold in `kept`.
constexpr const char* order_file = "/order.json";
constexpr const char* order_format = "plain-site";
constexpr const char* law_name = "order-law.json";
constexpr const char* tin_name = "order-design.ply";
constexpr const char* raster_name = "order-design.tif";

Json corners(const SitePolygon& polygon) {
  Json list = Json::array();
  for (const Eigen::Vector2d& corner : polygon) list.push_back({corner.x(), corner.y()});
  return list;
}

/// As read_plain_site() reads it.
Json site_json(const JobDesign& job) {
  Json json = {{"format", order_format},
               {"version", 1},
               {"id", job.name},
               {"tolerance_m", job.tolerance},
               {"edge_margin_m", job.edge_margin},
               {"start_pose",
                {{"x", job.start->x}, {"y", job.start->y}, {"heading_rad", job.start->heading}}}};
  for (const KeepOut& each : job.keep_out) {
    Json part = {{"kind", each.kind}, {"polygon", corners(each.polygon)}};
    if (each.depth) part["depth_m"] = *each.depth;
    json["keep_out"].push_back(std::move(part));
  }
  for (const JobObstacle& each : job.obstacles) {
    json["obstacles"].push_back(
        {{"kind", each.kind}, {"polygon", corners(each.polygon)}, {"height_m", each.height}});
  }
  for (const DumpArea& each : job.dump_areas) {
    const bool is_heap = each.kind == DumpArea::Kind::heap;
    json["dump_areas"].push_back(
        {{"kind", is_heap ? "heap" : "windrow"}, {"polygon", corners(each.polygon)}});
  }
  if (job.truck) {
    json["truck"] = {{"bed_polygon", corners(job.truck->bed)},
                     {"bed_height_m", job.truck->bed_height},
                     {"target_kg", job.truck->target_mass}};
  }
  if (job.sensor) {
    json["sensor"] = {{"noise_sd_at_1m_m", job.sensor->own},
                      {"pattern_sd_at_1m_m", job.sensor->shared},
                      {"range_power", job.sensor->range_power}};
  }
  return json;
}

Json keep_design(const std::string& folder, const DesignSurface& design) {
  Json json = {{"name", design.name}, {"cuts_only", design.cuts_only}, {"unit", design.unit}};
  json["unit_told_by"] = design.unit_told_by;
  json["hangs_on_scan"] = design.hangs_on_scan;
  if (const auto* tin = std::get_if<Tin>(&design.shape)) {
    write_own_file(folder + '/' + tin_name, ply_of(*tin));
    json["origin_m"] = {tin->origin.x(), tin->origin.y(), tin->origin.z()};
    return json;
  }
  GroundState raster;
  raster.terrain = undisturbed(std::get<HeightMap>(design.shape));
  save_ground(folder + '/' + raster_name, raster);
  return json;
}

DesignSurface kept_design(const std::string& folder, JsonObject object) {
  DesignSurface design;
  if (object.has("origin_m")) {
    design = read_design(folder + '/' + tin_name);
    const std::vector<double> origin = object.numbers("origin_m", 3);
    std::get<Tin>(design.shape).origin += Eigen::Vector3d(origin[0], origin[1], origin[2]);
  } else {
    design.shape = load_ground(folder + '/' + raster_name).terrain.bank;
  }
  design.notes.clear();
  design.name = object.text("name");
  design.cuts_only = object.flag("cuts_only");
  design.unit = object.number("unit");
  design.hangs_on_scan = object.has("hangs_on_scan") && object.flag("hangs_on_scan");
  design.unit_told_by = object.text("unit_told_by");
  object.done();
  return design;
}

std::string machine_name(const std::string& file) {
  return "order-machine" + std::filesystem::path(file).extension().string();
}

}  // namespace

void save_order(const std::string& folder, const JobSettings& settings, const OrderFiles& files) {
  require_job_settings(settings);
  const std::string machine = read_file(files.machine);
  const std::string law = files.law.empty() ? "" : read_file(files.law);
  make_folder(folder);
  write_own_file(folder + '/' + machine_name(files.machine), machine);
  if (!law.empty()) write_own_file(folder + '/' + law_name, law);
  Json json = site_json(settings.design);
  json["kept"] = {{"soil", soil_json(settings.site.soil)},
                  {"machine", machine_name(files.machine)},
                  {"law", law.empty() ? "" : law_name},
                  {"frame", settings.site.frame},
                  {"density_percent", settings.density_percent},
                  {"time_price_w", settings.time_price},
                  {"design", keep_design(folder, settings.surface)}};
  if (settings.site.cell_size) json["kept"]["cell_size_m"] = *settings.site.cell_size;
  write_own_file(folder + order_file, sealed_text(json));
}

JobSettings load_order(const std::string& folder) {
  const std::string path = folder + order_file;
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorKind::bad_file, folder + ": holds no job: it has no order.json");
  }
  JsonObject object =
      JsonObject::open_sealed(path, read_own_file(path, most_foreign_bytes), order_format);
  JobSettings settings;
  settings.design = read_plain_site(path);
  JsonObject kept = object.object("kept");
  settings.site.soil = read_soil(kept.object("soil"));
  const std::string machine = kept.text("machine");
  if (machine_name(machine) != machine) kept.fail("machine", "must be order-machine.json or .urdf");
  settings.site.machine = load_machine(folder + '/' + machine);
  const bool has_law = !kept.text("law").empty();
  settings.site.law =
      has_law ? load_density_law(folder + '/' + law_name) : density_law_of(settings.site.soil);
  settings.site.frame = kept.text("frame");
  if (kept.has("cell_size_m")) settings.site.cell_size = kept.number("cell_size_m", 0.001, 1.0);
  settings.density_percent = kept.number("density_percent", 0.0, 100.0);
  settings.time_price = kept.number("time_price_w", 0.0, 1e6);
  settings.surface = kept_design(folder, kept.object("design"));
  kept.done();
  return settings;
}

}  // namespace excavplan
