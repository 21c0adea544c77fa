// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_draft.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan::scenes {

void make_room(Rectangle& extent, double x, double y, double radius) {
  const double reach = radius + 0.8;
  extent.x_min = std::min(extent.x_min, x - reach);
  extent.x_max = std::max(extent.x_max, x + reach);
  extent.y_min = std::min(extent.y_min, y - reach);
  extent.y_max = std::max(extent.y_max, y + reach);
}

Dig site_dig(Random& random) {
  Dig dig = random_dig(random.bits());
  const double size = random.uniform(0.9, 1.15);
  dig.pit_length *= size;
  dig.pit_width *= size;
  dig.ridge_height = random.uniform(0.25, 0.5) * dig.pit_depth;
  dig.ridge_offset = 0.5 * dig.pit_width + dig.ridge_height / std::tan(dig.ridge_slope) +
                     random.uniform(0.02, 0.20);
  dig.bulking = random.uniform(1.05, 1.5);
  dig.heap_x = dig.heap_y = 0.0;
  if (random.uniform() < 0.3) dig.heap_crest = random.uniform(0.4, 1.2);
  return dig;
}

void enlarge(Dig& dig, double factor) {
  for (double* length : {&dig.pit_length, &dig.pit_width, &dig.pit_depth, &dig.pit_x, &dig.pit_y,
                         &dig.ridge_offset, &dig.ridge_height, &dig.heap_crest}) {
    *length *= factor;
  }
}

}  // namespace excavplan::scenes
