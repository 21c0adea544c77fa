// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <excavplan/error.hpp>

#include "base/files.hpp"

namespace excavplan {
namespace {

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\"";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> list;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) list.push_back(trimmed(field));
  if (!line.empty() && line.back() == ',') list.emplace_back();
  return list;
}

}  // namespace

Table Table::read(const std::string& path) {
  Table table;
  table.path_ = path;
  std::istringstream in(read_file(path));
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const std::vector<std::string> words = fields(line);
    const std::string place = path + ": line " + std::to_string(number) + ": ";
    if (table.names_.empty()) {
      table.names_ = words;
      for (std::size_t i = 0; i < words.size(); ++i) {
        if (std::find(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(i), words[i]) !=
            words.begin() + static_cast<std::ptrdiff_t>(i)) {
          throw Error(ErrorKind::bad_file, place + "column '" + words[i] + "' appears twice");
        }
      }
      table.columns_.resize(words.size());
      continue;
    }
    if (words.size() != table.names_.size()) {
      throw Error(ErrorKind::bad_file, place + "found " + std::to_string(words.size()) +
                                           " fields, expected " +
                                           std::to_string(table.names_.size()));
    }
    for (std::size_t i = 0; i < words.size(); ++i) {
      double value = 0.0;
      const char* const end = words[i].data() + words[i].size();
      const auto [stop, error] = std::from_chars(words[i].data(), end, value);
      if (error != std::errc{} || stop != end || !std::isfinite(value)) {
        throw Error(ErrorKind::bad_file,
                    place + table.names_[i] + " is '" + words[i] + "', expected a number");
      }
      table.columns_[i].push_back(value);
    }
  }
  if (table.rows() == 0) {
    throw Error(ErrorKind::bad_file,
                path + ": expected a line of column names and lines of numbers");
  }
  return table;
}

const std::vector<double>& Table::column(const std::string& name) const {
  if (const auto at = index(name)) return columns_[*at];
  std::string found;
  for (const std::string& other : names_) found += (found.empty() ? "" : ", ") + other;
  throw Error(ErrorKind::bad_file,
              path_ + ": has no column '" + name + "', its columns are: " + found);
}

std::optional<std::size_t> Table::index(const std::string& name) const {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names_.begin());
}

}  // namespace excavplan
