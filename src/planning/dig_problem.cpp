// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/dig_problem.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <excavplan/optimisation/search.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "optimisation/search_checkpoint.hpp"
#include "planning/planned_digs.hpp"
#include "planning/simulated_dig.hpp"
#include "planning/start_rule.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The start, where it is searched, follows the numbers of the table.
double start_in(const VectorXd& point) { return point(point.size() - 1); }

void append(VectorXd& point, double number) {
  point.conservativeResize(point.size() + 1);
  point(point.size() - 1) = number;
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
  void add(const Terrain& terrain) {
    add(terrain.bank.origin.x());
    add(terrain.bank.origin.y());
    add(terrain.bank.cell_size);
    for (const Eigen::ArrayXXd* layer :
         {&terrain.bank.z, &terrain.loose, &terrain.bank_void_ratio, &terrain.loose_void_ratio}) {
      add(*layer);
    }
  }
  void add(const std::variant<PlannedDig, DigFailure>& outcome) {
    add(static_cast<double>(outcome.index()));
    if (const auto* dig = std::get_if<PlannedDig>(&outcome)) {
      for (double PlannedDig::*figure : dig_figures) add(dig->*figure);
    } else if (const auto* stall = std::get_if<Stall>(&std::get<DigFailure>(outcome))) {
      for (const double value :
           {static_cast<double>(stall->phase), static_cast<double>(stall->joint), stall->travelled,
            stall->torque, static_cast<double>(stall->cause), stall->needed}) {
        add(value);
      }
    }
  }
  void add(const std::string& text) { bytes_ += text; }
  std::string text() const { return checksum_text(bytes_); }

 private:
  std::string bytes_;
};

constexpr double DigPathOptions::*path_rules[] = {
    &DigPathOptions::step, &DigPathOptions::min_heel_clearance, &DigPathOptions::max_depth,
    &DigPathOptions::track_margin, &DigPathOptions::lift_clearance};

constexpr std::size_t most_laid = 200;  // paths kept until they are simulated; ours

/// Why the first dig failed that did; empty if none did.
std::string first_failure(const SearchResult& found) {
  for (const SearchRecord& record : found.history) {
    const auto status = record.outcome.status;
    if (record.source == SearchRecord::Source::simulated &&
        (status == Evaluation::Status::failed || status == Evaluation::Status::timed_out)) {
      return record.outcome.reason;
    }
  }
  return {};
}

std::vector<double> ranks_of(const SearchResult& found) {
  std::vector<double> ranks;
  for (const SearchRecord& record : found.history) {
    if (record.source == SearchRecord::Source::simulated) ranks.push_back(record.outcome.fitness);
  }
  return ranks;
}

/// SoilSimulator::identity(), or if it has none the checksum of three digs, from the paper's path
/// down to a quarter of its lengths, which few machines and soils forbid.
std::string identity_of(const SoilSimulator& simulator, const Machine& machine) {
  std::string own = checked_identity(simulator);
  if (!own.empty()) return own;
  const Terrain level = level_planning_ground(machine, 0.1);
  Fingerprint digs;
  for (const double share : {1.0, 0.5, 0.25}) {
    DigParameters dig = paper_fixed_path();
    dig.penetration_length *= share;
    dig.drag_length *= share;
    try {
      digs.add(evaluate_dig(machine, simulator, level, dig));
    } catch (const Error& error) {  // as in the search, which goes on
      digs.add(std::string(error.what()));
    }
  }
  return "a simulator of digs " + digs.text();
}

/// Remaining share of one phase, 0 .. 1.
double rest_of_phase(const Infeasible& stop, const DigParameters& parameters) {
  const auto rest = [&](double length) {
    return length > 0.0 ? std::clamp(1.0 - stop.distance / length, 0.0, 1.0) : 1.0;
  };
  switch (stop.phase) {
    case DigPhase::penetrate:
      return rest(parameters.penetration_length);
    case DigPhase::drag:
      return rest(parameters.drag_length);
    default:
      return std::clamp(std::abs(stop.value - stop.limit), 0.0, 1.0);
  }
}

double left_to_drive(const Infeasible& stop, const DigParameters& parameters) {
  const double phases = static_cast<double>(DigPhase::lift) - static_cast<double>(stop.phase);
  return 1.0 + phases + rest_of_phase(stop, parameters);
}

}  // namespace

double violation(const DigFailure& failure, const DigParameters& parameters) {
  if (const auto* stop = std::get_if<Infeasible>(&failure)) {
    return left_to_drive(*stop, parameters);
  }
  const double length = parameters.penetration_length + parameters.drag_length;
  return length > 0.0 ? std::clamp(1.0 - std::get<Stall>(failure).travelled / length, 0.01, 1.0)
                      : 1.0;
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

void check(const DigSearchOptions& options, const Machine& machine) {
  const DigBounds bounds = machine_bounds(machine, options.bounds);
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const double lower = bounds.lower.*info.field;
    const double upper = bounds.upper.*info.field;
    const std::string what = std::string("the search range of the ") + info.text;
    require(lower >= 0.0 && std::isfinite(lower), "the lower end of " + what, lower,
            "finite and at least 0");
    require(upper >= lower && std::isfinite(upper), "the upper end of " + what, upper,
            "finite and not below the lower end");
  }
  check(options.objective, machine);
}

DigsInEach dig_in_each(const Machine& machine, const std::vector<PossibleSoil>& soils,
                       const Terrain& terrain, const DigPath& path, const CycleOptions& cycle) {
  DigsInEach digs;
  for (const PossibleSoil& soil : soils) {
    digs.push_back(dig_of_path(machine, *soil.simulator, terrain, path, cycle));
  }
  return digs;
}

DigProblem::DigProblem(const Machine& machine, const std::vector<PossibleSoil>& soils,
                       const Terrain& terrain, const DigSearchOptions& options)
    : soils_(soils),
      terrain_(terrain),
      options_(options),
      bounds_(machine_bounds(machine, options.bounds)),
      layout_(machine, terrain, options.rules) {
  check(options, machine);
}

SearchResult DigProblem::run() {
  SearchOptions search_options{options_, {}};
  for (const KnownDig& dig : options_.start) search_options.start.push_back(point_of(dig));
  return search(as_search(), search_options);
}

void DigProblem::require_own_checkpoint() { SearchCheckpoint(as_search(), {options_, {}}); }

SearchProblem DigProblem::as_search() {
  SearchProblem problem{box(), [this](const VectorXd& point) { return simulate(point); },
                        [this](const VectorXd& point) { return lay_out(point); }};
  if (!options_.checkpoint.empty()) problem.fingerprint = fingerprint();
  return problem;
}

DigProblem::Best DigProblem::best_of(const SearchResult& found) const {
  Best best;
  DigSearchResult& result = best.result;
  result.path = path_of(found.best);
  best.digs = dig_in_each(layout_.machine(), soils_, terrain_, result.path, options_.objective);
  result.dig = mean_dig(best.digs);
  result.worth = mean_worth(best.digs);
  result.evaluations = found.evaluations;
  result.refused = found.repair;
  result.infeasible = found.infeasible;
  result.failed = found.failed;
  result.first_failure = first_failure(found);
  result.stopped = found.stopped_by == StopReason::cancelled;
  result.stopped_by = found.stopped_by;
  result.at_bound = at_bound(result.dig.parameters);
  result.insight = explain(box(), found);
  result.ranks = ranks_of(found);
  return best;
}

Found<DigSearchResult> DigProblem::result_of(const SearchResult& found) const {
  if (found.feasible()) return best_of(found).result;
  Found<DigSearchResult> none;
  none.nearest = nearest_of(found);
  none.stopped = found.stopped_by == StopReason::cancelled;
  none.evaluations = found.evaluations;
  return none;
}

std::vector<KnownDig> DigProblem::best_apart(const SearchResult& found, int count) const {
  constexpr double apart = 0.05;  // of the search ranges; ours
  std::vector<const SearchRecord*> feasible;
  for (const SearchRecord& record : found.history) {
    const bool simulated = record.source == SearchRecord::Source::simulated;
    if (simulated && record.outcome.ok()) feasible.push_back(&record);
  }
  std::stable_sort(feasible.begin(), feasible.end(), [](const auto* a, const auto* b) {
    return a->outcome.fitness > b->outcome.fitness;
  });
  const UnitCube cube(box());
  std::vector<VectorXd> chosen;
  std::vector<KnownDig> digs;
  for (const SearchRecord* record : feasible) {
    if (static_cast<int>(digs.size()) == count) break;
    const VectorXd& point = record->point;
    if (std::any_of(chosen.begin(), chosen.end(), [&](const VectorXd& better) {
          return cube.distance(point, better) <= apart;
        })) {
      continue;
    }
    chosen.push_back(point);
    digs.emplace_back(to_dig_parameters(point), start_of(point));
  }
  return digs;
}

std::vector<const DigParameterInfo*> DigProblem::at_bound(const DigParameters& best) const {
  constexpr double near = 0.01;  // of the range; ours
  std::vector<const DigParameterInfo*> found;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const double lower = bounds_.lower.*info.field;
    const double upper = bounds_.upper.*info.field;
    const double margin = near * (upper - lower);
    const double value = best.*info.field;
    const bool low = lower > 0.0 && value < lower + margin;
    if (margin > 0.0 && (low || value > upper - margin)) found.push_back(&info);
  }
  return found;
}

std::optional<NearestDig> DigProblem::nearest_of(const SearchResult& found) const {
  if (found.history.empty()) return std::nullopt;
  return NearestDig{to_dig_parameters(found.best), start_of(found.best), found.outcome.violation,
                    found.outcome.reason};
}

SearchBox DigProblem::box() const {
  const Machine& machine = layout_.machine();
  SearchBox box{to_vector(bounds_.lower), to_vector(bounds_.upper)};
  if (start_is_searched()) {
    append(box.lower, machine.track_front);
    append(box.upper, machine.boom_pin.x() + machine.full_length());
  }
  return box;
}

VectorXd DigProblem::point_of(const KnownDig& known) const {
  const DigParameters& dig = known.parameters;
  VectorXd point = to_vector(dig);
  if (start_is_searched() && known.start_x) {
    append(point, *known.start_x);
  } else if (start_is_searched()) {
    const auto path = path_by(layout_, dig, StartRule::Kind::least_work);
    const auto* drivable = std::get_if<DigPath>(&path);
    append(point,
           drivable ? drivable->start_x : 0.5 * (start_in(box().lower) + start_in(box().upper)));
  }
  return point;
}

/// The repair: an undrivable path is refused, the start of a drivable one is kept for later.
std::variant<VectorXd, Evaluation> DigProblem::lay_out(const VectorXd& point) {
  const DigParameters parameters = to_dig_parameters(point);
  auto path = path_by(layout_, parameters,
                      start_is_searched() ? StartRule(start_in(point)) : options_.start_rule);
  if (const auto* stop = std::get_if<Infeasible>(&path)) {
    return Evaluation::infeasible(violation(*stop, parameters), stop->message);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const PointKey key = key_of(point);
  starts_[key] = std::get<DigPath>(path).start_x;
  if (laid_.size() == most_laid) laid_.clear();
  laid_[key] = std::get<DigPath>(std::move(path));
  return point;
}

/// As it was laid out, or laid out again from its start.
DigPath DigProblem::taken_path(const VectorXd& point) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (auto kept = laid_.extract(key_of(point))) return std::move(kept.mapped());
  }
  return path_of(point);
}

Evaluation DigProblem::simulate(const VectorXd& point) {
  const DigPath path = taken_path(point);
  const DigsInEach digs =
      dig_in_each(layout_.machine(), soils_, terrain_, path, options_.objective);
  const DigFailure* failure = nullptr;
  for (const auto& dig : digs) {
    if (std::holds_alternative<PlannedDig>(dig)) {
      return options_.objective.rank(mean_worth(digs), mean_dig(digs).fill);
    }
    if (!failure) failure = &std::get<DigFailure>(dig);
  }
  return Evaluation::infeasible(violation(*failure, path.parameters), describe(*failure));
}

/// A stall is worth nothing.
double DigProblem::mean_worth(const DigsInEach& digs) const {
  double worth = 0.0;
  for (std::size_t i = 0; i < digs.size(); ++i) {
    const auto* dig = std::get_if<PlannedDig>(&digs[i]);
    if (dig) worth += soils_[i].probability * options_.objective.worth(*dig);
  }
  return worth;
}

/// Means over the soils in which the machine does not stall; there must be one.
PlannedDig DigProblem::mean_dig(const DigsInEach& digs) const {
  PlannedDig mean;
  double probability = 0.0;
  for (std::size_t i = 0; i < digs.size(); ++i) {
    const auto* dig = std::get_if<PlannedDig>(&digs[i]);
    if (!dig) continue;
    if (probability == 0.0) mean = *dig;
    probability += soils_[i].probability;
    const double share = soils_[i].probability / probability;
    for (double PlannedDig::*figure : dig_figures) {
      mean.*figure += share * (dig->*figure - mean.*figure);
    }
  }
  return mean;
}

/// Nothing for a path that was not laid out, unless its start does not depend on the path.
std::optional<double> DigProblem::start_of(const VectorXd& point) const {
  if (start_is_searched()) return start_in(point);
  if (options_.start_rule.kind == StartRule::Kind::given) return options_.start_rule.x;
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = starts_.find(key_of(point));
  return known != starts_.end() ? std::optional(known->second) : std::nullopt;
}

DigPath DigProblem::path_of(const VectorXd& point) const {
  const std::optional<double> start_x = start_of(point);
  auto path = path_by(layout_, to_dig_parameters(point),
                      start_x ? StartRule(*start_x) : options_.start_rule);
  return std::get<DigPath>(std::move(path));
}

/// All that decides the worth of a dig.
std::string DigProblem::fingerprint() const {
  Fingerprint ground;
  ground.add(terrain_);
  Fingerprint start;
  start.add(static_cast<double>(options_.start_rule.kind));
  start.add(options_.start_rule.x);
  for (double DigPathOptions::*rule : path_rules) start.add(options_.rules.*rule);
  const Machine& machine = layout_.machine();
  std::string text = "dig on " + machine.name + " " + excavplan::fingerprint(machine) +
                     ", ground " + ground.text() + ", goal " + describe(options_.objective) +
                     ", start " + start.text();
  for (const PossibleSoil& soil : soils_) {
    text += ", with probability " + number_text(soil.probability) + " in " +
            identity_of(*soil.simulator, machine);
  }
  return text;
}

void require_own_checkpoint(const Machine& machine, const SoilSimulator& simulator,
                            const Terrain& terrain, const DigSearchOptions& options) {
  if (!options.resume) return;
  const std::vector<PossibleSoil> soils = {{&simulator, 1.0}};
  DigProblem(machine, soils, terrain, options).require_own_checkpoint();
}

}  // namespace excavplan
