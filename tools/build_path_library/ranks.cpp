// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "build_path_library/ranks.hpp"

#ifndef EXCAVPLAN_MPI

int excavplan::tools::run_ranked(int argc, const char* const* argv, const RankedProgram& program) {
  return program(argc, argv, nullptr);
}

#else

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <sstream>
#include <thread>

#include <excavplan/base/error.hpp>

#include "base/parallel.hpp"

namespace excavplan::tools {
namespace {

constexpr std::chrono::microseconds between_polls(200);
// On an abort the launcher discards output that it has not forwarded.
constexpr std::chrono::milliseconds before_abort(300);

/// Collects what is written to a stream, for as long as it exists.
class Captured {
 public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* before_;
};

/// The answer of a worker as text: a character for its kind, then the result or the error.
std::string answer_of(const LibraryWorker& worker, const std::string& task) {
  try {
    return "+" + worker(task);
  } catch (const Error& e) {
    return (e.kind() == ErrorKind::bad_file ? "f" : "i") + std::string(e.what());
  } catch (const std::exception& e) {
    return "!" + std::string(e.what());
  }
}

std::string result_in(const std::string& answer, int rank) {
  if (answer[0] == '+') return answer.substr(1);
  const std::string text = "rank " + std::to_string(rank) + ": " + answer.substr(1);
  if (answer[0] == '!') throw std::runtime_error(text);
  throw Error(answer[0] == 'f' ? ErrorKind::bad_file : ErrorKind::bad_input, text);
}

class MpiRanks : public Ranks {
 public:
  explicit MpiRanks(std::string job) : job_(std::move(job)) {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) {
      std::fprintf(stderr, "build-path-library: this MPI may not be called from several threads\n");
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const override { return rank_; }

  void agree(unsigned threads) override {
    lanes_ = static_cast<int>(threads);
    compare(0, job_);
  }

  std::vector<LibraryWorker> workers() override {
    std::vector<LibraryWorker> all;
    for (int rank = 1; rank < size_; ++rank) {
      for (int lane = 0; lane < lanes_; ++lane) {
        all.emplace_back([this, rank, lane](const std::string& task) {
          send(rank, lane, task);
          return result_in(received(rank, lane).text, rank);
        });
      }
    }
    return all;
  }

  /// Each thread takes the tasks of any lane, so that fewer threads do them too.
  void serve(const LibraryWorker& worker) override {
    const auto lanes = static_cast<unsigned>(lanes_);
    parallel_for(lanes, lanes, [&](std::size_t) {
      try {
        for (Message task = received(0, MPI_ANY_TAG); !task.text.empty();
             task = received(0, MPI_ANY_TAG)) {
          send(0, task.lane, answer_of(worker, task.text));
        }
      } catch (const std::exception& e) {
        fail(1, std::string("build-path-library: ") + e.what());  // rank 0 waits for the answer
      }
    });
  }

  /// Ends this rank's part.
  void end(int code, const std::string& complaint) {
    if (!agreed_) compare(code, complaint);
    if (rank_ != 0 && code != 0) fail(code, complaint);
    for (int rank = 1; rank_ == 0 && rank < size_; ++rank) {
      for (int lane = 0; lane < lanes_; ++lane) send(rank, lane, {});
    }
    MPI_Finalize();
  }

 private:
  /// Returns if no rank has failed and all have the same text.
  void compare(int code, const std::string& text) {
    agreed_ = true;
    std::vector<int> codes(static_cast<std::size_t>(size_));
    MPI_Allgather(&code, 1, MPI_INT, codes.data(), 1, MPI_INT, MPI_COMM_WORLD);
    const auto failed = std::find_if(codes.begin(), codes.end(), [](int c) { return c != 0; });
    if (failed != codes.end()) {
      if (failed - codes.begin() == rank_) fail(code, text);
      wait_for_the_end();
    }
    std::string first = text;
    int length = static_cast<int>(first.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
    first.resize(static_cast<std::size_t>(length));
    MPI_Bcast(first.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
    int other = first == text ? size_ : rank_;
    int lowest = size_;
    MPI_Allreduce(&other, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (lowest == size_) return;
    if (lowest == rank_) {
      fail(2,
           "build-path-library: the ranks of an MPI job share out one build: give all of them "
           "the same options\n");
    }
    wait_for_the_end();
  }

  /// Prints the reason, which rank 0 has printed already, and aborts all ranks.
  [[noreturn]] void fail(int code, const std::string& complaint) {
    std::istringstream lines(rank_ == 0 ? "" : complaint);
    for (std::string line; std::getline(lines, line);) {
      std::fprintf(stderr, "rank %d: %s\n", rank_, line.c_str());
    }
    std::this_thread::sleep_for(before_abort);
    const std::lock_guard<std::mutex> lock(mutex_);
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
  }

  [[noreturn]] static void wait_for_the_end() {
    for (;;) std::this_thread::sleep_for(before_abort);
  }

  // Called by several threads; the mutex is held for single MPI calls only.

  void send(int rank, int lane, const std::string& text) {
    MPI_Request request = MPI_REQUEST_NULL;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      MPI_Isend(text.data(), static_cast<int>(text.size()), MPI_CHAR, rank, lane, MPI_COMM_WORLD,
                &request);
    }
    for (int sent = 0;; std::this_thread::sleep_for(between_polls)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      MPI_Test(&request, &sent, MPI_STATUS_IGNORE);
      if (sent != 0) return;
    }
  }

  struct Message {
    int lane = 0;
    std::string text;
  };

  /// @param lane  or MPI_ANY_TAG
  Message received(int rank, int lane) {
    for (;; std::this_thread::sleep_for(between_polls)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      int there = 0;
      MPI_Status status;
      MPI_Iprobe(rank, lane, MPI_COMM_WORLD, &there, &status);
      if (there == 0) continue;
      int length = 0;
      MPI_Get_count(&status, MPI_CHAR, &length);
      Message message{status.MPI_TAG, std::string(static_cast<std::size_t>(length), ' ')};
      MPI_Recv(message.text.data(), length, MPI_CHAR, rank, message.lane, MPI_COMM_WORLD,
               MPI_STATUS_IGNORE);
      return message;
    }
  }

  const std::string job_;
  int rank_ = 0;
  int size_ = 1;
  int lanes_ = 0;  // threads of each of the others that work for rank 0
  bool agreed_ = false;
  std::mutex mutex_;
};

/// Set by the launchers of Open MPI and MPICH, and by Slurm's srun. Without one of them MPI is not
/// started: that takes longer than a small build.
bool launched() {
  const char* const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"};
  return std::any_of(std::begin(names), std::end(names),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace

int run_ranked(int argc, const char* const* argv, const RankedProgram& program) {
  if (!launched()) return program(argc, argv, nullptr);
  std::vector<const char*> words(argv, argv + argc);
  std::string job;
  for (int i = 1; i < argc; ++i) job += std::string(argv[i]) + '\n';
  MpiRanks ranks(job);
  if (ranks.rank() == 0) {
    const int code = program(argc, argv, &ranks);
    ranks.end(code, {});
    return code;
  }
  words.push_back("--quiet");  // but for errors
  std::string complaint;
  int code = 0;
  {
    const Captured answer(std::cout), errors(std::cerr);
    code = program(static_cast<int>(words.size()), words.data(), &ranks);
    complaint = errors.text();
  }
  ranks.end(code, complaint);
  return code;
}

}  // namespace excavplan::tools

#endif
