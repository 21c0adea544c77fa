// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table.hpp"

#include <algorithm>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/table_dialect.hpp"
#include "base/table_text.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string_view;

constexpr std::size_t longest_name = 40;  // that a message shows [byte]

/// The delimiter of a first line as spreadsheets read and write it, "sep=;".
std::optional<char> stated_delimiter(string_view text) {
  constexpr string_view key = "sep=";
  const std::size_t end = std::min(text.size(), text.find_first_of("\r\n"));
  if (end != key.size() + 1 || text.substr(0, key.size()) != key) return std::nullopt;
  return text[key.size()];
}

}  // namespace

Table Table::read(const std::string& path, const TableDialect& stated) {
  Table table;
  table.path_ = path;
  table.text_ = table_text(path, read_file(path, most_table_bytes));
  table.dialect_ = stated;
  const auto written = stated_delimiter(table.text_);
  if (written) table.begin_ = table.text_.find_first_of("\r\n");
  table.begin_ = std::min(table.begin_, table.text_.size());
  const string_view text = string_view(table.text_).substr(table.begin_);
  auto& [delimiter, mark] = table.dialect_;
  if (!delimiter) delimiter = written ? *written : find_delimiter(path, text);
  if (!mark) mark = find_decimal_mark(path, text, *delimiter);
  TableRecords records(path, text, *delimiter);
  std::vector<string_view> fields;
  if (records.next(fields)) table.add_names(fields, records.line());
  while (records.next(fields)) table.add_row(fields, records.line());
  if (table.rows() == 0) {
    throw Error(ErrorKind::bad_file,
                path + ": expected a line of column names and lines of numbers");
  }
  return table;
}

void Table::add_names(const std::vector<string_view>& names, std::size_t line) {
  if (names.size() > most_table_columns) {
    refuse_line(path_, line,
                "found more than " + std::to_string(most_table_columns) +
                    " columns, expected at most that");
  }
  const auto is_number = [](string_view name) { return number_of(name, '.').has_value(); };
  if (std::all_of(names.begin(), names.end(), is_number)) {
    refuse_line(path_, line, "found numbers, expected names of columns");
  }
  for (const string_view name : names) {
    if (!name.empty() && index(name)) {
      refuse_line(path_, line, "column " + in_quotes(name) + " appears twice");
    }
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
    Column& column = columns_[i];
    const auto value = number_of(fields[i], *dialect_.decimal_mark);
    if (!value && !column.bad_field) {
      column.bad_row = rows();
      column.bad_field = in_quotes(fields[i]);
    }
    if (!column.bad_field) column.values.push_back(*value);
  }
  lines_.push_back(static_cast<std::uint32_t>(line));
}

const std::vector<double>& Table::column(const std::string& name) const {
  const Column& column = columns_[index_of(name)];
  if (column.bad_field) {
    refuse_line(path_, line(column.bad_row),
                safe_text(name, longest_name) + " is " + *column.bad_field + ", expected a number");
  }
  return column.values;
}

std::vector<std::string> Table::texts(const std::string& name) const {
  const std::size_t column = index_of(name);
  TableRecords records(path_, string_view(text_).substr(begin_), *dialect_.delimiter);
  std::vector<string_view> fields;
  std::vector<std::string> texts;
  records.next(fields);
  while (records.next(fields)) texts.emplace_back(fields[column]);
  return texts;
}

std::size_t Table::index_of(const std::string& name) const {
  if (const auto at = index(name)) return *at;
  throw Error(ErrorKind::bad_file, path_ + ": has no column " + in_quotes(name) +
                                       ", its columns are: " + listed_names());
}

std::string Table::listed_names() const {
  std::string list;
  for (const std::string& name : names_) {
    list += (list.empty() ? "" : ", ") + safe_text(name, longest_name);
  }
  return list;
}

std::optional<std::size_t> Table::index(string_view name) const {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names_.begin());
}

}  // namespace excavplan
