// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>
#include <utility>

#include <nlopt.hpp>

#include "base/random.hpp"
#include "optimisation/evolution_polish.hpp"
#include "optimisation/search_methods.hpp"
#include "optimisation/search_points.hpp"
#include "optimisation/space_filling.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;
using Origin = SearchRecord::Origin;

/// Nelder-Mead search from a point already evaluated, in one strand.
class SimplexPolish {
 public:
  SimplexPolish(const UnitCube& cube, const SearchRecord& start, int place, double step)
      : cube_(cube),
        start_(start.point),
        start_u_(cube.inside(start.point)),
        place_(place),
        step_(step) {}

  void operator()(SearchLog::Strand& strand) {
    strand_ = &strand;
    const auto n = static_cast<unsigned>(cube_.dimensions());
    nlopt::opt search(nlopt::LN_NELDERMEAD, n);
    search.set_max_objective(&SimplexPolish::value, this);
    std::vector<double> upper(n, 1.0);
    for (unsigned i = 0; i < n; ++i) {
      if (cube_.is_flat(i)) upper[i] = 0.0;
    }
    search.set_lower_bounds(0.0);
    search.set_upper_bounds(upper);
    search.set_initial_step(step_);
    search.set_xtol_abs(fine_enough);
    search.set_maxeval(1000);  // also where the repair refuses every point
    std::vector<double> u(start_u_.data(), start_u_.data() + n);
    double best = 0.0;
    try {
      search.optimize(u, best);
    } catch (const nlopt::forced_stop&) {
      if (failure_) std::rethrow_exception(failure_);
    } catch (const nlopt::roundoff_limited&) {
      // As good as it gets: the log holds the best point.
    }
  }

 private:
  static constexpr double fine_enough = 3e-3;  // of the box; ours
  static constexpr double worst = -1e30;       // below every fitness; finite, to be compared

  static double value(const std::vector<double>& u, std::vector<double>&, void* self) {
    return static_cast<SimplexPolish*>(self)->value(u);
  }

  /// NLopt loses the text of what is thrown through it: it is carried around it.
  double value(const std::vector<double>& u) {
    try {
      if (const auto found = value_at(Eigen::Map<const VectorXd>(u.data(), start_u_.size()))) {
        return *found;
      }
    } catch (...) {
      failure_ = std::current_exception();
    }
    throw nlopt::forced_stop();
  }

  std::optional<double> value_at(const VectorXd& u) {
    std::optional<Evaluation> outcome;
    // A failure need not hold for its neighbourhood: a point beside it is tried too.
    for (int attempt = 0; attempt < 3; ++attempt) {
      VectorXd tried = u == start_u_ ? start_ : cube_.point(u);
      if (attempt > 0) tried = cube_.point(u + VectorXd::Constant(u.size(), aside(attempt)));
      outcome = strand_->ask({tried, Origin::polish, {place_}});
      if (!outcome) return std::nullopt;
      if (outcome->ok()) return std::max(outcome->fitness, 0.1 * worst);
      if (outcome->status == Evaluation::Status::infeasible) {
        return worst * (1.0 + outcome->violation / (1.0 + outcome->violation));
      }
    }
    return 4.0 * worst;
  }
  static double aside(int attempt) { return attempt == 1 ? 2e-3 : -2e-3; }

  const UnitCube& cube_;
  VectorXd start_;
  VectorXd start_u_;
  int place_;
  double step_;
  SearchLog::Strand* strand_ = nullptr;
  std::exception_ptr failure_;
};

class Memetic {
 public:
  Memetic(const MemeticSearch& method, const SearchTask& task, SearchLog& log)
      : method_(method),
        task_(task),
        log_(log),
        cube_(task.box),
        sequence_(cube_.dimensions(), task.seed) {}

  void run() {
    const std::optional<Evaluation> inherited = polish_given();
    first_generation(inherited);
    restart();
    for (int i = 1; i <= method_.generations && !log_.stopped(); ++i) {
      generation_ = i;
      breed();
      improve();
    }
  }

 private:
  /// @return the best of the given points before it was polished
  std::optional<Evaluation> polish_given() {
    std::vector<Candidate> given;
    for (const VectorXd& point : task_.start) given.push_back({point, Origin::given, {}});
    const std::vector<int> places = log_.evaluate(0, given);
    if (places.empty()) return std::nullopt;
    const std::vector<int> sorted = best_first(places);
    const Evaluation inherited = log_[sorted.front()].outcome;
    polish(separate(sorted, method_.basins), given_step);
    return inherited;
  }

  void first_generation(const std::optional<Evaluation>& inherited) {
    std::vector<Candidate> points;
    points.reserve(static_cast<std::size_t>(method_.first_generation));
    for (int i = 0; i < method_.first_generation; ++i) {
      points.push_back({cube_.point(sequence_.next()), Origin::space_filling, {}});
    }
    if (log_.stopped()) return;
    std::vector<int> places = best_first(log_.evaluate(0, points));
    if (inherited) {
      places.erase(
          std::remove_if(places.begin(), places.end(),
                         [&](int place) { return !better(log_[place].outcome, *inherited); }),
          places.end());
    }
    polish(separate(places, method_.basins), first_step);
  }

  /// A simplex that has shrunk at a cliff or a step may improve further when spread again.
  void restart() {
    if (method_.basins > 0 && log_.best() >= 0) polish(best_apart(method_.restarts), restart_step);
  }

  std::vector<int> all_best_first() const {
    std::vector<int> all(static_cast<std::size_t>(log_.size()));
    std::iota(all.begin(), all.end(), 0);
    return best_first(std::move(all));
  }

  /// The best point, and the next that lie apart from those before.
  std::vector<int> best_apart(int count) const {
    return apart(all_best_first(), count, near_best * method_.basin_radius, {});
  }

  void breed() {
    elite_ = all_best_first();
    elite_.resize(std::min(elite_.size(), elite_size));
    const int immigrants =
        static_cast<int>(std::ceil(method_.immigrants * method_.generation_size));
    std::vector<Candidate> children;
    for (int i = 0; i < method_.generation_size; ++i) {
      if (i < immigrants) {
        children.push_back({cube_.point(sequence_.next()), Origin::immigrant, {}});
      } else {
        children.push_back(mutant(i));
      }
    }
    born_ = best_first(log_.evaluate(generation_, children));
  }

  /// Polishes the best newcomer of a basin not seen before, and the best if a mutation found it.
  void improve() {
    if (log_.stopped() || method_.basins == 0) return;
    std::vector<int> strangers;
    for (const int place : born_) {
      if (log_[place].origin == Origin::immigrant) strangers.push_back(place);
    }
    std::vector<int> starts = separate(strangers, 1);
    if (log_[log_.best()].polish == 0) starts.insert(starts.begin(), log_.best());
    polish(starts, restart_step);
  }

  /// A neighbour of one of the best, at a distance drawn over the decades.
  Candidate mutant(int individual) {
    Random random(task_.seed, static_cast<std::uint64_t>(generation_),
                  static_cast<std::uint64_t>(individual));
    const int parent = elite_[random.index(elite_.size())];
    const double reach = widest * std::pow(10.0, -random.uniform(0.0, 2.0));
    VectorXd u = cube_.inside(log_[parent].point);
    for (Eigen::Index i = 0; i < u.size(); ++i) u(i) += reach * random.normal();
    return {cube_.point(u.cwiseMax(0.0).cwiseMin(1.0)), Origin::mutation, {parent}};
  }

  std::vector<int> best_first(std::vector<int> places) const {
    std::stable_sort(places.begin(), places.end(),
                     [&](int a, int b) { return better(log_[a].outcome, log_[b].outcome); });
    return places;
  }

  /// The first few places that lie in no basin polished so far, nor in one another's.
  std::vector<int> separate(const std::vector<int>& places, int count) const {
    return apart(places, count, method_.basin_radius, polished_);
  }

  /// The first few places that promise something and lie farther than a radius from one another and
  /// from others.
  std::vector<int> apart(const std::vector<int>& places, int count, double radius,
                         const std::vector<int>& others) const {
    std::vector<int> chosen;
    for (const int place : places) {
      if (static_cast<int>(chosen.size()) == count || !promises(log_[place].outcome)) break;
      const auto taken = [&](int other) {
        return cube_.distance(log_[place].point, log_[other].point) <= radius;
      };
      if (std::none_of(chosen.begin(), chosen.end(), taken) &&
          std::none_of(others.begin(), others.end(), taken)) {
        chosen.push_back(place);
      }
    }
    return chosen;
  }

  /// Infeasible starts only while nothing is feasible, and if they show a way towards it.
  bool promises(const Evaluation& outcome) const {
    return outcome.ok() || (outcome.violation > 0.0 && !log_[log_.best()].outcome.ok());
  }

  void polish(const std::vector<int>& starts, double step) {
    if (log_.stopped()) return;
    std::vector<std::function<void(SearchLog::Strand&)>> tasks;
    for (const int start : starts) {
      if (!promises(log_[start].outcome)) continue;
      if (method_.polishing == Polishing::evolution) {
        const double first = std::min(step, longest_first_step);
        tasks.emplace_back(EvolutionPolish(cube_, log_[start], start, first, task_.seed));
      } else {
        tasks.emplace_back(SimplexPolish(cube_, log_[start], start, step));
      }
    }
    log_.run_strands(generation_, method_.polish_evaluations, tasks);
    polished_.insert(polished_.end(), starts.begin(), starts.end());
    polished_.push_back(log_.best());
  }

  // Lengths of the simplex and of mutations as shares of the box; ours, after
  // docs/methods.md#search.
  static constexpr double given_step = 0.05;
  static constexpr double first_step = 0.1;
  static constexpr double restart_step = 0.15;
  static constexpr double longest_first_step = 0.06;  // of an evolution, which lengthens its own
  static constexpr double near_best = 0.25;           // of the radius of a basin
  static constexpr double widest = 0.2;
  static constexpr std::size_t elite_size = 10;  // several: under noise the best is often no better

  const MemeticSearch& method_;
  const SearchTask& task_;
  SearchLog& log_;
  UnitCube cube_;
  SpaceFilling sequence_;
  int generation_ = 0;
  std::vector<int> elite_;     // parents of the next generation
  std::vector<int> born_;      // the last generation, best first
  std::vector<int> polished_;  // where polishes began, and the best after each
};

}  // namespace

void run(const MemeticSearch& method, const SearchTask& task, SearchLog& log) {
  Memetic(method, task, log).run();
}

}  // namespace excavplan
