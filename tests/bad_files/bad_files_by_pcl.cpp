// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <excavplan/base/error.hpp>

#include "fuzz/file_readers.hpp"

// The same clouds read by the Point Cloud Library, as its tutorials do it: one call.

namespace excavplan::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

std::string read_by(int (*load)(const std::string&, Cloud&), const std::string& path) {
  Cloud cloud;
  if (load(path, cloud) < 0) throw Error(ErrorKind::bad_file, path + ": refused");
  std::vector<Eigen::Vector3d> points;
  for (const pcl::PointXYZ& p : cloud) points.push_back(p.getVector3fMap().cast<double>());
  return points_text(points);
}

}  // namespace

std::vector<FileReader> pcl_readers() {
  return {{"pcd",
           [](const std::string& path) {
             return read_by(
                 [](const std::string& p, Cloud& c) { return pcl::io::loadPCDFile(p, c); }, path);
           }},
          {"ply", [](const std::string& path) {
             return read_by(
                 [](const std::string& p, Cloud& c) { return pcl::io::loadPLYFile(p, c); }, path);
           }}};
}

}  // namespace excavplan::test
