// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/screened_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <excavplan/base/ceilings.hpp>

#include "base/check.hpp"
#include "ground/terrain.hpp"
#include "planning/dig_attempts.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr int most_together = 8;  // ours

/// Means of a layer over the cells that are known, each as heavy as `weight` says.
template <typename Weight>
Eigen::ArrayXXd means(const Eigen::ArrayXXd& layer, int cells, const Weight& weight) {
  const auto blocks = [&](Index count) { return (count + cells - 1) / cells; };
  Eigen::ArrayXXd coarse(blocks(layer.rows()), blocks(layer.cols()));
  for (Index col = 0; col < coarse.cols(); ++col) {
    for (Index row = 0; row < coarse.rows(); ++row) {
      double sum = 0.0;
      double weights = 0.0;
      for (Index c = col * cells; c < std::min(layer.cols(), (col + 1) * cells); ++c) {
        for (Index r = row * cells; r < std::min(layer.rows(), (row + 1) * cells); ++r) {
          const double heavy = weight(r, c);
          if (!(heavy > 0.0)) continue;
          sum += heavy * layer(r, c);
          weights += heavy;
        }
      }
      coarse(row, col) = weights > 0.0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return coarse;
}

DigSearchOptions confirming(const DigSearchOptions& options, const DigSearchResult& screened,
                            int digs) {
  DigSearchOptions confirm = polish_search(0, 1, digs / 2);
  DigSearchOptions same = options;
  same.method = confirm.method;
  same.checkpoint = {};
  same.resume = false;
  same.stop.evaluations = digs;
  same.start = {KnownDig(screened.dig.parameters, screened.dig.start_x)};
  return same;
}

}  // namespace

Terrain coarser(const Terrain& terrain, int cells) {
  require_terrain(terrain, "screening");
  require_in("screening: cells of the ground in one", cells, 1, most_together);
  const HeightMap& bank = terrain.bank;
  const auto known = [&](Index row, Index col) { return std::isnan(bank.z(row, col)) ? 0.0 : 1.0; };
  Terrain coarse;
  coarse.bank = {bank.origin, cells * bank.cell_size, means(bank.z, cells, known)};
  coarse.loose = means(terrain.loose, cells, known).unaryExpr([](double thickness) {
    return std::isnan(thickness) ? 0.0 : thickness;
  });
  if (terrain.bank_void_ratio.size() > 0) {
    coarse.bank_void_ratio = means(terrain.bank_void_ratio, cells, known);
  }
  if (terrain.loose_void_ratio.size() > 0) {
    constexpr double where_none_lies = 1e-9;  // the state counts all the same [m]; ours
    coarse.loose_void_ratio = means(terrain.loose_void_ratio, cells, [&](Index row, Index col) {
      return known(row, col) * std::max(where_none_lies, terrain.loose(row, col));
    });
  }
  return coarse;
}

Found<DigSearchResult> search_screened(const Machine& machine, const SoilSimulator& simulator,
                                       const Terrain& terrain, const DigSearchOptions& options,
                                       const Screening& screening) {
  require(screening.steps >= 1.0 && std::isfinite(screening.steps), "screening: steps in one",
          screening.steps, "finite and at least 1");
  require_in("screening: digs on the ground itself", screening.confirmed, 1, most_evaluations);
  const Terrain coarse = coarser(terrain, screening.cells);
  DigSearchOptions screen = options;
  screen.rules.step *= screening.steps;
  Found<DigSearchResult> screened = search_dig(machine, simulator, coarse, screen);
  if (!screened && screened.stopped) return screened;
  if (screened) {
    Found<DigSearchResult> found = search_dig(machine, simulator, terrain,
                                              confirming(options, *screened, screening.confirmed));
    if (found) {
      found->evaluations += screened->evaluations;
      found->stopped_by = found->stopped ? found->stopped_by : screened->stopped_by;
      return found;
    }
  }
  return search_dig(machine, simulator, terrain, options);
}

}  // namespace excavplan
