// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "logs/log_clock.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "base/table_dialect.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string_view;

constexpr double day = 86400.0;  // [s]

/// The numbers of a date as they stand.
struct WrittenDate {
  std::array<int, 3> numbers{};
  char sign = '-';  ///< between them
  bool year_first = true;
};

struct WrittenTime {
  std::optional<WrittenDate> date;
  double seconds = 0.0;  ///< since midnight
};

enum class Order { year_month_day, day_month_year, month_day_year };

/// Up to so many digits at the front, which are taken off.
std::optional<int> taken_number(string_view& text, std::size_t most_digits) {
  std::size_t digits = 0;
  int value = 0;
  while (digits < text.size() && digits < most_digits && text[digits] >= '0' &&
         text[digits] <= '9') {
    value = 10 * value + (text[digits++] - '0');
  }
  if (digits == 0) return std::nullopt;
  text.remove_prefix(digits);
  return value;
}

bool take(string_view& text, string_view signs) {
  if (text.empty() || signs.find(text[0]) == signs.npos) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<WrittenDate> taken_date(string_view& text) {
  constexpr std::size_t year_digits = 4;
  string_view rest = text;
  WrittenDate date;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t before = rest.size();
    const auto number = taken_number(rest, year_digits);
    if (!number) return std::nullopt;
    const bool is_year = before - rest.size() == year_digits;
    if (i == 0) date.year_first = is_year;
    if (is_year != (i == (date.year_first ? 0U : 2U))) return std::nullopt;
    date.numbers[i] = *number;
    if (i == 0 && !rest.empty()) date.sign = rest[0];
    if (!take(rest, i == 2 ? string_view(" T") : string_view(&date.sign, 1))) return std::nullopt;
  }
  if (string_view("-/.").find(date.sign) == string_view::npos) return std::nullopt;
  text = rest;
  return date;
}

/// Of " AM" or " PM" at the end, which is taken off: the hours that it adds to those from 0 to 11.
std::optional<int> taken_half_of_day(string_view& text) {
  if (text.size() < 2 || (text.back() != 'M' && text.back() != 'm')) return std::nullopt;
  const char half = text[text.size() - 2];
  if (string_view("AaPp").find(half) == string_view::npos) return std::nullopt;
  text.remove_suffix(2);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return half == 'A' || half == 'a' ? 0 : 12;
}

std::optional<WrittenTime> written_time(string_view text) {
  WrittenTime time;
  time.date = taken_date(text);
  const auto half = taken_half_of_day(text);
  if (!half && !text.empty() && text.back() == 'Z') text.remove_suffix(1);
  auto hours = taken_number(text, 2);
  if (!hours || !take(text, ":")) return std::nullopt;
  const auto minutes = taken_number(text, 2);
  if (!minutes || !take(text, ":") || *hours > 23 || *minutes > 59) return std::nullopt;
  if (half && (*hours < 1 || *hours > 12)) return std::nullopt;
  if (half) hours = *hours % 12 + *half;
  if (text.empty() || text[0] < '0' || text[0] > '9') return std::nullopt;
  const auto seconds = number_of(text, text.find(',') != text.npos ? ',' : '.');
  if (!seconds || *seconds >= 61.0) return std::nullopt;
  time.seconds = 3600.0 * *hours + 60.0 * *minutes + *seconds;
  return time;
}

/// Days from 1970-01-01 (proleptic Gregorian; Hinnant 2021, "chrono-compatible low-level date
/// algorithms").
int days_from_civil(int year, int month, int day_of_month) {
  year -= month <= 2 ? 1 : 0;
  const int era = (year >= 0 ? year : year - 399) / 400;
  const int year_of_era = year - era * 400;
  const int day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day_of_month - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097 + day_of_era - 719468;
}

/// Nothing if the calendar has no such day.
std::optional<int> days_of(const WrittenDate& date, Order order) {
  auto [year, month, day_of_month] = date.numbers;
  if (order != Order::year_month_day) std::swap(year, day_of_month);
  if (order == Order::month_day_year) std::swap(month, day_of_month);
  if (month < 1 || month > 12) return std::nullopt;
  const int first = days_from_civil(year, month, 1);
  const int next = days_from_civil(month == 12 ? year + 1 : year, month % 12 + 1, 1);
  if (day_of_month < 1 || day_of_month > next - first) return std::nullopt;
  return first + day_of_month - 1;
}

bool are_alike(const std::optional<WrittenDate>& a, const std::optional<WrittenDate>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->sign == b->sign && a->year_first == b->year_first;
}

ClockTimes fault_at(std::size_t row, std::string fault) { return {{}, row, std::move(fault)}; }

ClockTimes in_order(const std::vector<WrittenTime>& times, const std::vector<std::string>& texts,
                    Order order) {
  ClockTimes result;
  double midnight = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i].date) {
      const auto days = days_of(*times[i].date, order);
      if (!days) return fault_at(i, "a date that the calendar does not have");
      midnight = day * *days;
    } else if (i > 0 && times[i].seconds + midnight < result.seconds.back() - 0.5 * day) {
      midnight += day;
    }
    const double seconds = midnight + times[i].seconds;
    if (i > 0 && seconds <= result.seconds.back()) {
      return fault_at(i, "must be later than " + in_quotes(texts[i - 1]) + " of the row before");
    }
    result.seconds.push_back(seconds);
  }
  return result;
}

std::vector<Order> orders_of(const std::optional<WrittenDate>& date) {
  if (!date || date->year_first) return {Order::year_month_day};
  if (date->sign == '.') return {Order::day_month_year};
  return {Order::month_day_year, Order::day_month_year};
}

bool same_steps(const std::vector<double>& a, const std::vector<double>& b) {
  const double shift = b.front() - a.front();
  return std::equal(a.begin(), a.end(), b.begin(),
                    [&](double x, double y) { return y - x == shift; });
}

}  // namespace

ClockTimes clock_times(const std::vector<std::string>& texts) {
  std::vector<WrittenTime> times;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const auto time = written_time(texts[i]);
    if (!time) return fault_at(i, "expected a time as 13:05:59.250");
    times.push_back(*time);
    if (are_alike(times.front().date, time->date)) continue;
    return fault_at(i, "expected a date or none as in " + in_quotes(texts.front()));
  }
  std::optional<ClockTimes> best;
  for (const Order order : orders_of(times.front().date)) {
    ClockTimes read = in_order(times, texts, order);
    if (best && best->fault.empty() && read.fault.empty() &&
        !same_steps(best->seconds, read.seconds)) {
      return fault_at(0, "whose day and month may be either: write dates as 2026-11-23");
    }
    const bool is_better =
        !best || (!best->fault.empty() && (read.fault.empty() || read.bad_row > best->bad_row));
    if (is_better) best = std::move(read);
  }
  return *best;
}

}  // namespace excavplan
