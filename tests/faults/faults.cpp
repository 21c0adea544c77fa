// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>

#include <cstdio>
#include <iostream>
#include <random>
#include <set>

#include "faults/job_run.hpp"

/// @file
/// Runs a small job of every tool and lets one thing go wrong: the n-th call of a kind fails, for
/// n = 1, 2, 3 .. until no call is left; files are limited in size; the disk is full; a signal
/// comes. Each run must give the right result with exit code 0, or a message and an exit code of
/// 1 .. 3, or end by the signal; old files must be whole and no file left over.
///
///   faults [--quick] [TOOL]

namespace excavplan::test {
namespace {

struct Count {
  int runs = 0, right = 0, refused = 0, findings = 0;
  double longest = 0.0;  ///< [s]
};

class Faults {
 public:
  explicit Faults(bool quick) : quick_(quick) {}

  void run(const Job& job) {
    if (quick_ && job.slow) return;
    double whole_time = 0.0;
    whole_ = folder_.reference(job, whole_time);
    if (!job.slow) {
      calls(job);
      sizes(job);
      full_streams(job);
    }
    if (!quick_) signals(job, whole_time);
  }

  /// @return the exit code
  int finish() const {
    std::printf("%d runs, %d findings\n", runs_, findings_);
    if (runs_ == 0) std::printf("no tool of that name was run\n");
    return findings_ == 0 && runs_ > 0 ? 0 : 1;
  }

 private:
  void calls(const Job& job) {
    for (const char* kind :
         {"open", "read", "write", "fsync", "rename", "close", "mkdir", "thread", "malloc"}) {
      for (const char* later : {"", "+"}) {
        if (quick_ && *later != '\0') continue;
        Count count;
        for (int n = 1; fail(job, kind, std::to_string(n) + later, count); n = next(n)) {
        }
        if (count.runs == 0 && must_call(job, kind)) found(job, kind, "none failed", count);
        report(job, std::string(kind) + later, count);
      }
    }
  }

  /// Else the faults do not reach the tool.
  static bool must_call(const Job& job, const std::string& kind) {
    const bool is_of_output = kind == "write" || kind == "fsync" || kind == "rename";
    return kind == "malloc" || (is_of_output && !job.outputs.empty());
  }

  /// All of the first, then fewer: there are thousands of allocations.
  int next(int n) const { return n < (quick_ ? 6 : 300) ? n + 1 : n + n / (quick_ ? 1 : 30); }

  /// @return whether there was a call to fail
  bool fail(const Job& job, const std::string& kind, const std::string& nth, Count& count) {
    TemporaryFolder folder;
    const std::string seen = folder.write("seen", "");
    const JobResult result = folder_.run(job, [&] {
      const int file = ::dup2(::open(seen.c_str(), O_WRONLY), 200);
      ::setenv("EXCAVPLAN_FAULT", (kind + ":" + nth).c_str(), 1);
      ::setenv("EXCAVPLAN_FAULT_SEEN", std::to_string(file).c_str(), 1);
      ::setenv("LD_PRELOAD", EXCAVPLAN_FAIL_NTH, 1);
    });
    if (content_of(seen).empty()) return false;
    judge(job, kind + ":" + nth, result, count);
    return true;
  }

  void sizes(const Job& job) {
    if (job.outputs.empty()) return;
    Count count;
    for (const rlim_t most : {0U, 1U, 100U, 1000U, 4096U, 5000U, 20000U, 100000U}) {
      const JobResult result = folder_.run(job, [&] {
        const rlimit limit = {most, most};
        ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
        ::setrlimit(RLIMIT_FSIZE, &limit);
      });
      judge_files(job, "files of " + std::to_string(most) + " bytes", result, count);
    }
    report(job, "file size", count);
  }

  void full_streams(const Job& job) {
    Count count;
    for (const Words& words : {Words{"--help"}, Words{"--version"}, job.words}) {
      const JobResult result = folder_.run(
          {job.tool, words, {}}, [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); });
      ++count.runs;
      const std::string expected =
          job.tool + ": standard output: cannot be written: No space left on device\n";
      const bool said = result.err.find(expected) != std::string::npos;
      if (exit_code(result.status) != 3 || !said)
        found(job, words[0] + " > /dev/full", result.err, count);
      ++count.refused;
    }
    report(job, "/dev/full", count);
  }

  void signals(const Job& job, double whole_time) {
    Count count;
    for (int i = 0; i < 40; ++i) {
      const int signal = i % 2 == 0 ? SIGTERM : SIGINT;
      const double after = std::uniform_real_distribution<double>(0.0, whole_time)(random_);
      const JobResult result = folder_.run(
          job, [] {}, SentSignal{signal, after});
      ++count.runs;
      const int status = result.status;
      const bool by_signal = WIFSIGNALED(status) && WTERMSIG(status) == signal;
      const bool good = by_signal || exit_code(status) == 0 || exit_code(status) == 75;
      ++(exit_code(status) == 0 ? count.right : count.refused);
      count.longest =
          std::max(count.longest, by_signal || exit_code(status) == 75 ? result.seconds : 0.0);
      const std::string when =
          "signal " + std::to_string(signal) + " after " + std::to_string(after) + " s";
      if (!good) found(job, when, "status " + std::to_string(status) + ", " + result.err, count);
      if (count.longest > 2.0) found(job, when, "takes longer than 2 s", count);
      const std::string fault = folder_.fault_in_files(job, whole_, exit_code(status) == 0);
      if (!fault.empty()) found(job, when, fault, count);
      folder_.clear_leftovers(job);
    }
    report(job, "signals", count);
  }

  void judge(const Job& job, const std::string& what, const JobResult& result, Count& count) {
    ++count.runs;
    ++(exit_code(result.status) == 0 ? count.right : count.refused);
    count.longest = std::max(count.longest, result.seconds);
    const std::string fault = folder_.fault_in(job, result, whole_);
    if (!fault.empty()) found(job, what, fault, count);
    folder_.clear_leftovers(job);
  }

  /// Without standard output, which is a file here.
  void judge_files(const Job& job, const std::string& what, JobResult result, Count& count) {
    result.out = whole_[""];
    judge(job, what, result, count);
  }

  void found(const Job& job, const std::string& what, const std::string& fault, Count& count) {
    ++count.findings;
    ++findings_;
    std::cout << "FOUND " << job.tool << ", " << what << ": " << fault << std::endl;
  }

  void report(const Job& job, const std::string& kind, const Count& count) {
    runs_ += count.runs;
    if (count.runs == 0) return;
    std::printf("%-20s %-10s %5d runs: %5d done, %5d refused, %d findings, at most %.2f s",
                job.tool.c_str(), kind.c_str(), count.runs, count.right, count.refused,
                count.findings, count.longest);
    std::printf("\n");
    std::fflush(stdout);
  }

  const bool quick_;
  JobFolder folder_;
  std::map<std::string, std::string> whole_;
  std::mt19937 random_{1};
  int runs_ = 0;
  int findings_ = 0;
};

}  // namespace
}  // namespace excavplan::test

int main(int argc, char** argv) {
  using namespace excavplan::test;
  const std::vector<std::string> words(argv + 1, argv + argc);
  const bool quick = !words.empty() && words.front() == "--quick";
  const std::string only = words.size() > (quick ? 1U : 0U) ? words.back() : "";
  const std::set<std::string> quick_tools = {"inspect-cloud", "measure-efficiency", "simulate-dig"};
  Faults faults(quick);
  for (const Job& job : jobs()) {
    const bool built = fs::exists(std::string(EXCAVPLAN_BIN) + "/" + job.tool);
    if (built && (only.empty() || only == job.tool) &&
        (!quick || quick_tools.count(job.tool) > 0)) {
      faults.run(job);
    }
  }
  return faults.finish();
}
