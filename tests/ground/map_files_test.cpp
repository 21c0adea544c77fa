// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/map_files.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

/// Three columns by two rows that no turn or mirror leaves as it is; the cell in the middle of the
/// upper row is not known.
LayeredMap unsymmetrical() {
  LayeredMap map;
  map.ground.origin = {10.0, -20.0};
  map.ground.cell_size = 0.5;
  map.ground.z.resize(2, 3);
  map.ground.z << 1.0, 2.0, 3.0,  // the lower row, y from -20
      4.0, nan, 6.1;
  map.layers = {{"height_m", "height", map.ground.z}};
  return map;
}

class MapFiles : public testing::Test {
 protected:
  test::TemporaryFolder folder;
};

TEST_F(MapFiles, AsciiGridBeginsWithTheLargestYAndHasItsCorner) {
  const std::string file = folder.file("a.ASC");
  write_map(file, unsymmetrical());
  EXPECT_EQ(test::content_of(file),
            "ncols 3\nnrows 2\nxllcorner 10\nyllcorner -20\ncellsize 0.5\nNODATA_value -9999\n"
            "4 -9999 6.1\n1 2 3\n");
}

TEST_F(MapFiles, AsciiGridKeepsEveryDigit) {
  LayeredMap map = unsymmetrical();
  map.layers.front().values(0, 0) = 0.1 + 0.2;
  const std::string file = folder.file("a.asc");
  write_map(file, map);
  EXPECT_NE(test::content_of(file).find("\n0.30000000000000004 2 3\n"), std::string::npos);
}

template <typename Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST_F(MapFiles, PlyHasThePointsThatAreKnownWithTheirLayers) {
  LayeredMap map = unsymmetrical();
  map.layers.push_back({"change_m", "change", 10.0 * map.ground.z});
  map.layers.back().values(0, 1) = nan;
  const std::string file = folder.file("a.ply");
  write_map(file, map);
  const std::string bytes = test::content_of(file);
  const std::string head = bytes.substr(0, bytes.find("end_header\n") + 11);
  EXPECT_EQ(head,
            "ply\nformat binary_little_endian 1.0\ncomment excavplan, site frame, metres\n"
            "element vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
            "property double scalar_height_m\nproperty double scalar_change_m\nend_header\n");
  ASSERT_EQ(bytes.size(), head.size() + 5 * 5 * sizeof(double));
  const auto value = [&](std::size_t point, std::size_t which) {
    return number_at<double>(bytes, head.size() + (5 * point + which) * sizeof(double));
  };
  EXPECT_EQ(value(0, 0), 10.25);
  EXPECT_EQ(value(0, 1), -19.75);
  EXPECT_EQ(value(0, 2), 1.0);
  EXPECT_TRUE(std::isnan(value(1, 4)));
  EXPECT_EQ(value(4, 0), 11.25);
  EXPECT_EQ(value(4, 1), -19.25);
  EXPECT_EQ(value(4, 2), 6.1);
  EXPECT_EQ(value(4, 4), 61.0);
}

TEST_F(MapFiles, LinesArePolylinesInDxfAndEdgesInPly) {
  const std::vector<MapLine> lines = {{"tip_path", {{1.0, 0.0, 0.5}, {2.0, 0.0, -0.25}}},
                                      {"footprint", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, true}};
  write_lines(folder.file("a.dxf"), lines);
  const std::string dxf = test::content_of(folder.file("a.dxf"));
  EXPECT_NE(dxf.find("0\nPOLYLINE\n8\ntip_path\n66\n1\n10\n0\n20\n0\n30\n0\n70\n8\n"
                     "0\nVERTEX\n8\ntip_path\n10\n1\n20\n0\n30\n0.5\n70\n32\n"
                     "0\nVERTEX\n8\ntip_path\n10\n2\n20\n0\n30\n-0.25\n70\n32\n"
                     "0\nSEQEND\n"),
            std::string::npos);
  EXPECT_NE(dxf.find("0\nPOLYLINE\n8\nfootprint\n66\n1\n10\n0\n20\n0\n30\n0\n70\n9\n"),
            std::string::npos);
  EXPECT_EQ(dxf.substr(dxf.size() - 15), "0\nENDSEC\n0\nEOF\n");
  write_lines(folder.file("a.ply"), lines);
  const std::string ply = test::content_of(folder.file("a.ply"));
  EXPECT_NE(ply.find("element vertex 5\n"), std::string::npos);
  EXPECT_NE(ply.find("element edge 4\nproperty int vertex1\nproperty int vertex2\n"),
            std::string::npos);
  const std::vector<int> joined = {0, 1, 2, 3, 3, 4, 4, 2};
  for (std::size_t i = 0; i < joined.size(); ++i) {
    EXPECT_EQ(number_at<std::int32_t>(ply, ply.size() - 32 + 4 * i), joined[i]) << i;
  }
}

/// The values of a field of a TIFF file, by its tag.
template <typename Number>
std::vector<Number> field_of(const std::string& tiff, int tag) {
  const auto directory = number_at<std::uint32_t>(tiff, 4);
  const auto fields = number_at<std::uint16_t>(tiff, directory);
  for (std::size_t at = directory + 2; at < directory + 2 + 12U * fields; at += 12) {
    if (number_at<std::uint16_t>(tiff, at) != tag) continue;
    const auto count = number_at<std::uint32_t>(tiff, at + 4);
    const bool fits = count * sizeof(Number) <= 4;
    const std::size_t first = fits ? at + 8 : number_at<std::uint32_t>(tiff, at + 8);
    std::vector<Number> values;
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(number_at<Number>(tiff, first + i * sizeof(Number)));
    }
    return values;
  }
  return {};
}

// Tags of TIFF 6.0 and OGC GeoTIFF 1.1. map_programs.py has GDAL read such files.
TEST_F(MapFiles, GeoTiffBeginsWithTheLargestYAndHasItsOuterCorner) {
  LayeredMap map = unsymmetrical();
  map.layers.push_back({"zone", "a < b & c", 10.0 * map.ground.z});
  const std::string file = folder.file("a.TIF");
  write_map(file, map);
  const std::string tiff = test::content_of(file);
  EXPECT_EQ(tiff.substr(0, 4), std::string("II*\0", 4));
  EXPECT_EQ(field_of<std::uint32_t>(tiff, 256), (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(field_of<std::uint32_t>(tiff, 257), (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(field_of<double>(tiff, 33550), (std::vector<double>{0.5, 0.5, 0.0}));
  EXPECT_EQ(field_of<double>(tiff, 33922), (std::vector<double>{0, 0, 0, 10.0, -19.0, 0}));
  // GeoTIFF 1.1 asks for the type of the model (1024), and of one of its own for a name (1026).
  EXPECT_EQ(field_of<std::uint16_t>(tiff, 34735),
            (std::vector<std::uint16_t>{1, 1, 1,    4,     1024, 0, 1,    32767, 1025, 0,
                                        1, 1, 1026, 34737, 21,   0, 3076, 0,     1,    9001}));
  const auto strips = field_of<std::uint32_t>(tiff, 273);
  ASSERT_EQ(strips.size(), 4U);  // two rows of two bands
  EXPECT_EQ(number_at<double>(tiff, strips[0]), 4.0);
  EXPECT_TRUE(std::isnan(number_at<double>(tiff, strips[0] + 8)));
  EXPECT_EQ(number_at<double>(tiff, strips[0] + 16), 6.1);
  EXPECT_EQ(number_at<double>(tiff, strips[1]), 1.0);
  EXPECT_EQ(number_at<double>(tiff, strips[3] + 16), 30.0);
  EXPECT_EQ(tiff.size(), strips[3] + 24);
  EXPECT_NE(tiff.find("a &lt; b &amp; c"), std::string::npos);
}

TEST_F(MapFiles, GeoTiffOfOneLayerHasNoOther) {
  const std::string file = folder.file("a.tif");
  write_map(file, unsymmetrical());
  const std::string tiff = test::content_of(file);
  EXPECT_EQ(field_of<std::uint32_t>(tiff, 273).size(), 2U);
  EXPECT_TRUE(field_of<std::uint16_t>(tiff, 338).empty());
  EXPECT_EQ(field_of<std::uint16_t>(tiff, 339), (std::vector<std::uint16_t>{3}));
}

TEST_F(MapFiles, RefusesWhatAFileCannotHold) {
  using test::error_of;
  LayeredMap map = unsymmetrical();
  EXPECT_EQ(error_of([&] { write_map("a.png", map); }), "'a.png' must end in .tif or .ply or .asc");
  EXPECT_EQ(error_of([] { require_line_format("a.tif"); }), "'a.tif' must end in .dxf or .ply");
  EXPECT_EQ(error_of([] { require_map_format("a.asc", 4); }),
            "'a.asc' would hold 4 layers, .asc holds one");
  EXPECT_NE(error_of([&] { write_map(folder.file("no/a.asc"), map); }, ErrorKind::bad_file)
                .find("cannot be written"),
            std::string::npos);
  map.layers.front().name = "height [m]";
  EXPECT_EQ(error_of([&] { write_map(folder.file("a.asc"), map); }),
            "map layer 'height [m]': a name has small letters, digits and _");
  map = unsymmetrical();
  map.layers.front().values.resize(3, 2);
  EXPECT_EQ(error_of([&] { write_map(folder.file("a.asc"), map); }),
            "map layer height_m has another size than the grid");
  EXPECT_EQ(error_of([&] {
              write_lines(folder.file("a.dxf"), {{"line", {{0, 0, 0}}}});
            }),
            "line line needs two points");
  EXPECT_EQ(error_of([&] {
              write_lines(folder.file("a.dxf"), {{"line", {{0, 0, 0}, {0, nan, 0}}}});
            }),
            "line line has a point that is not finite");
}

}  // namespace
}  // namespace excavplan
