// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/site/site.hpp>

#include "base/random.hpp"

/// @file
/// What an update of a site costs: site_updates [POINTS] [WIDTH [m]] prints, for the dig of one
/// bucket in scans as binary PCD, the time by the clock and of the processors.

namespace excavplan {
namespace {

/// Ground with a pit of 0.5 m^3 and its heap, if it is dug, and 5 mm noise.
void write_scan(const std::string& file, std::size_t points, double width, bool dug) {
  Random random(3, dug ? 1 : 0);
  Cloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = random.uniform(-0.5 * width, 0.5 * width);
    const double y = random.uniform(-0.5 * width, 0.5 * width);
    double z = 0.05 * std::sin(0.9 * x) * std::cos(0.7 * y);
    if (dug && std::abs(x - 6.0) < 1.0 && std::abs(y) < 0.45) z -= 0.28;
    if (dug) z += std::max(0.0, 0.75 - 0.8 * std::hypot(x - 5.0, y - 4.0));
    cloud.points.emplace_back(x, y, z + 0.005 * random.normal());
  }
  cloud.width = points;
  write_cloud(file, cloud, {"pcd"});
}

SiteEvent event_of(const std::string& file, double time) {
  SiteEvent event;
  event.scan.files = {file};
  event.time = time;
  return event;
}

void measure(std::size_t points, double width) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "excavplan-site-updates";
  fs::create_directories(folder);
  write_scan(folder / "0.pcd", points, width, false);
  write_scan(folder / "1.pcd", points, width, true);
  {
    Site site(folder / "site",
              {load_soil(find_data_file("soils/loam.json")),
               load_machine(find_data_file("machines/zx120.json")),
               load_density_law(find_data_file("laws/zx120-loam.json")),
               0.05,
               {}},
              SiteAccess::write);
    site.update(event_of(folder / "0.pcd", 0.0));
    std::printf("%lld cells, %zu points\n",
                static_cast<long long>(site.ground().terrain.bank.z.size()), points);
    for (int i = 0; i < 5; ++i) {
      const auto start = std::chrono::steady_clock::now();
      const std::clock_t processors = std::clock();
      const SiteUpdate update = site.update(event_of(folder / "1.pcd", 1.0));
      const double used = static_cast<double>(std::clock() - processors) / CLOCKS_PER_SEC;
      const double passed =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      std::printf("update %.3f s, of the processors %.3f s, density %.1f %%\n", passed, used,
                  update.density ? update.density->percent : std::nan(""));
      site.undo();
    }
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace excavplan

int main(int argc, char** argv) {
  const std::size_t points = argc > 1 ? std::stoul(argv[1]) : 1000000;
  excavplan::measure(points, argc > 2 ? std::stod(argv[2]) : 27.4);
}
