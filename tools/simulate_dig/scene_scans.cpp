// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_dig/scene_scans.hpp"

#include <filesystem>
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

/// "scan.pcd", "scan-2.pcd", "scan-3.pcd"
std::string file_of_look(const std::string& file, std::size_t index) {
  if (index == 0) return file;
  const std::filesystem::path path = file;
  return (path.parent_path() / path.stem()).string() + "-" + std::to_string(index + 1) +
         path.extension().string();
}

/// The files of the second look and those after it.
std::vector<std::string> files_beside(const std::string& file, const SceneScanInputs& inputs) {
  if (!inputs.each_look) return {};
  const std::size_t above = inputs.places.empty() ? 2 : inputs.places.size();
  const std::size_t looks = inputs.setup == from_above ? above : looks_at_scene;
  std::vector<std::string> files;
  for (std::size_t i = 1; i < looks; ++i) files.push_back(file_of_look(file, i));
  return files;
}

void write_look(const std::string& file, PlacedScan look, bool tells_place,
                const Eigen::Vector2d& base) {
  const Eigen::Vector3d shift(base.x(), base.y(), 0.0);
  Cloud cloud;
  if (tells_place) cloud.sensor_origin = look.place + shift;
  for (Eigen::Vector3d& point : look.points) point += shift;
  cloud.points = std::move(look.points);
  cloud.width = cloud.points.size();
  write_cloud(file, cloud, cloud_format_of_name(file));
}

void write_scan(const std::optional<std::string>& file, std::vector<PlacedScan> looks,
                const SceneScanInputs& inputs) {
  if (!file) return;
  if (!inputs.each_look && looks.size() > 1) {
    return write_look(*file, {{}, points_of(looks)}, false, inputs.base);
  }
  for (std::size_t i = 0; i < looks.size(); ++i) {
    write_look(file_of_look(*file, i), std::move(looks[i]), true, inputs.base);
  }
}

}  // namespace

void declare_scans(Arguments& arguments, SceneScanInputs& inputs) {
  const auto beside = [&inputs](const std::string& file) { return files_beside(file, inputs); };
  arguments.output("before", inputs.before,
                   "write a depth-camera scan of the ground before the dig", beside);
  arguments.output("after", inputs.after, "write a depth-camera scan after the dig", beside);
  arguments.option("camera", inputs.places,
                   "place of a camera of the scans and point it faces; repeated for several "
                   "(default: one over the dig and one over the heap)");
  arguments.only_if({[&inputs] { return inputs.any(); }, "no scans are written"}, [&] {
    arguments.choice("setup", inputs.setup, setup_words(),
                     "what scans: cameras at the places of --camera, or a sensor that the machine "
                     "carries and swings to dig and heap");
    arguments.flag("each-look", inputs.each_look,
                   "write what the sensor sees from each place into a file of its own that tells "
                   "the place: FILE, then the same with -2, -3 before the ending");
    arguments.option("noise", inputs.camera.noise, Quantity::length,
                     "depth noise of the scans at 1 m; grows with range squared");
  });
}

void check_scans(const SceneScanInputs& inputs) {
  if (!inputs.places.empty() && !inputs.any()) {
    usage_error("--camera needs --before or --after");
  }
  for (const auto& file : {inputs.before, inputs.after}) {
    if (!file) continue;
    const CloudFormat format = cloud_format_of_name(*file);
    if (inputs.each_look && format.name != "pcd") {
      usage_error("--each-look: " + *file + " cannot tell a place: the name must end in .pcd");
    }
  }
  if (!inputs.places.empty() && inputs.setup != from_above) {
    usage_error("--camera places cameras; the sensor of --setup " + inputs.setup +
                " has its place on the machine");
  }
}

void write_scans(const SceneScanInputs& inputs, const DigScene& scene, std::uint64_t seed) {
  if (!inputs.any()) return;
  const OptionNames names = {{"the camera at", "--camera: the one at"}, {"the set-up", "--setup:"}};
  SceneLooks looks = naming_options(names, [&] {
    return inputs.setup == from_above
               ? look_at_scene(scene, inputs.camera, seed, inputs.places)
               : look_at_scene(scene, sensor_setup_of_word(inputs.setup), seed);
  });
  write_scan(inputs.before, std::move(looks.before), inputs);
  write_scan(inputs.after, std::move(looks.after), inputs);
}

}  // namespace excavplan::tools
