// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>
#include <excavplan/scans/scan_surface.hpp>

namespace excavplan {

/// The ground as the last scans of each cell show it.
class LastSeenGround {
 public:
  explicit LastSeenGround(HeightMap first) : map_(std::move(first)) {}

  /// A cell with returns gets their mean height. The scan is in the frame of the site.
  void take(const Scan& scan);
  /// The height of the nearest known cell, within half a metre; NaN without one.
  double at(double x, double y) const;
  const HeightMap& map() const { return map_; }

 private:
  HeightMap map_;
};

}  // namespace excavplan
