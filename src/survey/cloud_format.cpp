// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "cloud_format.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "binary PCD is read and written as is");

constexpr std::string_view blanks = " \t";

/// Closes a file however its reading ends.
class Descriptor {
 public:
  explicit Descriptor(const std::string& path)
      : value_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

std::string gibibytes(std::uint64_t bytes) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), static_cast<double>(bytes) / (1 << 30),
                    std::chars_format::fixed, 3)
          .ptr;
  return {text.data(), end};
}

/// Calls `body` with a value of the C++ type that `type` stands for.
template <typename Body>
auto with_type(ScalarType type, Body body) {
  switch (type) {
    case ScalarType::int8:
      return body(std::int8_t{});
    case ScalarType::uint8:
      return body(std::uint8_t{});
    case ScalarType::int16:
      return body(std::int16_t{});
    case ScalarType::uint16:
      return body(std::uint16_t{});
    case ScalarType::int32:
      return body(std::int32_t{});
    case ScalarType::uint32:
      return body(std::uint32_t{});
    case ScalarType::int64:
      return body(std::int64_t{});
    case ScalarType::uint64:
      return body(std::uint64_t{});
    case ScalarType::float32:
      return body(float{});
    case ScalarType::float64:
      break;
  }
  return body(double{});
}

template <typename T>
double load(const char* bytes, bool swapped) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, raw.size());
  if (swapped) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), raw.size());
  return static_cast<double>(value);
}

}  // namespace

FileBytes::FileBytes(std::string path, std::uint64_t memory_limit)
    : path_(std::move(path)), memory_limit_(memory_limit) {
  const auto refuse = [this](const std::string& why) {
    throw Error(ErrorKind::bad_file, path_ + ": " + why);
  };
  const Descriptor file(path_);
  if (file.value() < 0) refuse(std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) refuse("cannot be examined");
  if (!S_ISREG(status.st_mode)) refuse("is not a regular file");
  if (status.st_size == 0) refuse("is empty");
  size_ = static_cast<std::size_t>(status.st_size);
  require_memory(0);

  data_.reset(new char[size_]);
  for (std::size_t done = 0; done < size_;) {
    const ssize_t got = ::read(file.value(), data_.get() + done, size_ - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) refuse("became shorter while it was read");
    done += static_cast<std::size_t>(got);
  }
}

void FileBytes::require_memory(std::uint64_t points, std::uint64_t more) const {
  const std::uint64_t free = memory_limit_ > size_ ? memory_limit_ - size_ : 0;
  const bool fits =
      size_ <= memory_limit_ && more <= free && points <= (free - more) / sizeof(Eigen::Vector3d);
  if (fits) return;
  throw Error(ErrorKind::bad_file, path_ + ": found " + std::to_string(size_) + " bytes for " +
                                       std::to_string(points) +
                                       " points, expected what fits into " +
                                       gibibytes(memory_limit_) + " GiB of memory");
}

void FileBytes::require_end(std::size_t end) const {
  const std::string_view surplus = text().substr(end);
  constexpr std::string_view padding(" \t\r\n\0", 5);
  if (surplus.size() > longest_surplus || surplus.find_first_not_of(padding) != surplus.npos) {
    fail("byte " + std::to_string(end), std::to_string(surplus.size()) + " bytes more",
         "the end of the file after the last point");
  }
}

void FileBytes::fail(const std::string& place, const std::string& found,
                     const std::string& expected) const {
  throw Error(ErrorKind::bad_file,
              path_ + ": " + place + ": found " + found + ", expected " + expected);
}

bool LineReader::next() {
  const std::string_view rest = file_.text().substr(offset_);
  if (rest.empty()) return false;
  ++number_;
  const std::size_t end = rest.substr(0, longest_line + 2).find('\n');
  if (end == rest.npos && rest.size() > longest_line) {
    fail("a line of more than " + std::to_string(longest_line) + " bytes", "a shorter one");
  }
  line_ = rest.substr(0, end);
  offset_ += line_.size() + (end == rest.npos ? 0 : 1);
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

std::string quoted(std::string_view text) {
  std::string out(text.substr(0, 40));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < 32 || c == 127; }, '?');
  return "'" + out + (text.size() > 40 ? "...'" : "'");
}

std::optional<double> parse_number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
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
  if (!value) lines.fail(quoted(word), "a number");
  return *value;
}

std::uint64_t count_of(std::string_view word, const LineReader& lines) {
  const auto value = parse_count(word);
  if (!value) lines.fail(quoted(word), "a whole number, not negative and below 2^64");
  return *value;
}

std::size_t size_of(ScalarType type) {
  return with_type(type, [](auto value) { return sizeof value; });
}

double load_scalar(ScalarType type, const char* bytes, bool swapped) {
  return with_type(type, [&](auto value) { return load<decltype(value)>(bytes, swapped); });
}

void copy_points(const char* block, const Columns& columns, bool swapped,
                 std::vector<Eigen::Vector3d>& points) {
  constexpr std::size_t batch = 1024;  // stays in the nearest cache for all three axes
  for (std::size_t begin = 0; begin < points.size(); begin += batch) {
    const std::size_t end = std::min(begin + batch, points.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const char* const column = block + columns.offset[axis];
      const std::size_t stride = columns.stride[axis];
      with_type(columns.type[axis], [&](auto value) {
        for (std::size_t i = begin; i < end; ++i) {
          points[i][static_cast<Eigen::Index>(axis)] =
              load<decltype(value)>(column + i * stride, swapped);
        }
      });
    }
  }
}

}  // namespace excavplan
