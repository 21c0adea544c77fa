// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "logs/dig_phases.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr std::array<const char*, 3> dig_words = {"penetrate", "drag", "scoop"};
constexpr std::array<const char*, 6> other_words = {"approach", "lift",   "swing",
                                                    "dump",     "return", "lower"};
constexpr std::array<const char*, 3> rest_words = {"idle", "rest", ""};

template <typename List>
bool holds(const List& list, const std::string& word) {
  return std::any_of(list.begin(), list.end(), [&](const char* known) { return word == known; });
}

double half_way(const std::vector<double>& time, std::size_t row) {
  return 0.5 * (time[row - 1] + time[row]);
}

[[noreturn]] void refuse_phase(const Table& table, std::size_t row, const std::string& word) {
  throw Error(ErrorKind::bad_file,
              table.path() + ": line " + std::to_string(table.line(row)) + ": phase is " +
                  in_quotes(word) +
                  ", expected penetrate, drag, scoop, or one of approach, lift, swing, dump, "
                  "return, lower, idle, rest");
}

}  // namespace

MarkedPhases marked_phases(const Table& table, const std::string& column,
                           const std::vector<double>& time) {
  const std::vector<std::string> words = table.texts(column);
  const std::size_t rows = words.size();
  const auto begin_of = [&](std::size_t i) { return i == 0 ? time[0] : half_way(time, i); };
  const auto end_of = [&](std::size_t i) {
    return i + 1 == rows ? time.back() : half_way(time, i + 1);
  };
  MarkedPhases found{{}, {time.back(), time.front()}};
  std::string before;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string word = small_letters(words[i]);
    if (!holds(dig_words, word) && !holds(other_words, word) && !holds(rest_words, word)) {
      refuse_phase(table, i, words[i]);
    }
    if (holds(dig_words, word)) {
      const bool is_new = !holds(dig_words, before) || (before == "scoop" && word != "scoop");
      if (is_new) found.digs.push_back({begin_of(i), 0.0});
      found.digs.back().to = end_of(i);
    }
    if (!holds(rest_words, word)) {
      found.cycle.from = std::min(found.cycle.from, begin_of(i));
      found.cycle.to = end_of(i);
    }
    before = word;
  }
  return found;
}

std::vector<LogInterval> found_digs(const std::vector<double>& time, const std::vector<double>& arm,
                                    const std::vector<double>& bucket) {
  constexpr double slowest = 0.05;     // [rad/s]; ours
  constexpr double longest_pause = 1;  // [s]; ours
  constexpr double least_turn = 0.5;   // [rad]; ours
  struct Curl {
    LogInterval during;
    double turn = 0.0;
  };
  std::vector<Curl> curls;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double step = time[i] - time[i - 1];
    const double turn =
        std::max(0.0, arm[i] - arm[i - 1]) + std::max(0.0, bucket[i] - bucket[i - 1]);
    if (turn < slowest * step) continue;
    if (curls.empty() || time[i - 1] - curls.back().during.to > longest_pause) {
      curls.push_back({{time[i - 1], time[i]}, 0.0});
    }
    curls.back().during.to = time[i];
    curls.back().turn += turn;
  }
  std::vector<LogInterval> digs;
  for (const Curl& curl : curls) {
    if (curl.turn >= least_turn) digs.push_back(curl.during);
  }
  return digs;
}

}  // namespace excavplan
