// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "change/surveyed_area.hpp"
#include "change/zone_shape.hpp"

/// @file
/// What the zones of an area look like, and which of them look like tracks. Private to the project.

namespace excavplan {

/// One zone as the attribution sees it.
struct ZoneLook {
  std::vector<Cell> cells;
  ZoneShape shape;
  /// Mean |D| of the far half of a tail over that of its near half; soil thins out, tracks do not.
  double lasting = 1.0;
};

/// Of each zone.
std::vector<ZoneLook> looks_of(const Area& area);

/// The tracks of an area: narrow and low strips that keep their height.
struct Tracks {
  std::vector<bool> is_track;  ///< of each zone, whether it fell or rose
  std::vector<bool> has_twin;  ///< a parallel one that is alike, as a machine's other track
  std::vector<bool> is_rut;    ///< a track that fell
  Eigen::ArrayXXd away;        ///< from the nearest rut [m]

  /// Most of it lies beside ruts.
  bool lies_along(const ZoneLook& look) const;
};

/// @param may_be  zones that are no track otherwise: hole, heap, stirred ground, given areas
/// @param hole_height  ruts are less than half as deep [m]
Tracks find_tracks(const Area& area, const std::vector<ZoneLook>& looks,
                   const std::vector<bool>& may_be, double hole_height);

}  // namespace excavplan
