// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <vector>

#include "support/errors.hpp"

/// @file
/// Tasks on several threads, also where there is no memory to start them.

namespace {
/// Allocations of this thread that succeed before one fails; negative: all succeed.
thread_local int allocations_left = -1;
}  // namespace

void* operator new(std::size_t size) {
  if (allocations_left >= 0 && allocations_left-- == 0) throw std::bad_alloc();
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace excavplan::test {
namespace {

TEST(Parallel, EveryTaskIsDoneOnce) {
  for (const unsigned threads : {0U, 1U, 3U, 100U}) {
    std::vector<int> done(50, 0);
    parallel_for(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    EXPECT_EQ(done, std::vector<int>(50, 1)) << threads;
  }
}

TEST(Parallel, TheFirstErrorIsThrown) {
  EXPECT_EQ(error_of([] {
              parallel_for(50, 4, [](std::size_t i) {
                if (i >= 7) throw Error(ErrorKind::bad_input, std::to_string(i));
              });
            }),
            "7");
  EXPECT_EQ(error_of([] { parallel_for(1, most_threads + 1, [](std::size_t) {}); }),
            "the number of threads is 1025, must be at most 1024");
}

TEST(Parallel, WithoutMemoryForAThreadTheOthersDoAllTasks) {
  int completed = 0;
  for (int left = 0; left < 12; ++left) {
    std::vector<std::atomic<int>> done(50);
    const auto task = [&](std::size_t i) {
      ++done[i];
      allocations_left = -1;
    };
    allocations_left = left;
    try {
      parallel_for(done.size(), 8, task);
      allocations_left = -1;
      ++completed;
      for (const auto& count : done) EXPECT_EQ(count.load(), 1) << left;
    } catch (const std::bad_alloc&) {
      allocations_left = -1;
      for (const auto& count : done) EXPECT_EQ(count.load(), 0) << left << ": before any thread";
    }
  }
  EXPECT_GE(completed, 7);
}

}  // namespace
}  // namespace excavplan::test
