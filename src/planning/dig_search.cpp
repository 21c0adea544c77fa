// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include <Eigen/Eigenvalues>

#include <excavplan/error.hpp>
#include <excavplan/planning/planner.hpp>

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "optimisation/search_points.hpp"
#include "planning/dig_layout.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

void require(bool holds, const std::string& what, double value, const char* rule) {
  if (holds) return;
  throw Error(ErrorKind::bad_input, what + " is " + number_text(value) + ", must be " + rule);
}

void check(const std::vector<PossibleSoil>& soils) {
  double sum = 0.0;
  for (const PossibleSoil& soil : soils) {
    require(soil.simulator && soil.probability > 0.0, "the probability of a soil", soil.probability,
            "above 0, with a simulator");
    sum += soil.probability;
  }
  require(std::abs(sum - 1.0) < 1e-9, "the probability of all soils", sum, "1");
}

void check(const DigSearchOptions& options) {
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const double lower = options.bounds.lower.*info.field;
    const double upper = options.bounds.upper.*info.field;
    const std::string what = std::string("the search range of ") + info.name;
    require(lower >= 0.0 && std::isfinite(lower), what + " from", lower, "finite and at least 0");
    require(upper >= lower && std::isfinite(upper), what + " to", upper,
            "finite and not below its lower end");
  }
  const DigObjective& objective = options.objective;
  require(objective.time_price >= 0.0 && std::isfinite(objective.time_price), "the price of time",
          objective.time_price, "at least 0 W and finite");
  require(objective.rest_of_cycle >= 0.0 && std::isfinite(objective.rest_of_cycle),
          "the rest of the cycle", objective.rest_of_cycle, "at least 0 s and finite");
}

/// The checksum of numbers, byte by byte.
class Fingerprint {
 public:
  void add(double value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
  }
  void add(const Eigen::ArrayXXd& values) {
    add(static_cast<double>(values.rows()));
    add(static_cast<double>(values.cols()));
    for (Index i = 0; i < values.size(); ++i) add(values(i));
  }
  void add(const std::variant<PlannedDig, DigFailure>& outcome) {
    add(static_cast<double>(outcome.index()));
    if (const auto* dig = std::get_if<PlannedDig>(&outcome)) {
      for (const double value :
           {dig->payload_mass, dig->payload_volume, dig->energy, dig->duration}) {
        add(value);
      }
    } else if (const auto* stall = std::get_if<Stall>(&std::get<DigFailure>(outcome))) {
      for (const double value :
           {static_cast<double>(stall->phase), static_cast<double>(stall->joint), stall->travelled,
            stall->torque}) {
        add(value);
      }
    }
  }
  std::string text() const { return checksum_text(bytes_); }

 private:
  std::string bytes_;
};

/// All that decides the digs of a simulator: its own words, or what it says of a few digs, from the
/// paper's down to short ones that few machines and soils forbid.
std::string identity_of(const SoilSimulator& simulator, const Machine& machine) {
  std::string own = simulator.identity();
  if (!own.empty()) return own;
  const Terrain level = level_planning_ground(machine, 0.1);
  Fingerprint hash;
  for (const double share : {1.0, 0.5, 0.25}) {
    DigParameters dig = paper_fixed_path();
    dig.penetration_length *= share;
    dig.drag_length *= share;
    hash.add(evaluate_dig(machine, simulator, level, dig));
  }
  return "a simulator of digs " + hash.text();
}

/// A dig along one path in each of the soils.
using DigsInEach = std::vector<std::variant<PlannedDig, DigFailure>>;

DigsInEach dig_in_each(const Machine& machine, const std::vector<PossibleSoil>& soils,
                       const Terrain& terrain, const DigPath& path) {
  DigsInEach digs;
  for (const PossibleSoil& soil : soils) {
    digs.push_back(dig_along(machine, *soil.simulator, terrain, path));
  }
  return digs;
}

/// The start, where it is searched, follows the numbers of the table.
double start_in(const VectorXd& point) { return point(point.size() - 1); }

void append(VectorXd& point, double number) {
  point.conservativeResize(point.size() + 1);
  point(point.size() - 1) = number;
}

/// The search for a dig as a search of a box.
class DigProblem {
 public:
  DigProblem(const Machine& machine, const std::vector<PossibleSoil>& soils, const Terrain& terrain,
             const DigSearchOptions& options)
      : soils_(soils), terrain_(terrain), options_(options), layout_(machine, terrain) {
    check(options);
  }

  SearchResult run() {
    SearchOptions search_options{options_, {}};
    for (const DigParameters& dig : options_.start) search_options.start.push_back(point_of(dig));
    SearchProblem problem{box(), [this](const VectorXd& point) { return simulate(point); },
                          [this](const VectorXd& point) { return lay_out(point); }};
    if (!options_.checkpoint.empty()) problem.fingerprint = fingerprint();
    return search(problem, search_options);
  }

  /// @return nothing if nothing was looked at
  std::optional<NearestDig> nearest_of(const SearchResult& found) const {
    if (found.history.empty()) return std::nullopt;
    return NearestDig{to_dig_parameters(found.best), start_of(found.best), found.outcome.violation,
                      found.outcome.reason};
  }

  DigsInEach best_digs(const SearchResult& found) const { return dig_all(path_of(found.best)); }

  /// @param digs  best_digs()
  DigSearchResult result_of(const SearchResult& found, const DigsInEach& digs) const {
    DigSearchResult result;
    result.dig = *mean_dig(digs);
    result.worth = found.outcome.fitness;
    result.evaluations = found.evaluations;
    result.refused = found.repair;
    result.infeasible = found.infeasible;
    result.stopped = found.stopped_by == StopReason::cancelled;
    result.stopped_by = found.stopped_by;
    result.insight = explain(box(), found);
    return result;
  }

 private:
  bool start_is_searched() const { return options_.start_rule.kind == StartRule::Kind::searched; }

  SearchBox box() const {
    const Machine& machine = layout_.machine();
    SearchBox box{to_vector(options_.bounds.lower), to_vector(options_.bounds.upper)};
    if (start_is_searched()) {
      append(box.lower, machine.track_front);
      append(box.upper, machine.boom_pin.x() + machine.full_length());
    }
    return box;
  }

  VectorXd point_of(const DigParameters& dig) const {
    VectorXd point = to_vector(dig);
    if (start_is_searched()) {
      const auto path = layout_.path(dig, StartRule::Kind::least_work);
      const auto* drivable = std::get_if<DigPath>(&path);
      append(point,
             drivable ? drivable->start_x : 0.5 * (start_in(box().lower) + start_in(box().upper)));
    }
    return point;
  }

  /// The repair: an undrivable path is refused, the start of a drivable one is kept for later.
  std::variant<VectorXd, Evaluation> lay_out(const VectorXd& point) {
    const DigParameters parameters = to_dig_parameters(point);
    const auto path = layout_.path(
        parameters, start_is_searched() ? StartRule(start_in(point)) : options_.start_rule);
    if (const auto* stop = std::get_if<Infeasible>(&path)) {
      return Evaluation::infeasible(violation(*stop, parameters), stop->message);
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    starts_[key_of(point)] = std::get<DigPath>(path).start_x;
    return point;
  }

  DigsInEach dig_all(const DigPath& path) const {
    return dig_in_each(layout_.machine(), soils_, terrain_, path);
  }

  Evaluation simulate(const VectorXd& point) const {
    const DigPath path = path_of(point);
    const DigsInEach digs = dig_all(path);
    double worth = 0.0;
    const DigFailure* failure = nullptr;
    bool any = false;
    for (std::size_t i = 0; i < digs.size(); ++i) {
      if (const auto* dig = std::get_if<PlannedDig>(&digs[i])) {
        worth += soils_[i].probability * options_.objective.worth(*dig);
        any = true;
      } else if (!failure) {
        failure = &std::get<DigFailure>(digs[i]);
      }
    }
    if (any) return worth;
    return Evaluation::infeasible(violation(*failure, path.parameters), describe(*failure));
  }

  /// Means over the soils in which the machine does not stall.
  std::optional<PlannedDig> mean_dig(const DigsInEach& digs) const {
    std::optional<PlannedDig> mean;
    double probability = 0.0;
    for (std::size_t i = 0; i < digs.size(); ++i) {
      const auto* dig = std::get_if<PlannedDig>(&digs[i]);
      if (!dig) continue;
      probability += soils_[i].probability;
      const double share = soils_[i].probability / probability;
      if (!mean) mean = *dig;
      mean->payload_mass += share * (dig->payload_mass - mean->payload_mass);
      mean->payload_volume += share * (dig->payload_volume - mean->payload_volume);
      mean->energy += share * (dig->energy - mean->energy);
    }
    return mean;
  }

  /// Nothing for a path that was not laid out, unless its start is no matter of the path.
  std::optional<double> start_of(const VectorXd& point) const {
    if (start_is_searched()) return start_in(point);
    if (options_.start_rule.kind == StartRule::Kind::given) return options_.start_rule.x;
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = starts_.find(key_of(point));
    return known != starts_.end() ? std::optional(known->second) : std::nullopt;
  }

  DigPath path_of(const VectorXd& point) const {
    const std::optional<double> start_x = start_of(point);
    const auto path =
        layout_.path(to_dig_parameters(point), start_x ? StartRule(*start_x) : options_.start_rule);
    return std::get<DigPath>(path);
  }

  /// All that decides the worth of a dig.
  std::string fingerprint() const {
    Fingerprint ground;
    ground.add(terrain_.bank.origin.x());
    ground.add(terrain_.bank.origin.y());
    ground.add(terrain_.bank.cell_size);
    for (const Eigen::ArrayXXd* layer : {&terrain_.bank.z, &terrain_.loose,
                                         &terrain_.bank_void_ratio, &terrain_.loose_void_ratio}) {
      ground.add(*layer);
    }
    Fingerprint worth;
    worth.add(static_cast<double>(options_.objective.goal));
    worth.add(options_.objective.time_price);
    worth.add(options_.objective.rest_of_cycle);
    worth.add(static_cast<double>(options_.start_rule.kind));
    worth.add(options_.start_rule.x);
    const Machine& machine = layout_.machine();
    std::string text = "dig on " + machine.name + " " + excavplan::fingerprint(machine) +
                       ", ground " + ground.text() + ", worth " + worth.text();
    for (const PossibleSoil& soil : soils_) {
      text += ", with probability " + number_text(soil.probability) + " in " +
              identity_of(*soil.simulator, machine);
    }
    return text;
  }

  const std::vector<PossibleSoil>& soils_;
  const Terrain& terrain_;
  const DigSearchOptions& options_;
  DigLayout layout_;
  mutable std::mutex mutex_;
  std::map<PointKey, double> starts_;  ///< of the drivable paths looked at
};

template <typename Result>
Found<Result> nothing(std::optional<NearestDig> nearest) {
  Found<Result> none;
  none.nearest = std::move(nearest);
  return none;
}

std::string checkpoint_of_soil(const std::string& checkpoint, std::size_t i) {
  return checkpoint.empty() ? checkpoint : checkpoint + ".soil" + std::to_string(i + 1);
}

/// Of an earlier search: should this one end before it has written all of its own, resuming it
/// would meet them.
void remove_checkpoints(const std::string& checkpoint, std::size_t soils) {
  std::vector<std::string> files = {checkpoint};
  for (std::size_t i = 0; i < soils; ++i) files.push_back(checkpoint_of_soil(checkpoint, i));
  for (const std::string& file : files) {
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) std::filesystem::remove(file, error);
  }
}

struct BestForEach {
  std::vector<Found<DigSearchResult>> soils;
  bool stopped = false;  ///< by `progress`, which then is not asked again

  std::vector<DigParameters> digs() const {
    std::vector<DigParameters> all;
    for (const auto& found : soils) {
      if (found) all.push_back(found->dig.parameters);
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

/// Side by side, each from nothing: the best dig for one soil need not be near that for another.
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
    DigSearchOptions one = shared;
    one.seed = options.seed + i;  // what one overlooks another may see
    one.checkpoint = checkpoint_of_soil(options.checkpoint, i);
    best.soils[i] = search_dig(machine, *soils[i].simulator, terrain, one);
  });
  return best;
}

/// Nothing but a polish of the digs given, by the default method.
DigSearchOptions from_known(const DigSearchOptions& options, std::vector<DigParameters> start) {
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
DigSearchOptions only_known(const DigSearchOptions& options, std::vector<DigParameters> start) {
  DigSearchOptions known = options;
  MemeticSearch no_search;
  no_search.first_generation = no_search.generations = no_search.basins = 0;
  known.method = no_search;
  known.start = std::move(start);
  known.progress = {};
  known.checkpoint = {};
  return known;
}

}  // namespace

double DigObjective::worth(const PlannedDig& dig) const {
  const double time = dig.duration + rest_of_cycle;
  const double cost = goal == Goal::mass_per_energy ? dig.energy
                      : goal == Goal::mass_per_time ? time
                                                    : dig.energy + time_price * time;
  return cost > 0.0 ? dig.payload_mass / cost : 0.0;
}

DigBounds::DigBounds() {
  for (const DigParameterInfo& info : dig_parameter_table()) {
    lower.*info.field = info.lower;
    upper.*info.field = info.upper;
  }
}

Found<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                  const Terrain& terrain, const DigSearchOptions& options) {
  const std::vector<PossibleSoil> soils = {{&simulator, 1.0}};
  DigProblem problem(machine, soils, terrain, options);
  const SearchResult found = problem.run();
  if (!found.feasible()) return nothing<DigSearchResult>(problem.nearest_of(found));
  return problem.result_of(found, problem.best_digs(found));
}

Found<UncertainDigSearchResult> search_dig(const Machine& machine,
                                           const std::vector<PossibleSoil>& soils,
                                           const Terrain& terrain,
                                           const DigSearchOptions& options) {
  check(soils);
  check(options);
  if (!options.checkpoint.empty() && !options.resume) {
    remove_checkpoints(options.checkpoint, soils.size());
  }
  const BestForEach best = best_for_each(machine, soils, terrain, options);
  if (best.digs().empty()) return nothing<UncertainDigSearchResult>(best.nearest());
  const DigSearchOptions from_bests =
      best.stopped ? only_known(options, best.digs()) : from_known(options, best.digs());
  DigProblem problem(machine, soils, terrain, from_bests);
  const SearchResult found = problem.run();
  if (!found.feasible()) return nothing<UncertainDigSearchResult>(problem.nearest_of(found));
  UncertainDigSearchResult result;
  const DigsInEach digs = problem.best_digs(found);
  result.expected = problem.result_of(found, digs);
  if (best.stopped) {
    result.expected.stopped = true;
    result.expected.stopped_by = StopReason::cancelled;
  }
  result.evaluations = best.evaluations() + found.evaluations * static_cast<int>(soils.size());
  for (std::size_t i = 0; i < soils.size(); ++i) {
    const auto* dig = std::get_if<PlannedDig>(&digs[i]);
    const double same = dig ? options.objective.worth(*dig) : 0.0;  // a stall is worth nothing
    const auto& own = best.soils[i];
    result.worth_if_known += soils[i].probability * (own ? std::max(own->worth, same) : same);
  }
  return result;
}

DigSpread dig_spread(const Machine& machine, const std::vector<PossibleSoil>& soils,
                     const Terrain& terrain, const PlannedDig& dig) {
  check(soils);
  const auto path = DigLayout(machine, terrain).path(dig.parameters, StartRule(dig.start_x));
  if (const auto* stop = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "the dig cannot be driven: " + stop->message);
  }
  const DigsInEach digs = dig_in_each(machine, soils, terrain, std::get<DigPath>(path));
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
  require(count >= 1 && count <= 20, "the number of possible densities", count, "in 1 .. 20");
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
  for (int i = 0; i < count; ++i) {
    densities.push_back(
        {middle + half * solved.eigenvalues()(i), std::pow(solved.eigenvectors()(0, i), 2)});
  }
  return densities;
}

}  // namespace excavplan
