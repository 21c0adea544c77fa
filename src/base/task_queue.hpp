// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace excavplan {

/// Tasks that wait for others, and the workers that do them.
class TaskQueue {
 public:
  struct Task {
    std::vector<std::size_t> after;     ///< numbers of the tasks it waits for
    std::function<std::string()> text;  ///< called when they are done; empty: nothing to do
    std::function<void(const std::string&)> take;  ///< the result
  };
  /// Returns the result of a task; empty: stop all.
  using Worker = std::function<std::string(const std::string& task)>;

  /// @param offset  which of the ready tasks is done next, modulo their number
  explicit TaskQueue(std::size_t offset = 0) : offset_(offset) {}

  /// @return the number of the task
  std::size_t add(Task task);

  /// Does all tasks, each worker in a thread of its own. `text` and `take` of the tasks are called
  /// one at a time. What a task throws ends the run.
  /// @return false if a worker stopped it
  bool run(const std::vector<Worker>& workers);

 private:
  struct Job {
    std::size_t number = 0;
    std::string text;
  };
  void work(const Worker& worker);
  std::optional<Job> next(std::unique_lock<std::mutex>& lock);
  void finish(std::size_t number);
  void stop();

  std::size_t offset_;
  std::vector<Task> tasks_;
  std::vector<std::size_t> waits_for_;              // number of tasks, by task
  std::vector<std::vector<std::size_t>> children_;  // by task
  std::set<std::size_t> ready_;
  std::size_t left_ = 0;
  bool stopped_ = false;
  std::mutex mutex_;  // guards the above while it runs
  std::condition_variable changed_;
};

}  // namespace excavplan
