// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks.hpp"

#ifdef EXCAVPLAN_MPI

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace excavplan::tools {
namespace {

/// Takes numbers from a counter in the memory of rank 0, which need not do anything for it.
class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    const MPI_Aint bytes = rank_ == 0 ? sizeof(long long) : 0;
    MPI_Win_allocate(bytes, sizeof(long long), MPI_INFO_NULL, MPI_COMM_WORLD, &counter_, &window_);
    MPI_Win_lock_all(0, window_);
    begin_anew();
  }

  int rank() const override { return rank_; }

  std::size_t next() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const long long one = 1;
    long long taken = 0;
    MPI_Fetch_and_op(&one, &taken, MPI_LONG_LONG, 0, 0, MPI_SUM, window_);
    MPI_Win_flush(0, window_);
    return static_cast<std::size_t>(taken);
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

  void end(int code) override {
    constexpr int stopped_early = 75;
    if (code != 0 && code != stopped_early) {
      // Where all fail alike, the first rank tells why before it is taken down.
      if (rank_ != 0) std::this_thread::sleep_for(std::chrono::seconds(1));
      MPI_Abort(MPI_COMM_WORLD, code);
    }
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }

 private:
  void begin_anew() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_ == 0) {
      const long long zero = 0;
      long long before = 0;
      MPI_Fetch_and_op(&zero, &before, MPI_LONG_LONG, 0, 0, MPI_REPLACE, window_);
      MPI_Win_flush(0, window_);
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }

  int rank_ = 0;
  int size_ = 1;
  long long* counter_ = nullptr;
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
