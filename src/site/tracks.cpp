// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/tracks.hpp"

#include <excavplan/simulation/compaction.hpp>

#include "machine/machine_mass.hpp"

namespace excavplan {

void compact_under_tracks(const SiteSettings& settings, const BasePose& base, double time,
                          GroundState& ground) {
  const Machine& machine = settings.machine;
  if (!machine.body || !(machine.track_front > 0.0)) return;
  const TrackPrint tracks(machine);
  const double front = 0.5 * tracks.length;
  const double pressure = gravity * total_mass(machine) / tracks.area();
  Terrain pressed = ground.terrain;
  for (const double inner : {-tracks.half, tracks.half - tracks.shoe}) {
    Load track = {{-front, inner, front, inner + tracks.shoe}, pressure};
    track.place = Eigen::Translation2d(base.x, base.y) * Eigen::Rotation2Dd(base.heading);
    compact(pressed, settings.soil, track);
  }
  const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> is_seen = ground.seen == time;
  Terrain& terrain = ground.terrain;
  terrain.loose = is_seen.select(terrain.loose, pressed.loose).eval();
  terrain.loose_void_ratio =
      is_seen.select(terrain.loose_void_ratio, pressed.loose_void_ratio).eval();
}

}  // namespace excavplan
