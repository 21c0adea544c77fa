// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/attribution.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/change/blocks.hpp>

#include "change/change_zones.hpp"

namespace excavplan {
namespace {

constexpr double negligible = 0.0005;  // of the hole's volume; ours
constexpr std::size_t most_open = 12;  // ours: changes that are combined
constexpr double counted_first = 0.5;  // prior from which a change counts without balance

/// Of what rose and fell, without the loose soil that was dug again. What is left where most was
/// loose tells too little to judge by.
double likelihood_of_balance(double before, double after, double loose) {
  constexpr double least_bank = 1.0 / 3.0;  // of the hole; ours
  const double taken = std::min(loose, (1.0 - least_bank) * before);
  return likelihood_of_bulking((after - taken) / (before - taken));
}

/// How well the soil of some changes balances; 0 without a hole that could be the dig. Where too
/// little rose by its shape the heap is not in the scans, and there is no balance to judge by.
double likelihood_of(const std::vector<Change>& changes, const std::vector<bool>& counted) {
  constexpr double least_hole = 0.3;  // of the largest fall; ours
  double before = 0.0;
  double after = 0.0;
  double largest = 0.0;
  double rose = 0.0;
  double loose = 0.0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (changes[i].prior >= counted_first) {
      largest = std::max(largest, -changes[i].volume);
      rose += std::max(0.0, changes[i].volume);
    }
    if (!counted[i]) continue;
    (changes[i].volume < 0.0 ? before : after) += std::abs(changes[i].volume);
    loose += changes[i].loose;
  }
  if (largest == 0.0) return 1.0;
  if (!(before > least_hole * largest)) return 0.0;
  return rose < least_after_share * largest ? 1.0 : likelihood_of_balance(before, after, loose);
}

/// All combinations of combined_changes(), each as likely as its shapes, places and bulking factor;
/// likeliest first.
std::vector<Combination> combinations_of(const std::vector<Change>& changes) {
  const std::vector<std::size_t> open = combined_changes(changes);
  Combination base;
  for (const Change& change : changes) base.counted.push_back(change.prior >= counted_first);
  std::vector<Combination> all;
  double sum = 0.0;
  for (std::size_t set = 0; set < std::size_t{1} << open.size(); ++set) {
    Combination one = base;
    one.weight = 1.0;
    for (std::size_t bit = 0; bit < open.size(); ++bit) {
      const bool counted = (set >> bit & 1U) != 0;
      const double p = changes[open[bit]].prior;
      one.counted[open[bit]] = counted;
      one.weight *= counted ? p : 1.0 - p;
    }
    one.weight *= likelihood_of(changes, one.counted);
    sum += one.weight;
    if (one.weight > 0.0) all.push_back(std::move(one));
  }
  if (all.empty()) {
    base.weight = sum = 1.0;
    all.push_back(base);
  }
  for (Combination& one : all) one.weight /= sum;
  std::stable_sort(all.begin(), all.end(),
                   [](const Combination& a, const Combination& b) { return a.weight > b.weight; });
  return all;
}

/// Sets the probability of each change from the combinations.
void set_probabilities(const std::vector<Combination>& combinations, std::vector<Change>& changes) {
  for (const std::size_t i : combined_changes(changes)) {
    changes[i].probability = 0.0;
    for (const Combination& one : combinations) {
      changes[i].probability += one.counted[i] ? one.weight : 0.0;
    }
  }
}

using Chosen = std::vector<bool>;

Chosen zones_of_kind(const Area& area, ZoneKind kind) {
  Chosen chosen(area.zones.size());
  for (std::size_t z = 0; z < chosen.size(); ++z) chosen[z] = area.kinds[z] == kind;
  return chosen;
}

double volume_of_kind(const Area& area, ZoneKind kind) {
  double volume = 0.0;
  for (std::size_t z = 0; z < area.zones.size(); ++z) {
    if (area.kinds[z] == kind) volume += area.zones[z].volume;
  }
  return volume;
}

/// Where nothing rose away from the hole, or too little for a heap and yet all of the soil is
/// there, the largest rise beside it, if that could hold the dug soil, is the heap.
void find_heap_beside(Area& area) {
  const double hole = -volume_of_kind(area, ZoneKind::dig);
  const double away = volume_of_kind(area, ZoneKind::dump);
  const double beside = volume_of_kind(area, ZoneKind::spill);
  const bool is_all_there =
      away < least_dumped_share * hole && away + beside >= least_bulking * hole;
  if (away > 0.0 && !is_all_there) return;
  std::size_t largest = area.zones.size();
  for (std::size_t z = 0; z < area.zones.size(); ++z) {
    if (area.kinds[z] != ZoneKind::spill) continue;
    if (largest == area.zones.size() || area.zones[z].volume > area.zones[largest].volume) {
      largest = z;
    }
  }
  if (largest == area.zones.size()) return;
  if (area.zones[largest].volume >= least_after_share * hole) area.kinds[largest] = ZoneKind::dump;
}

void set_kinds(std::vector<Area>& areas, const Attribution& attribution,
               const ChangeOptions& options) {
  if (attribution.combinations.empty()) return;
  const std::vector<bool>& counted = attribution.combinations.front().counted;
  const auto for_each_counted = [&](auto visit) {
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (!counted[i]) continue;
      for (const Change::Place& p : attribution.changes[i].zones) visit(areas[p.area], p.zone);
    }
  };
  for_each_counted([&](Area& area, std::size_t z) {
    if (area.zones[z].volume < 0.0) area.kinds[z] = ZoneKind::dig;
  });
  const Chosen beside = zones_near(areas[0].ground.zone, zones_of_kind(areas[0], ZoneKind::dig),
                                   options.spill_distance / areas[0].grid.cell_size);
  for_each_counted([&](Area& area, std::size_t z) {
    if (area.zones[z].volume < 0.0) return;
    const Eigen::Vector2d& at = area.zones[z].centre;
    const auto is_in = [&](const std::optional<Rectangle>& told) {
      return told && told->contains(at.x(), at.y());
    };
    const bool is_dumped =
        &area != areas.data() || !beside[z] || is_in(options.dump_area) || is_in(options.heap_near);
    area.kinds[z] = is_dumped ? ZoneKind::dump : ZoneKind::spill;
  });
  if (areas.size() == 1 && !options.dump_area) find_heap_beside(areas[0]);
}

}  // namespace

double likelihood_of_bulking(double k) {
  constexpr double least = 1.02, least_sd = 0.04;
  constexpr double most = 1.65, most_sd = 0.08;
  constexpr double blocks = 0.3;
  constexpr double never = 1e-3;
  const double most_in_blocks = most / (1.0 - BlockOptions{}.packed_voids);
  const auto above = [&](double limit) {
    return std::exp(-0.5 * std::pow((k - limit) / most_sd, 2));
  };
  double likelihood = 1.0;
  if (k < least) likelihood = std::exp(-0.5 * std::pow((k - least) / least_sd, 2));
  if (k > most) likelihood = std::max(above(most), blocks);
  if (k > most_in_blocks) likelihood = blocks * above(most_in_blocks);
  return never + (1.0 - never) * likelihood;
}

std::vector<std::size_t> combined_changes(const std::vector<Change>& changes) {
  double hole = 0.0;
  for (const Change& change : changes) hole = std::max(hole, -change.volume);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const bool is_large = std::abs(changes[i].volume) > negligible * hole;
    if (changes[i].is_open() && is_large) open.push_back(i);
  }
  std::stable_sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(changes[a].volume) > std::abs(changes[b].volume);
  });
  if (open.size() > most_open) open.resize(most_open);
  return open;
}

Attribution attribute(std::vector<Area>& areas, const ChangeOptions& options) {
  Attribution attribution;
  attribution.changes = read_changes(areas, options);
  attribution.combinations = combinations_of(attribution.changes);
  set_probabilities(attribution.combinations, attribution.changes);
  set_kinds(areas, attribution, options);
  return attribution;
}

}  // namespace excavplan
