// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include <excavplan/base/ceilings.hpp>

#include "base/check.hpp"

namespace excavplan {

/// Number of threads; 0: one per core. @throws Error (bad_input) if it is above most_threads
inline unsigned thread_count(unsigned threads) {
  require(threads <= most_threads, "the number of threads", threads,
          "at most " + std::to_string(most_threads));
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

/// Calls task(0) .. task(count - 1) on up to `threads` threads (0: one per core). The tasks must
/// not depend on each other; of several exceptions the one of the lowest index is rethrown, so that
/// the outcome is the same for any number of threads.
template <typename Task>
void parallel_for(std::size_t count, unsigned threads, const Task& task) {
  threads = thread_count(threads);
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> others;
  others.reserve(threads);
  try {
    for (std::size_t t = 1; t < std::min<std::size_t>(threads, count); ++t) {
      others.emplace_back(work);
    }
  } catch (const std::exception&) {
    // There are no more threads, or no memory for one; those that started do all tasks.
  }
  work();
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace excavplan
