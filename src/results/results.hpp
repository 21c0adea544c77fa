// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/change/volume_change.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/soil/density_law.hpp>

#include "planning/planned_digs.hpp"  // dig_json()

/// @file
/// Results as JSON, with the keys of docs/formats.md, and as lines of text.

namespace excavplan {

/// The five volumes, each with its standard deviation.
nlohmann::ordered_json volumes_json(const VolumeChange& change);
/// "45.0 deg, 0.350 m, 1.50 m from x = 6.05 m"
std::string path_text(const PlannedDig& dig);
/// Path, payload, energy, efficiency and duration.
std::vector<std::string> dig_lines(const PlannedDig& dig, const DigSpread& spread = {});

/// A simulated dig: payload, energy, loads of the joints, volumes.
/// @param scene  with the history of its dig
nlohmann::ordered_json scene_json(const Machine& machine, const DigScene& scene);
std::vector<std::string> scene_lines(const Machine& machine, const DigScene& scene);

/// What else the law was measured on than what is worked with: law_of_other_machine,
/// law_of_other_soil. An empty soil is not compared.
std::vector<Warning> unlike_law(const DensityLaw& law, const std::string& machine,
                                const std::string& soil = {});

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

}  // namespace excavplan
