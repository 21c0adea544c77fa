// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/zone_looks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

// What tracks look like: all ours.
constexpr double highest_lone_track = 0.05;  // one deeper than this is no rut [m]
constexpr double lasting_track = 0.6;        // a tail that keeps this share of its depth is one
constexpr double berm_reach = 0.6;           // from a rut [m]
constexpr double berm_share = 0.6;           // of its cells that lie there

/// Mean |D| of the far half of a tail over that of its near half, by distance from its parent.
double lasting_of(const Area& area, std::size_t tail, const std::vector<Cell>& cells) {
  const Eigen::ArrayXXd away = distance_to(area.ground.zone == area.parts.parent[tail]);
  std::vector<double> distances;
  distances.reserve(cells.size());
  for (const Cell at : cells) distances.push_back(away(at.row, at.col));
  std::vector<double> sorted = distances;
  const double middle = median(sorted);
  std::array<double, 2> sums = {0.0, 0.0};
  std::array<double, 2> counts = {0.0, 0.0};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t half = distances[i] > middle ? 1 : 0;
    sums[half] += std::abs(area.ground.difference(cells[i].row, cells[i].col));
    counts[half] += 1.0;
  }
  return counts[1] > 0.0 && sums[0] > 0.0 ? sums[1] / counts[1] / (sums[0] / counts[0]) : 1.0;
}

}  // namespace

std::vector<ZoneLook> looks_of(const Area& area) {
  std::vector<ZoneLook> looks;
  for (std::vector<Cell>& cells : cells_of(area.ground)) {
    const std::size_t i = looks.size();
    ZoneLook look{std::move(cells), {}};
    look.shape = shape_of(area.ground.difference, look.cells, area.grid.cell_size);
    if (area.parts.part[i] == Part::tail && !look.cells.empty()) {
      look.lasting = lasting_of(area, i, look.cells);
    }
    looks.push_back(std::move(look));
  }
  return looks;
}

bool Tracks::lies_along(const ZoneLook& look) const {
  const auto near = std::count_if(look.cells.begin(), look.cells.end(),
                                  [&](Cell at) { return away(at.row, at.col) < berm_reach; });
  return static_cast<double>(near) > berm_share * static_cast<double>(look.cells.size());
}

Tracks find_tracks(const Area& area, const std::vector<ZoneLook>& looks,
                   const std::vector<bool>& may_be, double hole_height) {
  const std::size_t count = looks.size();
  Tracks tracks{std::vector<bool>(count), std::vector<bool>(count), std::vector<bool>(count), {}};
  const auto are_twins = [&](std::size_t a, std::size_t b) {
    return a != b && may_be[b] && area.zones[a].volume * area.zones[b].volume > 0.0 &&
           looks[a].shape.is_twin_of(looks[b].shape);
  };
  Mask ruts = Mask::Constant(area.ground.zone.rows(), area.ground.zone.cols(), false);
  for (std::size_t z = 0; z < count; ++z) {
    const ZoneShape& shape = looks[z].shape;
    if (!may_be[z] || !shape.is_track_wide() || !(looks[z].lasting > lasting_track)) continue;
    for (std::size_t other = 0; other < count && !tracks.has_twin[z]; ++other) {
      tracks.has_twin[z] = are_twins(z, other);
    }
    tracks.is_track[z] =
        tracks.has_twin[z] || (shape.is_strip() && shape.height < highest_lone_track);
    tracks.is_rut[z] =
        tracks.is_track[z] && area.zones[z].volume < 0.0 && shape.height < 0.5 * hole_height;
    if (tracks.is_rut[z]) ruts = ruts || area.ground.zone == static_cast<int>(z);
  }
  tracks.away = distance_to(ruts) * area.grid.cell_size;
  return tracks;
}

}  // namespace excavplan
