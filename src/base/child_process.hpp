// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/types.h>

/// @file
/// A program that this one runs and asks line by line. Private to the project.

namespace excavplan {

/// What a program did instead of answering: "it gave no answer within 2 s".
struct ChildFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// It ended or closed its output.
struct ChildEnded : ChildFailure {
  using ChildFailure::ChildFailure;
};

/// The words of a command. Spaces part them, '..' and ".." hold them together.
/// @throws ChildFailure if there is none, or a quotation does not end
std::vector<std::string> words_of(const std::string& command);

/// A running program in a process group of its own, with pipes to its standard streams. It and all
/// that it started in that group are ended with this.
class ChildProcess {
 public:
  /// @throws ChildFailure with the reason if it cannot be started
  explicit ChildProcess(const std::vector<std::string>& words);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes a line and waits for one, both without their end.
  /// @throws ChildFailure if the program ends, closes its output, is silent or too slow for
  /// `limit`,
  ///         answers with more than `longest` bytes, or had written without being asked
  std::string ask(const std::string& line, std::chrono::duration<double> limit,
                  std::size_t longest);

  /// What it wrote on standard error since the last call, of much the end.
  std::string take_notes();

  /// Ends all programs and lets no more start.
  static void end_all();

 private:
  enum Stream { input, output, notes };

  void start(const std::vector<std::string>& words);
  void write_some(const std::string& line, std::size_t& written);
  /// @return false at the end of the stream
  bool read_some(Stream stream, std::string& to);
  bool wait(bool writes, std::chrono::steady_clock::time_point until);
  std::string how_it_ended();
  bool ended_within(int milliseconds) const;
  void end();

  pid_t pid_ = -1;
  std::array<int, 3> pipes_ = {-1, -1, -1};  ///< our ends, by Stream
  std::string read_;                         ///< of its output, not asked for yet
  std::string notes_;
};

}  // namespace excavplan
