// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "optimisation/search_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"
#include "base/parallel.hpp"
#include "optimisation/sound_evaluation.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;

constexpr int certain = 20;  // consecutive failures from the start that end the search; ours

bool failed(const Evaluation& outcome) {
  return outcome.status == Evaluation::Status::failed ||
         outcome.status == Evaluation::Status::timed_out;
}

std::variant<VectorXd, Evaluation> repair(const SearchProblem& problem, const VectorXd& point) {
  using Repaired = std::variant<VectorXd, Evaluation>;
  Repaired repaired = caught([&]() -> Repaired { return problem.repair(point); });
  if (const auto* refusal = std::get_if<Evaluation>(&repaired)) {
    if (refusal->ok()) return Evaluation::failed("the repair gave a fitness, not a point");
    return sound(*refusal);
  }
  if (const auto& fit = std::get<VectorXd>(repaired);
      fit.size() != point.size() || !fit.allFinite()) {
    return Evaluation::failed("the repair gave no finite point of the box's dimensions");
  }
  return repaired;
}

VectorXd snapped(const VectorXd& point, const SearchProblem& problem) {
  VectorXd result = point;
  for (Eigen::Index i = 0; i < problem.step.size(); ++i) {
    if (!(problem.step(i) > 0.0)) continue;
    const double lower = problem.box.lower(i);
    result(i) = lower + problem.step(i) * std::round((point(i) - lower) / problem.step(i));
    if (result(i) > problem.box.upper(i)) result(i) -= problem.step(i);
  }
  return result;
}

}  // namespace

SearchLog::SearchLog(const SearchProblem& problem, const SearchOptions& options, double planned)
    : problem_(problem), options_(options), checkpoint_(problem, options) {
  const int limit = options.stop.evaluations;
  const int most = limit > 0 ? limit : std::numeric_limits<int>::max();
  progress_.planned = static_cast<int>(std::min<double>(most, planned));
  progress_.best = progress_.mean = progress_.seconds_left = nan;
  checkpoint_.verify_best(problem.objective);
}

SearchLog::Prepared SearchLog::prepare(int generation, const Candidate& candidate) const {
  const SearchBox& box = problem_.box;
  const auto clip = [&](const VectorXd& point) -> VectorXd {
    return point.cwiseMax(box.lower).cwiseMin(box.upper);
  };
  Prepared prepared;
  SearchRecord& record = prepared.record;
  record.origin = candidate.origin;
  record.parents = candidate.parents;
  record.generation = generation;
  record.point = clip(snapped(clip(candidate.point), problem_));
  if (problem_.repair) {
    auto repaired = repair(problem_, record.point);
    if (const auto* point = std::get_if<VectorXd>(&repaired)) {
      record.point = clip(*point);
    } else {
      record.source = SearchRecord::Source::repair;
      record.outcome = std::get<Evaluation>(std::move(repaired));
    }
  }
  prepared.key = key_of(record.point);
  return prepared;
}

std::optional<Evaluation> SearchLog::simulate(const VectorXd& point) {
  if (halted_) return std::nullopt;
  const Evaluation* known = checkpoint_.find(point);
  const Evaluation outcome =
      known ? *known : sound(caught([&]() -> Evaluation { return problem_.objective(point); }));
  report(point, outcome, known == nullptr);
  return outcome;
}

void SearchLog::report(const VectorXd& point, const Evaluation& outcome, bool fresh) {
  const std::lock_guard<std::mutex> lock(report_mutex_);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  ++progress_.evaluations;
  if (outcome.ok() && !(progress_.best >= outcome.fitness)) progress_.best = outcome.fitness;
  if (fresh) {
    ++fresh_;
    checkpoint_.add(point, outcome);
    if (seconds - saved_at_ >= options_.checkpoint_interval) {
      checkpoint_.save();
      saved_at_ = seconds;
    }
  }
  tell(seconds);
}

void SearchLog::tell(double seconds) {
  progress_.seconds = seconds;
  progress_.seconds_left = seconds_left();
  if (options_.stop.seconds > 0.0 && seconds >= options_.stop.seconds) halt(StopReason::seconds);
  if (!options_.progress || halted_) return;
  try {
    if (!options_.progress(progress_)) halt(StopReason::cancelled);
  } catch (...) {
    halt(StopReason::cancelled);  // for the other threads
    throw;
  }
}

void SearchLog::halt(StopReason reason) {
  if (!halted_) halted_by_ = reason;
  halted_ = true;
}

double SearchLog::seconds_left() const {
  const int evaluations_left = std::max(0, progress_.planned - progress_.evaluations);
  const double left = fresh_ > 0 ? progress_.seconds / fresh_ * evaluations_left : nan;
  const double limit = options_.stop.seconds;
  return limit > 0.0 ? std::fmin(left, std::max(0.0, limit - progress_.seconds)) : left;
}

int SearchLog::room() const {
  const int limit = options_.stop.evaluations;
  return limit > 0 ? std::max(0, limit - evaluations_) : std::numeric_limits<int>::max();
}

int SearchLog::take(SearchRecord record) {
  const int place = size();
  if (record.source == SearchRecord::Source::simulated) {
    ++evaluations_;
    failed_ += failed(record.outcome) ? 1 : 0;
    seen_.emplace(key_of(record.point), record.outcome);
  }
  history_.push_back(std::move(record));
  if (best_ < 0 || better(history_.back().outcome, (*this)[best_].outcome)) {
    best_ = place;
    best_since_ = evaluations_;
  }
  return place;
}

std::vector<int> SearchLog::evaluate(int generation, const std::vector<Candidate>& candidates) {
  if (candidates.empty() || stop_reason_) return {};
  std::vector<Prepared> batch(candidates.size());
  parallel_for(batch.size(), options_.threads,
               [&](std::size_t i) { batch[i] = prepare(generation, candidates[i]); });
  std::vector<int> places;
  for (std::size_t done = 0; done < batch.size() && !stop_reason_;) {
    std::size_t count = batch.size() - done;
    if (failed_ == evaluations_ && evaluations_ < certain) {
      count = std::min(count, static_cast<std::size_t>(certain - evaluations_));
    }
    evaluate_part(&batch[done], count, places);
    refuse_if_all_failed(certain);
    done += count;
  }
  note_generation(generation, places);
  return places;
}

std::vector<SearchRecord*> SearchLog::mark_fresh(Prepared* batch, std::size_t& count) {
  std::vector<SearchRecord*> fresh;
  std::set<PointKey> in_batch;
  for (std::size_t i = 0; i < count; ++i) {
    Prepared& it = batch[i];
    if (it.record.source == SearchRecord::Source::repair) continue;
    if (seen_.count(it.key) > 0 || !in_batch.insert(it.key).second) {
      it.record.source = SearchRecord::Source::cached;
    } else if (static_cast<int>(fresh.size()) == room()) {
      count = i;
      stop_reason_ = StopReason::evaluations;
    } else {
      fresh.push_back(&it.record);
    }
  }
  return fresh;
}

void SearchLog::evaluate_part(Prepared* batch, std::size_t count, std::vector<int>& places) {
  const std::vector<SearchRecord*> fresh = mark_fresh(batch, count);
  std::vector<std::optional<Evaluation>> outcomes(fresh.size());
  parallel_for(fresh.size(), options_.threads,
               [&](std::size_t i) { outcomes[i] = simulate(fresh[i]->point); });
  std::size_t simulated = 0;
  for (std::size_t i = 0; i < count; ++i) {
    SearchRecord& record = batch[i].record;
    if (record.source == SearchRecord::Source::simulated) {
      const auto& outcome = outcomes[simulated++];
      if (!outcome) continue;
      record.outcome = *outcome;
    } else if (record.source == SearchRecord::Source::cached) {
      const auto known = seen_.find(batch[i].key);
      if (known == seen_.end()) continue;  // of a point whose evaluation was cancelled
      record.outcome = known->second;
    }
    places.push_back(take(std::move(record)));
  }
  check_rules();
}

void SearchLog::run_strands(int generation, int evaluations,
                            const std::vector<std::function<void(Strand&)>>& tasks) {
  if (stop_reason_) return;
  // As long as all evaluations failed, no more than make that certain.
  const bool hopeless = failed_ == evaluations_ && evaluations_ < certain;
  const auto tasks_left = std::max<int>(1, static_cast<int>(tasks.size()));
  const int patience = hopeless ? std::max(1, (certain - evaluations_) / tasks_left)
                                : std::numeric_limits<int>::max();
  std::vector<Strand> strands;
  int room_left = room();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const int limit = std::min(evaluations, room_left);
    room_left -= limit;
    strands.push_back(Strand(*this, generation, {limit, patience}));
  }
  parallel_for(tasks.size(), options_.threads, [&](std::size_t i) { tasks[i](strands[i]); });
  for (Strand& strand : strands) {
    for (SearchRecord& record : strand.records_) take(std::move(record));
  }
  refuse_if_all_failed(certain);
  check_rules();
}

const Evaluation* SearchLog::Strand::remembered(const PointKey& key) const {
  if (const auto own = seen_.find(key); own != seen_.end()) return &own->second;
  const auto all = log_.seen_.find(key);
  return all != log_.seen_.end() ? &all->second : nullptr;
}

std::optional<Evaluation> SearchLog::Strand::ask(const Candidate& candidate) {
  if (reached_) return std::nullopt;
  Prepared prepared = log_.prepare(generation_, candidate);
  SearchRecord& record = prepared.record;
  record.polish = number_;
  if (record.source != SearchRecord::Source::repair) {
    if (const Evaluation* known = remembered(prepared.key)) {
      record.source = SearchRecord::Source::cached;
      record.outcome = *known;
    } else {
      if (evaluations_ == limits_.evaluations ||
          (failed_ >= limits_.patience && failed_ == evaluations_)) {
        return std::nullopt;
      }
      const std::optional<Evaluation> outcome = log_.simulate(record.point);
      if (!outcome) return std::nullopt;
      ++evaluations_;
      failed_ += failed(*outcome) ? 1 : 0;
      record.outcome = seen_[prepared.key] = *outcome;
    }
  }
  reached_ = log_.reaches_target(record.outcome);
  records_.push_back(std::move(record));
  return records_.back().outcome;
}

bool SearchLog::reaches_target(const Evaluation& outcome) const {
  const std::optional<double>& target = options_.stop.target;
  return target && outcome.ok() && outcome.fitness >= *target;
}

void SearchLog::note_generation(int generation, const std::vector<int>& places) {
  const std::lock_guard<std::mutex> lock(report_mutex_);
  double sum = 0.0;
  int feasible = 0;
  for (const int place : places) {
    if (!(*this)[place].outcome.ok()) continue;
    sum += (*this)[place].outcome.fitness;
    ++feasible;
  }
  progress_.generation = generation;
  progress_.mean = feasible > 0 ? sum / feasible : nan;
  if (halted_) return;
  tell(std::chrono::duration<double>(Clock::now() - begin_).count());
  check_rules();
}

void SearchLog::check_rules() {
  if (stop_reason_ && *stop_reason_ != StopReason::evaluations) return;
  const StopRules& rules = options_.stop;
  if (halted_) {
    stop_reason_ = halted_by_;
  } else if (best_ >= 0 && reaches_target((*this)[best_].outcome)) {
    stop_reason_ = StopReason::target;
  } else if (room() == 0) {
    stop_reason_ = StopReason::evaluations;
  } else if (rules.stall > 0 && evaluations_ - best_since_ >= rules.stall) {
    stop_reason_ = StopReason::stall;
  }
}

void SearchLog::refuse_if_all_failed(int evaluations) const {
  if (evaluations_ < std::max(1, evaluations) || failed_ < evaluations_) return;
  const auto first = std::find_if(history_.begin(), history_.end(), [](const SearchRecord& record) {
    return record.source == SearchRecord::Source::simulated;
  });
  throw Error(ErrorKind::bad_input,
              "search: all of the first " + std::to_string(evaluations_) +
                  " evaluations failed, the first one: " + first->outcome.reason);
}

SearchResult SearchLog::finish() {
  checkpoint_.save();
  SearchResult result;
  result.stopped_by = stop_reason_.value_or(StopReason::generations);
  if (!halted_) refuse_if_all_failed(1);
  if (best_ >= 0) {
    result.best = (*this)[best_].point;
    result.outcome = (*this)[best_].outcome;
  }
  result.asked = size();
  result.evaluations = evaluations_;
  result.failed = failed_;
  for (const SearchRecord& record : history_) {
    using Source = SearchRecord::Source;
    result.cached += record.source == Source::cached ? 1 : 0;
    result.repair += record.source == Source::repair ? 1 : 0;
    result.infeasible += record.source == Source::simulated &&
                                 record.outcome.status == Evaluation::Status::infeasible
                             ? 1
                             : 0;
  }
  result.history = std::move(history_);
  return result;
}

}  // namespace excavplan
