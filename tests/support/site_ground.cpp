// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

namespace excavplan::scenes {

// Draws have statements of their own: compilers differ in the order of arguments.

Eigen::Vector2d place_in(Draft& d, const Rectangle& area) {
  const double y = d.random.uniform(area.y_min, area.y_max);
  return {d.random.uniform(area.x_min, area.x_max), y};
}

void second_heap(Draft& d) {
  const double loose = d.bulking * d.scene.truth.hole;
  const double away = d.random.uniform(0.8, 2.5);
  d.add_heap(d.random.uniform(0.08, 0.16) * loose, away);
}

void add_scrape(Draft& d, Dig scrape) {
  const double reach = 0.5 * std::hypot(d.scene.dig.pit_length, d.scene.dig.pit_width) +
                       0.5 * std::hypot(scrape.pit_length, scrape.pit_width);
  const Eigen::Vector2d pit(d.scene.dig.pit_x, d.scene.dig.pit_y);
  const double away = 2.0 * d.scene.dig.ridge_offset - d.scene.dig.pit_width;  // the ridge's foot
  const Eigen::Vector2d at = d.beside(pit, reach + away + d.random.uniform(0.3, 1.2), 5.0);
  scrape.pit_x = at.x();
  scrape.pit_y = at.y();
  make_room(d.scene.extent, at.x(), at.y(), 0.5 * scrape.pit_length);
  d.more_hole = scrape.pit_volume();
  d.soil.push_back([scrape](double x, double y) { return scrape.dug(x, y); });
  d.compose();
}

void second_scrape(Draft& d) {
  const double volume = d.random.uniform(0.05, 0.12) * d.scene.truth.hole;
  Dig scrape;
  scrape.ridge_height = 1e-9;
  scrape.pit_depth = d.random.uniform(0.06, 0.12);
  scrape.pit_width = d.random.uniform(0.5, 0.9);
  scrape.heading = d.random.uniform(0.0, pi);
  scrape.pit_length = 0.3;
  while (scrape.pit_volume() < volume) scrape.pit_length += 0.01;
  add_scrape(d, scrape);
}

void scrape_like_rut(Draft& d) {
  Dig scrape;
  scrape.ridge_height = 1e-9;
  scrape.pit_depth = d.random.uniform(0.03, 0.05);
  scrape.pit_width = d.random.uniform(0.6, 0.9);
  scrape.heading = d.random.uniform(0.0, pi);
  scrape.pit_length = d.random.uniform(2.0, 3.2);
  add_scrape(d, scrape);
}

void steep_heap(Draft& d) {
  const double volume = d.random.uniform(0.06, 0.16);
  const double gap = d.random.uniform(0.8, 2.5);
  d.add_heap(volume, gap, d.random.uniform(50.0, 60.0) * degree);
}

void hard_second_heap(Draft& d) {
  d.bulking = d.random.uniform(1.9, 2.2);
  d.compose();
  second_heap(d);
}

void lump(Draft& d) {
  Clod clod;
  clod.volume = d.random.uniform(0.01, 0.06);
  const bool off = d.random.uniform() < 0.5;
  const double along = d.random.uniform(0.35, 0.65);
  const double aside = off ? d.random.uniform(1.6, 2.3) : d.random.uniform(0.0, 0.4);
  clod.x = along * d.scene.heap.x();
  clod.y = along * d.scene.heap.y() + (d.random.uniform() < 0.5 ? -aside : aside);
  d.elsewhere += clod.volume;
  d.soil.emplace_back(clod);
  d.compose();
}

void over_old_spill(Draft& d) {
  const Dig dig = d.scene.dig;
  Strip ridge;
  ridge.height = d.random.uniform(0.08, 0.2);
  ridge.slope = d.random.uniform(30.0, 38.0) * degree;
  ridge.width = 2.0 * ridge.height / std::tan(ridge.slope);
  ridge.length = d.random.uniform(1.5, 2.5);
  ridge.heading = dig.heading + d.random.uniform(-0.3, 0.3);
  const Eigen::Vector2d along(std::cos(ridge.heading), std::sin(ridge.heading));
  const Eigen::Vector2d at =
      d.at_pit(0.0, d.random.uniform(-0.3, 0.3) * dig.pit_width) - 0.5 * ridge.length * along;
  ridge.x = at.x();
  ridge.y = at.y();
  d.scene.older = ridge;
  const Height taken = [dig, ridge](double x, double y) {
    return dig.dug(x, y) < 0.0 ? -ridge(x, y) : 0.0;
  };
  d.elsewhere += volume_of(taken, d.scene.extent);  // the heap holds more than the hole's soil
  d.soil.push_back(taken);
  d.compose();
}

void two_pits(Draft& d) {
  Dig other = site_dig(d.random);
  const double shrink = d.random.uniform(0.8, 1.0);
  other.pit_length *= shrink;
  other.pit_width *= shrink;
  other.pit_x = -3.6 + d.random.uniform(-0.2, 0.2);
  other.pit_y = d.random.uniform(-0.5, 0.5);
  make_room(d.scene.extent, other.pit_x, other.pit_y, 0.5 * other.pit_length + 0.3);
  d.more_hole = other.pit_volume();
  d.more_spill = other.ridge_volume();
  d.elsewhere = 0.0;
  d.soil.push_back([other](double x, double y) { return other.dug(x, y); });
  d.compose();
}

void two_pits_two_heaps(Draft& d) {
  two_pits(d);
  const double away = d.random.uniform(0.1, 1.5);
  d.add_heap(d.random.uniform(0.35, 0.5) * d.scene.truth.heap, away);
}

void two_heaps_alike(Draft& d) {
  const double away = d.random.uniform(0.1, 1.5);
  d.add_heap(d.random.uniform(0.45, 0.55) * d.scene.truth.heap, away);
}

void clods(Draft& d) {
  const auto count = 5 + d.random.index(16);
  const double bow = d.random.uniform(-1.2, 1.2);
  for (std::uint64_t i = 0; i < count; ++i) {
    Clod clod;
    clod.volume = d.random.uniform(0.001, 0.004);
    const double along = d.random.uniform(0.3, 0.8);
    clod.x = along * d.scene.heap.x();
    clod.y = along * d.scene.heap.y() + 4.0 * along * (1.0 - along) * bow + 0.2 * d.random.normal();
    d.elsewhere += clod.volume;
    d.soil.emplace_back(clod);
  }
  d.compose();
}

void ruts_joined(Draft& d) {
  Tracks tracks = d.tracks_from_pit(0.0);
  if (d.random.uniform() < 0.5) tracks.berm_height = d.random.uniform(0.01, 0.02);
  d.scene.other = tracks.change();
}

void rut_shallow(Draft& d) {
  Tracks tracks = d.tracks_from_pit(0.0);
  tracks.depth = 0.01;
  d.scene.other = tracks.change();
}

void ruts_apart(Draft& d) {
  d.scene.other = d.tracks_from_pit(d.random.uniform(0.4, 1.5)).change();
}

void berms_joined(Draft& d) {
  Tracks tracks;
  tracks.x = d.scene.heap.x();
  tracks.y = d.scene.heap.y();
  tracks.heading = (d.random.uniform() < 0.5 ? 0.5 : -0.5) * pi + d.random.uniform(-0.6, 0.6);
  tracks.length = d.scene.dig.heap_radius() + d.random.uniform(1.0, 1.8);
  tracks.spacing = d.random.uniform(1.2, 1.8);
  tracks.depth = d.random.uniform(0.02, 0.04);
  tracks.berm_height = d.random.uniform(0.02, 0.04);
  d.scene.other = tracks.change();
}

void churned(Draft& d) {
  const double length = d.random.uniform(0.05, 0.25);
  const double rms = d.random.uniform(0.01, 0.02);
  const double heading = d.random.uniform(0.0, 2.0 * pi);
  const auto texture =
      std::make_shared<SmoothError>(d.scene.extent, length, Random(d.random.bits()));
  d.scene.other = [=](double x, double y) {
    const double side = (x - 2.8) * std::cos(heading) + y * std::sin(heading);
    return side > 0.0 ? rms * (*texture)(x, y) : 0.0;
  };
}

void set_down(Draft& d, double x, double y) {
  Box box;
  box.x = x;
  box.y = y;
  box.heading = d.random.uniform(0.0, pi);
  box.length = d.random.uniform(0.3, 0.5);
  box.width = d.random.uniform(0.3, 0.5);
  box.top = d.scene.after(x, y) + d.random.uniform(0.15, 0.4);
  d.scene.boxes.push_back(box);
}

void crate_on_heap(Draft& d) {
  const double away = d.random.uniform(0.0, 0.6) * d.scene.dig.heap_radius();
  const double angle = d.random.uniform(0.0, 2.0 * pi);
  set_down(d, d.scene.heap.x() + away * std::cos(angle), d.scene.heap.y() + away * std::sin(angle));
}

void crate_in_pit(Draft& d) {
  const double across = d.random.uniform(-0.1, 0.1);
  const Eigen::Vector2d at =
      d.at_pit(d.random.uniform(-0.25, 0.25) * d.scene.dig.pit_length, across);
  set_down(d, at.x(), at.y());
}

void fill_pit(Draft& d) {
  const Dig& dig = d.scene.dig;
  d.scene.water =
      d.scene.ground(dig.pit_x, dig.pit_y) - (1.0 - d.random.uniform(0.05, 0.6)) * dig.pit_depth;
}

void water(Draft& d) {
  const double roughness = d.random.uniform(0.01, 0.02);
  d.ground(d.random.uniform(0.0, 3.0) * degree, roughness);
  fill_pit(d);
}

void water_even(Draft& d) {
  d.ground(0.0, 0.0);
  fill_pit(d);
}

void lawn(Draft& d) {
  d.scene.sampling.grass_share = 1.0;
  d.scene.sampling.grass_height = 0.03;
}

void grass(Draft& d) {
  d.scene.sampling.grass_share = 0.4;
  d.scene.sampling.grass_height = 0.02;
}

void pressed(Draft& d) { d.scene.pressed = d.random.uniform(0.0, 0.03); }

void heap_at_wall(Draft& d) {
  const double angle = d.random.uniform(-0.5 * pi, 0.5 * pi);
  const double distance = d.random.uniform(0.8, 1.0) * d.scene.dig.heap_radius();
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  Box wall;
  wall.width = 0.25;
  wall.length = 4.0;
  const Eigen::Vector2d at = d.scene.heap + (distance + 0.5 * wall.width) * normal;
  wall.x = at.x();
  wall.y = at.y();
  wall.heading = std::atan2(normal.x(), -normal.y());
  wall.top = d.scene.ground(wall.x, wall.y) + d.random.uniform(1.0, 1.4);
  make_room(d.scene.extent, wall.x, wall.y, 0.2);
  const Height moved = d.scene.moved;
  d.scene.moved = [=, heap = d.scene.heap](double x, double y) {
    return (Eigen::Vector2d(x, y) - heap).dot(normal) < distance ? moved(x, y) : 0.0;
  };
  d.scene.truth.heap = volume_of(d.scene.moved, {2.8, -4.0, 9.0, 4.0});
  d.scene.walls.push_back(wall);
  d.scene.sampling.face_share = 0.04;
}

void crate_apart(Draft& d) {
  const double side = d.random.uniform() < 0.5 ? -1.0 : 1.0;
  set_down(d, d.random.uniform(2.0, 2.8), side * 2.2);
}

void steep_ground(Draft& d) { d.ground(d.random.uniform(10.0, 15.0) * degree, 0.01); }

void heap_spread(Draft& d) {
  d.scene.dig.heap_slope = d.random.uniform(4.0, 8.0) * degree;
  d.compose();
}

void thin_dig(Draft& d) {
  d.scene.dig.pit_depth = d.random.uniform(0.02, 0.04);
  d.scene.dig.ridge_height = 0.3 * d.scene.dig.pit_depth;
  d.compose();
}

void dug_again(Draft& d) {
  Dig old = d.scene.dig;
  old.pit_length *= 1.3;
  old.pit_width *= 1.6;
  old.ridge_offset = 1.5 * d.scene.dig.pit_width;
  old.pit_x += d.random.uniform(-0.5, 0.5);
  d.scene.older = [old](double x, double y) { return old.dug(x, y); };
}

namespace {

/// Half balls in a jittered lattice, so many that they are `thickness` high on average.
Height crumbs_of(double thickness, std::uint64_t seed) {
  constexpr double pitch = 0.05;
  return [=](double x, double y) {
    double height = 0.0;
    const auto column = static_cast<long long>(std::floor(x / pitch));
    const auto row = static_cast<long long>(std::floor(y / pitch));
    for (long long c = column - 1; c <= column + 1; ++c) {
      for (long long r = row - 1; r <= row + 1; ++r) {
        Random random(seed, static_cast<std::uint64_t>(c + 100000),
                      static_cast<std::uint64_t>(r + 100000));
        const double radius = random.uniform(0.012, 0.022);
        const double volume = 2.0 / 3.0 * pi * radius * radius * radius;
        const double many = thickness * pitch * pitch / volume;
        const Clod clod{pitch * (static_cast<double>(c) + random.uniform()),
                        pitch * (static_cast<double>(r) + random.uniform()), volume};
        if (random.uniform() < many) height = std::max(height, clod(x, y));
      }
    }
    return height;
  };
}

/// Where the soil is strewn: an ellipse between hole and heap, or about one of them.
struct Patch {
  Eigen::Vector2d centre;
  Eigen::Vector2d half;
  bool contains(double x, double y) const {
    return std::pow((x - centre.x()) / half.x(), 2) + std::pow((y - centre.y()) / half.y(), 2) <
           1.0;
  }
};

void strew(Draft& d, double share, bool as_crumbs) {
  const double loose = d.bulking * d.scene.truth.hole;
  double thickness = d.random.uniform(0.002, 0.02);
  const double area = std::min(share * loose / thickness, 9.0);
  thickness = share * loose / area;
  d.scene.sampling.noise = d.random.uniform(0.003, 0.01);
  const double place = d.random.uniform(0.0, 1.0);
  const double length = std::sqrt(area / pi) * d.random.uniform(0.8, 1.3);
  const Patch patch{{place * d.scene.heap.x(), place * d.scene.heap.y()},
                    {length, area / pi / length}};
  const Height whole = as_crumbs ? crumbs_of(thickness, d.random.bits())
                                 : Height([=](double, double) { return thickness; });
  d.elsewhere += share * loose;
  d.compose();
  const Height soil = d.scene.moved;
  const Height strewn = [=](double x, double y) {
    return patch.contains(x, y) && soil(x, y) == 0.0 ? whole(x, y) : 0.0;
  };
  d.elsewhere += volume_of(strewn, d.scene.extent) - share * loose;
  d.soil.push_back(strewn);
  d.compose();
}

}  // namespace

void strewn_layer(Draft& d) { strew(d, d.random.uniform(0.0, 0.1), false); }

void strewn_crumbs(Draft& d) { strew(d, d.random.uniform(0.0, 0.1), true); }

void strewn_none(Draft& d) { d.scene.sampling.noise = d.random.uniform(0.003, 0.01); }

void strewn_by_wheels(Draft& d) {
  d.scene.sampling.noise = d.random.uniform(0.003, 0.01);
  const double height = d.random.uniform(0.003, 0.015);
  const double start = d.scene.heap.x() - d.scene.dig.heap_radius() - 0.1;
  const double length = d.random.uniform(1.2, 2.0);
  for (const double side : {-0.8, 0.8}) {
    Strip strip;
    strip.x = start - length;
    strip.y = d.scene.heap.y() + side;
    strip.length = length;
    strip.width = d.random.uniform(0.4, 0.6);
    strip.height = height;
    const Height soil = d.scene.moved;
    const Height strewn = [=](double x, double y) { return soil(x, y) == 0.0 ? strip(x, y) : 0.0; };
    d.elsewhere += volume_of(strewn, d.scene.extent);
    d.soil.push_back(strewn);
  }
  d.compose();
}

void level_floor(Draft& d) {
  const double roughness = d.random.uniform(0.01, 0.02);
  d.ground(d.random.uniform(0.0, 3.0) * degree, roughness);
  const Dig& dig = d.scene.dig;
  d.scene.floor =
      d.scene.ground(dig.pit_x, dig.pit_y) - d.random.uniform(0.7, 0.85) * dig.pit_depth;
  const SiteScene& scene = d.scene;
  const Height ground = scene.ground;
  const Height moved = scene.moved;
  const double left = volume_of(
      [&](double x, double y) {
        const double soil = moved(x, y);
        return soil < 0.0 ? std::max(0.0, scene.floor - ground(x, y) - soil) : 0.0;
      },
      scene.extent);
  d.elsewhere += d.bulking * left;  // is in no heap at all
  d.compose();
  d.scene.truth.hole -= left;
  d.scene.truth.heap -= d.bulking * left;
}

void back_over_rim(Draft& d) {
  Dig& dig = d.scene.dig;
  dig.ridge_height = 1e-9;
  d.compose();
  const double loose = d.bulking * d.scene.truth.hole;
  // A windrow along the pit whose near slope runs on into the pit.
  const double slope = d.random.uniform(30.0, 38.0) * degree;
  const double run_in = d.random.uniform(0.15, 0.45);  // of the rim behind the foot [m]
  const double length = d.random.uniform(1.0, 1.1) * dig.pit_length;
  double half = std::sqrt(loose / (length * std::tan(slope)));
  for (int i = 0; i < 30; ++i) {
    half -= (pi / 3.0 * half * half * half + length * half * half - loose / std::tan(slope)) /
            (pi * half * half + 2.0 * length * half);
  }
  const double axis = 0.5 * dig.pit_width + half - run_in;
  const Height ridge = [=](double x, double y) {
    const double u =
        (x - dig.pit_x) * std::cos(dig.heading) + (y - dig.pit_y) * std::sin(dig.heading);
    const double v =
        (y - dig.pit_y) * std::cos(dig.heading) - (x - dig.pit_x) * std::sin(dig.heading);
    const double away = std::hypot(std::max(std::abs(u) - 0.5 * length, 0.0), v - axis);
    return (half - away) * std::tan(slope);
  };
  const Height pit = [=](double x, double y) { return std::min(0.0, dig.dug(x, y)); };
  d.scene.moved = [=](double x, double y) {
    const double cut = pit(x, y);
    const double above = ridge(x, y);
    return cut < 0.0 ? std::max(cut, above) : std::max(0.0, above);
  };
  const Height filled = [=, moved = d.scene.moved](double x, double y) {
    return std::max(0.0, moved(x, y) - pit(x, y));
  };
  d.scene.truth.spill = 0.0;
  make_room(d.scene.extent, d.scene.heap.x(), d.scene.heap.y(), length);
  d.scene.truth.heap = volume_of(filled, d.scene.extent);
  d.scene.heap = {dig.pit_x - axis * std::sin(dig.heading),
                  dig.pit_y + axis * std::cos(dig.heading)};
  make_room(d.scene.extent, d.scene.heap.x(), d.scene.heap.y(), length);
}

void foreign_berm(Draft& d) {
  Strip berm;
  berm.height = d.random.uniform(0.12, 0.3);
  berm.slope = d.random.uniform(28.0, 38.0) * degree;
  berm.width = 2.0 * berm.height / std::tan(berm.slope);
  berm.length = d.random.uniform(1.5, 3.0);
  const bool beside = d.random.uniform() < 0.4;
  berm.heading = beside ? d.scene.dig.heading : d.random.uniform(0.0, pi);
  const Eigen::Vector2d along(std::cos(berm.heading), std::sin(berm.heading));
  Eigen::Vector2d centre = d.at_pit(0.0, -0.5 * d.scene.dig.pit_width - 0.5 * berm.width - 0.15);
  if (!beside) {
    centre = {0.45 * d.scene.heap.x(), (d.random.uniform() < 0.5 ? -1.0 : 1.0) * 2.2};
  }
  const Eigen::Vector2d at = centre - 0.5 * berm.length * along;
  berm.x = at.x();
  berm.y = at.y();
  make_room(d.scene.extent, centre.x(), centre.y(), 0.5 * berm.length);
  d.scene.other = berm;
}

void bucket_rests(Draft& d) {
  Box bucket;
  bucket.length = d.random.uniform(0.8, 1.1);
  bucket.width = d.random.uniform(0.6, 0.9);
  bucket.heading = d.random.uniform(0.0, pi);
  const bool in_pit = d.random.uniform() < 0.4;
  const Eigen::Vector2d at = in_pit ? d.at_pit(0.0, 0.0) : place_in(d, {1.8, -1.5, 2.6, 1.5});
  bucket.x = at.x();
  bucket.y = at.y();
  bucket.top = d.scene.after(at.x(), at.y()) + d.random.uniform(0.5, 0.8);
  d.scene.boxes.push_back(bucket);
}

void crate_before(Draft& d) {
  set_down(d, 0.0, 0.0);
  Box box = d.scene.boxes.back();
  d.scene.boxes.clear();
  const bool on_pit = d.random.uniform() < 0.6;
  const Eigen::Vector2d at =
      on_pit ? d.at_pit(d.random.uniform(-0.3, 0.3) * d.scene.dig.pit_length, 0.0)
             : place_in(d, {2.0, -2.0, 2.8, 2.0});
  box.x = at.x();
  box.y = at.y();
  box.length = d.random.uniform(0.4, 0.8);
  box.width = d.random.uniform(0.4, 0.6);
  box.top = d.scene.before(at.x(), at.y()) + d.random.uniform(0.2, 0.6);
  d.scene.boxes_before.push_back(box);
}

}  // namespace excavplan::scenes
