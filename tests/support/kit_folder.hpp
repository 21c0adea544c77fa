// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/planning/path_library.hpp>

#include "support/run_program.hpp"

namespace excavplan::test {

/// A folder with a machine "digger", the zx120 by another name, and its kit.
class KitFolder {
 public:
  KitFolder() {
    std::filesystem::create_directories(kit() + "/laws");
    std::filesystem::create_directories(kit() + "/libraries");
    copy("machines/zx120.json", machine(), "digger");
    copy("machines/zx120.json", kit() + "/machine.json", "digger");
    copy("laws/zx120-loam.json", kit() + "/laws/digger-loam.json", "digger-loam");
    add_library(DigObjective::Goal::cycle);
  }

  std::string machine() const { return folder_.file("digger.json"); }
  std::string kit() const { return folder_.file("digger-kit"); }

  /// The kit has a library for an objective: the shipped digs of the cycle.
  void add_library(const DigObjective& objective) const {
    PathLibrary library =
        load_path_library(std::string(EXCAVPLAN_DATA_SOURCE) + "/libraries/zx120-loam-cycle.json");
    library.machine = "digger";
    library.objective = objective;
    std::ofstream(kit() + "/libraries/" + file_name(library)) << to_json(library);
  }

 private:
  static void copy(const std::string& shipped, const std::string& file, const std::string& name) {
    auto json = nlohmann::ordered_json::parse(
        content_of(std::string(EXCAVPLAN_DATA_SOURCE) + "/" + shipped));
    json["name"] = name;
    std::ofstream(file) << json.dump(1);
  }

  TemporaryFolder folder_;
};

}  // namespace excavplan::test
