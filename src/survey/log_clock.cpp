// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "survey/log_clock.hpp"

#include <cstddef>
#include <string>

#include "base/table_dialect.hpp"

namespace excavplan {
namespace {

using std::string_view;

/// Of one or two digits, or of four, at the front, with the sign behind it; both are taken off.
std::optional<int> taken_number(string_view& text, std::size_t most_digits, char sign) {
  std::size_t digits = 0;
  int value = 0;
  while (digits < text.size() && digits < most_digits && text[digits] >= '0' &&
         text[digits] <= '9') {
    value = 10 * value + (text[digits++] - '0');
  }
  if (digits == 0 || digits == text.size() || text[digits] != sign) return std::nullopt;
  text.remove_prefix(digits + 1);
  return value;
}

/// Days from 1970-01-01 (proleptic Gregorian; Hinnant 2021, "chrono-compatible low-level date
/// algorithms").
int days_from_civil(int year, int month, int day) {
  year -= month <= 2 ? 1 : 0;
  const int era = (year >= 0 ? year : year - 399) / 400;
  const int year_of_era = year - era * 400;
  const int day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097 + day_of_era - 719468;
}

std::optional<int> taken_date(string_view& text) {
  string_view rest = text;
  const auto year = taken_number(rest, 4, '-');
  const auto month = year ? taken_number(rest, 2, '-') : std::nullopt;
  if (!month || *month < 1 || *month > 12) return std::nullopt;
  const char sign = rest.find('T') != rest.npos ? 'T' : ' ';
  const auto day = taken_number(rest, 2, sign);
  if (!day || *day < 1 || *day > 31) return std::nullopt;
  text = rest;
  return days_from_civil(*year, *month, *day);
}

}  // namespace

std::optional<double> seconds_of_clock(string_view text) {
  constexpr double day = 86400.0;
  const int days = taken_date(text).value_or(0);
  const auto hours = taken_number(text, 2, ':');
  const auto minutes = hours ? taken_number(text, 2, ':') : std::nullopt;
  if (!minutes || *hours > 23 || *minutes > 59) return std::nullopt;
  if (!text.empty() && text.back() == 'Z') text.remove_suffix(1);
  const char mark = text.find(',') != text.npos ? ',' : '.';
  if (text.empty() || text[0] < '0' || text[0] > '9') return std::nullopt;
  const auto seconds = number_of(text, mark);
  if (!seconds || *seconds >= 61.0) return std::nullopt;
  return day * days + 3600.0 * *hours + 60.0 * *minutes + *seconds;
}

}  // namespace excavplan
