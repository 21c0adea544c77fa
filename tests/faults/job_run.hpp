// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/resource.h>

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <thread>

#include "faults/jobs.hpp"

/// @file
/// One run of a job with something that goes wrong, and whether the tool took it well.

namespace excavplan::test {

/// Runs in the child before the tool begins.
using Prepare = std::function<void()>;

struct SentSignal {
  int signal = 0;
  double after = 0.0;  ///< the start [s]
};

struct JobResult {
  int status = 0;
  double seconds = 0.0;  ///< from the start, or the signal, to the end
  bool hung = false;
  std::string out, err;
};

inline const std::string old_content = "what was there before\n";
constexpr double longest_run = 60.0;  ///< [s]; a job takes below 1

/// The folder of all jobs: inputs, outputs, and the streams of the last run beside it.
class JobFolder {
 public:
  JobFolder() { write_inputs(folder_); }
  explicit JobFolder(const JobFolder& other) = delete;

  std::string path() const { return folder_.file(""); }

  JobResult run(const Job& job, const Prepare& prepare, std::optional<SentSignal> sent = {}) const {
    for (const std::string& name : job.outputs) folder_.write(name, old_content);
    std::array<int, 2> errors{};  // no file, whose size may be limited
    if (::pipe(errors.data()) != 0) throw std::runtime_error("no pipe to be had");
    using Clock = std::chrono::steady_clock;
    auto since = Clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(Clock::now() - since).count();
    };
    const pid_t child = started(job.tool, job.words + Words{"--json"}, [&] {
      constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
      ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
      ::dup2(::open(streams_.file("out").c_str(), flags, 0600), STDOUT_FILENO);
      ::dup2(errors[1], STDERR_FILENO);
      for (const int end : errors) ::close(end);
      ::setenv("TMPDIR", path().c_str(), 1);
      if (::chdir(path().c_str()) != 0) ::_exit(126);
      prepare();
    });
    ::close(errors[1]);
    JobResult result;
    while (::waitpid(child, &result.status, WNOHANG) == 0) {
      if (sent && seconds() >= sent->after) {
        ::kill(child, sent->signal);
        sent.reset();
        since = Clock::now();
      }
      const double longest = job.slow ? 10.0 * longest_run : longest_run;
      if (seconds() > longest && !result.hung) result.hung = ::kill(child, SIGKILL) == 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    result.seconds = seconds();
    result.out = content_of(streams_.file("out"));
    std::array<char, 4096> text{};  // a tool says less
    const ssize_t got = ::read(errors[0], text.data(), text.size());
    result.err.assign(text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    ::close(errors[0]);
    return result;
  }

  /// The outputs of a run without faults, and what it prints but for times.
  /// @param seconds  set to the time it takes
  std::map<std::string, std::string> reference(const Job& job, double& seconds) const {
    const JobResult whole = run(job, [] {});
    seconds = whole.seconds;
    if (exit_code(whole.status) != 0) throw std::runtime_error(job.tool + ": " + whole.err);
    std::map<std::string, std::string> content = {{"", without_times(whole.out)}};
    for (const std::string& name : job.outputs) content[name] = content_of(folder_.file(name));
    clear_leftovers(job);
    return content;
  }

  /// What is wrong after a run; empty if nothing is.
  std::string fault_in(const Job& job, const JobResult& result,
                       std::map<std::string, std::string> whole) const {
    if (result.hung) return "hangs";
    if (WIFSIGNALED(result.status)) {
      return "ended by signal " + std::to_string(WTERMSIG(result.status)) + ": " + result.err;
    }
    const int code = exit_code(result.status);
    if (code == 0 && without_times(result.out) != whole[""]) return "exit 0, other results";
    if (code != 0 && (code > 3 || result.err.rfind(job.tool + ": ", 0) != 0)) {
      return "exit " + std::to_string(code) + ": " + result.err;
    }
    if (code == 1 && result.err.find("internal error") != std::string::npos) return result.err;
    return fault_in_files(job, std::move(whole), code == 0);
  }

  /// Files half written, lost or left over.
  std::string fault_in_files(const Job& job, std::map<std::string, std::string> whole,
                             bool all_new) const {
    for (const std::string& name : job.outputs) {
      const std::string content = content_of(folder_.file(name));
      const bool is_new = content == whole[name];
      if (!is_new && (all_new || content != old_content)) return name + " is neither old nor new";
    }
    for (const auto& entry : fs::recursive_directory_iterator(path())) {
      const std::string name = entry.path().filename();
      if (name.find(".part-") != std::string::npos || name.rfind("excavplan-", 0) == 0) {
        return name + " is left over";
      }
    }
    return {};
  }

  void clear_leftovers(const Job& job) const {
    for (const std::string& name : job.outputs) fs::remove_all(folder_.file(name + ".cells"));
    for (const auto& entry : fs::directory_iterator(path())) {
      if (entry.path().filename().string().find(".part-") != std::string::npos) {
        fs::remove(entry.path());
      }
    }
  }

 private:
  static std::string without_times(const std::string& text) {
    static const std::regex time("\"(wall_time_s|seconds)\": [^,\n]*");
    return std::regex_replace(text, time, "");
  }

  TemporaryFolder folder_;
  TemporaryFolder streams_;
};

}  // namespace excavplan::test
