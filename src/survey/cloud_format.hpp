// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <excavplan/survey/cloud.hpp>

/// @file What the readers of cloud files share: the bytes of a file, its lines, numbers of any
/// type, the way points go on, and errors that name the place. Private to the library.

namespace excavplan {

constexpr std::size_t longest_header = 65536;  ///< of a PCD or PLY file [byte]
constexpr std::size_t longest_line = 4096;     ///< without its end [byte]
constexpr std::size_t most_fields = 64;        ///< of a point
constexpr std::size_t longest_row = 4096;      ///< of a binary point [byte]
constexpr std::size_t longest_surplus = 4096;  ///< blanks or zeros after the last point [byte]

/// A regular file read from front to back through a window that slides over it, so that it may be
/// larger than memory. Not mapped: a mapped file that another program cuts short would end ours
/// with a bus error.
class FileStream {
 public:
  /// Never waits on a pipe or device.
  /// @throws Error (bad_file) if the file is not regular, not readable or empty
  explicit FileStream(std::string path);
  ~FileStream();
  FileStream(const FileStream&) = delete;
  FileStream& operator=(const FileStream&) = delete;

  std::uint64_t size() const { return size_; }
  std::uint64_t offset() const { return offset_; }  ///< of the byte that comes next
  std::uint64_t left() const { return size_ - offset_; }

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
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  void fill(std::size_t count);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t offset_ = 0;  ///< of window_[begin_] in the file
  std::unique_ptr<char[]> window_;
  std::size_t begin_ = 0;
  std::size_t filled_ = 0;
  std::size_t capacity_ = 0;
};

/// Where a reader puts the points of a file, in their order.
class PointSink {
 public:
  virtual ~PointSink() = default;
  /// Asked before the points come, where a file says how many there are at most, and before more
  /// than the points at hand is held for them. @throws Error (bad_file) if that is too much
  virtual void require_memory(std::uint64_t points, std::uint64_t more_bytes) = 0;
  virtual void take(const std::vector<Eigen::Vector3d>& points) = 0;
};

constexpr std::size_t points_at_a_time = 2048;  ///< stay in the second cache

/// Hands on points that come one by one.
class PointBatch {
 public:
  explicit PointBatch(PointSink& sink) : sink_(sink) { points_.reserve(points_at_a_time); }
  void add(const Eigen::Vector3d& point) {
    points_.push_back(point);
    if (points_.size() == points_at_a_time) hand_on();
  }
  /// To be called after the last one.
  void hand_on() {
    if (!points_.empty()) sink_.take(points_);
    points_.clear();
  }

 private:
  PointSink& sink_;
  std::vector<Eigen::Vector3d> points_;
};

/// What a file says of the order of its points.
struct CloudShape {
  std::uint64_t width = 0;
  std::uint64_t height = 1;
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
/// Hands on `count` points that stand one behind the other in a file.
void stream_rows(FileStream& file, std::uint64_t count, const Columns& columns, bool swapped,
                 PointSink& sink);
/// Hands on points that stand in memory.
void stream_block(const char* block, std::uint64_t count, const Columns& columns, PointSink& sink);

CloudShape stream_pcd(FileStream& file, PointSink& sink);
CloudShape stream_ply(FileStream& file, PointSink& sink);
CloudShape stream_xyz(FileStream& file, PointSink& sink);

/// True if the first words of a file are those of a PCD header.
bool looks_like_pcd(FileStream& file);

}  // namespace excavplan
