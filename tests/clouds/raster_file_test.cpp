// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/clouds/raster_file.hpp>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/ground/map_files.hpp>

#include "base/scalar.hpp"
#include "clouds/tiff_coding.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

using std::string;

class RasterPath {
 public:
  explicit RasterPath(const string& ending)
      : path_(testing::TempDir() + "excavplan_raster_" + std::to_string(::getpid()) + ending) {}
  ~RasterPath() { std::filesystem::remove(path_); }
  RasterPath(const RasterPath&) = delete;
  RasterPath& operator=(const RasterPath&) = delete;
  const string& path() const { return path_; }

 private:
  string path_;
};

HeightMap hilly() {
  HeightMap map = flat_ground({512000.0, 5400000.0, 512003.0, 5400002.0}, 0.5);
  for (Eigen::Index i = 0; i < map.z.size(); ++i) map.z(i) = 100.0 + 0.125 * static_cast<double>(i);
  map.z(1, 2) = std::nan("");
  return map;
}

TEST(RasterFile, WhatWriteMapWroteIsReadAgain) {
  const HeightMap map = hilly();
  for (const char* ending : {".tif", ".asc"}) {
    const RasterPath file(ending);
    write_map(file.path(), {map, {{"height_m", "height", map.z}}});
    ASSERT_TRUE(is_raster(file.path()));
    const RasterFile raster = read_raster(file.path());
    EXPECT_TRUE(same_grid(raster.map, map)) << ending;
    EXPECT_TRUE((raster.map.z.isNaN() == map.z.isNaN()).all());
    EXPECT_TRUE((raster.map.z.isNaN() || raster.map.z == map.z).all());
    const Cloud cloud = read_cloud(file.path());
    ASSERT_EQ(cloud.points.size(), 23u);
    EXPECT_EQ(cloud.points[0], Eigen::Vector3d(512000.25, 5400000.25, 100.0));
  }
}

/// A TIFF of 16-bit numbers in one tile or strip, of either byte order.
class SmallTiff {
 public:
  explicit SmallTiff(bool is_swapped) : swapped_(is_swapped) {}

  void word(std::uint16_t tag, std::uint16_t value) {
    string bytes;
    add(value, bytes);
    add(std::uint16_t{0}, bytes);
    fields_.push_back({tag, 3, 1, bytes});
  }
  void doubles(std::uint16_t tag, const std::vector<double>& values) {
    string bytes;
    for (const double value : values) add(value, bytes);
    fields_.push_back({tag, 12, static_cast<std::uint32_t>(values.size()), bytes});
  }
  void words(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
    string bytes;
    for (const std::uint16_t value : values) add(value, bytes);
    fields_.push_back({tag, 3, static_cast<std::uint32_t>(values.size()), bytes});
  }
  string bytes(const string& image, std::uint16_t place_tag, std::uint16_t size_tag) {
    const auto at = static_cast<std::uint16_t>(8);
    word(place_tag, at);
    word(size_tag, static_cast<std::uint16_t>(image.size()));
    string file = swapped_ ? "MM" : "II";
    add(std::uint16_t{42}, file);
    std::uint32_t values = 8 + static_cast<std::uint32_t>(image.size() + image.size() % 2);
    std::uint32_t directory = values;
    for (const Field& field : fields_) {
      if (field.bytes.size() > 4) directory += static_cast<std::uint32_t>(field.bytes.size());
    }
    add(directory, file);
    file += image + string(image.size() % 2, '\0');
    string entries;
    add(static_cast<std::uint16_t>(fields_.size()), entries);
    for (const Field& field : fields_) {
      add(field.tag, entries);
      add(field.type, entries);
      add(field.count, entries);
      if (field.bytes.size() > 4) {
        add(values, entries);
        values += static_cast<std::uint32_t>(field.bytes.size());
        file += field.bytes;
      } else {
        entries += field.bytes;
      }
    }
    return file + entries + string(4, '\0');
  }
  template <typename Number>
  void add(Number value, string& bytes) const {
    string raw;
    put(value, raw);
    if (swapped_) raw.assign(raw.rbegin(), raw.rend());
    bytes += raw;
  }

 private:
  struct Field {
    std::uint16_t tag;
    std::uint16_t type;
    std::uint32_t count;
    string bytes;
  };
  bool swapped_;
  std::vector<Field> fields_;
};

/// 3 x 2 cells of 2 feet, heights 1 .. 6 from the top left, as differences in a tile of 4 x 2.
string tiled_tiff(bool is_swapped, std::uint16_t raster_type, std::uint16_t model = 1) {
  SmallTiff tiff(is_swapped);
  tiff.word(256, 3);
  tiff.word(257, 2);
  tiff.word(258, 16);
  tiff.word(259, 32773);
  tiff.word(277, 1);
  tiff.word(317, 2);
  tiff.word(322, 4);
  tiff.word(323, 2);
  tiff.word(339, 2);
  tiff.doubles(33550, {2.0, 2.0, 0.0});
  tiff.doubles(33922, {0.0, 0.0, 0.0, 100.0, 50.0, 0.0});
  tiff.words(34735, {1, 1, 0, 3, 1024, 0, 1, model, 1025, 0, 1, raster_type, 3076, 0, 1, 9002});
  string image(1, '\x0F');  // 16 bytes as they are
  for (const int difference : {1, 1, 1, 0, 4, 1, 1, 0}) {
    tiff.add(static_cast<std::int16_t>(difference), image);
  }
  return tiff.bytes(image, 324, 325);
}

TEST(RasterFile, TilesOfDifferencesInEitherByteOrder) {
  for (const bool is_swapped : {false, true}) {
    const RasterPath file(".tif");
    std::ofstream(file.path(), std::ios::binary) << tiled_tiff(is_swapped, 1);
    const RasterFile raster = read_raster(file.path());
    Eigen::ArrayXXd expected(2, 3);
    expected << 4, 5, 6, 1, 2, 3;
    EXPECT_TRUE((raster.map.z == expected).all());
    EXPECT_EQ(raster.map.origin, Eigen::Vector2d(100.0, 46.0));
    EXPECT_EQ(raster.unit, 0.3048);
  }
}

TEST(RasterFile, OfAPointTheCentreOfACellIsTold) {
  const RasterPath file(".tif");
  std::ofstream(file.path(), std::ios::binary) << tiled_tiff(false, 2);
  EXPECT_EQ(read_raster(file.path()).map.origin, Eigen::Vector2d(99.0, 47.0));
}

TEST(RasterFile, DegreesAreRefused) {
  const RasterPath file(".tif");
  std::ofstream(file.path(), std::ios::binary) << tiled_tiff(false, 1, 2);
  EXPECT_NE(error_about([&] { read_raster(file.path()); }, file.path()).find("are degrees"),
            string::npos);
}

TEST(TiffCoding, LzwOfTheSpecification) {
  // TIFF 6.0, section 13: 7 7 7 8 8 7 7 6 6 with the codes 256 7 258 8 8 258 6 6 257.
  string packed;
  unsigned held = 0, bits = 0;
  const auto add = [&](unsigned code, unsigned width) {
    bits = bits << width | code;
    held += width;
    for (; held >= 8; held -= 8) packed += static_cast<char>(bits >> (held - 8) & 255U);
  };
  for (const unsigned code : {256U, 7U, 258U, 8U, 8U, 258U, 6U, 6U, 257U}) add(code, 9);
  packed += static_cast<char>(bits << (8 - held));
  EXPECT_EQ(unpacked(5, packed, 9), "\7\7\7\x8\x8\7\7\6\6");
  EXPECT_EQ(unpacked(5, packed, 10), std::nullopt);
}

TEST(TiffCoding, FloatsOfPlanes) {
  // Two floats 1.0 and 2.0 (3F800000, 40000000): planes 3F 40 | 80 00 | 00 00 | 00 00, differences.
  string bytes("\x3F\x01\x40\x80\x00\x00\x00\x00", 8);
  take_predictor_off(3, {8, 4, 1, false}, bytes);
  string expected;
  put(1.0F, expected);
  put(2.0F, expected);
  EXPECT_EQ(bytes, expected);
}

}  // namespace
}  // namespace excavplan::test
