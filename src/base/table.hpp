// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// Tables in CSV files, as spreadsheets and loggers write them. Private to the project.

namespace excavplan {

/// How a table is written.
struct TableDialect {
  std::optional<char> delimiter = {};     ///< ',', ';', tab or '|'
  std::optional<char> decimal_mark = {};  ///< '.' or ','
};

/// A line of names, then lines of as many fields, as docs/formats.md#csv-files-that-are-read says.
/// What the dialect does not state is found from the file, or refused where the file can be read in
/// two ways.
class Table {
 public:
  /// @throws Error (bad_file) naming file, line, what was found and what was expected
  static Table read(const std::string& path, const TableDialect& stated = {});

  bool has(const std::string& name) const { return index(name).has_value(); }
  /// @throws Error (bad_file) if there is no such column, or naming line and field where it holds
  /// no number
  const std::vector<double>& column(const std::string& name) const;
  /// The same column as it is written. @throws Error (bad_file) if there is no such column
  std::vector<std::string> texts(const std::string& name) const;
  /// Name of the file.
  const std::string& path() const { return path_; }
  std::size_t rows() const { return lines_.size(); }
  const std::vector<std::string>& names() const { return names_; }
  /// "time_s, power_w", for messages.
  std::string listed_names() const;
  /// Line of the file in which a row begins.
  std::size_t line(std::size_t row) const { return lines_[row]; }
  /// What was stated or found.
  char delimiter() const { return *dialect_.delimiter; }
  char decimal_mark() const { return *dialect_.decimal_mark; }

 private:
  struct Column {
    std::vector<double> values;
    std::size_t bad_row = 0;  ///< the first that is no number
    std::optional<std::string> bad_field;
  };

  std::size_t index_of(const std::string& name) const;
  std::optional<std::size_t> index(std::string_view name) const;
  void add_names(const std::vector<std::string_view>& names, std::size_t line);
  void add_row(const std::vector<std::string_view>& fields, std::size_t line);

  std::string path_;
  std::string text_;
  std::size_t begin_ = 0;  ///< of the records, behind a line sep=
  TableDialect dialect_;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
  std::vector<std::uint32_t> lines_;
};

}  // namespace excavplan
