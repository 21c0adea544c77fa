// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/scans.hpp"

namespace excavplan::tools {
namespace {

Scan scan_of(const std::string& file, const std::optional<std::string>& frame,
             const std::optional<Rectangle>& area) {
  Scan scan;
  scan.files = {file};
  if (frame) scan.site_from_scan = read_frame(*frame);
  scan.area = area;
  return scan;
}

}  // namespace

ScanPair scan_pair(const std::string& before, const std::string& after, const ScanFrames& frames) {
  return {scan_of(before, frames.before, frames.area), scan_of(after, frames.after, frames.area)};
}

}  // namespace excavplan::tools
