// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <excavplan/library/library_build.hpp>

/// @file
/// How the tasks of a build are shared out among threads and processes, and what the user sees of
/// it.

namespace excavplan {

/// What the user sees of a build, and whether he stopped it.
class LibraryWatch {
 public:
  explicit LibraryWatch(const LibraryBuildOptions& options)
      : callback_(options.progress), note_(options.note) {}

  bool stopped() const { return stopped_; }
  void expect(std::size_t cells) {
    const std::lock_guard<std::mutex> lock(mutex_);
    now_.cells = cells;
  }
  void cell_done(bool computed) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++now_.cells_done;
    computed_ += computed ? 1 : 0;
    tell();
  }
  void note(const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (note_) note_(line);
  }
  /// The progress of the search for a cell, whose evaluations never fall.
  std::function<bool(const SearchProgress&)> of(const std::string& cell) {
    return [this, cell, counted = 0](const SearchProgress& progress) mutable {
      const std::lock_guard<std::mutex> lock(mutex_);
      now_.evaluations += progress.evaluations - counted;
      counted = progress.evaluations;
      now_.cell = cell;
      now_.best = progress.best;
      tell();
      return !stopped_;
    };
  }

 private:
  void tell();

  const std::function<bool(const LibraryProgress&)>& callback_;
  const std::function<void(const std::string&)>& note_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  LibraryProgress now_;
  std::size_t computed_ = 0;
  std::atomic<bool> stopped_{false};
};

/// The tasks of a build: each done once, by one thread of one process.
class SharedTasks {
 public:
  explicit SharedTasks(const LibraryBuildOptions& options);

  LibraryWatch& watch() { return watch_; }
  bool stopped() const { return stopped_; }  ///< by the user, in any of the processes

  /// What a task came to; empty if the user stopped it.
  using Task = std::function<std::string(std::size_t number)>;
  /// Called once for every result that is not empty, by one thread at a time, in all processes.
  using Take = std::function<void(std::size_t number, const std::string& result)>;

  /// Does task(0) .. task(count - 1), and then takes the results in this order.
  void run(std::size_t count, const Task& task, const Take& take);

  /// Does task(i) for all parents, each when the results of parents[i], which are all below i, have
  /// been taken.
  void run_in_order(const std::vector<std::vector<std::size_t>>& parents, const Task& task,
                    const Take& take);

 private:
  void run_by_generations(const std::vector<std::vector<std::size_t>>& parents, const Task& task,
                          const Take& take);

  /// The only process there is.
  class Alone : public WorkSharing {
   public:
    std::size_t next() override { return next_++; }
    std::vector<std::string> exchange(const std::string& mine) override {
      next_ = 0;
      return {mine};
    }

   private:
    std::atomic<std::size_t> next_{0};
  };

  Alone alone_;
  WorkSharing& sharing_;
  unsigned threads_;
  LibraryWatch watch_;
  bool stopped_ = false;
};

}  // namespace excavplan
