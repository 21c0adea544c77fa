// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// The text of a table: its encoding, and its records as fields. Private to the project.

namespace excavplan {

constexpr std::size_t most_table_columns = 1000;  ///< ours

/// @throws Error (bad_file) of a line of a file
[[noreturn]] void refuse_line(const std::string& path, std::size_t line, const std::string& why);

/// Content of a file as UTF-8 without a byte order mark; UTF-16 is known by its mark or its zero
/// bytes. @throws Error (bad_file) with the line if it has a control character or is no UTF-16
std::string table_text(const std::string& path, std::string content);

/// The records of a table by RFC 4180, `#` begins a comment outside of quotes. Blank lines, and
/// records whose fields are all empty, are left out; lines end in LF, CRLF or CR.
class TableRecords {
 public:
  /// @param path  for messages
  TableRecords(const std::string& path, std::string_view text, char delimiter);

  /// The next record, up to one field more than there may be columns; the fields are valid until
  /// the next call. @throws Error (bad_file) with the line of a quote that does not end
  bool next(std::vector<std::string_view>& fields);
  /// Line in which the last record began, from 1.
  std::size_t line() const { return line_; }
  /// Whether this field of the last record was in quotes.
  bool was_quoted(std::size_t field) const { return quoted_[field]; }

 private:
  std::string_view bare_field();
  std::string_view quoted_field();
  bool ends_line(char c) const { return c == '\n' || c == '\r'; }
  bool is_blank(char c) const { return c == ' ' || (c == '\t' && delimiter_ != '\t'); }
  void skip_blanks();
  void skip_line();
  /// Steps over a delimiter, if one comes next; over the end of the line else.
  bool more_fields();

  const std::string& path_;
  std::string_view text_;
  char delimiter_;
  std::size_t at_ = 0;
  std::size_t next_line_ = 1;
  std::size_t line_ = 0;
  std::vector<bool> quoted_;
  std::deque<std::string> unescaped_;
};

}  // namespace excavplan
