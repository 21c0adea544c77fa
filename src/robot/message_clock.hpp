// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

/// @file When messages were measured. Private to the library.

namespace excavplan {

/// The stamps of one topic by the clock of who receives it.
///
/// Those that are off by more than a minute (ours) are of another clock: of a recording that is
/// played, or of a sensor since it was switched on. The least delay of the last 20 messages (ours)
/// tells by how much; that of one that waited in a queue is larger.
class MessageClock {
 public:
  /// @param stamp     0: none [ns]
  /// @param received  nothing: the stamps are by the right clock [ns]
  /// @return nothing if neither is known
  std::optional<std::int64_t> time(std::int64_t stamp, std::optional<std::int64_t> received);

 private:
  std::deque<std::int64_t> delays_;  // received - stamp, of the last messages
};

}  // namespace excavplan
