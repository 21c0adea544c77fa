// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

namespace excavplan::tools {

/// How a tool takes signals while this lives; one at a time.
///
/// INT, TERM and HUP end the program as they do by default, but first end the programs of
/// simulators and remove the files that are not written to their end. A tool that can stop is
/// first asked to, and given 1.5 s (ours) or until a second signal. A signal that was ignored when
/// the program began remains so. A limit on the size of files (XFSZ) and a pipe that its reader
/// closed (PIPE) become errors of the write. Where memory ends and std::terminate() would abort,
/// the program ends with 1 and says so.
class Signals {
 public:
  explicit Signals(bool can_stop);
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// From here on the tool can stop.
  void let_stop() { can_stop_ = true; }
  /// True once INT, TERM or HUP has come.
  bool stop_requested() const;
  /// From here on a closed pipe ends the program, as it does by default: only standard output is
  /// still to be written.
  void end_at_closed_pipe() const;

 private:
  void watch() const;

  std::atomic<bool> can_stop_;
  std::thread watcher_;
};

}  // namespace excavplan::tools
