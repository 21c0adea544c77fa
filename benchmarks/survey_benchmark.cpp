// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <excavplan/scans/scan_surface.hpp>
#include "base/random.hpp"

namespace excavplan {
namespace {

/// Scans of 6 m x 5 m with a pit, 5 mm noise and 1 % outliers, as binary PCD.
class ScanFiles {
 public:
  ScanFiles(std::size_t points, std::size_t count)
      : folder_(std::filesystem::temp_directory_path() /
                ("excavplan-scans-" + std::to_string(points))) {
    std::filesystem::create_directories(folder_);
    for (std::size_t i = 0; i < count; ++i) {
      Random random(i);
      Cloud cloud;
      cloud.points.reserve(points);
      for (std::size_t n = 0; n < points; ++n) {
        const double x = random.uniform(-3.0, 3.0);
        const double y = random.uniform(-2.5, 2.5);
        const double z = i % 2 == 1 && x * x < 1.0 && y * y < 0.25 ? -0.3 : 0.0;
        const double outlier = random.uniform() < 0.01 ? random.uniform(-0.3, 1.0) : 0.0;
        cloud.points.emplace_back(x, y, z + outlier + 0.005 * random.normal());
      }
      cloud.width = points;
      Scan scan;
      scan.files = {(folder_ / (std::to_string(i) + ".pcd")).string()};
      write_cloud(scan.files.front(), cloud, CloudFormat{"pcd"});
      scans_.push_back(scan);
    }
  }
  ~ScanFiles() { std::filesystem::remove_all(folder_); }
  ScanFiles(const ScanFiles&) = delete;
  ScanFiles& operator=(const ScanFiles&) = delete;

  const std::vector<Scan>& scans() const { return scans_; }

 private:
  std::filesystem::path folder_;
  std::vector<Scan> scans_;
};

/// From files to surfaces, reading included; the files are in the page cache.
void survey(benchmark::State& state) {
  const ScanFiles files(static_cast<std::size_t>(state.range(0)),
                        static_cast<std::size_t>(state.range(1)));
  for (auto _ : state) {
    const std::vector<ScanOutline> seen = outlines(files.scans());
    RasterOptions raster;
    raster.cell_size = cell_for(seen);
    benchmark::DoNotOptimize(survey_surfaces(files.scans(), *seen.front().extent, raster));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(1));
}
BENCHMARK(survey)
    ->ArgNames({"points", "scans"})
    ->Args({100000, 4})
    ->Args({1000000, 4})
    ->Args({10000000, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace excavplan
