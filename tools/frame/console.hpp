// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>

#include "frame/signals.hpp"

namespace excavplan::tools {

constexpr std::size_t longest_line = 4000;  ///< of a text on the terminal; ours [byte]

/// Progress and notes on standard error while a tool works.
class Console {
 public:
  Console(bool quiet, bool terminal, Signals& signals)
      : quiet_(quiet), terminal_(terminal), signals_(signals) {}

  /// One line that is overwritten by the next; only on a terminal. `done` is in 0 .. 1.
  void progress(double done, const std::string& what);
  /// One line of text, from any thread. Warnings belong in the outcome.
  void note(const std::string& line);
  /// True once the user or the system asked a tool that can stop early to stop.
  bool stop_requested() const { return signals_.stop_requested(); }
  /// From here on the tool can stop early.
  void let_stop() { signals_.let_stop(); }
  /// Removes the progress line.
  void clear();

 private:
  void remove_line();

  bool quiet_;
  bool terminal_;
  Signals& signals_;
  std::mutex mutex_;  ///< of standard error and of
  bool line_open_ = false;
};

}  // namespace excavplan::tools
