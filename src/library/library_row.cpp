// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "library/library_row.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace excavplan {
namespace {

// Distances between two densities [%]; ours. Where entries are farther apart, what is best amid
// them cannot be told from them.
constexpr double coarsest = 10.0;
constexpr double finest = 1.0;

// What a dig may be worse than the line through two others on both sides, or on one, without being
// suspect; of an efficiency, ours.
constexpr double slack_between = 0.005;
constexpr double slack_beyond = 0.01;

double middle_of(const LibraryRow::Pair& pair) { return 0.5 * (pair.first + pair.second); }

}  // namespace

LibraryCell LibraryRow::cell(double density) const {
  LibraryCell cell = row_;
  cell.density_percent = density;
  return cell;
}

const PathLibraryEntry* LibraryRow::entry(double density) const {
  const auto found = outcomes_.find(density);
  return found != outcomes_.end() && found->second.entry ? &*found->second.entry : nullptr;
}

void LibraryRow::take(double density, const CellOutcome& outcome) {
  outcomes_.emplace(density, outcome);
}

std::vector<LibraryRow::Pair> LibraryRow::unmeasured() const {
  std::vector<Pair> pairs;
  for (auto above = std::next(densities_.begin()); above != densities_.end(); ++above) {
    const Pair pair{*std::prev(above), *above};
    if (midways_.count(pair) == 0 && entry(pair.first) && entry(pair.second)) {
      pairs.push_back(pair);
    }
  }
  return pairs;
}

/// Of up to four entries around.
double LibraryRow::expected_best(const Pair& pair) const {
  auto from = densities_.find(pair.first);
  auto to = densities_.find(pair.second);
  if (from != densities_.begin() && entry(*std::prev(from))) --from;
  if (std::next(to) != densities_.end() && entry(*std::next(to))) ++to;
  std::vector<std::pair<double, double>> known;
  for (auto i = from; i != std::next(to); ++i) known.push_back({*i, entry(*i)->dig.efficiency()});
  return expected_between(known, middle_of(pair));
}

Midway LibraryRow::measure(const Pair& pair, double cell_size) const {
  return measure_midway(cell(middle_of(pair)), cell_size, entry(pair.first)->dig,
                        entry(pair.second)->dig, expected_best(pair));
}

void LibraryRow::take(const Pair& pair, const Midway& midway) {
  midways_[pair] = midway;
  outcomes_.at(pair.first).entry->evaluations += midway.evaluations;
}

std::vector<double> LibraryRow::line_to(double density) const {
  const auto place = densities_.find(density);
  const bool first = place == densities_.begin();
  const bool last = std::next(place) == densities_.end();
  if (densities_.size() < 3) return {};
  std::vector<double> line = {first ? *std::next(place) : *std::prev(place),
                              first  ? *std::next(place, 2)
                              : last ? *std::prev(place, 2)
                                     : *std::next(place)};
  for (const double one : line) {
    const bool far = std::abs(one - density) > (first || last ? 2.0 : 1.0) * coarsest;
    if (far || !entry(one)) return {};
  }
  return line;
}

bool LibraryRow::below_the_line(double density) const {
  const PathLibraryEntry* own = entry(density);
  const std::vector<double> line = line_to(density);
  if (own == nullptr || line.empty()) return false;
  const PlannedDig& near = entry(line[0])->dig;
  const PlannedDig& other = entry(line[1])->dig;
  if (far_apart(near, other) || far_apart(own->dig, near)) return false;
  const bool between = (line[0] < density) != (line[1] < density);
  const double expected =
      expected_between({{line[0], near.efficiency()}, {line[1], other.efficiency()}}, density);
  return own->dig.efficiency() < (1.0 - (between ? slack_between : slack_beyond)) * expected;
}

std::vector<LibraryRow::Look> LibraryRow::looks_due() const {
  using Better = Midway::Better;
  std::vector<Look> looks;
  for (const auto& [pair, midway] : midways_) {
    if (midway.better == Better::below) looks.push_back({pair.second, pair.first});
    if (midway.better == Better::above) looks.push_back({pair.first, pair.second});
  }
  for (const double density : densities_) {
    if (below_the_line(density)) looks.push_back({density, density});
  }
  const auto done = [this](const Look& look) {
    return looked_.count({look.density, look.from}) == 1;
  };
  looks.erase(std::remove_if(looks.begin(), looks.end(), done), looks.end());
  return looks;
}

std::vector<CellOutcome> LibraryRow::starts_of(const Look& look) const {
  std::vector<CellOutcome> starts;
  if (look.from == look.density) {
    for (const double density : line_to(look.density)) starts.push_back(outcomes_.at(density));
    return starts;
  }
  starts.push_back(outcomes_.at(look.from));
  const auto near = densities_.find(look.from);
  const PathLibraryEntry* next = nullptr;
  if (look.from > look.density && std::next(near) != densities_.end()) {
    next = entry(*std::next(near));
  } else if (look.from < look.density && near != densities_.begin()) {
    next = entry(*std::prev(near));
  }
  if (next != nullptr && !far_apart(starts.front().entry->dig, next->dig)) {
    starts.push_back(outcomes_.at(next->density_percent));
  }
  return starts;
}

void LibraryRow::take(const Look& look, const CellOutcome& outcome) {
  looked_.insert({look.density, look.from});
  PathLibraryEntry& known = *outcomes_.at(look.density).entry;
  known.evaluations += outcome.evaluations;
  if (!outcome.entry || outcome.entry->dig.efficiency() <= known.dig.efficiency()) return;
  known.dig = outcome.entry->dig;
  forget_what_used(look.density);
}

void LibraryRow::forget_what_used(double density) {
  for (auto i = midways_.begin(); i != midways_.end();) {
    const bool used = i->first.first == density || i->first.second == density;
    i = used ? midways_.erase(i) : std::next(i);
  }
  for (auto i = looked_.begin(); i != looked_.end();) {
    const std::vector<double> line = line_to(i->first);
    const bool used = i->first == i->second
                          ? std::find(line.begin(), line.end(), density) != line.end()
                          : i->second == density;
    i = used ? looked_.erase(i) : std::next(i);
  }
}

bool LibraryRow::worth_refining(const Pair& pair, double share) const {
  const double distance = pair.second - pair.first;
  if (distance < 2.0 * finest) return false;
  return distance > coarsest || midways_.at(pair).error.loss > share;
}

bool LibraryRow::refine(double share) {
  std::vector<Pair> wide;
  for (auto above = std::next(densities_.begin()); above != densities_.end(); ++above) {
    const Pair pair{*std::prev(above), *above};
    if (midways_.count(pair) == 1 && worth_refining(pair, share)) wide.push_back(pair);
  }
  for (const Pair& pair : wide) {
    densities_.insert(middle_of(pair));
    midways_.erase(pair);
  }
  return !wide.empty();
}

void LibraryRow::add_to(PathLibrary& library) const {
  for (auto density = densities_.begin(); density != densities_.end(); ++density) {
    const PathLibraryEntry* known = entry(*density);
    if (known == nullptr) {
      library.gaps.push_back({*density, row_.slope});
      continue;
    }
    library.entries.push_back(*known);
    if (std::next(density) == densities_.end()) continue;
    const auto midway = midways_.find({*density, *std::next(density)});
    if (midway == midways_.end()) continue;
    library.entries.back().midway = midway->second.error;
    library.entries.back().jump = midway->second.jump;
  }
}

}  // namespace excavplan
