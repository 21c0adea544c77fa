// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <excavplan/survey/cloud.hpp>

/// @file
/// What the readers of cloud files share: the bytes of a file, its lines, numbers of any type, and
/// errors that name the place. Private to the library.

namespace excavplan {

constexpr std::size_t longest_header = 65536;  ///< of a PCD or PLY file [byte]
constexpr std::size_t longest_line = 4096;     ///< without its end [byte]
constexpr std::size_t most_fields = 64;        ///< of a point
constexpr std::size_t longest_row = 4096;      ///< of a binary point [byte]
constexpr std::size_t longest_surplus = 4096;  ///< blanks or zeros after the last point [byte]

/// The content of a regular file, read in one go: a mapped file that another program cuts short
/// would end ours with a bus error.
class FileBytes {
 public:
  /// Never waits on a pipe or device.
  /// @throws Error (bad_file) if the file is not regular, not readable, empty or over the limit
  FileBytes(std::string path, std::uint64_t memory_limit);

  std::string_view text() const { return {data_.get(), size_}; }
  const char* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

  /// Asked before memory is: the content, `points` points and `more` bytes must stay in the limit.
  /// @throws Error (bad_file)
  void require_memory(std::uint64_t points, std::uint64_t more = 0) const;
  /// The binary part must end at `end`, but for a few blanks or zeros. @throws Error (bad_file)
  void require_end(std::size_t end) const;

  /// @throws Error (bad_file): "file: place: found ..., expected ..."
  [[noreturn]] void fail(const std::string& place, const std::string& found,
                         const std::string& expected) const;

 private:
  std::string path_;
  std::uint64_t memory_limit_;
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

/// The lines of a file, ended by LF or CRLF.
class LineReader {
 public:
  explicit LineReader(const FileBytes& file) : file_(file) {}

  /// Goes to the next line. @throws Error (bad_file) if it is too long
  /// @return false at the end of the file
  bool next();
  /// Goes to the next line that is neither blank nor, in a header, a comment.
  bool next_filled();

  std::string_view line() const { return line_; }
  std::size_t offset() const { return offset_; }  ///< of the byte after the line
  /// @throws Error (bad_file) naming this line
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

 private:
  const FileBytes& file_;
  std::string_view line_;
  std::size_t offset_ = 0;
  std::size_t number_ = 0;
};

/// Takes the next word, delimited by blanks, off the front of a text; empty if there is none.
std::string_view take_word(std::string_view& text);
std::vector<std::string_view> words_of(std::string_view line);
/// A text of unknown origin made fit for a message: in quotes, cut, without control characters.
std::string quoted(std::string_view text);

/// The number that the whole of `word` spells (also nan and inf), if it does.
std::optional<double> parse_number(std::string_view word);
std::optional<std::uint64_t> parse_count(std::string_view word);
/// @throws Error (bad_file) naming the line
double number_of(std::string_view word, const LineReader& lines);
std::uint64_t count_of(std::string_view word, const LineReader& lines);

enum class ScalarType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};
std::size_t size_of(ScalarType type);
inline bool is_integer(ScalarType type) { return type < ScalarType::float32; }
/// The number at `bytes`, of the machine's byte order or, with `swapped`, the other one.
double load_scalar(ScalarType type, const char* bytes, bool swapped);

/// Where x, y and z of the points stand in a block of memory.
struct Columns {
  std::array<ScalarType, 3> type{};
  std::array<std::size_t, 3> offset{};  ///< of the first point [byte]
  std::array<std::size_t, 3> stride{};  ///< from point to point [byte]
};
void copy_points(const char* block, const Columns& columns, bool swapped,
                 std::vector<Eigen::Vector3d>& points);

Cloud read_pcd(const FileBytes& file);
Cloud read_ply(const FileBytes& file);
Cloud read_xyz(const FileBytes& file);

/// True if the first words of a file are those of a PCD header.
bool looks_like_pcd(const FileBytes& file);

}  // namespace excavplan
