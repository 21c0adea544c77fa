// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/lzf_stream.hpp"

#include <algorithm>

namespace excavplan {
namespace {

constexpr std::size_t farthest_back = 8192;
constexpr std::size_t longest_unpacked = 264;  // a repeat
constexpr std::size_t window_size = 16 * farthest_back;

std::size_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
}

}  // namespace

LzfStream::LzfStream(const FileStream& file, const LzfBlock& block)
    : file_(file.again()),
      block_(block),
      packed_left_(block.packed),
      unpacked_left_(block.unpacked) {
  file_.skip(block.begin);
}

std::string_view LzfStream::read(std::size_t count) {
  if (window_.size() < count + farthest_back + longest_unpacked) {
    window_.resize(std::max(window_size, 2 * (count + farthest_back + longest_unpacked)));
  }
  while (filled_ - taken_ < count) unpack_item();
  taken_ += count;
  return {window_.data() + (taken_ - count), count};
}

void LzfStream::skip(std::uint64_t count) {
  for (; count > farthest_back; count -= farthest_back) read(farthest_back);
  read(static_cast<std::size_t>(count));
}

void LzfStream::finish() {
  skip(filled_ - taken_ + unpacked_left_);
  if (packed_left_ > 0) fail();
}

/// A control byte below 32 heads literals, any other repeats what stands up to 8 KiB back.
void LzfStream::unpack_item() {
  if (packed_left_ == 0) fail();
  make_room();
  const std::size_t control = byte_at(file_.peek(1), 0);
  if (control < 32) {
    unpack_literals(control + 1);
  } else {
    unpack_repeat(control);
  }
}

void LzfStream::unpack_literals(std::size_t count) {
  if (count + 1 > packed_left_ || count > unpacked_left_) fail();
  const std::string_view in = file_.peek(count + 1);
  std::copy_n(in.data() + 1, count, window_.data() + filled_);
  filled_ += count;
  unpacked_left_ -= count;
  packed_left_ -= count + 1;
  file_.skip(count + 1);
}

void LzfStream::unpack_repeat(std::size_t control) {
  std::size_t length = (control >> 5U) + 2;
  const std::size_t used = length == 9 ? 3 : 2;
  if (used > packed_left_) fail();
  const std::string_view in = file_.peek(used);
  if (used == 3) length += byte_at(in, 1);
  const std::size_t back = ((control & 31U) << 8U) + byte_at(in, used - 1) + 1;
  if (back > filled_ || length > unpacked_left_) fail();
  for (std::size_t i = 0; i < length; ++i, ++filled_) window_[filled_] = window_[filled_ - back];
  unpacked_left_ -= length;
  packed_left_ -= used;
  file_.skip(used);
}

void LzfStream::make_room() {
  if (window_.size() - filled_ >= longest_unpacked) return;
  const std::size_t passed = std::min(taken_, filled_ - std::min(filled_, farthest_back));
  std::copy(window_.begin() + static_cast<std::ptrdiff_t>(passed),
            window_.begin() + static_cast<std::ptrdiff_t>(filled_), window_.begin());
  filled_ -= passed;
  taken_ -= passed;
}

void LzfStream::fail() const {
  file_.fail("byte " + std::to_string(block_.begin), "damaged compressed data",
             std::to_string(block_.unpacked) + " bytes of LZF");
}

}  // namespace excavplan
