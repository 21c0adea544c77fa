// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/uncertain_soil.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <utility>

#include <Eigen/Eigenvalues>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "optimisation/search_checkpoint.hpp"
#include "planning/dig_problem.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

namespace fs = std::filesystem;

/// Makes sure that no other file is in the place of a checkpoint, and, unless they are resumed,
/// removes those of an earlier search: a resume would otherwise read them if this search ends
/// before it has written its own.
void prepare_checkpoints(const DigSearchOptions& options, std::size_t soils) {
  if (options.checkpoint.empty()) return;
  std::vector<std::string> files = {options.checkpoint};
  for (std::size_t i = 0; i < soils; ++i) {
    files.push_back(checkpoint_of_soil(options.checkpoint, i));
  }
  for (const std::string& file : files) require_checkpoint_place(file);
  for (const std::string& file : files) {
    std::error_code error;
    if (!options.resume && fs::is_regular_file(file, error)) fs::remove(file, error);
  }
}

struct BestForEach {
  std::vector<Found<DigSearchResult>> soils;
  bool stopped = false;  ///< by `progress`, which then is not called again

  std::vector<KnownDig> digs() const {
    std::vector<KnownDig> all;
    for (const auto& found : soils) {
      if (found) all.emplace_back(found->dig.parameters, found->dig.start_x);
    }
    return all;
  }
  /// In any of the soils.
  std::optional<NearestDig> nearest() const {
    std::optional<NearestDig> least;
    for (const auto& found : soils) {
      if (!found.nearest || (least && least->violation <= found.nearest->violation)) continue;
      least = found.nearest;
    }
    return least;
  }
  int evaluations() const {
    int sum = 0;
    for (const auto& found : soils) sum += found ? found->evaluations : 0;
    return sum;
  }
};

/// A basin that one search misses another may find.
DigSearchOptions of_soil(const DigSearchOptions& options, std::size_t soil) {
  DigSearchOptions one = options;
  one.seed = options.seed + soil;
  one.checkpoint = checkpoint_of_soil(options.checkpoint, soil);
  return one;
}

/// In parallel, without a warm start: the best digs of two soils may be far apart.
BestForEach best_for_each(const Machine& machine, const std::vector<PossibleSoil>& soils,
                          const Terrain& terrain, const DigSearchOptions& options) {
  BestForEach best;
  std::mutex mutex;
  DigSearchOptions shared = options;
  shared.threads = 1;
  if (options.progress) {
    shared.progress = [&](const SearchProgress& progress) {
      const std::lock_guard<std::mutex> lock(mutex);
      best.stopped = best.stopped || !options.progress(progress);
      return !best.stopped;
    };
  }
  best.soils.resize(soils.size());
  parallel_for(soils.size(), options.threads, [&](std::size_t i) {
    best.soils[i] = search_dig(machine, *soils[i].simulator, terrain, of_soil(shared, i));
  });
  return best;
}

/// Nothing but a polish of the digs given, by the default method.
DigSearchOptions from_known(const DigSearchOptions& options, std::vector<KnownDig> start) {
  DigSearchOptions polish = options;
  if (auto* memetic = std::get_if<MemeticSearch>(&polish.method)) {
    memetic->generations = 0;
    memetic->first_generation = 0;
  }
  polish.start = std::move(start);
  return polish;
}

/// Nothing but the digs given. They are those of searches not finished: a checkpoint of this one
/// would be of no use to the next.
DigSearchOptions only_known(const DigSearchOptions& options, std::vector<KnownDig> start) {
  DigSearchOptions known = options;
  MemeticSearch no_search;
  no_search.first_generation = no_search.generations = no_search.basins = 0;
  known.method = no_search;
  known.start = std::move(start);
  known.progress = {};
  known.checkpoint = {};
  return known;
}

Found<UncertainDigSearchResult> found_nothing(std::optional<NearestDig> nearest, bool stopped) {
  Found<UncertainDigSearchResult> none;
  none.nearest = std::move(nearest);
  none.stopped = stopped;
  return none;
}

}  // namespace

void require_own_checkpoint(const Machine& machine, const std::vector<PossibleSoil>& soils,
                            const Terrain& terrain, const DigSearchOptions& options) {
  if (!options.resume) return;
  for (std::size_t i = 0; i < soils.size(); ++i) {
    require_own_checkpoint(machine, *soils[i].simulator, terrain, of_soil(options, i));
  }
  const DigSearchOptions together = from_known(options, {});
  DigProblem(machine, soils, terrain, together).require_own_checkpoint();
}

std::string checkpoint_of_soil(const std::string& checkpoint, std::size_t soil) {
  return checkpoint.empty() ? checkpoint : checkpoint + ".soil" + std::to_string(soil + 1);
}

Found<UncertainDigSearchResult> search_dig(const Machine& machine,
                                           const std::vector<PossibleSoil>& soils,
                                           const Terrain& terrain,
                                           const DigSearchOptions& options) {
  check(soils);
  check(options, machine);
  prepare_checkpoints(options, soils.size());
  require_own_checkpoint(machine, soils, terrain, options);
  const BestForEach best = best_for_each(machine, soils, terrain, options);
  if (best.digs().empty()) return found_nothing(best.nearest(), best.stopped);
  const DigSearchOptions from_bests =
      best.stopped ? only_known(options, best.digs()) : from_known(options, best.digs());
  DigProblem problem(machine, soils, terrain, from_bests);
  const SearchResult found = problem.run();
  if (!found.feasible()) {
    return found_nothing(problem.nearest_of(found), found.stopped_by == StopReason::cancelled);
  }
  UncertainDigSearchResult result;
  DigProblem::Best mean = problem.best_of(found);
  result.expected = std::move(mean.result);
  if (best.stopped) {
    result.expected.stopped = true;
    result.expected.stopped_by = StopReason::cancelled;
  }
  result.evaluations = best.evaluations() + found.evaluations * static_cast<int>(soils.size());
  for (std::size_t i = 0; i < soils.size(); ++i) {
    const auto* dig = std::get_if<PlannedDig>(&mean.digs[i]);
    const double same = dig ? options.objective.worth(*dig) : 0.0;  // a stall is worth nothing
    const auto& own = best.soils[i];
    result.worth_if_known += soils[i].probability * (own ? std::max(own->worth, same) : same);
  }
  return result;
}

DigSpread dig_spread(const Machine& machine, const std::vector<PossibleSoil>& soils,
                     const Terrain& terrain, const PlannedDig& dig, const DigPath& path) {
  check(soils);
  const DigsInEach digs = dig_in_each(machine, soils, terrain, path);
  DigSpread spread;
  Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
  double probability = 0.0;
  for (std::size_t i = 0; i < digs.size(); ++i) {
    const auto* dug = std::get_if<PlannedDig>(&digs[i]);
    if (!dug) {
      spread.stall_probability += soils[i].probability;
      continue;
    }
    const Eigen::Array3d off(dug->payload_mass - dig.payload_mass, dug->energy - dig.energy,
                             dug->efficiency() - dig.efficiency());
    probability += soils[i].probability;
    sum += soils[i].probability * off;
    squares += soils[i].probability * off.square();
  }
  if (probability == 0.0) return spread;
  const Eigen::Array3d mean = sum / probability;
  const Eigen::Array3d sd = (squares / probability - mean.square()).max(0.0).sqrt();
  return {sd(0), sd(1), sd(2), spread.stall_probability};
}

std::vector<PossibleDensity> possible_densities(double mean_percent, double sd_percent, int count) {
  require(mean_percent >= 0.0 && mean_percent <= 100.0, "the mean density", mean_percent,
          "in 0 .. 100 %");
  require(sd_percent > 0.0 && std::isfinite(sd_percent), "the standard deviation of the density",
          sd_percent, "above 0 and finite");
  sd_percent = std::min(sd_percent, 1000.0);  // above it all densities are equally likely
  require(count >= 1 && count <= most_possible_densities, "the number of possible densities", count,
          "in 1 .. " + std::to_string(most_possible_densities));
  // Three-term recurrence of the polynomials orthogonal under the density on a fine grid
  // (Stieltjes), then the eigenvalues of its matrix (Golub and Welsch 1969).
  constexpr Index fine = 4000;
  const double low = std::max(0.0, mean_percent - 10.0 * sd_percent);
  const double high = std::min(100.0, mean_percent + 10.0 * sd_percent);
  const Eigen::ArrayXd x = (Eigen::ArrayXd::LinSpaced(fine, 0.5, fine - 0.5) / fine - 0.5) * 2.0;
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  Eigen::ArrayXd weight = (-0.5 * ((middle + half * x - mean_percent) / sd_percent).square()).exp();
  weight /= weight.sum();
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(count, count);
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(fine);
  Eigen::ArrayXd now = Eigen::ArrayXd::Ones(fine);  // orthonormal
  double link = 0.0;
  for (int i = 0; i < count; ++i) {
    jacobi(i, i) = (weight * x * now.square()).sum();
    if (i + 1 == count) break;
    Eigen::ArrayXd next = (x - jacobi(i, i)) * now - link * before;
    link = std::sqrt((weight * next.square()).sum());
    jacobi(i, i + 1) = jacobi(i + 1, i) = link;
    before = std::exchange(now, next / link);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(jacobi);
  std::vector<PossibleDensity> densities;
  densities.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    densities.push_back(
        {middle + half * solved.eigenvalues()(i), std::pow(solved.eigenvectors()(0, i), 2)});
  }
  return densities;
}

void require_density(const GroundDensity& density) {
  require(density.percent >= 0.0 && density.percent <= 100.0, "the density", density.percent,
          "in 0 .. 100 %");
  require(density.sd_percent >= 0.0 && std::isfinite(density.sd_percent),
          "the standard deviation of the density", density.sd_percent, "at least 0 and finite");
}

PossibleGround::PossibleGround(const SimulatorKind& simulator, const Machine& machine,
                               const SoilKind& soil, const GroundDensity& density) {
  require_density(density);
  std::vector<PossibleDensity> densities = {{density.percent, 1.0}};
  if (density.sd_percent > 0.0) {
    densities = possible_densities(density.percent, density.sd_percent);
  }
  for (const auto& [percent, probability] : densities) {
    simulators_.push_back(make_simulator(simulator, machine, soil, percent));
    soils_.push_back({simulators_.back().get(), probability});
  }
}

}  // namespace excavplan
