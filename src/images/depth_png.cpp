// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "images/depth_png.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include <png.h>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"

namespace excavplan {
namespace {

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 24;
constexpr std::uint64_t longest_side = 65535;
constexpr std::size_t signature_size = 8;

/// What libpng reads, and why it stopped.
struct Source {
  std::string content;
  std::size_t at = 0;
  bool ended = false;  ///< too early
  bool no_memory = false;
  char fault[100] = "";  ///< libpng's words; no string, which may throw through C
};

// libpng calls these.

void give_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  Source& source = *static_cast<Source*>(png_get_io_ptr(png));
  source.ended = count > source.content.size() - source.at;
  if (source.ended) png_error(png, "the end");
  std::memcpy(bytes, source.content.data() + source.at, count);
  source.at += count;
}

[[noreturn]] void stop(png_structp png, png_const_charp why) {
  Source& source = *static_cast<Source*>(png_get_error_ptr(png));
  std::snprintf(source.fault, sizeof source.fault, "%s", why);
  png_longjmp(png, 1);
}

png_voidp allocate(png_structp png, png_alloc_size_t size) {
  void* const memory = std::malloc(size);
  if (!memory) static_cast<Source*>(png_get_mem_ptr(png))->no_memory = true;
  return memory;
}

void release(png_structp /*png*/, png_voidp memory) { std::free(memory); }

void ignore(png_structp /*png*/, png_const_charp /*warning*/) {}

class PngReader {
 public:
  PngReader(const std::string& path, std::string content) : path_(path) {
    source_.content = std::move(content);
    png_ = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &source_, stop, ignore, &source_,
                                    allocate, release);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) throw std::bad_alloc();
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  DepthPng read() {
    require_signature();
    run([&] {
      set_strictness();
      png_read_info(png_, info_);
    });
    require_depths();
    DepthPng image{png_get_image_width(png_, info_), png_get_image_height(png_, info_), {}};
    image.bytes.resize(2 * image.pixels());
    std::vector<png_bytep> rows(image.height);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = &image.bytes[2 * i * image.width];
    run([&] {
      png_read_image(png_, rows.data());
      png_read_end(png_, nullptr);
    });
    return image;
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw Error(ErrorKind::bad_file, path_ + ": found " + found + ", expected " + expected);
  }
  [[noreturn]] void refuse(const std::string& found) const {
    refuse(found, "a 16-bit single-channel PNG image");
  }

  /// Steps of libpng, which it leaves by a jump: nothing in them may need a destructor.
  template <typename Steps>
  void run(const Steps& steps) {
    if (setjmp(png_jmpbuf(png_)) == 0) {
      steps();
    } else if (source_.no_memory) {
      throw std::bad_alloc();
    } else if (source_.ended) {
      refuse("the end of the file at byte " + std::to_string(source_.content.size()));
    } else {
      refuse("damage before byte " + std::to_string(source_.at) + " (" + source_.fault + ")");
    }
  }

  void require_signature() const {
    const auto* bytes = reinterpret_cast<png_const_bytep>(source_.content.data());
    if (source_.content.size() < signature_size || png_sig_cmp(bytes, 0, signature_size) != 0) {
      refuse("something that is not a PNG image");
    }
  }

  void set_strictness() {
    png_set_read_fn(png_, &source_, give_bytes);
    png_set_benign_errors(png_, 0);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    const auto* transparency = reinterpret_cast<png_const_bytep>("tRNS");
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, transparency, 1);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // ours say what they are
    png_set_chunk_malloc_max(png_, 0);
  }

  void require_depths() const {
    const std::uint64_t width = png_get_image_width(png_, info_);
    const std::uint64_t height = png_get_image_height(png_, info_);
    if (width > longest_side || height > longest_side || width * height > most_pixels) {
      refuse(std::to_string(width) + " x " + std::to_string(height) + " pixels",
             "at most " + std::to_string(longest_side) + " a side and " +
                 std::to_string(most_pixels) + " in all");
    }
    const int bits = png_get_bit_depth(png_, info_);
    const int colours = png_get_color_type(png_, info_);
    if (bits != 16 || colours != PNG_COLOR_TYPE_GRAY) {
      refuse(std::to_string(bits) + " bits of colour type " + std::to_string(colours));
    }
  }

  const std::string& path_;
  Source source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

DepthPng read_depth_png(const std::string& path) {
  return decode_depth_png(path, read_file(path, most_image_bytes));
}

DepthPng decode_depth_png(const std::string& name, std::string content) {
  return PngReader(name, std::move(content)).read();
}

}  // namespace excavplan
