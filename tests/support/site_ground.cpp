// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_ground.hpp"

#include <cmath>
#include <cstdint>

namespace excavplan::scenes {

void second_heap(Draft& d) {
  const double loose = d.bulking * d.scene.truth.hole;
  d.add_heap(d.random.uniform(0.08, 0.16) * loose, d.random.uniform(0.8, 2.5));
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
  d.add_heap(d.random.uniform(0.35, 0.5) * d.scene.truth.heap, d.random.uniform(0.1, 1.5));
}

void two_heaps_alike(Draft& d) {
  d.add_heap(d.random.uniform(0.45, 0.55) * d.scene.truth.heap, d.random.uniform(0.1, 1.5));
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
  const Eigen::Vector2d at =
      d.at_pit(d.random.uniform(-0.25, 0.25) * d.scene.dig.pit_length, d.random.uniform(-0.1, 0.1));
  set_down(d, at.x(), at.y());
}

void fill_pit(Draft& d) {
  const Dig& dig = d.scene.dig;
  d.scene.water =
      d.scene.ground(dig.pit_x, dig.pit_y) - (1.0 - d.random.uniform(0.05, 0.6)) * dig.pit_depth;
}

void water(Draft& d) {
  d.ground(d.random.uniform(0.0, 3.0) * degree, d.random.uniform(0.01, 0.02));
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
  set_down(d, d.random.uniform(2.0, 2.8), (d.random.uniform() < 0.5 ? -1.0 : 1.0) * 2.2);
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

}  // namespace excavplan::scenes
