// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/message_clock.hpp"

#include <algorithm>

#include "recording/times.hpp"

namespace excavplan {

std::optional<std::int64_t> MessageClock::time(std::int64_t stamp,
                                               std::optional<std::int64_t> received) {
  constexpr std::int64_t other_clock = 60'000'000'000;  // [ns]
  constexpr std::size_t remembered = 20;
  if (stamp == 0) return received;
  if (!received) return stamp;
  delays_.push_back(time_between(stamp, *received));
  if (delays_.size() > remembered) delays_.pop_front();
  const std::int64_t least = *std::min_element(delays_.begin(), delays_.end());
  const bool same = least >= -other_clock && least <= other_clock;
  return same ? stamp : later(stamp, least);
}

}  // namespace excavplan
