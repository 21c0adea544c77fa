// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/scan_surface.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include "base/files.hpp"

namespace excavplan {
namespace {

/// A dig searched in loam of some density by two threads of its own.
double searched_worth(const Machine& machine, const SoilKind& soil, double density) {
  PlanOptions options;
  options.method = PlanMethod::search;
  options.search.threads = 2;
  options.search.stop.evaluations = 40;
  options.cell_size = 0.1;
  return plan_dig(machine, soil, GroundDensity(density, 0.0), options).search.value().worth;
}

/// The hole of the shipped scans [m^3], by two threads.
double surveyed_hole() {
  ScanPair scans;
  scans.before.files = {find_data_file("quickstart/before.pcd")};
  scans.after.files = {find_data_file("quickstart/after.pcd")};
  const std::vector<ScanOutline> seen = outlines({scans.before, scans.after}, 2);
  RasterOptions raster;
  raster.cell_size = 0.1;
  const Rectangle extent = seen.front().extent.value();
  return measure_change(survey_registered(scans, extent, raster, 0.2, 2).surfaces).excavated.value;
}

/// Many planners and surveys at once give what each gives alone. scripts/check.d/35-threads runs it
/// with the thread sanitizer.
TEST(ParallelPlanners, DoNotDisturbEachOther) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const std::vector<double> densities = {10.0, 30.0, 50.0, 70.0, 90.0};
  std::vector<double> alone;
  for (const double density : densities) alone.push_back(searched_worth(machine, loam, density));
  const double hole_alone = surveyed_hole();

  std::vector<double> together(densities.size());
  std::vector<double> holes(2);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < densities.size(); ++i) {
    threads.emplace_back([&, i] { together[i] = searched_worth(machine, loam, densities[i]); });
  }
  for (double& hole : holes) threads.emplace_back([&hole] { hole = surveyed_hole(); });
  for (std::thread& thread : threads) thread.join();

  EXPECT_EQ(together, alone);
  EXPECT_EQ(holes, std::vector<double>(2, hole_alone));
}

/// A library is whole at any time for those who read it while it is replaced.
TEST(ParallelPlanners, ReadALibraryThatIsBeingReplaced) {
  const std::string path = testing::TempDir() + "replaced.json";
  const PathLibrary library = load_path_library(find_data_file("libraries/zx120-loam-energy.json"));
  const std::string content = to_json(library);
  write_file(path, content);
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (int i = 0; i < 100; ++i) write_file(path, content);
    done = true;
  });
  int read = 0;
  while (!done || read == 0) {
    EXPECT_EQ(load_path_library(path).entries.size(), library.entries.size());
    ++read;
  }
  writer.join();
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace excavplan
