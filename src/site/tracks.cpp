// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/tracks.hpp"

#include <excavplan/simulation/compaction.hpp>

namespace excavplan {
namespace {

constexpr double shoe_share = 0.2;  ///< width of one track over that of both: 0.5 m of the zx120's

double mass_of(const Machine& machine) {
  double mass = machine.body->mass;
  for (const LinkMass& link : machine.links) mass += link.mass;
  return mass;
}

}  // namespace

void compact_under_tracks(const SiteSettings& settings, const BasePose& base, double time,
                          GroundState& ground) {
  const Machine& machine = settings.machine;
  if (!machine.body || !(machine.track_front > 0.0)) return;
  const double half = 0.5 * machine.undercarriage_width();
  const double shoe = 2.0 * shoe_share * half;
  const double length = 2.0 * machine.track_front;
  const double pressure = gravity * mass_of(machine) / (2.0 * shoe * length);
  Terrain pressed = ground.terrain;
  for (const double inner : {-half, half - shoe}) {
    Load track = {{-machine.track_front, inner, machine.track_front, inner + shoe}, pressure};
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
