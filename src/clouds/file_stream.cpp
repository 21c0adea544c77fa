// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/file_stream.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "base/read_double.hpp"

namespace excavplan {
namespace {

constexpr std::string_view blanks = " \t";
constexpr std::size_t longest_surplus = 4096;  // blanks or zeros after the last point [byte]

}  // namespace

FileStream::FileStream(std::string path)
    : file_(std::make_shared<const InputFile>(std::move(path))) {
  if (size() == 0) refuse("is empty");
}

void FileStream::fill(std::size_t count) {
  constexpr std::size_t usual_window = std::size_t{1} << 18;
  const std::size_t kept = filled_ - begin_;
  if (count > capacity_) {
    const std::size_t capacity = std::max(count, usual_window);
    std::unique_ptr<char[]> window(new char[capacity]);
    std::copy_n(window_.get() + begin_, kept, window.get());
    window_ = std::move(window);
    capacity_ = capacity;
  } else {
    std::copy_n(window_.get() + begin_, kept, window_.get());
  }
  begin_ = 0;
  filled_ = kept;
  const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(capacity_, left()));
  file_->read(offset_ + kept, window_.get() + kept, wanted - kept);
  filled_ = wanted;
  if (offset_ + filled_ == size()) file_->require_end();
}

void FileStream::skip(std::uint64_t count) {
  const std::size_t held = filled_ - begin_;
  if (count <= held) {
    begin_ += static_cast<std::size_t>(count);
  } else {
    begin_ = filled_ = 0;
  }
  offset_ += count;
}

void FileStream::require_end(std::uint64_t ahead) const {
  const std::uint64_t end = offset_ + ahead;
  const std::uint64_t surplus = size() - end;
  std::array<char, longest_surplus> bytes;
  const auto is_padding = [&] {
    file_->read(end, bytes.data(), surplus);
    constexpr std::string_view padding(" \t\r\n\0", 5);
    return std::string_view(bytes.data(), surplus).find_first_not_of(padding) ==
           std::string_view::npos;
  };
  if (surplus > longest_surplus || !is_padding()) {
    fail("byte " + std::to_string(end), std::to_string(surplus) + " bytes more",
         "the end of the file after the last point");
  }
}

void FileStream::fail(const std::string& place, const std::string& found,
                      const std::string& expected) const {
  refuse(place + ": found " + found + ", expected " + expected);
}

void FileStream::fail_here(const std::string& found, const std::string& expected) const {
  fail("byte " + std::to_string(offset_), found, expected);
}

bool LineReader::next() {
  const std::string_view ahead = file_.peek(longest_line + 2);
  if (ahead.empty()) return false;
  ++number_;
  const std::size_t end = ahead.find('\n');
  if (end == ahead.npos && ahead.size() > longest_line) {
    fail("a line of more than " + std::to_string(longest_line) + " bytes", "a shorter one");
  }
  line_ = ahead.substr(0, end);
  file_.skip(line_.size() + (end == ahead.npos ? 0 : 1));
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (number_ == 1 && line_.substr(0, 3) == byte_order_mark) line_.remove_prefix(3);
  return true;
}

bool LineReader::next_filled() {
  while (next()) {
    if (line_.find_first_not_of(blanks) != line_.npos) return true;
  }
  ++number_;
  return false;
}

void LineReader::fail(const std::string& found, const std::string& expected) const {
  file_.fail("line " + std::to_string(number_), found, expected);
}

std::string_view take_word(std::string_view& text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_blank);
  const auto end = std::find_if(begin, text.end(), is_blank);
  const auto skipped = static_cast<std::size_t>(begin - text.begin());
  const std::string_view word = text.substr(skipped, static_cast<std::size_t>(end - begin));
  text.remove_prefix(skipped + word.size());
  return word;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = take_word(line); !word.empty(); word = take_word(line)) words.push_back(word);
  return words;
}

std::optional<double> parse_number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = read_double(word.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> parse_count(std::string_view word) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

double number_of(std::string_view word, const LineReader& lines) {
  const auto value = parse_number(word);
  if (!value) lines.fail(in_quotes(word), "a number");
  return *value;
}

std::uint64_t count_of(std::string_view word, const LineReader& lines) {
  const auto value = parse_count(word);
  if (!value) lines.fail(in_quotes(word), "a whole number, not negative and below 2^64");
  return *value;
}

}  // namespace excavplan
