// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/depth_image.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <excavplan/error.hpp>

#include "json_file.hpp"

namespace excavplan {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void require_valid(const DepthIntrinsics& intrinsics) {
  const auto require = [](bool holds, const char* name, double value, const char* rule) {
    if (holds && std::isfinite(value)) return;
    throw Error(ErrorKind::bad_input, std::string("depth image: ") + name + " is " +
                                          number_text(value) + ", must be " + rule);
  };
  require(intrinsics.fx > 0.0, "fx", intrinsics.fx, "> 0");
  require(intrinsics.fy > 0.0, "fy", intrinsics.fy, "> 0");
  require(true, "cx", intrinsics.cx, "finite");
  require(true, "cy", intrinsics.cy, "finite");
  require(intrinsics.depth_unit > 0.0, "depth_unit", intrinsics.depth_unit, "> 0");
  require(intrinsics.min_depth >= 0.0, "min_depth", intrinsics.min_depth, ">= 0");
  require(intrinsics.max_depth > intrinsics.min_depth, "max_depth", intrinsics.max_depth,
          "> min_depth");
}

/// CRC-32 of ISO 3309, as PNG uses it.
std::uint32_t check_sum(std::string_view bytes) {
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ (0xEDB88320U & (0U - (sum & 1U)));
  }
  return ~sum;
}

/// A PNG file as a row of chunks, read before it is decoded: libpng writes to the console when a
/// file is damaged, and a header can promise any number of pixels.
class PngChunks {
 public:
  PngChunks(const std::string& path, const std::string& content) : path_(path), content_(content) {}

  /// @throws Error (bad_file) unless this is a whole 16-bit grey image
  void require_depth() const {
    constexpr std::uint64_t most_pixels = 100000000;
    constexpr std::size_t header_size = 33;
    if (content_.size() < header_size || content_.compare(0, 8, "\x89PNG\r\n\x1a\n") != 0 ||
        content_.compare(12, 4, "IHDR") != 0) {
      refuse("something that is not a PNG image");
    }
    const std::uint64_t width = number_at(16);
    const std::uint64_t height = number_at(20);
    if (width * height > most_pixels) {
      refuse(std::to_string(width) + " x " + std::to_string(height) + " pixels");
    }
    const int bits = byte_at(24);
    const int colour_type = byte_at(25);
    if (bits != 16 || colour_type != 0) {
      refuse(std::to_string(bits) + " bits of colour type " + std::to_string(colour_type));
    }
    require_whole();
  }

 private:
  [[noreturn]] void refuse(const std::string& found) const {
    throw Error(ErrorKind::bad_file,
                path_ + ": found " + found + ", expected a 16-bit single-channel PNG image");
  }
  int byte_at(std::size_t at) const { return static_cast<unsigned char>(content_[at]); }
  std::uint64_t number_at(std::size_t at) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value = value * 256 + static_cast<std::uint64_t>(byte_at(at + i));
    }
    return value;
  }
  /// A chunk is the length of its data, its name, the data and a check sum of name and data; IEND
  /// is the last one.
  void require_whole() const {
    for (std::size_t at = 8; at + 12 <= content_.size();) {
      const std::uint64_t length = number_at(at);
      if (length > content_.size() - at - 12) break;
      const std::string_view checked = std::string_view(content_).substr(at + 4, 4 + length);
      if (check_sum(checked) != number_at(at + 8 + length)) {
        refuse("damage behind byte " + std::to_string(at));
      }
      if (checked.substr(0, 4) == "IEND") return;
      at += 12 + length;
    }
    refuse("the end of the file at byte " + std::to_string(content_.size()));
  }

  const std::string& path_;
  const std::string& content_;
};

cv::Mat read_depth_image(const std::string& path) {
  const std::string content = read_file(path);
  PngChunks(path, content).require_depth();
  cv::Mat image;
  try {
    // not imread(), which writes to the console
    const cv::Mat bytes(1, static_cast<int>(content.size()), CV_8UC1,
                        const_cast<char*>(content.data()));
    image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& e) {
    throw Error(ErrorKind::bad_file, path + ": cannot be decoded: " + e.what());
  }
  if (image.empty() || image.type() != CV_16UC1) {
    throw Error(ErrorKind::bad_file, path + ": damaged PNG image");
  }
  return image;
}

}  // namespace

DepthIntrinsics load_intrinsics(const std::string& path) {
  constexpr double tiny = std::numeric_limits<double>::min();
  JsonObject json = JsonObject::open(path, "excavplan-depth-intrinsics");
  DepthIntrinsics intrinsics;
  intrinsics.fx = json.number("fx", tiny);
  intrinsics.fy = json.number("fy", tiny);
  intrinsics.cx = json.number("cx");
  intrinsics.cy = json.number("cy");
  intrinsics.depth_unit = json.number_or("depth_unit_m", intrinsics.depth_unit, tiny);
  intrinsics.min_depth = json.number_or("min_depth_m", intrinsics.min_depth, 0.0);
  intrinsics.max_depth =
      json.number_or("max_depth_m", intrinsics.max_depth,
                     std::nextafter(intrinsics.min_depth, std::numeric_limits<double>::max()));
  json.ignore("sources");
  json.done();
  return intrinsics;
}

Cloud depth_image_to_cloud(const std::string& image_path, const DepthIntrinsics& intrinsics) {
  require_valid(intrinsics);
  const cv::Mat image = read_depth_image(image_path);
  Cloud cloud;
  cloud.width = static_cast<std::size_t>(image.cols);
  cloud.height = static_cast<std::size_t>(image.rows);
  cloud.points.reserve(image.total());
  for (int row = 0; row < image.rows; ++row) {
    const auto* const counts = image.ptr<std::uint16_t>(row);
    for (int column = 0; column < image.cols; ++column) {
      const double z = counts[column] * intrinsics.depth_unit;
      const bool is_seen =
          counts[column] > 0 && z >= intrinsics.min_depth && z <= intrinsics.max_depth;
      cloud.points.push_back(is_seen ? Eigen::Vector3d((column - intrinsics.cx) / intrinsics.fx * z,
                                                       (row - intrinsics.cy) / intrinsics.fy * z, z)
                                     : Eigen::Vector3d::Constant(unknown));
    }
  }
  return cloud;
}

}  // namespace excavplan
