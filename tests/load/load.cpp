// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// A long run in one process: load digs|estimates NUMBER [THREADS]. Prints memory and open files
/// after each tenth and exits with 1 if either has grown since the first one: memory by more than
/// 1 MiB, files at all. load scans POINTS BEFORE AFTER [TIMES] writes a pair of scans, so many
/// times as long and wide.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/random.hpp"

using namespace excavplan;

namespace {

double resident_mib() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

long open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return static_cast<long>(std::distance(begin(files), end(files)));
}

/// A pit and a heap on level ground, with noise, seen before or after the dig.
Cloud scanned(double spacing, bool after, double times = 1.0) {
  Random random(2, after ? 1 : 0);
  Cloud cloud;
  for (double x = 0.0; x < 6.0; x += spacing) {
    for (double y = -2.0; y < 2.0; y += spacing) {
      const double hole = x > 1.0 && x < 2.5 && y > -0.5 && y < 0.5 ? -0.3 : 0.0;
      const double heap = std::max(0.0, 0.63 - 0.7 * std::hypot(x - 4.3, y));
      const double z = after ? hole + heap : 0.0;
      cloud.points.emplace_back(times * x, times * y, z + 0.002 * random.normal());
    }
  }
  cloud.width = cloud.points.size();
  return cloud;
}

/// Digs of random paths in random states of four soils, one after the other.
class Digs {
 public:
  Digs() {
    for (const char* soil : {"loam", "sand", "clay", "gravel"}) {
      const SoilKind kind = load_soil(find_data_file("soils/" + std::string(soil) + ".json"));
      for (int d = 0; d <= 100; d += 10) simulators_.emplace_back(machine_, kind, d);
    }
  }
  /// True if the bucket lifted soil.
  bool operator()(std::uint64_t index) const {
    Random random(1, index);
    const auto which =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(simulators_.size()));
    return simulators_[which].dig(ground_, drivable_path(random)).payload_mass > 0.0;
  }

 private:
  /// About every fourth that is drawn.
  DigPath drivable_path(Random& random) const {
    while (true) {
      DigParameters parameters;
      for (const DigParameterInfo& info : dig_parameter_table()) {
        parameters.*info.field =
            random.uniform(bounds_.lower.*info.field, bounds_.upper.*info.field);
      }
      auto path =
          make_dig_path(machine_, parameters, random.uniform(3.5, 7.5), [](double) { return 0.0; });
      if (auto* found = std::get_if<DigPath>(&path)) return std::move(*found);
    }
  }

  Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  DigBounds bounds_ = machine_bounds(machine_);
  Terrain ground_ = level_planning_ground(machine_, 0.1);
  std::vector<HeightMapSimulator> simulators_;
};

/// Estimates from two files of a pit and a heap with noise, read anew each time.
class Estimates {
 public:
  Estimates() {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    const std::string name = "excavplan-load-" + std::to_string(::getpid());
    for (Scan* scan : {&scans_.before, &scans_.after}) {
      const bool after = scan == &scans_.after;
      scan->files = {folder / (name + (after ? "-after.pcd" : "-before.pcd"))};
      write_cloud(scan->files.front(), scanned(0.06, after), {"pcd"});
    }
  }
  ~Estimates() {
    std::filesystem::remove(scans_.before.files.front());
    std::filesystem::remove(scans_.after.files.front());
  }
  Estimates(const Estimates&) = delete;
  Estimates& operator=(const Estimates&) = delete;

  bool operator()(std::uint64_t) const {
    DensityOptions options;
    options.threads = 1;
    return estimate_density(scans_, law_, options).density.has_value();
  }

 private:
  DigScans scans_;
  DensityLaw law_ = load_density_law(find_data_file("laws/zx120-loam.json"));
};

/// Calls `work` for 0 .. number - 1; false if memory or files grew.
bool run(std::uint64_t number, unsigned threads, const std::function<bool(std::uint64_t)>& work) {
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t done = 0;
  double first_memory = 0.0;
  long first_files = 0;
  bool flat = true;
  for (std::uint64_t tenth = 1; tenth <= 10; ++tenth) {
    const std::uint64_t end = number * tenth / 10;
    std::atomic<std::uint64_t> next{done};
    std::atomic<std::uint64_t> good{0};
    std::vector<std::thread> workers;
    for (unsigned t = 0; t < threads; ++t) {
      workers.emplace_back([&] {
        for (std::uint64_t i = next++; i < end; i = next++) good += work(i) ? 1 : 0;
      });
    }
    for (std::thread& worker : workers) worker.join();
    const double memory = resident_mib();
    const long files = open_files();
    if (tenth == 1) {
      first_memory = memory;
      first_files = files;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    std::printf("%9llu done, %5.1f %% of the last with a result, %.1f MiB, %ld files, %.0f s\n",
                static_cast<unsigned long long>(end),
                100.0 * static_cast<double>(good) / static_cast<double>(end - done), memory, files,
                time.count());
    std::fflush(stdout);
    flat = flat && memory <= first_memory + 1.0 && files <= first_files && good > 0;
    done = end;
  }
  return flat;
}

}  // namespace

int main(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  if (what == "scans" && (count == 5 || count == 6)) {
    const double spacing = std::sqrt(24.0 / std::strtod(words[2], nullptr));
    const double times = count == 6 ? std::strtod(words[5], nullptr) : 1.0;
    write_cloud(words[3], scanned(spacing, false, times), {"pcd"});
    write_cloud(words[4], scanned(spacing, true, times), {"pcd"});
    return 0;
  }
  const std::uint64_t number = count > 2 ? std::strtoull(words[2], nullptr, 10) : 0;
  const auto threads = count > 3 ? static_cast<unsigned>(std::strtoul(words[3], nullptr, 10)) : 2u;
  if (number < 10 || threads == 0 || (what != "digs" && what != "estimates")) {
    std::fprintf(stderr, "load digs|estimates NUMBER [THREADS], NUMBER at least 10\n");
    return 2;
  }
  if (what == "digs") {
    const Digs digs;
    return run(number, threads, std::ref(digs)) ? 0 : 1;
  }
  const Estimates estimates;
  return run(number, threads, std::ref(estimates)) ? 0 : 1;
}
