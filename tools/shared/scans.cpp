// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/scans.hpp"

namespace excavplan::tools {
namespace {

Scan scan_of(const std::string& file, const std::optional<std::string>& frame,
             const ScanFrames& frames) {
  Scan scan;
  scan.files = {file};
  if (frame) scan.site_from_scan = read_frame(*frame);
  scan.area = frames.area;
  scan.sensor_origin = frames.sensor_origin;
  return scan;
}

}  // namespace

ScanPair scan_pair(const std::string& before, const std::string& after, const ScanFrames& frames) {
  return {scan_of(before, frames.before, frames), scan_of(after, frames.after, frames)};
}

}  // namespace excavplan::tools
