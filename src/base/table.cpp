// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/error.hpp>

#include "base/files.hpp"
#include "base/read_double.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string_view;

constexpr std::size_t most_columns = 1000;  // ours
constexpr std::size_t longest_name = 40;    // that a message shows [byte]

string_view trimmed(string_view text) {
  constexpr string_view blanks = " \t\r\"";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// What stands before the next `end`, which is taken off with it.
string_view taken(string_view& text, char end) {
  const string_view before = text.substr(0, text.find(end));
  text.remove_prefix(std::min(text.size(), before.size() + 1));
  return before;
}

/// Of a line that is not empty, up to one more than there may be columns.
void split(string_view line, std::vector<string_view>& fields) {
  fields.clear();
  bool goes_on = true;
  while (goes_on && fields.size() <= most_columns) {
    const string_view field = taken(line, ',');
    goes_on = field.data() + field.size() != line.data();
    fields.push_back(trimmed(field));
  }
}

[[noreturn]] void refuse_line(const std::string& path, std::size_t line, const std::string& why) {
  throw Error(ErrorKind::bad_file, path + ": line " + std::to_string(line) + ": " + why);
}

}  // namespace

Table Table::read(const std::string& path) {
  Table table;
  table.path_ = path;
  const std::string content = read_file(path, most_table_bytes);
  const auto lines = static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n')) + 1;
  std::vector<string_view> fields;
  std::size_t number = 0;
  for (string_view rest = content; !rest.empty();) {
    ++number;
    string_view line = taken(rest, '\n');
    if (!is_printable(line)) refuse_line(path, number, "found a control character");
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    split(line, fields);
    if (table.names_.empty()) {
      table.add_names(fields, number);
      const std::size_t most_rows = content.size() / (2 * fields.size());
      for (auto& column : table.columns_) column.reserve(std::min(lines, most_rows));
    } else {
      table.add_row(fields, number);
    }
  }
  if (table.rows() == 0) {
    throw Error(ErrorKind::bad_file,
                path + ": expected a line of column names and lines of numbers");
  }
  return table;
}

void Table::add_names(const std::vector<string_view>& names, std::size_t line) {
  if (names.size() > most_columns) {
    refuse_line(
        path_, line,
        "found more than " + std::to_string(most_columns) + " columns, expected at most that");
  }
  for (const string_view name : names) {
    if (index(name))
      refuse_line(path_, line, "column " + excavplan::quoted(name) + " appears twice");
    names_.emplace_back(name);
  }
  columns_.resize(names.size());
}

void Table::add_row(const std::vector<string_view>& fields, std::size_t line) {
  if (fields.size() != names_.size()) {
    refuse_line(path_, line,
                "found " + std::to_string(fields.size()) + " fields, expected " +
                    std::to_string(names_.size()));
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    double value = 0.0;
    const char* const end = fields[i].data() + fields[i].size();
    const auto [stop, error] = read_double(fields[i].data(), end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value)) {
      refuse_line(path_, line,
                  safe_text(names_[i], longest_name) + " is " + excavplan::quoted(fields[i]) +
                      ", expected a number");
    }
    columns_[i].push_back(value);
  }
}

const std::vector<double>& Table::column(const std::string& name) const {
  if (const auto at = index(name)) return columns_[*at];
  std::string found;
  for (const std::string& other : names_) {
    found += (found.empty() ? "" : ", ") + safe_text(other, longest_name);
  }
  throw Error(ErrorKind::bad_file,
              path_ + ": has no column '" + name + "', its columns are: " + found);
}

std::optional<std::size_t> Table::index(string_view name) const {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names_.begin());
}

}  // namespace excavplan
