// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/scans/scan_pose.hpp>

#include "fuzz/file_readers.hpp"

namespace excavplan::test {
namespace {

/// By both ways to read it, which must agree.
std::string read_points(const std::string& path) {
  const Cloud cloud = read_cloud(path);
  std::size_t streamed = 0;
  stream_cloud(path, [&](const auto& points) { streamed += points.size(); });
  if (streamed != cloud.points.size() || cloud.width * cloud.height != streamed) {
    throw std::logic_error(path + ": read and streamed clouds differ in size");
  }
  Said said;
  if (cloud.height != 1) said.add("width", static_cast<double>(cloud.width));
  if (cloud.sensor_origin) said.all("sensor", *cloud.sensor_origin);
  return said.text() + points_text(cloud.points);
}

std::string read_matrix(const std::string& path) {
  return Said().all("entry", read_frame(path).reshaped()).text();
}

std::string read_pairs(const std::string& path) {
  const KnownPoints points = read_known_points(path);
  return points_text(points.in_scan) + points_text(points.in_site);
}

std::string read_log(const std::string& path) {
  LoggedDig dig;
  dig.file = path;
  dig.lifted = Payload{Lifted::mass, {500.0, 10.0}};
  dig.threads = 1;
  const DigEfficiency found = measure_efficiency(dig);
  return Said().add("cost", found.cost).add("duration", found.duration).text();
}

}  // namespace

std::vector<FileReader> cloud_readers() {
  return {{"pcd", read_points}, {"ply", read_points},   {"xyz", read_points},
          {"las", read_points}, {"frame", read_matrix}, {"known_points", read_pairs},
          {"log", read_log}};
}

}  // namespace excavplan::test
