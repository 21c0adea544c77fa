// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/logs/dig_log.hpp>

#include "base/table.hpp"

/// @file
/// Where the digs are in a log. Private to the library.

namespace excavplan {

/// What a column of phases marks.
struct MarkedPhases {
  std::vector<LogInterval> digs;
  LogInterval cycle;  ///< without idling or rest before and behind it
};

/// By a column of names: penetrate, drag and scoop are a dig, which begins anew where scoop is
/// followed by another of them. A dig goes half-way to the rows beside it.
/// @throws Error (bad_file) naming line and word of a phase that is unknown
MarkedPhases marked_phases(const Table& table, const std::string& column,
                           const std::vector<double>& time);

/// By angles of the joints [rad], positive curls in: a dig is a stretch in which arm or bucket curl
/// in, with pauses of less than 1 s, by at least 0.5 rad together. Numbers are ours.
std::vector<LogInterval> found_digs(const std::vector<double>& time, const std::vector<double>& arm,
                                    const std::vector<double>& bucket);

}  // namespace excavplan
