// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table_text.hpp"

#include <algorithm>
#include <cstdint>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string_view;

bool begins_with(string_view text, string_view start) {
  return text.substr(0, start.size()) == start;
}

string_view trimmed(string_view text) {
  constexpr string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string without_doubled_quotes(string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    plain += text[at];
    if (text[at] == '"') ++at;
  }
  return plain;
}

void append_utf8(std::string& out, std::uint32_t code) {
  const auto add = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  const auto add_tail = [&](unsigned shift) { add(0x80U | (code >> shift & 0x3FU)); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0U | code >> 6U);
    add_tail(0);
  } else if (code < 0x10000) {
    add(0xE0U | code >> 12U);
    add_tail(6);
    add_tail(0);
  } else {
    add(0xF0U | code >> 18U);
    add_tail(12);
    add_tail(6);
    add_tail(0);
  }
}

std::string from_utf16(const std::string& path, string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  std::string out;
  out.reserve(bytes.size() / 2);
  std::size_t line = 1;
  for (std::size_t at = 0; at < bytes.size(); at += 2) {
    if (at + 1 == bytes.size()) refuse_line(path, line, "UTF-16 ends in half a character");
    std::uint32_t code = unit(at);
    const bool is_high = code >= 0xD800 && code < 0xDC00;
    if (is_high && at + 3 < bytes.size() && unit(at + 2) >= 0xDC00 && unit(at + 2) < 0xE000) {
      at += 2;
      code = 0x10000 + ((code - 0xD800) << 10U) + (unit(at) - 0xDC00);
    } else if (code >= 0xD800 && code < 0xE000) {
      refuse_line(path, line, "UTF-16 with half a pair of characters");
    }
    if (code == '\n') ++line;
    append_utf8(out, code);
  }
  return out;
}

void require_printable(const std::string& path, string_view text) {
  std::size_t line = 1;
  while (!text.empty()) {
    const string_view one = text.substr(0, text.find('\n'));
    if (!is_printable(one)) refuse_line(path, line, "found a control character");
    text.remove_prefix(std::min(text.size(), one.size() + 1));
    ++line;
  }
}

/// With a mark of the other byte order, letters have their zero byte where others have their own.
void require_order_of_mark(const std::string& path, string_view bytes, bool big_endian) {
  const std::size_t low = big_endian ? 1 : 0;
  if (bytes.size() < 4 || bytes[low] != '\0' || bytes[low + 2] != '\0') return;
  refuse_line(path, 1, "UTF-16 whose bytes are in the other order than its mark states");
}

std::string from_marked_utf16(const std::string& path, string_view bytes, bool big_endian) {
  require_order_of_mark(path, bytes, big_endian);
  return from_utf16(path, bytes, big_endian);
}

}  // namespace

void refuse_line(const std::string& path, std::size_t line, const std::string& why) {
  throw Error(ErrorKind::bad_file, path + ": line " + std::to_string(line) + ": " + why);
}

std::string table_text(const std::string& path, std::string content) {
  const auto is_zero = [&](std::size_t at) { return content.size() > 1 && content[at] == '\0'; };
  if (begins_with(content, "\xFF\xFE")) {
    content = from_marked_utf16(path, string_view(content).substr(2), false);
  } else if (begins_with(content, "\xFE\xFF")) {
    content = from_marked_utf16(path, string_view(content).substr(2), true);
  } else if (is_zero(0) != is_zero(1)) {
    content = from_utf16(path, content, is_zero(0));
  } else if (begins_with(content, "\xEF\xBB\xBF")) {
    content.erase(0, 3);
  }
  require_printable(path, content);
  return content;
}

TableRecords::TableRecords(const std::string& path, string_view text, char delimiter)
    : path_(path), text_(text), delimiter_(delimiter) {}

bool TableRecords::next(std::vector<string_view>& fields) {
  while (at_ < text_.size()) {
    fields.clear();
    quoted_.clear();
    unescaped_.clear();
    line_ = next_line_;
    bool more = true;
    while (more && fields.size() <= most_table_columns) {
      skip_blanks();
      quoted_.push_back(at_ < text_.size() && text_[at_] == '"');
      fields.push_back(quoted_.back() ? quoted_field() : bare_field());
      more = more_fields();
    }
    if (more) skip_line();
    const auto is_empty = [](string_view field) { return field.empty(); };
    if (!std::all_of(fields.begin(), fields.end(), is_empty)) return true;
  }
  return false;
}

void TableRecords::skip_blanks() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}

void TableRecords::skip_line() {
  while (at_ < text_.size() && !ends_line(text_[at_])) ++at_;
  if (at_ == text_.size()) return;
  if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
  ++at_;
  ++next_line_;
}

string_view TableRecords::bare_field() {
  const std::size_t begin = at_;
  while (at_ < text_.size() && text_[at_] != delimiter_ && text_[at_] != '#' &&
         !ends_line(text_[at_])) {
    ++at_;
  }
  std::size_t end = at_;
  while (end > begin && is_blank(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

string_view TableRecords::quoted_field() {
  const std::size_t begin = ++at_;
  bool has_quotes = false;
  while (true) {
    if (at_ >= text_.size()) refuse_line(path_, line_, "a quote is not closed");
    if (text_[at_] == '\n') ++next_line_;
    if (text_[at_] == '"') {
      if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') break;
      has_quotes = true;
      ++at_;
    }
    ++at_;
  }
  string_view field = text_.substr(begin, at_ - begin);
  ++at_;
  if (has_quotes) field = unescaped_.emplace_back(without_doubled_quotes(field));
  skip_blanks();
  if (at_ < text_.size() && text_[at_] != delimiter_ && text_[at_] != '#' &&
      !ends_line(text_[at_])) {
    refuse_line(path_, next_line_, "found text behind the quotes of " + in_quotes(field));
  }
  return trimmed(field);
}

bool TableRecords::more_fields() {
  if (at_ < text_.size() && text_[at_] == delimiter_) {
    ++at_;
    return true;
  }
  skip_line();
  return false;
}

}  // namespace excavplan
