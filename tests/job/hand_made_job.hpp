// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "job/job_map.hpp"
#include "job/trench_job.hpp"

/// @file
/// Jobs on ground and designs made by hand.

namespace excavplan::test {

inline SitePolygon box(double x_min, double y_min, double x_max, double y_max) {
  return {{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}};
}

/// A trench along x from 0 in level ground, dug from beyond its near end.
struct HandMadeJob {
  explicit HandMadeJob(double length = 10.0, double width = 1.0) {
    settings.site.soil = load_soil(std::string(EXCAVPLAN_DATA_SOURCE) + "/soils/loam.json");
    settings.site.machine = zx120();
    settings.design.start = BasePose{-4.0, 0.0, 0.0, 0.0};
    settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-6.0, 1.5, 14.0, 6.0)}};
    DesignWords words;
    words.length = length;
    words.floor_width = width;
    words.depth = 0.5;
    settings.surface = design_of_words(words, ground.bank);
  }
  JobMap map() const { return map_of(settings, ground.bank); }
  JobFrame frame() const { return frame_of(settings, map()); }

  Terrain ground = undisturbed(flat_ground({-12.0, -8.0, 18.0, 8.0}, 0.05));
  JobSettings settings;
};

/// A trench in line with the machine whose sides lean back.
inline HandMadeJob leaning_trench() {
  HandMadeJob job;
  DesignWords words;
  words.length = 10.0;
  words.floor_width = 1.0;
  words.depth = 0.6;
  words.batter = 1.73;
  job.settings.surface = design_of_words(words, job.ground.bank);
  return job;
}

/// Ground that is dug to so far over the design [m].
inline Terrain dug_to(const JobMap& map, Terrain ground, double over) {
  for_each_cell(map.target.z, [&](Cell at) {
    const double target = map.target.z(at.row, at.col);
    double& bank = ground.bank.z(at.row, at.col);
    if (!std::isnan(target)) bank = std::min(bank, target + over);
  });
  return ground;
}

}  // namespace excavplan::test
