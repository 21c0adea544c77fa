// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/byte_file.hpp"

#include <limits>

#include <excavplan/base/error.hpp>

namespace excavplan {
namespace {

std::string place_of(const Origin& origin) {
  std::string byte = "byte " + std::to_string(origin.offset);
  if (origin.chunk == Origin::in_file) return byte;
  return byte + " of the chunk at byte " + std::to_string(origin.chunk);
}

}  // namespace

void fail_at(const std::string& file, const std::string& place, const std::string& found,
             const std::string& expected) {
  throw Error(ErrorKind::bad_file,
              file + ": " + place + ": found " + found + ", expected " + expected);
}

Bytes ByteFile::read(std::uint64_t offset, std::uint64_t count, const std::string& what) const {
  if (offset > size() || count > size() - offset) {
    fail(offset, std::to_string(offset > size() ? 0 : size() - offset) + " bytes left",
         std::to_string(count) + " of " + what);
  }
  if (count > most_bytes) {
    fail(offset, what + " of " + std::to_string(count) + " bytes",
         "at most " + std::to_string(most_bytes));
  }
  Bytes bytes(count);
  try {
    file_.read(offset, bytes.data(), bytes.size());
  } catch (const Error& error) {
    throw Unreadable(error.what());
  }
  return bytes;
}

void ByteFile::fail(std::uint64_t offset, const std::string& found,
                    const std::string& expected) const {
  fail_at(path(), "byte " + std::to_string(offset), found, expected);
}

std::uint64_t ByteReader::number(std::size_t size, const char* what) {
  const std::string_view bytes = take(size, what);
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

std::int64_t ByteReader::nanoseconds(const char* what) {
  const Origin before = origin_;
  const std::uint64_t value = u64(what);
  if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    fail_at(before.file.path(), place_of(before), std::string(what) + " " + std::to_string(value),
            "below 2^63");
  }
  return static_cast<std::int64_t>(value);
}

std::string_view ByteReader::take(std::uint64_t count, const char* what) {
  if (count > left()) {
    fail(std::to_string(left()) + " bytes left", std::to_string(count) + " of " + what);
  }
  const std::string_view out = bytes_.substr(0, count);
  bytes_.remove_prefix(count);
  origin_.offset += count;
  return out;
}

ByteReader ByteReader::part(const char* what) { return part(u32(what), what); }

ByteReader ByteReader::part(std::uint64_t count, const char* what) {
  const Origin origin = origin_;
  return {origin, take(count, what)};
}

void ByteReader::fail(const std::string& found, const std::string& expected) const {
  fail_at(origin_.file.path(), place_of(origin_), found, expected);
}

}  // namespace excavplan
