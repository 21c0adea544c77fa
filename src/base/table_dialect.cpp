// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table_dialect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <excavplan/base/error.hpp>

#include "base/read_double.hpp"
#include "base/table_text.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string_view;

constexpr std::size_t looked_at = 100;       // records that show a delimiter; ours
constexpr std::size_t longest_number = 400;  // of a double, in full [byte]

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits_from(string_view text, std::size_t at) {
  const auto begin = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return static_cast<std::size_t>(std::find_if_not(begin, text.end(), is_digit) - begin);
}

// ---- Delimiter --------------------------------------------------------------------------------

/// Share of the fields that are numbers; nothing if a record has not as many as the first.
std::optional<double> share_of_numbers(const std::string& path, string_view text, char delimiter) {
  TableRecords records(path, text, delimiter);
  std::vector<string_view> fields;
  std::size_t columns = 0;
  std::size_t all = 0;
  std::size_t numbers = 0;
  try {
    if (!records.next(fields) || fields.size() < 2) return std::nullopt;
    columns = fields.size();
    for (std::size_t i = 0; i < looked_at && records.next(fields); ++i) {
      if (fields.size() != columns) return std::nullopt;
      for (const string_view field : fields) {
        ++all;
        if (number_of(field, '.') || number_of(field, ',')) ++numbers;
      }
    }
  } catch (const Error&) {
    return std::nullopt;
  }
  return all == 0 ? 0.0 : static_cast<double>(numbers) / static_cast<double>(all);
}

/// Of the line of names, that which stands there most often.
char most_frequent(const std::string& path, string_view text, const std::array<char, 4>& list) {
  char best = ',';
  std::size_t most = 1;
  for (const char delimiter : list) {
    std::vector<string_view> names;
    TableRecords records(path, text, delimiter);
    try {
      if (!records.next(names) || names.size() <= most) continue;
    } catch (const Error&) {
      continue;
    }
    most = names.size();
    best = delimiter;
  }
  return best;
}

// ---- Decimal mark -----------------------------------------------------------------------------

/// A number with one mark in it.
struct Marked {
  char mark = '.';
  bool is_proof = true;  ///< false: three digits follow, which the mark may set off as thousands
};

std::optional<Marked> marked_number(string_view field) {
  if (!field.empty() && (field[0] == '+' || field[0] == '-')) field.remove_prefix(1);
  const std::size_t before = digits_from(field, 0);
  if (before == field.size() || (field[before] != '.' && field[before] != ',')) return std::nullopt;
  const std::size_t after = digits_from(field, before + 1);
  if (!number_of(field, field[before])) return std::nullopt;
  const bool is_whole = before + 1 + after == field.size();
  const bool in_groups = is_whole && after == 3 && before >= 1 && before <= 3 && field[0] != '0';
  return Marked{field[before], !in_groups};
}

/// The mark that a time of day has before its decimals, or that goes with a date of points. Both
/// speak for it only where the numbers leave it open: times are often written by other means.
std::optional<char> mark_beside(string_view field) {
  const std::size_t colon = field.rfind(':');
  if (colon != field.npos) {
    const std::size_t end = colon + 1 + digits_from(field, colon + 1);
    if (end < field.size() && (field[end] == ',' || field[end] == '.')) return field[end];
  }
  const std::size_t day = digits_from(field, 0);
  const std::size_t month = digits_from(field, day + 1);
  const std::size_t year = digits_from(field, day + month + 2);
  const bool has_points =
      day + month + 1 < field.size() && field[day] == '.' && field[day + month + 1] == '.';
  if (has_points && day >= 1 && month >= 1 && year == 4) return ',';
  return std::nullopt;
}

/// The first field that says something, and where.
struct Evidence {
  std::string field;
  std::string place;
  bool is_proof = false;
};

}  // namespace

std::optional<double> number_of(string_view field, char decimal_mark) {
  if (field.empty() || field.size() > longest_number) return std::nullopt;
  if (field[0] == '+' && field.size() > 1 && field[1] != '-') field.remove_prefix(1);
  std::array<char, longest_number> plain{};
  std::copy(field.begin(), field.end(), plain.begin());
  char* const end = plain.data() + field.size();
  if (decimal_mark != '.') {
    if (field.find('.') != field.npos) return std::nullopt;
    std::replace(plain.data(), end, decimal_mark, '.');
  }
  double value = 0.0;
  const auto [stop, error] = read_double(plain.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

char find_delimiter(const std::string& path, string_view text) {
  constexpr std::array<char, 4> list = {',', ';', '\t', '|'};
  std::optional<char> best;
  double most = -1.0;
  bool is_tie = false;
  for (const char delimiter : list) {
    const auto share = share_of_numbers(path, text, delimiter);
    if (!share) continue;
    is_tie = *share == most;
    if (*share <= most) continue;
    best = delimiter;
    most = *share;
  }
  if (is_tie && most > 0.0) {
    throw Error(ErrorKind::bad_file,
                path + ": can be read with more than one delimiter: state the delimiter");
  }
  return best ? *best : most_frequent(path, text, list);
}

char find_decimal_mark(const std::string& path, string_view text, char delimiter) {
  TableRecords records(path, text, delimiter);
  std::vector<string_view> fields;
  std::optional<Evidence> point;
  std::optional<Evidence> comma;
  std::optional<char> beside;
  records.next(fields);
  const std::vector<std::string> names(fields.begin(), fields.end());
  while (records.next(fields)) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (!beside) beside = mark_beside(fields[i]);
      const auto marked = marked_number(fields[i]);
      if (!marked) continue;
      auto& known = marked->mark == '.' ? point : comma;
      if (known && (known->is_proof || !marked->is_proof)) continue;
      const std::string name = i < names.size() ? safe_text(names[i], 40) : "a field";
      known = {in_quotes(fields[i]),
               "line " + std::to_string(records.line()) + ": " + name + " is ", marked->is_proof};
    }
  }
  // A comma between fields is none in numbers.
  if (point && !comma && delimiter == ',') return '.';
  const auto proven = [](const std::optional<Evidence>& seen) { return seen && seen->is_proof; };
  if (proven(point) && proven(comma)) {
    throw Error(ErrorKind::bad_file, path + ": " + comma->place + comma->field + ", but " +
                                         point->place + point->field + ": state the decimal mark");
  }
  if (proven(comma)) return ',';
  if (proven(point) || (!point && !comma)) return '.';
  if (beside == (comma ? ',' : '.')) return *beside;
  const Evidence& open = comma ? *comma : *point;
  throw Error(ErrorKind::bad_file, path + ": " + open.place + open.field +
                                       ", which may be a decimal or thousands: state the decimal "
                                       "mark");
}

}  // namespace excavplan
