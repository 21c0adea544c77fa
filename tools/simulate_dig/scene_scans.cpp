// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_dig/scene_scans.hpp"

#include <utility>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/sensing/sensor_setup.hpp>

namespace excavplan::tools {
namespace {

/// Of --setup: cameras that the places decide, and the set-ups of machines.
std::vector<std::string> setup_words() {
  std::vector<std::string> words = {from_above};
  for (const SensorSetup& each : sensor_setups()) words.push_back(each.name);
  return words;
}

/// One camera's place is that of the scan.
void write_scan(const std::optional<std::string>& file, std::vector<Eigen::Vector3d> points,
                const SceneScanInputs& inputs) {
  if (!file) return;
  const Eigen::Vector3d base(inputs.base.x(), inputs.base.y(), 0.0);
  Cloud cloud;
  if (inputs.places.size() == 1) cloud.sensor_origin = inputs.places.front().position + base;
  for (Eigen::Vector3d& point : points) point += base;
  cloud.points = std::move(points);
  cloud.width = cloud.points.size();
  write_cloud(*file, cloud, cloud_format_of_name(*file));
}

}  // namespace

void declare_scans(Arguments& arguments, SceneScanInputs& inputs) {
  arguments.output("before", inputs.before,
                   "write a depth-camera scan of the ground before the dig");
  arguments.output("after", inputs.after, "write a depth-camera scan after the dig");
  arguments.option("camera", inputs.places,
                   "place of a camera of the scans and point it faces; repeated for several "
                   "(default: one over the dig and one over the heap)");
  arguments.only_if({[&inputs] { return inputs.any(); }, "no scans are written"}, [&] {
    arguments.choice("setup", inputs.setup, setup_words(),
                     "what scans: cameras at the places of --camera, or a sensor that the machine "
                     "carries and swings to dig and heap");
    arguments.option("noise", inputs.camera.noise, Quantity::length,
                     "depth noise of the scans at 1 m; grows with range squared");
  });
}

void check_scans(const SceneScanInputs& inputs) {
  if (!inputs.places.empty() && !inputs.any()) {
    usage_error("--camera needs --before or --after");
  }
  for (const auto& file : {inputs.before, inputs.after}) {
    if (file) cloud_format_of_name(*file);
  }
  if (!inputs.places.empty() && inputs.setup != from_above) {
    usage_error("--camera places cameras; the sensor of --setup " + inputs.setup +
                " has its place on the machine");
  }
}

void write_scans(const SceneScanInputs& inputs, const DigScene& scene, std::uint64_t seed) {
  if (!inputs.any()) return;
  const OptionNames names = {{"the camera at", "--camera: the one at"}, {"the set-up", "--setup:"}};
  SceneScans scans = naming_options(names, [&] {
    return inputs.setup == from_above ? scan_scene(scene, inputs.camera, seed, inputs.places)
                                      : scan_scene(scene, sensor_setup_of_word(inputs.setup), seed);
  });
  write_scan(inputs.before, std::move(scans.before), inputs);
  write_scan(inputs.after, std::move(scans.after), inputs);
}

}  // namespace excavplan::tools
