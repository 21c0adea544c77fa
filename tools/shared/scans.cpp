// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/scans.hpp"

#include <map>
#include <vector>

namespace excavplan::tools {
namespace {

/// Length of a unit [m].
const std::map<std::string, double>& units() {
  static const std::map<std::string, double> lengths = {
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}};
  return lengths;
}

Scan scan_of(const std::string& file, const std::optional<std::string>& frame,
             const std::string& unit, const ScanFrames& frames) {
  Scan scan;
  scan.files = {file};
  if (frame) scan.site_from_scan = read_frame(*frame);
  scan.area = frames.area;
  scan.unit = units().at(unit.empty() ? frames.unit : unit);
  scan.sensor_origin = frames.sensor_origin;
  return scan;
}

}  // namespace

void declare_frames(Arguments& arguments, ScanFrames& frames) {
  arguments.file("before-frame", frames.before,
                 "4 x 4 matrix that transforms the clouds before into the site frame");
  arguments.file("after-frame", frames.after, "the same for the clouds after");
  arguments.option("sensor-origin", frames.sensor_origin,
                   "where the sensor stood, in the frame of the scans (default: VIEWPOINT of PCD)");
}

void declare_units(Arguments& arguments, ScanFrames& frames) {
  std::vector<std::string> words;
  for (const auto& [word, length] : units()) words.push_back(word);
  arguments.choice("unit", frames.unit, words, "unit of the coordinates in all clouds");
  arguments.choice("before-unit", frames.before_unit, words,
                   "of those before (default: as --unit)");
  arguments.choice("after-unit", frames.after_unit, words, "of those after (default: as --unit)");
}

ScanPair scan_pair(const std::string& before, const std::string& after, const ScanFrames& frames) {
  return {scan_of(before, frames.before, frames.before_unit, frames),
          scan_of(after, frames.after, frames.after_unit, frames)};
}

}  // namespace excavplan::tools
