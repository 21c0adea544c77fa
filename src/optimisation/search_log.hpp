// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include <excavplan/optimisation/search_result.hpp>

#include "optimisation/search_checkpoint.hpp"
#include "optimisation/search_points.hpp"

/// @file
/// The part of a search that is independent of its method: evaluates points, records them, counts,
/// stops. Private to the library.

namespace excavplan {

/// A point that a method requests.
struct Candidate {
  Eigen::VectorXd point;
  SearchRecord::Origin origin = SearchRecord::Origin::given;
  std::vector<int> parents;
};

/// All evaluations of a search, in an order that does not depend on threads.
class SearchLog {
 public:
  class Strand;

  /// @param planned  evaluations that the method will about make, for the progress
  SearchLog(const SearchProblem& problem, const SearchOptions& options, double planned);

  /// Evaluates candidates in parallel; returns the places of their records. Fewer than asked if a
  /// stop rule cut it short.
  std::vector<int> evaluate(int generation, const std::vector<Candidate>& candidates);

  /// Runs tasks in parallel that each evaluate one point after another, at most `evaluations`
  /// each; their records follow each other in the order of the tasks.
  void run_strands(int generation, int evaluations,
                   const std::vector<std::function<void(Strand&)>>& tasks);

  bool stopped() const { return stop_reason_.has_value(); }
  const SearchRecord& operator[](int place) const {
    return history_[static_cast<std::size_t>(place)];
  }
  int size() const { return static_cast<int>(history_.size()); }
  int evaluations() const { return evaluations_; }
  int best() const { return best_; }  ///< place of the best record; -1 if there is none

  SearchResult finish();

 private:
  using Clock = std::chrono::steady_clock;

  struct Prepared {
    SearchRecord record;
    PointKey key;
  };
  Prepared prepare(int generation, const Candidate& candidate) const;
  /// Calls the objective, or takes its answer from the checkpoint. Thread-safe.
  /// @return nothing if the search was cancelled or its time is over
  std::optional<Evaluation> simulate(const Eigen::VectorXd& point);
  void report(const Eigen::VectorXd& point, const Evaluation& outcome, bool fresh);
  void tell(double seconds);
  void halt(StopReason reason);
  double seconds_left() const;

  int room() const;  ///< evaluations that the rules still allow
  int take(SearchRecord record);
  /// Those of a batch that must be evaluated; shortens it where the rules leave no room.
  std::vector<SearchRecord*> mark_fresh(Prepared* batch, std::size_t& count);
  void evaluate_part(Prepared* batch, std::size_t count, std::vector<int>& places);
  void note_generation(int generation, const std::vector<int>& places);
  bool reaches_target(const Evaluation& outcome) const;
  void check_rules();
  void refuse_if_all_failed(int evaluations) const;

  const SearchProblem& problem_;
  const SearchOptions& options_;
  SearchCheckpoint checkpoint_;
  const Clock::time_point begin_ = Clock::now();

  std::vector<SearchRecord> history_;
  std::map<PointKey, Evaluation> seen_;
  int evaluations_ = 0;
  int failed_ = 0;
  int best_ = -1;
  int best_since_ = 0;  ///< evaluations made when it was found
  int strand_count_ = 0;
  std::optional<StopReason> stop_reason_;

  std::mutex report_mutex_;  // guards what follows, the checkpoint and the callback
  SearchProgress progress_;
  int fresh_ = 0;          // evaluations not taken from the checkpoint
  double saved_at_ = 0.0;  // [s]
  std::atomic<bool> halted_{false};
  StopReason halted_by_ = StopReason::cancelled;
};

/// One of several chains of evaluations that run in parallel.
class SearchLog::Strand {
 public:
  /// @return nothing if the strand has used up its evaluations or the target is reached
  std::optional<Evaluation> ask(const Candidate& candidate);

 private:
  friend class SearchLog;
  struct Limits {
    int evaluations;
    int patience;  ///< evaluations after which it ends if all of them failed
  };
  Strand(SearchLog& log, int generation, Limits limits)
      : log_(log), generation_(generation), number_(++log.strand_count_), limits_(limits) {}

  const Evaluation* remembered(const PointKey& key) const;

  SearchLog& log_;
  int generation_;
  int number_;
  Limits limits_;
  int evaluations_ = 0;
  int failed_ = 0;
  bool reached_ = false;
  std::map<PointKey, Evaluation> seen_;
  std::vector<SearchRecord> records_;
};

}  // namespace excavplan
