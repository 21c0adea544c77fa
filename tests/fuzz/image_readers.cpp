// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/images/depth_image.hpp>

#include "fuzz/file_readers.hpp"

namespace excavplan::test {
namespace {

DepthIntrinsics camera() {
  DepthIntrinsics camera;
  camera.fx = camera.fy = 40.0;
  camera.cx = camera.cy = 4.0;
  return camera;
}

std::string read_depths(const std::string& path) {
  const Cloud cloud = depth_image_to_cloud(path, camera());
  return Said().add("width", static_cast<double>(cloud.width)).text() + points_text(cloud.points);
}

std::string read_camera(const std::string& path) {
  const DepthIntrinsics found = load_intrinsics(path);
  return Said()
      .all("number", std::vector<double>{found.fx, found.fy, found.cx, found.cy, found.depth_unit,
                                         found.min_depth, found.max_depth})
      .all("size",
           std::vector<double>{static_cast<double>(found.width), static_cast<double>(found.height)})
      .text();
}

}  // namespace

std::vector<FileReader> image_readers() {
  return {{"depth_png", read_depths}, {"intrinsics", read_camera}};
}

}  // namespace excavplan::test
