// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>

#include "recording/times.hpp"

/// @file What of a recording is damaged and was left out, so that it spoils nothing else. Private
/// to the library.

namespace excavplan {

/// Times at which messages were recorded, both included [ns since 1970].
struct TimeRange {
  std::int64_t from = earliest;
  std::int64_t to = latest;
};

/// Messages that may have been lost.
struct Loss {
  TimeRange times;
  std::set<std::string> topics = {};  ///< empty: any
};

/// Of damage that no message was lost by, as what it hits is known from elsewhere.
constexpr TimeRange no_time = {latest, earliest};

/// No damage but what a limit forbids, or a build or this library cannot read: is never skipped.
class Unsupported : public Error {
 public:
  explicit Unsupported(const std::string& message) : Error(ErrorKind::bad_file, message) {}
};

/// No damage of a recording either: its disk or the system failed while it was read.
class Unreadable : public Unsupported {
  using Unsupported::Unsupported;
};

/// The parts that were left out, each once however often it was met.
class SkippedParts {
 public:
  /// @param why  as an error says it: "file: byte 17: found X, expected Y"
  /// @param loss  of what may have been in it
  void add(const std::string& why, const Loss& loss);
  /// Of what lay behind a time; close() says before which.
  void add_open(const std::string& why, std::int64_t from);
  void close(std::int64_t to);

  /// Runs `work`. @return false if it found damage (Error of bad_file), which is noted
  template <typename Work>
  bool guard(const Loss& loss, const Work& work) {
    return run(work, [&](const std::string& why) { add(why, loss); });
  }
  template <typename Work>
  bool guard(const TimeRange& times, const Work& work) {
    return guard(Loss{times}, work);
  }
  /// Likewise, noted by add_open().
  template <typename Work>
  bool guard_open(std::int64_t from, const Work& work) {
    return run(work, [&](const std::string& why) { add_open(why, from); });
  }

  const std::map<std::string, Loss>& parts() const { return whys_; }  ///< at most 1000
  std::uint64_t count() const { return whys_.size() + more_; }
  const std::string& first() const { return first_; }  ///< why; empty if there are none
  /// "3 parts are damaged and left out, the first: ..."; empty if there are none.
  std::string text() const;
  /// The earliest time in a range of a message of a topic that may have been in one of them.
  std::optional<std::int64_t> first_lost(const std::string& topic, const TimeRange& range) const;

 private:
  template <typename Work, typename Note>
  static bool run(const Work& work, const Note& note) {
    try {
      work();
      return true;
    } catch (const Unsupported&) {
      throw;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_file) throw;
      note(error.what());
      return false;
    }
  }

  std::map<std::string, Loss> whys_;
  std::vector<std::string> open_;  ///< of these, whose end is not known yet
  std::string first_;
  std::uint64_t more_ = 0;       ///< beyond those that are kept
  TimeRange of_more_ = no_time;  ///< their times
};

/// A topic lasts no longer; messages farther from the middle one of it bear a wrong time. Ours
/// [ns].
constexpr std::int64_t longest_topic = std::int64_t{366} * 86400 * 1000000000;

/// The times near the middle one of a topic's, which are put in another order.
TimeRange usual_times(std::vector<std::int64_t>& times);
TimeRange about(std::int64_t middle);

}  // namespace excavplan
