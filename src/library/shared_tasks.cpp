// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "library/shared_tasks.hpp"

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <excavplan/error.hpp>

#include "base/json.hpp"
#include "base/parallel.hpp"

namespace excavplan {
namespace {

/// Results by task of one process, on their way to the others.
struct Parcel {
  std::map<std::size_t, std::string> results;
  std::string error;
  bool bad_file = false;
  bool stopped = false;

  std::string text() const {
    return nlohmann::json{
        {"results", results}, {"error", error}, {"bad_file", bad_file}, {"stopped", stopped}}
        .dump();
  }
  void add(const std::string& text) {
    const auto json = nlohmann::json::parse(text);
    results.merge(json.at("results").get<std::map<std::size_t, std::string>>());
    stopped = stopped || json.at("stopped").get<bool>();
    if (error.empty()) {
      error = json.at("error").get<std::string>();
      bad_file = json.at("bad_file").get<bool>();
    }
  }
};

/// Tasks that wait for others, and the threads that do them: the lowest number that is ready first.
class OrderedTasks {
 public:
  OrderedTasks(const std::vector<std::vector<std::size_t>>& parents, const SharedTasks::Task& task,
               const SharedTasks::Take& take, const LibraryWatch& watch)
      : task_(task), take_(take), watch_(watch), left_(parents.size()) {
    waits_for_.resize(parents.size());
    children_.resize(parents.size());
    for (std::size_t i = 0; i < parents.size(); ++i) {
      waits_for_[i] = parents[i].size();
      for (const std::size_t parent : parents[i]) children_[parent].push_back(i);
      if (parents[i].empty()) ready_.insert(i);
    }
  }

  /// Of one thread, until nothing is left or one of them has failed.
  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    try {
      while (const auto i = next(lock)) {
        lock.unlock();
        const std::string result = task_(*i);
        lock.lock();
        end(*i, result);
      }
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      failed_ = true;
      changed_.notify_all();
      throw;
    }
  }

 private:
  bool over() const { return left_ == 0 || failed_ || watch_.stopped(); }

  /// Waits for a task that is ready. @return nothing when it is over
  std::optional<std::size_t> next(std::unique_lock<std::mutex>& lock) {
    changed_.wait(lock, [this] { return over() || !ready_.empty(); });
    if (over()) return std::nullopt;
    const std::size_t i = *ready_.begin();
    ready_.erase(ready_.begin());
    return i;
  }

  void end(std::size_t i, const std::string& result) {
    if (!result.empty()) take_(i, result);
    for (const std::size_t child : children_[i]) {
      if (--waits_for_[child] == 0) ready_.insert(child);
    }
    --left_;
    changed_.notify_all();
  }

  const SharedTasks::Task& task_;
  const SharedTasks::Take& take_;
  const LibraryWatch& watch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::size_t> ready_;
  std::vector<std::size_t> waits_for_;
  std::vector<std::vector<std::size_t>> children_;
  std::size_t left_;
  bool failed_ = false;
};

}  // namespace

void LibraryWatch::tell() {
  if (!callback_ || stopped_) return;
  now_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const auto left = static_cast<double>(now_.cells - std::min(now_.cells, now_.cells_done));
  now_.seconds_left = computed_ > 0 ? now_.seconds * left / static_cast<double>(computed_)
                                    : std::numeric_limits<double>::quiet_NaN();
  if (!callback_(now_)) stopped_ = true;
}

SharedTasks::SharedTasks(const LibraryBuildOptions& options)
    : sharing_(options.sharing != nullptr ? *options.sharing : alone_),
      threads_(thread_count(options.threads)),
      watch_(options) {}

void SharedTasks::run(std::size_t count, const Task& task, const Take& take) {
  if (count == 0 || stopped_) return;
  Parcel mine;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = sharing_.next(); i < count && !watch_.stopped(); i = sharing_.next()) {
      std::string text = task(i);
      const std::lock_guard<std::mutex> lock(mutex);
      if (!text.empty()) mine.results[i] = std::move(text);
    }
  };
  try {
    parallel_for(std::min<std::size_t>(threads_, count), threads_, [&](std::size_t) { work(); });
  } catch (const Error& e) {
    mine.error = e.what();
    mine.bad_file = e.kind() == ErrorKind::bad_file;
  }
  mine.stopped = watch_.stopped();
  Parcel all;
  for (const std::string& text : sharing_.exchange(mine.text())) all.add(text);
  if (!all.error.empty()) {
    throw Error(all.bad_file ? ErrorKind::bad_file : ErrorKind::bad_input, all.error);
  }
  stopped_ = stopped_ || all.stopped;
  for (const auto& [i, text] : all.results) take(i, text);
}

void SharedTasks::run_in_order(const std::vector<std::vector<std::size_t>>& parents,
                               const Task& task, const Take& take) {
  if (stopped_) return;
  // Only among threads is a result known to all at once.
  if (&sharing_ != &alone_) return run_by_generations(parents, task, take);
  OrderedTasks tasks(parents, task, take, watch_);
  parallel_for(std::min<std::size_t>(threads_, parents.size()), threads_,
               [&](std::size_t) { tasks.work(); });
  stopped_ = watch_.stopped();
}

void SharedTasks::run_by_generations(const std::vector<std::vector<std::size_t>>& parents,
                                     const Task& task, const Take& take) {
  std::vector<std::vector<std::size_t>> generations;
  std::vector<std::size_t> own(parents.size(), 0);
  for (std::size_t i = 0; i < parents.size(); ++i) {
    for (const std::size_t parent : parents[i]) own[i] = std::max(own[i], own[parent] + 1);
    if (generations.size() <= own[i]) generations.resize(own[i] + 1);
    generations[own[i]].push_back(i);
  }
  for (const std::vector<std::size_t>& all : generations) {
    run(
        all.size(), [&](std::size_t i) { return task(all[i]); },
        [&](std::size_t i, const std::string& result) { take(all[i], result); });
  }
}

}  // namespace excavplan
