// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/task_queue.hpp"

#include <iterator>

#include "base/parallel.hpp"

namespace excavplan {

std::size_t TaskQueue::add(Task task) {
  const std::size_t number = tasks_.size();
  waits_for_.push_back(task.after.size());
  children_.emplace_back();
  for (const std::size_t other : task.after) children_[other].push_back(number);
  if (task.after.empty()) ready_.insert(number);
  tasks_.push_back(std::move(task));
  ++left_;
  return number;
}

bool TaskQueue::run(const std::vector<Worker>& workers) {
  parallel_for(workers.size(), static_cast<unsigned>(workers.size()),
               [&](std::size_t i) { work(workers[i]); });
  return !stopped_;
}

void TaskQueue::work(const Worker& worker) {
  std::unique_lock<std::mutex> lock(mutex_);
  try {
    while (const auto job = next(lock)) {
      lock.unlock();
      const std::string result = worker(job->text);
      lock.lock();
      if (result.empty()) return stop();
      tasks_[job->number].take(result);
      finish(job->number);
    }
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    stop();
    throw;
  }
}

std::optional<TaskQueue::Job> TaskQueue::next(std::unique_lock<std::mutex>& lock) {
  for (;;) {
    changed_.wait(lock, [this] { return stopped_ || left_ == 0 || !ready_.empty(); });
    if (stopped_ || left_ == 0) return std::nullopt;
    const auto chosen =
        std::next(ready_.begin(), static_cast<std::ptrdiff_t>(offset_ % ready_.size()));
    const std::size_t number = *chosen;
    ready_.erase(chosen);
    if (std::string text = tasks_[number].text(); !text.empty()) return Job{number, text};
    finish(number);
  }
}

void TaskQueue::finish(std::size_t number) {
  for (const std::size_t child : children_[number]) {
    if (--waits_for_[child] == 0) ready_.insert(child);
  }
  --left_;
  changed_.notify_all();
}

void TaskQueue::stop() {
  stopped_ = true;
  changed_.notify_all();
}

}  // namespace excavplan
