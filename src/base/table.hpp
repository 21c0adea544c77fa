// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// Tables of numbers in CSV files. Private to the project.

namespace excavplan {

/// A CSV file of numbers: a line of names, then lines of as many numbers; `#` starts a comment.
class Table {
 public:
  /// @throws Error (bad_file) naming file, line, what was found and what was expected
  static Table read(const std::string& path);

  bool has(const std::string& name) const { return index(name).has_value(); }
  /// @throws Error (bad_file) if there is no such column
  const std::vector<double>& column(const std::string& name) const;
  std::size_t rows() const { return columns_.empty() ? 0 : columns_.front().size(); }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::optional<std::size_t> index(std::string_view name) const;
  void add_names(const std::vector<std::string_view>& names, std::size_t line);
  void add_row(const std::vector<std::string_view>& fields, std::size_t line);

  std::string path_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
};

}  // namespace excavplan
