// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/sensing/scene.hpp>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// The set-up of cameras over dig and heap, or at their own places.
inline constexpr const char* from_above = "above";

/// The scans of a simulated scene that are written to files.
struct SceneScanInputs {
  std::optional<std::string> before, after;
  DepthCamera camera;
  std::vector<CameraPlace> places;                 ///< empty: over dig and heap
  Eigen::Vector2d base = Eigen::Vector2d::Zero();  ///< of the machine in their frame [m]
  std::string setup = from_above;                  ///< or one of sensor_setups()
  bool each_look = false;                          ///< in a file of its own, with its place

  bool any() const { return before || after; }
};

void declare_scans(Arguments& arguments, SceneScanInputs& inputs);

/// Reports bad file names before the dig. @throws Error (bad_input)
void check_scans(const SceneScanInputs& inputs);

void write_scans(const SceneScanInputs& inputs, const DigScene& scene, std::uint64_t seed);

}  // namespace excavplan::tools
