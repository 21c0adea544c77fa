// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/design_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include <excavplan/base/error.hpp>
#include <excavplan/clouds/raster_file.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "clouds/ply_mesh.hpp"
#include "design/raw_design.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

constexpr double farthest_place = 1e9;  // [m]; that of a map
constexpr double foot = 0.3048, us_foot = 1200.0 / 3937.0;
constexpr const char* no_unit = "nothing: metres taken";

/// The ending of a path in small letters, without its dot.
std::string ending_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  return dot == path.npos || path[dot] == '/' ? "" : small_letters(path.substr(dot + 1));
}

enum class Format { land_xml, dxf, ply, obj, stl, raster };

/// A text whose first line that is no comment begins with a word of OBJ.
bool begins_as_obj(std::string_view start) {
  while (!start.empty()) {
    const std::string_view line = start.substr(0, start.find_first_of("\r\n"));
    start.remove_prefix(std::min(start.size(), line.size() + 1));
    std::string_view rest = line;
    const std::string_view word = take_word(rest);
    if (word.empty() || word.front() == '#') continue;
    return word == "v" || word == "vn" || word == "vt" || word == "mtllib" || word == "o" ||
           word == "g" || word == "f";
  }
  return false;
}

Format format_of(const std::string& path) {
  if (is_raster(path)) return Format::raster;
  FileStream file(path);
  if (is_ply(file)) return Format::ply;
  std::string_view start = file.peek(longest_line);
  if (start.substr(0, 3) == "\xEF\xBB\xBF") start.remove_prefix(3);
  const bool is_utf16 = start.substr(0, 2) == "\xFF\xFE" || start.substr(0, 2) == "\xFE\xFF";
  if (start.find("<LandXML") != start.npos || start.find(":LandXML") != start.npos || is_utf16 ||
      start.substr(0, 5) == "<?xml") {
    return Format::land_xml;
  }
  if (start.substr(0, 18) == "AutoCAD Binary DXF") {
    file.fail("byte 0", "a binary DXF drawing", "one of text: save it as ASCII DXF");
  }
  std::string_view words = start;
  words.remove_prefix(std::min(words.find_first_not_of(" \t\r\n"), words.size()));
  const std::string ending = ending_of(path);
  const std::string_view first = words.substr(0, words.find_first_of(" \t\r\n"));
  if (first == "0" || first == "999" || ending == "dxf") return Format::dxf;
  if (ending == "stl" || first == "solid") return Format::stl;
  if (ending == "obj" || begins_as_obj(start)) return Format::obj;
  file.fail("byte 0", "no design", "LandXML, DXF, PLY, OBJ, STL, an ESRI ASCII grid or a GeoTIFF");
}

RawDesign read_raw(Format format, const std::string& path, const DesignFileOptions& options) {
  if (format == Format::land_xml) return read_land_xml(path, options);
  if (format == Format::dxf) return read_dxf(path, options);
  if (format == Format::ply) return read_ply_design(path);
  if (format == Format::obj) return read_obj(path);
  return read_stl(path);
}

/// Two feet of which programs mix up the names: told where it matters.
void note_foot(double unit, double farthest, std::vector<std::string>& notes) {
  constexpr double noticed = 0.005;  // [m]; ours
  const double shift = farthest * std::abs(1.0 - us_foot / foot);
  if ((unit != foot && unit != us_foot) || shift < noticed) return;
  notes.push_back("foot and US survey foot, which programs mix up, differ here by " +
                  readable(shift, 2) + " m");
}

[[noreturn]] void refuse_file(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::bad_file, path + ": " + why);
}

void require_mesh(const std::string& path, const RawDesign& raw) {
  if (raw.triangles.empty()) {
    refuse_file(path, "byte 0 to the end: found " + std::to_string(raw.points.size()) +
                          " points and no face, expected the triangles of a surface");
  }
  for (std::size_t i = 0; i < raw.triangles.size(); ++i) {
    for (const std::uint32_t corner : raw.triangles[i]) {
      const std::string face = "face " + std::to_string(i) + " of the file: found ";
      if (corner >= raw.points.size()) {
        refuse_file(path, face + "the vertex " + std::to_string(corner) + " of " +
                              std::to_string(raw.points.size()) + ", numbered from 0");
      }
      if (raw.points[corner].allFinite()) continue;
      refuse_file(path, face + "a corner that is not finite, expected three numbers");
    }
  }
}

/// Points relative to the middle of the file's, subtracted before the units are changed.
Tin tin_of(const std::string& path, RawDesign raw, const DesignSurface& design, double rise) {
  require_mesh(path, raw);
  Tin tin;
  const Eigen::Vector3d first = raw.points[raw.triangles.front()[0]];
  const Eigen::Vector3d to_metres(design.unit, design.unit, rise);
  tin.origin = first.cwiseProduct(to_metres);
  tin.points = std::move(raw.points);
  for (Eigen::Vector3d& point : tin.points) point = (point - first).cwiseProduct(to_metres);
  tin.triangles = std::move(raw.triangles);
  for (const auto& triangle : tin.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Eigen::Vector3d place = tin.origin + tin.points[corner];
      if (place.head<2>().cwiseAbs().maxCoeff() <= farthest_place &&
          std::abs(place.z()) <= farthest_height) {
        continue;
      }
      refuse_file(path, "point " + std::to_string(corner) + " of the file: found the place " +
                            number_text(place.x()) + ", " + number_text(place.y()) + ", " +
                            number_text(place.z()) + " m, expected it within 1e9 m in plan and " +
                            "1e6 m in height");
    }
  }
  return tin;
}

HeightMap grid_of(const std::string& path, HeightMap map, double unit, double rise) {
  map.origin *= unit;
  map.cell_size *= unit;
  map.z *= rise;
  if (map.z.isNaN().all()) refuse_file(path, "byte 0 to the end: found no cell with a height");
  try {
    require_map(map, "the grid");
  } catch (const Error& error) {
    refuse_file(path, error.what());
  }
  return map;
}

void require_options(const DesignFileOptions& options) {
  if (options.unit) require_in("design: unit of the file [m]", *options.unit, 1e-6, 1e4);
  const Eigen::Matrix4d& m = options.site_from_design;
  const Eigen::Matrix3d turn = m.topLeftCorner<3, 3>();
  const bool is_level = (turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9 &&
                        std::abs(turn(2, 2) - 1.0) < 1e-9 && turn.determinant() > 0.0;
  require(m.allFinite() && is_level && m.row(3) == Eigen::RowVector4d(0, 0, 0, 1),
          "design: site_from_design must be a rigid motion that turns about z alone");
}

void move(DesignSurface& design, const Eigen::Matrix4d& motion) {
  if (motion == Eigen::Matrix4d::Identity()) return;
  const Eigen::Matrix3d turn = motion.topLeftCorner<3, 3>();
  const Eigen::Vector3d shift = motion.topRightCorner<3, 1>();
  if (Tin* const tin = std::get_if<Tin>(&design.shape)) {
    tin->origin = turn * tin->origin + shift;
    for (Eigen::Vector3d& point : tin->points) point = turn * point;
    return;
  }
  auto& map = std::get<HeightMap>(design.shape);
  require((turn - Eigen::Matrix3d::Identity()).norm() == 0.0,
          "design: a raster is not turned, site_from_design must be a shift");
  map.origin += shift.head<2>();
  map.z += shift.z();
}

}  // namespace

DesignSurface read_design(const std::string& path, const DesignFileOptions& options) {
  require_options(options);
  const Format format = format_of(path);
  RawDesign raw;
  RasterFile raster;
  if (format == Format::raster) {
    raster = read_raster(path);
    raw.unit = raster.unit;
    raw.height_unit = raster.height_unit;
    raw.unit_told_by = raster.unit ? "the GeoTIFF's keys" : "";
  } else {
    raw = read_raw(format, path, options);
  }
  DesignSurface design;
  design.name = raw.name.empty() ? path.substr(path.find_last_of('/') + 1) : raw.name;
  design.notes = raw.notes;
  design.unit = options.unit.value_or(raw.unit.value_or(1.0));
  design.unit_told_by = options.unit ? "the option: " + number_text(*options.unit) + " m"
                        : raw.unit   ? raw.unit_told_by
                                     : no_unit;
  const double rise = options.unit.value_or(raw.height_unit.value_or(design.unit));
  if (format == Format::raster) {
    design.shape = grid_of(path, std::move(raster.map), design.unit, rise);
  } else {
    design.shape = tin_of(path, std::move(raw), design, rise);
  }
  const Rectangle all = extent_of(design);
  note_foot(design.unit,
            std::max({std::abs(all.x_min), std::abs(all.x_max), std::abs(all.y_min),
                      std::abs(all.y_max)}),
            design.notes);
  move(design, options.site_from_design);
  return design;
}

}  // namespace excavplan
