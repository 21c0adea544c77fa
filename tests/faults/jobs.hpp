// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/depth_png.hpp"

/// @file
/// Small jobs of every tool, in a folder of inputs and outputs.

namespace excavplan::test {

struct Job {
  std::string tool;
  Words words;
  Words outputs;      ///< the files it writes
  bool slow = false;  ///< for signals alone
};

/// Of every container and compression.
inline const Words recordings = {"scene.db3",      "scene_zstd.db3",  "scene_none.mcap",
                                 "scene_lz4.mcap", "scene_zstd.mcap", "scene_lz4.bag",
                                 "scene_bz2.bag"};

/// Every n-th point of a cloud, as text.
inline std::string thinned(const std::string& xyz, int n) {
  std::istringstream in(xyz);
  std::string points;
  int i = 0;
  for (std::string line; std::getline(in, line);) {
    if (i++ % n == 0) points += line + '\n';
  }
  return points;
}

inline void write_inputs(const TemporaryFolder& folder) {
  for (const std::string name : {"before", "after"}) {
    const std::string file = folder.file(name + ".xyz");
    run_program("inspect-cloud", {shipped("quickstart/" + name + ".pcd"), "--out", file});
    folder.write(name + ".xyz", thinned(content_of(file), 8));
  }
  folder.write("depth.png", png_of(16, std::vector<std::uint16_t>(16 * 12, 2000)));
  folder.write("camera.json", intrinsics);
  folder.write("log.csv", "time_s,fuel_flow_ml_per_s\n0,2\n5,2\n");
  for (const std::string& name : recordings) {
    folder.write(name, content_of(EXCAVPLAN_RECORDINGS "/" + name));
  }
  folder.write(
      "result.json",
      answer("estimate-density", {folder.file("before.xyz"), folder.file("after.xyz")}).dump());
}

inline std::vector<Job> jobs() {
  std::vector<Job> jobs = {
      {"inspect-cloud", {"before.xyz", "--frame", "camera", "--out", "cloud.ply"}, {"cloud.ply"}},
      {"measure-efficiency", {"log.csv", "--volume", "0.4"}, {}},
      {"depth-to-cloud",
       {"depth.png", "--intrinsics", "camera.json", "--out", "depth.pcd"},
       {"depth.pcd"}},
      {"simulate-dig",
       {"--density", "40", "--history", "dig.csv", "--plot", "dig.svg", "--map", "dig.ply"},
       {"dig.csv", "dig.svg", "dig.ply"}},
      {"plan-path", {"--density-from", "result.json", "--trajectory", "path.csv"}, {"path.csv"}},
      {"run-experiment", {"--densities", "40"}, {}},
      {"calibrate-density",
       {"--densities", "0:25:100", "--draws", "0", "--out", "law.json"},
       {"law.json"}},
      {"build-path-library",
       Words{"--densities", "40", "--out", "library.json"} + small_library,
       {"library.json"}},
      {"estimate-density",
       {"before.xyz", "after.xyz", "--plot", "change.svg", "--map", "change=change.asc"},
       {"change.svg", "change.asc"}},
      {"plan-path", {"--density", "40", "--search", "--checkpoint", "digs.txt"}, {}, true},
      {"calibrate-density", {"--out", "law.json"}, {"law.json"}, true},
      {"build-path-library", {"--out", "library.json"}, {"library.json"}, true},
      {"estimate-density",
       {"before.xyz", "after.xyz", "--cell", "0.02", "--plot", "change.svg"},
       {"change.svg"},
       true},
  };
  for (const std::string& name : recordings) jobs.push_back({"inspect-cloud", {name}, {}});
  return jobs;
}

}  // namespace excavplan::test
