// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/trial/hidden_site.hpp>

#include "support/machine_file.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {

/// A short trench in level loam of 40 %, along x from x = 2, with a windrow to its left; as files.
/// Errors are 0 unless a test sets them.
class PlainSiteFolder {
 public:
  PlainSiteFolder() {
    site = {
        {"format", "plain-site"},
        {"version", 1},
        {"id", "S"},
        {"design",
         {{"kind", "trench"},
          {"length_m", 4.0},
          {"floor_width_m", 1.0},
          {"depth_m", 0.4},
          {"origin_m", {2.0, 0.0}},
          {"heading_rad", 0.0},
          {"floor_z_at_middle_m", -0.4}}},
        {"tolerance_m", 0.03},
        {"machine", {{"class", "zx120"}}},
        {"start_pose", {{"x", -0.2}, {"y", 0.0}, {"heading_rad", 0.0}}},
        {"soil", {{"name", "loam"}}},
        {"sensor",
         {{"name", "lidar"},
          {"mount", "cab"},
          {"noise_sd_at_1m_m", 0.0},
          {"height_m", 3.0},
          {"tilt_deg", 25},
          {"field_of_view_deg", {360, 45}}}},
        {"dump_areas",
         {{{"kind", "windrow"}, {"polygon", {{-1.0, 1.5}, {7.0, 1.5}, {7.0, 5.5}, {-1.0, 5.5}}}}}},
        {"keep_out", nlohmann::json::array()},
        {"obstacles", nlohmann::json::array()},
        {"files", {{"first_scan", "scan0.asc"}}}};
    truth = {{"payload_noise", 0.0}, {"tracking_height_sd_m", 0.0}, {"tracking_side_sd_m", 0.0}};
    std::filesystem::create_directories(path() + "/hidden");
  }

  std::string path() const { return folder_.file("S"); }

  /// Writes the files and reads them. @param cell  of the true ground [m]
  HiddenSite read(double cell = 0.05) const {
    std::ofstream(path() + "/site.json") << site.dump(1);
    std::ofstream(path() + "/hidden/truth.json") << truth.dump(1);
    write_grid("scan0.asc", 0.1, height);
    write_grid("hidden/ground.asc", 0.1, height);
    write_grid("hidden/density.asc", 0.5, density);
    return read_hidden_site(path(), cell);
  }

  nlohmann::json site, truth;
  std::function<double(double, double)> height = [](double, double) { return 0.0; };
  std::function<double(double, double)> density = [](double, double) { return 40.0; };

 private:
  void write_grid(const std::string& name, double cell,
                  const std::function<double(double, double)>& value) const {
    const double x_min = -8.0, y_min = -7.0, width = 18.0, depth = 14.0;
    std::ofstream file(path() + "/" + name);
    const int cols = static_cast<int>(width / cell + 0.5);
    const int rows = static_cast<int>(depth / cell + 0.5);
    file << "ncols " << cols << "\nnrows " << rows << "\nxllcorner " << x_min << "\nyllcorner "
         << y_min << "\ncellsize " << cell << "\nNODATA_value -9999\n";
    for (int row = rows - 1; row >= 0; --row) {
      for (int col = 0; col < cols; ++col) {
        file << value(x_min + cell * (col + 0.5), y_min + cell * (row + 0.5)) << ' ';
      }
      file << '\n';
    }
  }

  TemporaryFolder folder_;
};

}  // namespace excavplan::test
