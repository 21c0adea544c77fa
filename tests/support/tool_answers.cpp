// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/tool_answers.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace excavplan::test {

Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::string shipped(const std::string& file) {
  return std::string(EXCAVPLAN_DATA_SOURCE) + "/" + file;
}

std::string shared(const std::string& file) {
  return std::string(EXCAVPLAN_SHARED_DATA) + "/" + file;
}

json answer(const std::string& tool, const Words& words, int code) {
  const ProgramResult result = run_program(tool, words + Words{"--json"});
  EXPECT_EQ(result.code, code) << tool << ": " << result.err;
  json object = json::parse(result.out, nullptr, false);
  EXPECT_TRUE(object.is_object()) << tool << ": " << result.out;
  return object;
}

double number(const json& object, const std::string& pointer) {
  return object.at(json::json_pointer(pointer)).get<double>();
}

Words warning_codes(const json& object) {
  Words codes;
  for (const json& warning : object.at("warnings")) codes.push_back(warning.at("code"));
  return codes;
}

bool warns(const json& object, const std::string& code) {
  const Words codes = warning_codes(object);
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

void expect_keys(const json& object, const std::string& type, const Words& pointers) {
  for (const std::string& pointer : pointers) {
    const json::json_pointer at("/" + pointer);
    if (!object.contains(at)) {
      ADD_FAILURE() << pointer << " is missing";
      continue;
    }
    EXPECT_EQ(object.at(at).type_name(), type) << pointer << " is " << object.at(at).dump();
  }
}

Words quickstart(const TemporaryFolder&) {
  return {shipped("quickstart/before.pcd"), shipped("quickstart/after.pcd")};
}

std::string in_millimetres(const TemporaryFolder& folder, const std::string& scan) {
  const std::string name = folder.file(fs::path(scan).stem().string());
  answer("inspect-cloud", {scan, "--out", name + ".xyz"});
  std::ifstream metres(name + ".xyz");
  std::ofstream millimetres(name + "-mm.xyz");
  std::string header;
  std::getline(metres, header);
  for (double x, y, z; metres >> x >> y >> z;) {
    millimetres << 1e3 * x << ' ' << 1e3 * y << ' ' << 1e3 * z << '\n';
  }
  return name + "-mm.xyz";
}

ScanFiles scan_pair(const TemporaryFolder& folder, int density, int seed) {
  ScanFiles scans{folder.file("before.pcd"), folder.file("after.pcd"), {}};
  auto held_down = nlohmann::json::parse(content_of(shipped("machines/zx120.json")));
  held_down.erase("body");  // dense soil would lift the machine
  scans.truth =
      answer("simulate-dig", {"--density", std::to_string(density), "--seed", std::to_string(seed),
                              "--machine", folder.write("zx120.json", held_down.dump()), "--before",
                              scans.before, "--after", scans.after});
  return scans;
}

}  // namespace excavplan::test
