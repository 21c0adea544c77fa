// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/site_scene.hpp"

/// @file
/// A scene while it is made: pit, ridge and heap of random size and place on natural ground, to
/// which a family of scenes adds.

namespace excavplan::scenes {

/// Enlarges an extent until a disc lies inside it, 0.8 m from its edge.
void make_room(Rectangle& extent, double x, double y, double radius);

/// random_dig() in other sizes; a ridge that leaves most of the soil to the heap.
Dig site_dig(Random& random);

/// All lengths of a dig times a factor.
void enlarge(Dig& dig, double factor);

class Draft {
 public:
  explicit Draft(std::uint64_t seed) : random(seed, 31), seed_(seed) {
    scene.dig = site_dig(random);
    bulking = scene.dig.bulking;
    scene.extent.x_max += random.uniform(-0.5, 1.5);
    scene.heap = {dump_offset + random.uniform(-0.2, 0.3), random.uniform(-0.4, 0.4)};
    const double roughness = random.uniform(0.0, 0.012);
    ground(random.uniform(0.0, 4.0) * degree, roughness);
    compose();
  }

  SiteScene scene;
  Random random;
  double bulking;            ///< of all soil
  double more_hole = 0.0;    ///< dug beside the pit [m^3]
  double more_spill = 0.0;   ///< spilled beside the ridge [m^3]
  double elsewhere = 0.0;    ///< loose soil that is not in the main heap [m^3]
  std::vector<Height> soil;  ///< changes that belong to these

  void ground(double slope, double roughness) {
    ScanErrors errors;
    errors.slope = slope;
    errors.roughness = roughness;
    scene.ground = Ground(errors, seed_);
  }

  /// Gives the main heap what is left of the loose soil, and sets truth and moved soil.
  void compose() {
    Dig& dig = scene.dig;
    scene.truth.hole = dig.pit_volume() + more_hole;
    scene.truth.spill = dig.ridge_volume() + more_spill;
    scene.truth.heap = bulking * scene.truth.hole - scene.truth.spill;
    const double main = scene.truth.heap - elsewhere;
    dig.bulking = (main + dig.ridge_volume()) / dig.pit_volume();
    std::vector<Height> parts = soil;
    parts.push_back([dig](double x, double y) { return dig.dug(x, y); });
    parts.push_back(main_heap());
    scene.moved = sum_of(parts);
    make_room(scene.extent, scene.heap.x(), scene.heap.y(), dig.heap_radius());
  }

  /// A point of the dig's own frame: along the pit and across it, the ridge at positive v.
  Eigen::Vector2d at_pit(double u, double v) const {
    const Dig& dig = scene.dig;
    return {dig.pit_x + u * std::cos(dig.heading) - v * std::sin(dig.heading),
            dig.pit_y + u * std::sin(dig.heading) + v * std::cos(dig.heading)};
  }

  /// A place beside a disc of this radius, its gap to it random, away from the other end.
  Eigen::Vector2d beside(const Eigen::Vector2d& centre, double reach, double away_from_x) {
    const double side = centre.x() > away_from_x ? 0.0 : pi;
    const double angle = side + random.uniform(-0.5 * pi, 0.5 * pi);
    return {centre.x() + reach * std::cos(angle), centre.y() + reach * std::sin(angle)};
  }

  /// Puts loose soil into a further heap, its foot `gap` away from that of the main one.
  void add_heap(double volume, double gap) {
    add_heap(volume, gap, random.uniform(28.0, 38.0) * degree);
  }
  void add_heap(double volume, double gap, double slope) {
    Cone cone{0.0, 0.0, volume, slope};
    elsewhere += volume;
    compose();
    const double reach = scene.dig.heap_radius() + 0.5 * scene.dig.heap_crest + cone.radius() + gap;
    const Eigen::Vector2d at = beside(scene.heap, reach, 0.0);
    cone.x = at.x();
    cone.y = at.y();
    soil.emplace_back(cone);
    make_room(scene.extent, cone.x, cone.y, cone.radius());
    compose();
  }

  /// A machine's tracks that start in the pit, or `gap` away from its edge.
  Tracks tracks_from_pit(double gap) {
    const double start = gap > 0.0 ? gap : -0.15;
    const double aside = random.uniform(0.3, 0.7) * (random.uniform() < 0.5 ? -1.0 : 1.0);
    const Eigen::Vector2d at = at_pit(aside, -0.5 * scene.dig.pit_width - start);
    Tracks tracks;
    tracks.x = at.x();
    tracks.y = at.y();
    tracks.heading = scene.dig.heading - 0.5 * pi;
    tracks.length = random.uniform(1.8, 3.0);
    tracks.spacing = random.uniform(1.8, 2.2);
    tracks.width = random.uniform(0.4, 0.6);
    tracks.depth = random.uniform(0.02, 0.04);
    return tracks;
  }

 private:
  Height main_heap() const {
    const Dig& dig = scene.dig;
    return [radius = dig.heap_radius(), crest = 0.5 * dig.heap_crest, at = scene.heap,
            slope = std::tan(dig.heap_slope)](double x, double y) {
      const double away = std::hypot(std::max(std::abs(x - at.x()) - crest, 0.0), y - at.y());
      return std::max(0.0, (radius - away) * slope);
    };
  }

  std::uint64_t seed_;
};

}  // namespace excavplan::scenes
