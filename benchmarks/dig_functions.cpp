// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "dig_functions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/parallel.hpp"
#include "planning/dig_layout.hpp"
#include "planning/dig_problem.hpp"
#include "planning/start_rule.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;

struct Site {
  Machine machine = load_machine(find_data_file("machines/zx120.json"));
  Terrain ground;
  HeightMapSimulator simulator;
  DigLayout layout;

  explicit Site(const DigCondition& condition)
      : ground(sloped(level_planning_ground(machine), condition.rise)),
        simulator(machine, load_soil(find_data_file("soils/loam.json")), condition.density),
        layout(machine, ground) {}

  static Terrain sloped(Terrain ground, double rise) {
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      ground.bank.z.col(col) += rise * (ground.bank.x(col) - 5.0);
    }
    return ground;
  }

  static DigParameters at(const VectorXd& u) {
    const VectorXd lower = to_vector(DigBounds{}.lower);
    const VectorXd upper = to_vector(DigBounds{}.upper);
    return to_dig_parameters(lower + u.cwiseProduct(upper - lower));
  }

  /// 0 for what cannot be dug.
  double efficiency(const VectorXd& u) const {
    const auto path = path_by(layout, at(u), StartRule::Kind::least_work);
    if (std::holds_alternative<Infeasible>(path)) return 0.0;
    const DigResult dig = simulator.dig(ground, std::get<DigPath>(path));
    return dig.stall ? 0.0 : dig.efficiency();
  }

  std::optional<double> refused(const VectorXd& u) const {
    const auto path = path_by(layout, at(u), StartRule::Kind::least_work);
    const auto* stop = std::get_if<Infeasible>(&path);
    if (!stop) return std::nullopt;
    return violation(*stop, at(u));
  }
};

struct Found {
  VectorXd u;
  double efficiency = 0.0;
};

/// All digs of a grid over a cube around a point, the best first.
std::vector<Found> scan(const Site& site, const VectorXd& middle, double half, int grid) {
  std::vector<Found> all(static_cast<std::size_t>(grid * grid * grid));
  parallel_for(all.size(), 0, [&](std::size_t i) {
    const auto place = static_cast<int>(i);
    const Eigen::Vector3d steps(place % grid, place / grid % grid, place / grid / grid);
    const VectorXd u =
        (middle.array() + half * (2.0 * steps.array() / (grid - 1) - 1.0)).max(0.0).min(1.0);
    all[i] = {u, site.efficiency(u)};
  });
  std::stable_sort(all.begin(), all.end(),
                   [](const Found& a, const Found& b) { return a.efficiency > b.efficiency; });
  return all;
}

void find_maximum(DigCondition& condition, int grid) {
  const Site site(condition);
  std::vector<Found> best = scan(site, VectorXd::Constant(3, 0.5), 0.5, grid);
  condition.scanned = static_cast<long>(best.size());
  best.resize(std::min<std::size_t>(5, best.size()));
  for (Found& one : best) {
    double half = 1.0 / (grid - 1);
    for (int i = 0; i < 4; ++i, half *= 0.5) {
      const Found better = scan(site, one.u, half, 9).front();
      condition.scanned += 9 * 9 * 9;
      if (better.efficiency > one.efficiency) one = better;
    }
    condition.maximum = std::max(condition.maximum, one.efficiency);
  }
  std::fprintf(stderr, "%s: %.4f kg/kJ of %ld digs\n", condition.name().c_str(),
               1000.0 * condition.maximum, condition.scanned);
}

}  // namespace

std::string DigCondition::name() const {
  return std::to_string(std::lround(density)) + " %" + (rise > 0.0 ? ", slope" : "");
}

functions::Function DigCondition::function(std::uint64_t seed) const {
  const auto site = std::make_shared<const Site>(*this);
  Random random(seed, 4);
  Eigen::Vector3d flip;
  for (double& axis : flip) axis = std::round(random.uniform());
  const auto place = [flip](const VectorXd& x) -> VectorXd { return (x - flip).cwiseAbs(); };
  functions::Function function;
  function.name = name();
  function.value = [=](const VectorXd& x) { return site->efficiency(place(x)); };
  function.maximum = maximum;
  function.refused = [=](const VectorXd& x) { return site->refused(place(x)); };
  return function;
}

std::vector<DigCondition> dig_conditions(const std::string& file, int grid) {
  std::vector<DigCondition> conditions;
  std::ifstream in(file);
  DigCondition read;
  while (in >> read.density >> read.rise >> read.scanned >> read.maximum) {
    conditions.push_back(read);
  }
  constexpr std::size_t all = 6;
  if (conditions.size() == all) return conditions;
  conditions.clear();
  std::ofstream out(file);
  out.precision(17);
  for (const double rise : {0.0, 0.2679491924311227}) {
    for (const double density : {10.0, 40.0, 80.0}) {
      conditions.push_back({density, rise, 0, 0.0});
      DigCondition& one = conditions.back();
      find_maximum(one, grid);
      out << one.density << ' ' << one.rise << ' ' << one.scanned << ' ' << one.maximum
          << std::endl;
    }
  }
  return conditions;
}

}  // namespace excavplan
