// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "library/library_midway.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <excavplan/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

namespace excavplan {
namespace {

constexpr double near = 0.2;            // of a number's search range; ours
constexpr double clearly_more = 0.005;  // of an efficiency; ours

std::optional<PlannedDig> dig_in(const PathLibrary& library, double density, double slope) {
  try {
    return look_up(library, density, slope);
  } catch (const Error&) {
    return std::nullopt;  // beside a gap
  }
}

/// Of the entry and the next slope; nothing if there is no dig there.
/// @param own  its slope's place among all
std::optional<SlopeGap> slope_gap(const PathLibrary& library, std::size_t entry,
                                  const std::vector<double>& slopes, std::size_t own) {
  const double density = library.entries[entry].density_percent;
  std::vector<std::pair<double, double>> around;  // slope and efficiency
  for (std::size_t i = own > 0 ? own - 1 : 0; i < std::min(own + 3, slopes.size()); ++i) {
    const auto dig = dig_in(library, density, slopes[i]);
    if (dig) around.push_back({slopes[i], dig->efficiency()});
    if (!dig && i == own + 1) return std::nullopt;
  }
  const double middle = 0.5 * (slopes[own] + slopes[own + 1]);
  return SlopeGap{entry,
                  density,
                  middle,
                  library.entries[entry].dig,
                  look_up(library, density, slopes[own + 1]),
                  expected_between(around, middle)};
}

/// A dig looked up midway, dug.
struct MidwayDig {
  MidwayError error;
  double efficiency = 0.0;  ///< [kg/J]; 0 if it cannot be dug
};

/// @param best  efficiency of the best dig in the cell
MidwayDig dig_midway(const LibraryCell& midway, double cell_size, const PlannedDig& looked_up,
                     double best) {
  const Terrain ground = sloped_planning_ground(*midway.machine, midway.slope, cell_size);
  const HeightMapSimulator simulator(*midway.machine, *midway.soil, midway.density_percent);
  auto outcome = evaluate_dig(*midway.machine, simulator, ground, looked_up.parameters,
                              StartRule(looked_up.start_x));
  if (const auto* failure = std::get_if<DigFailure>(&outcome);
      failure != nullptr && std::holds_alternative<Infeasible>(*failure)) {
    outcome = evaluate_dig(*midway.machine, simulator, ground, looked_up.parameters,
                           DigSearchOptions{}.start_rule);
  }
  const auto* driven = std::get_if<PlannedDig>(&outcome);
  const double efficiency = driven ? driven->efficiency() : 0.0;
  return {{std::clamp(1.0 - efficiency / best, 0.0, 1.0),
           driven ? looked_up.efficiency() / efficiency - 1.0 : 0.0},
          efficiency};
}

}  // namespace

bool far_apart(const PlannedDig& a, const PlannedDig& b) {
  const auto& table = dig_parameter_table();
  return std::any_of(table.begin(), table.end(), [&](const DigParameterInfo& info) {
    const double step = std::abs(a.parameters.*info.field - b.parameters.*info.field);
    return step > near * (info.upper - info.lower);
  });
}

PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share, bool jump) {
  if (share == 0.0) return a;
  if (jump) return share < 0.5 ? a : b;
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  PlannedDig dig = a;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    dig.parameters.*info.field = mix(a.parameters.*info.field, b.parameters.*info.field);
  }
  dig.start_x = mix(a.start_x, b.start_x);
  dig.payload_mass = mix(a.payload_mass, b.payload_mass);
  dig.payload_volume = mix(a.payload_volume, b.payload_volume);
  dig.energy = mix(a.energy, b.energy);
  dig.duration = mix(a.duration, b.duration);
  return dig;
}

double expected_between(const std::vector<std::pair<double, double>>& known, double place) {
  double sum = 0.0;
  for (const auto& [own, value] : known) {
    double weight = std::log(value);
    for (const auto& [other, unused] : known) {
      if (other != own) weight *= (place - other) / (own - other);
    }
    sum += weight;
  }
  return std::exp(sum);
}

Midway measure_midway(const LibraryCell& midway, double cell_size, const PlannedDig& below,
                      const PlannedDig& above, double best) {
  const auto dig = [&](const PlannedDig& looked_up) {
    return dig_midway(midway, cell_size, looked_up, best);
  };
  const MidwayDig mix = dig(dig_between(below, above, 0.5, false));
  if (!far_apart(below, above)) return {mix.error, 1};
  const MidwayDig lower = dig(below);
  const MidwayDig upper = dig(above);
  const MidwayDig& worse = upper.efficiency < lower.efficiency ? upper : lower;
  Midway found;
  found.evaluations = 3;
  found.jump = mix.efficiency < worse.efficiency;
  found.error = found.jump ? worse.error : mix.error;
  const double least = (1.0 - clearly_more) * std::max(upper.efficiency, lower.efficiency);
  if (upper.efficiency < least) found.better = Midway::Better::below;
  if (lower.efficiency < least) found.better = Midway::Better::above;
  return found;
}

std::vector<SlopeGap> slope_gaps(const PathLibrary& library) {
  std::vector<double> slopes;
  for (const PathLibraryEntry& entry : library.entries) {
    if (slopes.empty() || entry.slope != slopes.back()) slopes.push_back(entry.slope);
  }
  std::vector<SlopeGap> gaps;
  std::size_t own = 0;
  for (std::size_t i = 0; i < library.entries.size(); ++i) {
    if (library.entries[i].slope != slopes[own]) ++own;
    if (own + 1 == slopes.size()) break;
    if (auto gap = slope_gap(library, i, slopes, own)) gaps.push_back(*gap);
  }
  return gaps;
}

}  // namespace excavplan
