// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/scans/depth_intrinsics.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double tiny = std::numeric_limits<double>::min();
constexpr double most_pixels = 65535.0;  // along a side

DepthIntrinsics own_intrinsics(JsonObject json) {
  DepthIntrinsics intrinsics;
  intrinsics.fx = json.number("fx", tiny);
  intrinsics.fy = json.number("fy", tiny);
  intrinsics.cx = json.number("cx");
  intrinsics.cy = json.number("cy");
  intrinsics.depth_unit = json.number_or("depth_unit_m", intrinsics.depth_unit, tiny);
  intrinsics.min_depth = json.number_or("min_depth_m", intrinsics.min_depth, 0.0);
  intrinsics.max_depth =
      json.number_or("max_depth_m", intrinsics.max_depth,
                     std::nextafter(intrinsics.min_depth, std::numeric_limits<double>::max()));
  json.ignore("sources");
  json.done();
  return intrinsics;
}

void read_size(JsonObject& json, const char* width, const char* height, DepthIntrinsics& found) {
  if (!json.has(width) || !json.has(height)) return;
  found.width = static_cast<int>(json.number(width, 0.0, most_pixels));
  found.height = static_cast<int>(json.number(height, 0.0, most_pixels));
  if (found.width == 0 || found.height == 0) found.width = found.height = 0;
}

/// Of a depth image, what is not a pinhole's has to be taken out before.
void refuse_distortion(const JsonObject& json, const std::string& key,
                       const std::vector<double>& coefficients) {
  const auto distorts = [](double c) { return !(c == 0.0); };
  const auto bad = std::find_if(coefficients.begin(), coefficients.end(), distorts);
  if (bad == coefficients.end()) return;
  json.fail(key, "holds " + number_text(*bad) +
                     ", must be zeros: rectify the depth images, and give the intrinsics of the "
                     "rectified ones");
}

/// From a camera matrix fx 0 cx, 0 fy cy, 0 0 1, the numbers row by row.
void take_matrix(const JsonObject& json, const std::string& key, const std::vector<double>& m,
                 DepthIntrinsics& found) {
  const bool is_finite = std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); });
  const bool is_pinhole = m[1] == 0.0 && m[3] == 0.0 && m[6] == 0.0 && m[7] == 0.0 && m[8] == 1.0;
  if (!is_finite || !is_pinhole || !(m[0] > 0.0) || !(m[4] > 0.0)) {
    json.fail(key, "must be the matrix fx 0 cx, 0 fy cy, 0 0 1, with fx and fy above 0");
  }
  found.fx = m[0];
  found.fy = m[4];
  found.cx = m[2];
  found.cy = m[5];
}

/// PinholeCameraIntrinsic of Open3D, whose matrix is written column by column.
DepthIntrinsics of_open3d(JsonObject json) {
  DepthIntrinsics found;
  const std::vector<double> m = json.numbers("intrinsic_matrix", 9);
  const std::vector<double> rows = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
  take_matrix(json, "intrinsic_matrix (column by column)", rows, found);
  read_size(json, "width", "height", found);
  return found;
}

/// What camera_calibration of ROS writes.
DepthIntrinsics of_calibration(JsonObject json) {
  DepthIntrinsics found;
  JsonObject matrix = json.object("camera_matrix");
  take_matrix(matrix, "data", matrix.numbers("data", 9), found);
  if (json.has("distortion_coefficients")) {
    JsonObject distortion = json.object("distortion_coefficients");
    refuse_distortion(distortion, "data", distortion.numbers("data"));
  }
  read_size(json, "image_width", "image_height", found);
  return found;
}

/// A CameraInfo message: k and d of ROS 2, K and D of ROS 1.
DepthIntrinsics of_camera_info(JsonObject json) {
  DepthIntrinsics found;
  const std::string k = json.has("k") ? "k" : "K";
  const std::string d = json.has("d") ? "d" : "D";
  take_matrix(json, k, json.numbers(k, 9), found);
  if (json.has(d)) refuse_distortion(json, d, json.numbers(d));
  for (const char* binning : {"binning_x", "binning_y"}) {
    if (json.number_or(binning, 0.0) > 1.0) {
      json.fail(binning, "is above 1: give the intrinsics of the binned image");
    }
  }
  if (json.has("roi")) {
    JsonObject region = json.object("roi");
    for (const char* offset : {"x_offset", "y_offset"}) {
      if (region.number_or(offset, 0.0) != 0.0) {
        region.fail(offset, "is not 0: give the intrinsics of the part of the image");
      }
    }
  }
  read_size(json, "width", "height", found);
  return found;
}

/// fx, fy with ppx, ppy as in RealSense's rs2_intrinsics, or with cx, cy.
DepthIntrinsics of_flat_keys(JsonObject json) {
  DepthIntrinsics found;
  found.fx = json.number("fx", tiny);
  found.fy = json.number("fy", tiny);
  found.cx = json.number(json.has("ppx") ? "ppx" : "cx");
  found.cy = json.number(json.has("ppy") ? "ppy" : "cy");
  for (const char* key : {"coeffs", "distortion", "dist_coeffs"}) {
    if (json.has(key)) refuse_distortion(json, key, json.numbers(key));
  }
  if (json.has("depth_scale")) {
    // Metres per count as RealSense says it, or counts per metre as Open3D does.
    const double scale = json.number("depth_scale", tiny);
    found.depth_unit = scale < 1.0 ? scale : 1.0 / scale;
  }
  read_size(json, "width", "height", found);
  return found;
}

}  // namespace

DepthIntrinsics load_intrinsics(const std::string& path) {
  const char* const format = "excavplan-depth-intrinsics";
  JsonObject json = JsonObject::of_others(path, read_file(path, most_foreign_bytes));
  if (json.has("format")) {
    json.require_format(format);
    return own_intrinsics(json);
  }
  if (json.has("intrinsic")) json = json.object("intrinsic");  // PinholeCameraParameters of Open3D
  if (json.has("intrinsic_matrix")) return of_open3d(json);
  if (json.has("camera_matrix")) return of_calibration(json);
  if (json.has("k") || json.has("K")) return of_camera_info(json);
  if (json.has("fx")) return of_flat_keys(json);
  throw Error(ErrorKind::bad_file,
              path +
                  ": found none of the keys format, intrinsic_matrix, camera_matrix, k, K and "
                  "fx, expected intrinsics of excavplan, Open3D, ROS or RealSense");
}

}  // namespace excavplan
