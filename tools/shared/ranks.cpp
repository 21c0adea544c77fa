// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/ranks.hpp"

#ifdef EXCAVPLAN_MPI

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <thread>

namespace excavplan::tools {
namespace {

/// Takes numbers from counters in the memory of rank 0, which need not do anything for it.
class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) {
      std::fprintf(stderr, "build-path-library: this MPI may not be called from several threads\n");
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    const MPI_Aint bytes = rank_ == 0 ? 2 * sizeof(long long) : 0;
    MPI_Win_allocate(bytes, sizeof(long long), MPI_INFO_NULL, MPI_COMM_WORLD, &counters_, &window_);
    MPI_Win_lock_all(0, window_);
    if (rank_ == 0) replaced(failures, 0, MPI_REPLACE);
    begin_anew();
  }

  int rank() const override { return rank_; }

  std::size_t next() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return static_cast<std::size_t>(replaced(taken, 1, MPI_SUM));
  }

  std::vector<std::string> exchange(const std::string& mine) override {
    const auto ranks = static_cast<std::size_t>(size_);
    const int length = static_cast<int>(mine.size());
    std::vector<int> lengths(ranks);
    MPI_Allgather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, MPI_COMM_WORLD);
    std::vector<int> starts(ranks, 0);
    for (std::size_t i = 1; i < ranks; ++i) starts[i] = starts[i - 1] + lengths[i - 1];
    std::string all(static_cast<std::size_t>(starts.back() + lengths.back()), ' ');
    MPI_Allgatherv(mine.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(),
                   MPI_CHAR, MPI_COMM_WORLD);
    begin_anew();
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < ranks; ++i) {
      texts.push_back(
          all.substr(static_cast<std::size_t>(starts[i]), static_cast<std::size_t>(lengths[i])));
    }
    return texts;
  }

  void end(int code, const std::string& complaint) override {
    constexpr int stopped_early = 75;
    if (code != 0 && code != stopped_early) {
      complain(complaint);
      // The launcher drops what it has not passed on when it takes the job down.
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      MPI_Abort(MPI_COMM_WORLD, code);
    }
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }

 private:
  enum Counter { taken, failures };

  void begin_anew() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_ == 0) replaced(taken, 0, MPI_REPLACE);
    MPI_Barrier(MPI_COMM_WORLD);
  }

  /// What a counter held before.
  long long replaced(Counter counter, long long operand, MPI_Op operation) {
    long long before = 0;
    MPI_Fetch_and_op(&operand, &before, MPI_LONG_LONG, 0, counter, operation, window_);
    MPI_Win_flush(0, window_);
    return before;
  }

  /// Where all fail alike, the first rank has said why by itself; where only others do, the first
  /// of them to come here speaks. Then it takes down those who wait.
  void complain(const std::string& text) {
    if (rank_ != 0) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (replaced(failures, 1, MPI_SUM) > 0) {
      std::this_thread::sleep_for(std::chrono::seconds(10));
    } else if (rank_ != 0) {
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) {
        std::fprintf(stderr, "rank %d: %s\n", rank_, line.c_str());
      }
    }
  }

  int rank_ = 0;
  int size_ = 1;
  long long* counters_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;
};

/// Set by the launchers of Open MPI and MPICH, and by Slurm's srun. Starting MPI without one of
/// them takes a good part of a second.
bool launched() {
  const char* const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"};
  return std::any_of(std::begin(names), std::end(names),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace

std::unique_ptr<Ranks> Ranks::started() {
  if (!launched()) return nullptr;
  return std::make_unique<MpiRanks>();
}

}  // namespace excavplan::tools

#else

std::unique_ptr<excavplan::tools::Ranks> excavplan::tools::Ranks::started() { return nullptr; }

#endif
