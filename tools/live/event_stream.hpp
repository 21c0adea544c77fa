// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "live/live_feed.hpp"

namespace excavplan::tools {

/// The server-sent events of one client: it gets what it lacks when it can take it, so that a slow
/// one costs no memory.
class EventStream {
 public:
  /// @param from  edition of the page that it has, or the id of the last event, "EDITION.STEPS"
  /// @param steps  that it has, where `from` does not tell
  EventStream(const std::string& from, const std::string& steps);

  /// The next events; empty if there are none.
  std::string take(const LiveFeed& feed);

 private:
  using Clock = std::chrono::steady_clock;

  int edition_ = -1;
  std::size_t steps_ = 0;
  int state_version_ = -1;
  bool is_over_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace excavplan::tools
