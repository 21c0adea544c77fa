// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/input_file.hpp"
#include "base/text.hpp"

/// @file The bytes of a file that may be larger than memory, its lines and the numbers in them, and
/// errors that name the place. Private to the library.

namespace excavplan {

constexpr std::size_t longest_line = 4096;  ///< without its end [byte]

/// A regular file read from front to back through a window that slides over it, so that it may be
/// larger than memory. Not mapped: a mapped file that another program cuts short would end ours
/// with a bus error.
class FileStream {
 public:
  /// Never waits on a pipe or device.
  /// @throws Error (bad_file) if the file is not regular, not readable or empty
  explicit FileStream(std::string path);
  /// The same open file once more, from its beginning.
  FileStream again() const { return FileStream(file_); }

  const std::string& path() const { return file_->path(); }
  std::uint64_t size() const { return file_->size(); }
  std::uint64_t offset() const { return offset_; }  ///< of the byte that comes next
  std::uint64_t left() const { return size() - offset_; }

  /// The next `count` bytes, or all that are left, without going past them; good until the next
  /// call. @throws Error (bad_file)
  std::string_view peek(std::size_t count) {
    if (filled_ - begin_ < count && filled_ - begin_ < left()) fill(count);
    return {window_.get() + begin_, std::min(count, filled_ - begin_)};
  }
  /// Goes past bytes, which must be left. @throws Error (bad_file)
  void skip(std::uint64_t count);
  /// The file must end `ahead` bytes from here, but for a few blanks or zeros.
  /// @throws Error (bad_file)
  void require_end(std::uint64_t ahead = 0) const;

  /// @throws Error (bad_file): "file: place: found ..., expected ..."
  [[noreturn]] void fail(const std::string& place, const std::string& found,
                         const std::string& expected) const;
  [[noreturn]] void fail_here(const std::string& found, const std::string& expected) const;
  /// @throws Error (bad_file): "file: why"
  [[noreturn]] void refuse(const std::string& why) const { file_->refuse(why); }

 private:
  explicit FileStream(std::shared_ptr<const InputFile> file) : file_(std::move(file)) {}
  void fill(std::size_t count);

  std::shared_ptr<const InputFile> file_;
  std::uint64_t offset_ = 0;  ///< of window_[begin_] in the file
  std::unique_ptr<char[]> window_;
  std::size_t begin_ = 0;
  std::size_t filled_ = 0;
  std::size_t capacity_ = 0;
};

/// The lines of a file, ended by LF or CRLF.
class LineReader {
 public:
  explicit LineReader(FileStream& file) : file_(file) {}

  /// Goes to the next line. @throws Error (bad_file) if it is too long
  /// @return false at the end of the file
  bool next();
  /// Goes to the next line that is neither blank nor, in a header, a comment.
  bool next_filled();

  std::string_view line() const { return line_; }          ///< good until the next one
  std::uint64_t offset() const { return file_.offset(); }  ///< of the byte after the line
  /// @throws Error (bad_file) naming this line
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

 private:
  FileStream& file_;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

/// Takes the next word, delimited by blanks, off the front of a text; empty if there is none.
std::string_view take_word(std::string_view& text);
std::vector<std::string_view> words_of(std::string_view line);

/// The number that the whole of `word` spells (also nan and inf), if it does.
std::optional<double> parse_number(std::string_view word);
std::optional<std::uint64_t> parse_count(std::string_view word);
/// @throws Error (bad_file) naming the line
double number_of(std::string_view word, const LineReader& lines);
std::uint64_t count_of(std::string_view word, const LineReader& lines);

}  // namespace excavplan
