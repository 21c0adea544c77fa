// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_ground.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr std::size_t least_cells = 40;  // of a cut that tells its height
constexpr double least_cut = 0.01;       // of a cell that was cut [m]
constexpr double cleanest = 0.005;       // loose soil on it, at most [m]
constexpr double most_off = 0.1;         // more is no error of tracking [m]

Terrain without_doubts(Terrain terrain) {
  terrain.doubts.clear();
  return terrain;
}

std::optional<double> cut_above(const Terrain& expected, const Terrain& before,
                                const Terrain& scanned) {
  if (before.loose.size() == 0 || !same_grid(scanned.bank, expected.bank)) return std::nullopt;
  if (!same_grid(before.bank, expected.bank)) return std::nullopt;
  std::vector<double> off;
  for_each_cell(expected.bank.z, [&](Cell at) {
    const double level = expected.bank.z(at.row, at.col);
    if (!(before.bank.z(at.row, at.col) - level > least_cut)) return;
    if (expected.loose(at.row, at.col) > cleanest) return;
    const double surface = scanned.bank.z(at.row, at.col) + scanned.loose(at.row, at.col);
    if (std::abs(surface - level) < most_off) off.push_back(surface - level);
  });
  if (off.size() < least_cells) return std::nullopt;
  return median(off);
}

}  // namespace

JobGround::JobGround(const std::string& folder, const JobSettings& settings)
    : settings_(settings), site_(folder, settings.site, SiteAccess::write) {
  if (!site_.is_empty()) begin_anew();
}

void JobGround::begin_anew() {
  unseen_.clear();
  expected_ = without_doubts(site_.ground().terrain);
}

void JobGround::expect(const UnseenDig& dig, double height_bias) {
  const Machine& machine = settings_.site.machine;
  const SoilKind& soil = settings_.site.soil;
  const HeightMapSimulator simulator(machine, soil, settings_.density_percent);
  DigLine line = dig_line(dig.step.base, dig.step.swung, dig.step.lane);
  line.z += height_bias;
  const DigResult result = dig_along(simulator, machine, expected_, line,
                                     soil_voids(soil, settings_.density_percent), dig.step.path);
  apply(result.patch, expected_);
  if (!dig.step.truck) {
    heap_soil(expected_, soil, settings_.density_percent, dig.step.dump.head<2>(),
              result.payload_volume);
  }
  unseen_.push_back(dig);
}

std::optional<double> JobGround::take_in(const SiteEvent& event) {
  const Terrain before = site_.is_empty() ? Terrain{} : site_.ground().terrain;
  const Terrain expected = std::move(expected_);
  const SiteUpdate update = site_.update(event);
  begin_anew();
  return update.taken ? cut_above(expected, before, expected_) : std::nullopt;
}

}  // namespace excavplan
