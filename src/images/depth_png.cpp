// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "images/depth_png.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include <zlib.h>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t header_size = 33;  // with the signature [byte]
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 24;
constexpr std::uint64_t longest_side = 65535;

const Bytef* bytes_of(std::string_view text) { return reinterpret_cast<const Bytef*>(text.data()); }
uInt size_of(std::string_view text) { return static_cast<uInt>(text.size()); }

struct Size {
  std::size_t width = 0;
  std::size_t height = 0;
};

/// The images that follow one another in the stream of pixels: one, or the seven of Adam7.
std::vector<Size> passes_of(const Size& image, bool is_interlaced) {
  struct Grid {
    std::size_t x, y, step_x, step_y;
  };
  constexpr Grid adam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                            {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  if (!is_interlaced) return {image};
  std::vector<Size> passes;
  for (const Grid& grid : adam7) {
    const Size pass = {(image.width + grid.step_x - 1 - grid.x) / grid.step_x,
                       (image.height + grid.step_y - 1 - grid.y) / grid.step_y};
    if (pass.width > 0 && pass.height > 0) passes.push_back(pass);
  }
  return passes;
}

/// A packed stream of bytes, whose beginning states how far back it refers; as for libpng, it must
/// keep to that.
class Unpacker {
 public:
  explicit Unpacker(std::string_view packed) {
    stream_.next_in = const_cast<Bytef*>(bytes_of(packed));
    stream_.avail_in = size_of(packed);
    if (::inflateInit2(&stream_, window_of_stream) != Z_OK) throw std::bad_alloc();
  }
  ~Unpacker() { ::inflateEnd(&stream_); }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  bool fill(std::vector<Bytef>& bytes) {
    stream_.next_out = bytes.data();
    stream_.avail_out = static_cast<uInt>(bytes.size());
    result_ = ::inflate(&stream_, Z_NO_FLUSH);
    return stream_.avail_out == 0;
  }
  bool ends() {
    std::vector<Bytef> more(1);
    return !fill(more) && result_ == Z_STREAM_END && stream_.avail_in == 0;
  }

 private:
  static constexpr int window_of_stream = 0;
  z_stream stream_{};
  int result_ = Z_OK;
};

/// A row of chunks, each of them the length of its data, its name, the data and a sum of name and
/// data.
class PngFile {
 public:
  explicit PngFile(const std::string& path)
      : path_(path), content_(read_file(path, most_image_bytes)) {}

  std::string checked() {
    read_header();
    kept_ = content_.substr(0, signature.size());
    read_chunks();
    check_pixels();
    return std::move(kept_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw Error(ErrorKind::bad_file, path_ + ": found " + found + ", expected " + expected);
  }
  [[noreturn]] void refuse(const std::string& found) const {
    refuse(found, "a 16-bit single-channel PNG image");
  }
  std::size_t byte_at(std::size_t at) const { return static_cast<unsigned char>(content_[at]); }
  std::size_t number_at(std::size_t at) const {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | byte_at(at + i);
    return value;
  }

  void read_header() {
    if (content_.size() < header_size || content_.compare(0, signature.size(), signature) != 0 ||
        content_.compare(12, 4, "IHDR") != 0 || number_at(8) != 13) {
      refuse("something that is not a PNG image");
    }
    size_ = {number_at(16), number_at(20)};
    const bool is_too_long = size_.width > longest_side || size_.height > longest_side;
    if (is_too_long || size_.width * size_.height > most_pixels) {
      refuse(std::to_string(size_.width) + " x " + std::to_string(size_.height) + " pixels",
             "at most " + std::to_string(longest_side) + " a side and " +
                 std::to_string(most_pixels) + " in all");
    }
    if (byte_at(24) != 16 || byte_at(25) != 0) {
      refuse(std::to_string(byte_at(24)) + " bits of colour type " + std::to_string(byte_at(25)));
    }
    const bool is_known = byte_at(26) == 0 && byte_at(27) == 0 && byte_at(28) <= 1;
    if (!is_known || size_.width == 0 || size_.height == 0) refuse("a damaged header");
  }

  void read_chunks() {
    for (std::size_t at = signature.size(); at + 12 <= content_.size();) {
      const std::size_t length = number_at(at);
      if (length > content_.size() - at - 12) break;
      const std::string_view whole = std::string_view(content_).substr(at, 12 + length);
      const std::string_view summed = whole.substr(4, 4 + length);
      if (::crc32(0, bytes_of(summed), size_of(summed)) != number_at(at + 8 + length)) {
        refuse("damage behind byte " + std::to_string(at));
      }
      const std::string_view name = summed.substr(0, 4);
      const bool is_header = name == "IHDR" && at == signature.size();
      const bool is_needed = name == "IDAT" || name == "IEND" || is_header;
      const bool is_extra = name[0] >= 'a' && name[0] <= 'z';
      if (!is_needed && !is_extra) refuse("a chunk " + in_quotes(name));
      if (is_needed) kept_.append(whole);
      if (name == "IDAT") pixels_.append(summed.substr(4));
      if (name == "IEND" && length > 0) refuse("an end with data");
      if (name == "IEND") return;
      at += whole.size();
    }
    refuse("the end of the file at byte " + std::to_string(content_.size()));
  }

  /// Every row begins with the number of its filter.
  void check_pixels() const {
    constexpr Bytef last_filter = 4;
    Unpacker unpacker(pixels_);
    for (const Size& pass : passes_of(size_, byte_at(28) == 1)) {
      std::vector<Bytef> row(1 + 2 * pass.width);
      for (std::size_t i = 0; i < pass.height; ++i) {
        if (!unpacker.fill(row) || row[0] > last_filter) refuse("damaged pixels");
      }
    }
    if (!unpacker.ends()) refuse("damaged pixels");
  }

  const std::string& path_;
  std::string content_;
  Size size_;
  std::string kept_;
  std::string pixels_;  ///< packed
};

}  // namespace

std::string read_depth_png(const std::string& path) { return PngFile(path).checked(); }

}  // namespace excavplan
