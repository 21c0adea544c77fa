// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/plain_ground.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include <excavplan/ground/ascii_grid.hpp>
#include <excavplan/ground/map_files.hpp>

#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

const std::string head = "ncols 3\nnrows 2\nxllcorner 1.5\nyllcorner -2\ncellsize 0.5\n";
const std::string cells = "1 2 3\n4 5 6\n";

class AsciiGrid : public testing::Test {
 protected:
  HeightMap read(const std::string& text) const {
    return read_ascii_grid(folder.write("grid.asc", text));
  }
  std::string fault_of(const std::string& text) const {
    const std::string file = folder.write("grid.asc", text);
    return test::error_about([&] { read_ascii_grid(file); }, file);
  }
  test::TemporaryFolder folder;
};

TEST_F(AsciiGrid, BeginsWithTheRowOfLargestY) {
  const HeightMap map = read(head + cells);
  EXPECT_EQ(map.origin, Eigen::Vector2d(1.5, -2.0));
  EXPECT_EQ(map.cell_size, 0.5);
  ASSERT_EQ(map.z.rows(), 2);
  ASSERT_EQ(map.z.cols(), 3);
  EXPECT_EQ(map.z(1, 0), 1.0);
  EXPECT_EQ(map.z(0, 2), 6.0);
}

TEST_F(AsciiGrid, IsReadInEveryDialect) {
  const HeightMap map = read(head + cells);
  for (const std::string& text :
       {std::string("NROWS 2\r\nNCOLS 3\r\nXLLCENTER 1.75\r\nyLLCorner -2.0\r\nCellSize 5e-1\r\n"
                    "NODATA_value -1\r\n1 2 3 4\r\n5\t6"),
        head + " 1\n2\n3\n4\n+5\n 6.0 \n\n\n", "nodata_value nan\n" + head + "1 2 3 4 5 6"}) {
    const HeightMap same = read(text);
    EXPECT_TRUE(same_grid(same, map)) << text;
    EXPECT_TRUE((same.z == map.z).all()) << text;
  }
}

TEST_F(AsciiGrid, NodataIsUnknown) {
  EXPECT_TRUE(std::isnan(read(head + "1 2 -9999\n4 5 6").z(1, 2)));
  EXPECT_EQ(read(head + "NODATA_value -1\n1 2 -9999\n4 5 6").z(1, 2), -9999.0);
  EXPECT_TRUE(std::isnan(read(head + "NODATA_value 3\n1 2 3.0\n4 5 6").z(1, 2)));
  EXPECT_TRUE(std::isnan(read(head + "NODATA_value nan\n1 2 NaN\n4 5 6").z(1, 2)));
  const std::string lowest = "NODATA_value -3.4028234663852886e+38\n1 2 -3.4028235e+38\n4 5 6";
  EXPECT_TRUE(std::isnan(read(head + lowest).z(1, 2)));
}

TEST_F(AsciiGrid, IsReadAsItIsWritten) {
  HeightMap map = flat_ground({-1.0 / 3.0, 2.0, 1.0, 3.0}, 0.1);
  map.z = map.z.Random(map.z.rows(), map.z.cols());
  map.z(3, 4) = std::nan("");
  const std::string file = folder.file("written.asc");
  write_map(file, {map, {{"height_m", "height", map.z}}});
  const HeightMap back = read_ascii_grid(file);
  EXPECT_TRUE(same_grid(back, map));
  EXPECT_TRUE((back.z == map.z || map.z.isNaN()).all());
  EXPECT_TRUE(std::isnan(back.z(3, 4)));
}

TEST_F(AsciiGrid, SaysWhyAFileIsNone) {
  EXPECT_EQ(fault_of(head + "1 2 3\n4 5"), "line 7: the values end before the last cell");
  EXPECT_EQ(fault_of(head + cells + "7"), "line 8: '7' follows the value of the last cell");
  EXPECT_EQ(fault_of(head + "1 2 3\n4 x 6"),
            "line 7: the value of a cell is 'x', must be a number");
  EXPECT_EQ(fault_of(head + "1 2 3\n4 5,5 6"),
            "line 7: the value of a cell is '5,5', must be a number");
  EXPECT_EQ(fault_of(head + "ncols 3\n" + cells), "line 6: ncols is there twice");
  EXPECT_EQ(fault_of("dx 1\n" + head + cells), "line 1: 'dx' is no key of an ESRI ASCII grid");
  EXPECT_TRUE(test::contains(fault_of(head + "1 2 inf\n4 5 6"), "must be in -1000000 .. 1000000"));
  EXPECT_TRUE(test::contains(fault_of(head + "xllcenter 1\n" + cells), "either xllcorner or xll"));
  EXPECT_TRUE(
      test::contains(fault_of("ncols 1e6\nnrows 1e6\nxllcorner 0\nyllcorner 0\ncellsize 1\n1"),
                     "the head promises 1000000000000 cells"));
  EXPECT_TRUE(test::contains(fault_of("ncols 1.5\n1"), "must be a whole number"));
  EXPECT_TRUE(test::contains(fault_of(""), "ncols is missing"));
}

class PlainGroundFile : public testing::Test {
 protected:
  PlainGroundFile() {
    folder.write("bank.asc", head + cells);
    folder.write("loose.asc", head + "0 0.25 -9999\n-1e-9 0 0");
    folder.write("dense.asc", head + "0 10 20\n30 -9999 100");
  }
  std::string fault_of(const std::string& json) const {
    const std::string file = folder.write("ground.json", json);
    return test::error_about([&] { load_plain_ground(file); }, file);
  }
  test::TemporaryFolder folder;
};

TEST_F(PlainGroundFile, NamesGridsBesideIt) {
  const PlainGround plain = load_plain_ground(folder.write(
      "ground.json",
      R"({"bank": "bank.asc", "loose": "loose.asc", "bank_density_percent": "./dense.asc",
          "frame": "quarry", "note": 12})"));
  const Terrain& terrain = plain.ground.terrain;
  EXPECT_EQ(plain.ground.frame, "quarry");
  EXPECT_EQ(terrain.bank.z(1, 0), 1.0);
  EXPECT_EQ(terrain.loose(1, 1), 0.25);
  EXPECT_EQ(terrain.loose(0, 0), 0.0);
  EXPECT_TRUE(std::isnan(terrain.bank.z(1, 2)));  // its loose soil is not known
  EXPECT_EQ(terrain.loose(1, 2), 0.0);
  EXPECT_EQ(plain.bank_density_percent(1, 1), 10.0);
  EXPECT_TRUE(std::isnan(plain.bank_density_percent(0, 1)));
  EXPECT_EQ(plain.loose_density_percent.size(), 0);
  EXPECT_EQ(terrain.bank_void_ratio.size(), 0);
}

TEST_F(PlainGroundFile, NeedsTheBankAlone) {
  const PlainGround plain =
      load_plain_ground(folder.write("ground.json", R"({"bank": "bank.asc", "loose": null})"));
  EXPECT_TRUE((plain.ground.terrain.loose == 0.0).all());
  EXPECT_EQ(plain.bank_density_percent.size(), 0);
}

TEST_F(PlainGroundFile, SaysWhyAFileIsNone) {
  EXPECT_EQ(fault_of("{}"), "bank: is missing: the file of the grid of heights");
  EXPECT_EQ(fault_of(R"({"bank": 1})"), "bank: is 1, must be a text");
  EXPECT_EQ(fault_of(R"({"bank": "bank.asc", "lose": "loose.asc"})"),
            "lose: is not known; loose is");
  EXPECT_TRUE(test::contains(fault_of(R"({"bank": "none.asc"})"), "bank: 'none.asc': No such"));
  folder.write("other.asc", "ncols 3\nnrows 2\nxllcorner 1\nyllcorner -2\ncellsize 0.5\n" + cells);
  EXPECT_TRUE(test::contains(fault_of(R"({"bank": "bank.asc", "loose": "other.asc"})"),
                             "has another origin, cell or size than the grid of bank"));
  folder.write("negative.asc", head + "0 0 0\n0 -0.1 0");
  EXPECT_TRUE(test::contains(fault_of(R"({"bank": "bank.asc", "loose": "negative.asc"})"),
                             "is -0.1 in the cell at x = 2.25 m, y = -1.75 m"));
  folder.write("percent.asc", head + "0 0 0\n0 101 0");
  EXPECT_TRUE(
      test::contains(fault_of(R"({"bank": "bank.asc", "bank_density_percent": "percent.asc"})"),
                     "must be in 0 .. 100"));
}

TEST_F(PlainGroundFile, LeadsNowhereElse) {
  namespace fs = std::filesystem;
  fs::create_directory(folder.file("below"));
  fs::create_symlink("../bank.asc", folder.file("below/out.asc"));
  fs::create_symlink("bank.asc", folder.file("link.asc"));
  const std::string outside = "outside of the folder of the JSON";
  const std::string below = folder.write("below/ground.json", R"({"bank": "out.asc"})");
  EXPECT_TRUE(test::contains(test::error_about([&] { load_plain_ground(below); }, below), outside));
  folder.write("below/ground.json", R"({"bank": "../bank.asc"})");
  EXPECT_TRUE(test::contains(test::error_about([&] { load_plain_ground(below); }, below), outside));
  const std::string named = R"({"bank": ")" + folder.file("bank.asc") + R"("})";
  EXPECT_TRUE(test::contains(fault_of(named), outside));
  EXPECT_EQ(fault_of(R"({"bank": "link.asc"})"), "no error");
}

}  // namespace
}  // namespace excavplan
