// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/screened_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include <excavplan/base/ceilings.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "ground/terrain.hpp"
#include "optimisation/space_filling.hpp"
#include "planning/dig_layout.hpp"
#include "planning/dig_problem.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr int most_together = 8;  // ours

/// Means of a layer over the cells that are known, each as heavy as `weight` says. Rounding puts
/// none beside what it is the mean of.
template <typename Weight>
Eigen::ArrayXXd means(const Eigen::ArrayXXd& layer, int cells, const Weight& weight) {
  const auto blocks = [&](Index count) { return (count + cells - 1) / cells; };
  Eigen::ArrayXXd coarse(blocks(layer.rows()), blocks(layer.cols()));
  for (Index col = 0; col < coarse.cols(); ++col) {
    for (Index row = 0; row < coarse.rows(); ++row) {
      double sum = 0.0, weights = 0.0;
      double least = infinity, most = -infinity;
      for (Index c = col * cells; c < std::min(layer.cols(), (col + 1) * cells); ++c) {
        for (Index r = row * cells; r < std::min(layer.rows(), (row + 1) * cells); ++r) {
          const double heavy = weight(r, c);
          if (!(heavy > 0.0)) continue;
          sum += heavy * layer(r, c);
          weights += heavy;
          least = std::min(least, layer(r, c));
          most = std::max(most, layer(r, c));
        }
      }
      coarse(row, col) = least <= most ? std::clamp(sum / weights, least, most)
                                       : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return coarse;
}

/// Numbers of both searches: ours.
MemeticSearch only_polishing() {
  auto polish = std::get<MemeticSearch>(budget_search().method);
  polish.first_generation = 0;
  polish.polishing = Polishing::evolution;
  return polish;
}

/// Digs that can be driven, from all over the search ranges and the reach: short ones more often,
/// and some that do not drag, as the best often do not.
std::vector<KnownDig> drivable_digs(const DigLayout& layout, const DigSearchOptions& options,
                                    int count) {
  constexpr int tries = 20;         // for each; ours
  constexpr double no_drag = 0.15;  // share of the digs; ours
  const DigBounds bounds = machine_bounds(layout.machine(), options.bounds);
  const Machine& machine = layout.machine();
  const double reach = machine.boom_pin.x() + machine.full_length();
  const auto within = [&](double DigParameters::*field, double share) {
    return bounds.lower.*field + share * (bounds.upper.*field - bounds.lower.*field);
  };
  const auto squared = [](double share) { return share * share; };
  SpaceFilling sequence(4, options.seed);
  std::vector<KnownDig> digs;
  for (int i = 0; i < tries * count && static_cast<int>(digs.size()) < count; ++i) {
    const Eigen::VectorXd u = sequence.next();
    const DigParameters dig = {within(&DigParameters::penetration_angle, u(0)),
                               within(&DigParameters::penetration_length, squared(u(1))),
                               within(&DigParameters::drag_length,
                                      squared(std::max(0.0, u(2) - no_drag) / (1.0 - no_drag)))};
    const double start_x = machine.track_front + u(3) * (reach - machine.track_front);
    const auto path = layout.path_from(dig, start_x);
    if (std::holds_alternative<DigPath>(path)) digs.emplace_back(dig, start_x);
  }
  return digs;
}

/// Digs all over the reach, and polishes of the best of them.
DigSearchOptions exploring(const Machine& machine, const Terrain& terrain,
                           DigSearchOptions options) {
  constexpr double first = 0.45;  // of the digs; ours
  const DigLayout layout(machine, terrain, options.rules);
  const double count = std::max(1.0, first * options.stop.evaluations);
  auto digs = drivable_digs(layout, options, static_cast<int>(count));
  if (digs.empty()) return options;
  MemeticSearch method = only_polishing();
  method.basins = 8;
  method.basin_radius = 0.15;
  method.polish_evaluations = 45;
  method.restarts = 3;
  method.generations = 0;
  options.method = method;
  options.start.insert(options.start.end(), digs.begin(), digs.end());
  return options;
}

/// Polishes the candidates, and what was known before.
DigSearchOptions confirming(const DigSearchOptions& options, std::vector<KnownDig> candidates,
                            int digs) {
  DigSearchOptions confirm = options;
  MemeticSearch method = only_polishing();
  method.basins = 2;
  method.basin_radius = 0.03;
  method.polish_evaluations = 60;
  confirm.method = method;
  confirm.stop.evaluations = digs;
  confirm.start = std::move(candidates);
  confirm.start.insert(confirm.start.end(), options.start.begin(), options.start.end());
  return confirm;
}

DigSearchOptions without_checkpoint(DigSearchOptions options) {
  options.checkpoint = {};
  options.resume = false;
  return options;
}

/// Digs the candidates alone, of a search that was cancelled.
DigSearchOptions only_digging(const DigSearchOptions& confirm) {
  DigSearchOptions digs = without_checkpoint(confirm);
  auto& method = std::get<MemeticSearch>(digs.method);
  method.generations = method.basins = 0;
  digs.progress = nullptr;
  return digs;
}

/// What a search on coarser ground tells.
struct Screened {
  std::vector<KnownDig> candidates;
  Found<DigSearchResult> result;
};

Screened screen(const Machine& machine, const SoilSimulator& simulator, const Terrain& terrain,
                const DigSearchOptions& options, const Screening& screening) {
  const Terrain coarse = screening.cells > 1 ? coarser(terrain, screening.cells) : terrain;
  DigSearchOptions search = without_checkpoint(options);
  search.rules.step *= screening.steps;
  const bool explores = search.start_rule.kind == StartRule::Kind::searched &&
                        std::holds_alternative<MemeticSearch>(search.method) &&
                        search.stop.evaluations > 0;
  if (explores) {
    search = exploring(machine, coarse, std::move(search));
    search.progress =
        as_part_of(options.progress, 0, options.stop.evaluations + screening.confirmed);
  }
  const std::vector<PossibleSoil> soils = {{&simulator, 1.0}};
  DigProblem problem(machine, soils, coarse, search);
  const SearchResult found = problem.run();
  return {problem.best_apart(found, screening.candidates), problem.result_of(found)};
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
  require_in("search: stop.evaluations", options.stop.evaluations, 0, most_evaluations);
  require_in("screening: digs on the ground itself", screening.confirmed, 1, most_evaluations);
  require_in("screening: candidates", screening.candidates, 1, most_evaluations);
  require_own_checkpoint(machine, simulator, terrain, confirming(options, {}, screening.confirmed));
  const Screened screened = screen(machine, simulator, terrain, options, screening);
  const bool stopped = was_stopped(screened.result);
  if (!screened.result && stopped) return screened.result;
  int made = digs_of(screened.result);
  const auto follow = [&](DigSearchOptions next) {
    next.progress = as_part_of(options.progress, made, made + next.stop.evaluations);
    return search_dig(machine, simulator, terrain, stopped ? only_digging(next) : next);
  };
  Found<DigSearchResult> found;
  DigSearchOptions confirm = confirming(options, screened.candidates, screening.confirmed);
  if (!confirm.start.empty()) found = follow(std::move(confirm));
  if (!found && !was_stopped(found) && !stopped) {
    const Found<DigSearchResult> polished = std::exchange(found, {});
    made += digs_of(polished);
    found = follow(without_checkpoint(options));
    precede(polished, found);
  }
  precede(screened.result, found);
  if (!found && stopped) found.stopped = true;
  if (found && stopped) {
    found->stopped = true;
    found->stopped_by = StopReason::cancelled;
  }
  return found;
}

}  // namespace excavplan
