// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "base/input_file.hpp"
#include "recording/skipped_parts.hpp"

/// @file Parts of a file read where they lie, the fields in them, and errors that name the place.
/// Private to the library.

namespace excavplan {

/// What is held in memory of one recording at once, and the largest message [byte]; ours.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;
/// The largest index, and the largest part of one [byte]; ours.
constexpr std::uint64_t most_index_bytes = std::uint64_t{1} << 28;

/// A block of memory that is filled once; not set to zero before.
class Bytes {
 public:
  Bytes() = default;
  explicit Bytes(std::uint64_t size) : data_(new char[size]), size_(size) {}
  char* data() { return data_.get(); }
  std::size_t size() const { return size_; }
  std::string_view view() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

/// @throws Error (bad_file): "file: place: found ..., expected ..."
[[noreturn]] void fail_at(const std::string& file, const std::string& place,
                          const std::string& found, const std::string& expected);

/// A regular file, read where it is asked for.
class ByteFile {
 public:
  /// @throws Error (bad_file) if the file is not regular or not readable
  explicit ByteFile(std::string path) : file_(std::move(path)) {}

  const std::string& path() const { return file_.path(); }
  std::uint64_t size() const { return file_.size(); }
  /// @throws Error (bad_file) unless these bytes are in the file and at most most_bytes
  /// @throws Unreadable if the system cannot read them
  Bytes read(std::uint64_t offset, std::uint64_t count, const std::string& what) const;
  /// @throws Error (bad_file) naming the byte
  [[noreturn]] void fail(std::uint64_t offset, const std::string& found,
                         const std::string& expected) const;
  /// @throws Unsupported "file: why"
  [[noreturn]] void refuse(const std::string& why) const { throw Unsupported(path() + ": " + why); }

 private:
  InputFile file_;
};

/// Where a block of bytes came from: a place in a file, or in what a chunk of it holds.
struct Origin {
  const ByteFile& file;
  std::uint64_t offset = 0;       ///< of the block's first byte
  std::uint64_t chunk = in_file;  ///< the chunk that it is in, by its place in the file
  static constexpr std::uint64_t in_file = ~std::uint64_t{0};
};

/// Takes little-endian fields off the front of a block of bytes, and never more than there are.
class ByteReader {
 public:
  ByteReader(const Origin& origin, std::string_view bytes) : origin_(origin), bytes_(bytes) {}

  std::uint8_t u8(const char* what) { return static_cast<std::uint8_t>(number(1, what)); }
  std::uint16_t u16(const char* what) { return static_cast<std::uint16_t>(number(2, what)); }
  std::uint32_t u32(const char* what) { return static_cast<std::uint32_t>(number(4, what)); }
  std::uint64_t u64(const char* what) { return number(8, what); }
  /// A count of nanoseconds of 64 bits, which must be below 2^63.
  std::int64_t nanoseconds(const char* what);
  /// The same, or the latest time there is of a larger one.
  std::int64_t nanoseconds_at_most(const char* what) {
    return static_cast<std::int64_t>(std::min<std::uint64_t>(u64(what), latest));
  }
  std::string_view take(std::uint64_t count, const char* what);
  /// Bytes after their count of 32 bits.
  std::string_view text(const char* what) { return take(u32(what), what); }
  /// The same as fields of their own.
  ByteReader part(const char* what);
  ByteReader part(std::uint64_t count, const char* what);

  std::uint64_t left() const { return bytes_.size(); }
  std::uint64_t offset() const { return origin_.offset; }  ///< of the next byte, in its block
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

 private:
  std::uint64_t number(std::size_t size, const char* what);

  Origin origin_;
  std::string_view bytes_;
};

}  // namespace excavplan
