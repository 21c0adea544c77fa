// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/planning/planner.hpp>
#include <excavplan/simulation/scene.hpp>

/// @file
/// Results as the JSON keys that other programs rely on, and as lines for people.

namespace excavplan::tools {

/// The five volumes, each with its standard deviation.
nlohmann::ordered_json volumes_json(const VolumeChange& change);
/// The same of height maps without error.
nlohmann::ordered_json volumes_json(const HeightMapVolumes& volumes);

/// "path" with start_x_m, payload, energy, efficiency, duration.
nlohmann::ordered_json dig_json(const PlannedDig& dig);

/// "45.0 deg, 0.350 m, 1.500 m from x = 6.05 m"
std::string path_text(const PlannedDig& dig);
/// "; the nearest, ANGLE, ...: why it cannot be done", to follow what says that none was found.
std::string nearest_text(const std::optional<NearestDig>& nearest);
/// What it lifts and costs.
std::vector<std::string> dig_lines(const PlannedDig& dig, const DigSpread& spread = {});

/// A simulated dig: what it lifts and costs, what it asks of the joints, where the soil goes.
/// @param scene  with the history of its dig
nlohmann::ordered_json scene_json(const Machine& machine, const DigScene& scene);
std::vector<std::string> scene_lines(const Machine& machine, const DigScene& scene);

/// Densities "0:5:100", "40" or "10,40,80" [%]. @throws Error (bad_input)
std::vector<double> parse_densities(const std::string& what, const std::string& text);

/// Seconds since its construction.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One self-contained HTML page: title, pictures, a table of figures, the JSON. Works offline.
std::string html_report(const std::string& title, const std::vector<std::string>& svgs,
                        const std::vector<std::string>& lines, const nlohmann::ordered_json& json);

}  // namespace excavplan::tools
