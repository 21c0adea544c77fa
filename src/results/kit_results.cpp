// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/kit_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <excavplan/kit/workspace.hpp>

#include "base/json.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

Json joints_json(const RobotJoints& joints) {
  constexpr std::array<const char*, 4> words = {"boom", "arm", "bucket", "swing"};
  Json json;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const RobotJoint& joint = joints[i];
    json[words[i]] = {{"name", joint.name}, {"sign", joint.sign}, {"zero_rad", joint.zero}};
  }
  return json;
}

}  // namespace

Json examined_json(const Machine& machine, const std::string& folder) {
  const Reach reach = reach_of(machine);
  return {
      {"machine", machine.name},
      {"folder", folder},
      {"reach_m", {{"ground", reach.ground}, {"depth", reach.depth}, {"height", reach.height}}},
      {"digging_force_kn",
       {{"bucket", 1e-3 * bucket_force(machine)}, {"arm", 1e-3 * arm_force(machine)}}},
      {"capacity_m3", {{"struck", struck_capacity(machine)}, {"heaped", heaped_capacity(machine)}}},
      {"robot_joints", joints_json(machine.robot_joints)}};
}

Json fitted_json(const std::vector<FittedNumber>& numbers) {
  Json list = Json::array();
  for (const FittedNumber& number : numbers) {
    list.push_back({{"key", number.key},
                    {"value", number.value},
                    {"how", number.how},
                    {"spread", number.spread ? Json(*number.spread) : Json(nullptr)}});
  }
  return list;
}

/// The dig on level ground at the density nearest to a usual one.
const PathLibraryEntry& shown_entry(const PathLibrary& library) {
  constexpr double usual = 40.0;  // [%]
  const auto distance = [](const PathLibraryEntry& entry) {
    return std::abs(entry.slope) * 1e4 + std::abs(entry.density_percent - usual);
  };
  return *std::min_element(library.entries.begin(), library.entries.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
}

Json kit_json(const SoilKind& soil, const std::string& law_file, const PathLibrary& library,
              const std::string& library_file) {
  Json json = {{"soil", soil.name}, {"law", law_file}, {"library", nullptr}};
  if (library.entries.empty()) return json;
  const PathLibraryEntry& entry = shown_entry(library);
  json["library"] = library_file;
  json["entries"] = library.entries.size();
  json["evaluations"] = library.evaluations();
  json["example"] = {{"density_percent", entry.density_percent}, {"slope_rad", entry.slope}};
  json["example"].update(dig_json(entry.dig));
  return json;
}

}  // namespace excavplan
