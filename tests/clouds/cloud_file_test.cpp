// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>
#include <excavplan/clouds/cloud.hpp>
#include "base/random.hpp"

#include "base/non_finite.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

using std::string;
using Points = std::vector<Eigen::Vector3d>;
using test::error_about;

/// A file that is gone when the test ends.
class TempFile {
 public:
  explicit TempFile(const string& content = "", const string& ending = ".cloud")
      : path_(testing::TempDir() + "excavplan_cloud_" + std::to_string(::getpid()) + ending) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TempFile() { std::filesystem::remove_all(path_); }
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;
  const string& path() const { return path_; }

 private:
  string path_;
};

string content_of(const string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Cloud read_content(const string& content) { return read_cloud(TempFile(content).path()); }

string error_of_content(const string& content) {
  const TempFile file(content);
  return error_about([&] { read_cloud(file.path()); }, file.path());
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void expect_points(const Cloud& cloud, const Points& expected) {
  ASSERT_EQ(cloud.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      ASSERT_PRED2(same, cloud.points[i][axis], expected[i][axis]) << "point " << i;
    }
  }
}

string replaced(string text, const string& from, const string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, string::npos) << from;
  return text.replace(at, from.size(), to);
}

template <typename T>
string bytes_of(std::initializer_list<T> values, bool swapped = false) {
  string bytes;
  for (const T value : values) {
    string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (swapped) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  }
  return bytes;
}

string from_hex(const string& hex) {
  string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

const string pcd_ascii =
    "# .PCD v0.7 - Point Cloud Data file format\n"
    "VERSION 0.7\n"
    "FIELDS x y z\n"
    "SIZE 4 4 4\n"
    "TYPE F F F\n"
    "COUNT 1 1 1\n"
    "WIDTH 2\n"
    "HEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\n"
    "POINTS 2\n"
    "DATA ascii\n"
    "1 2 3\n"
    "-4 5.5 6e1\n";
const Points two_points = {{1.0, 2.0, 3.0}, {-4.0, 5.5, 60.0}};

string pcd_head(const string& encoding) {
  return replaced(pcd_ascii.substr(0, pcd_ascii.find("DATA")), "POINTS 2\n",
                  "POINTS 2\nDATA " + encoding + "\n");
}

const string pcd_binary =
    pcd_head("binary") + bytes_of<float>({1.0F, 2.0F, 3.0F, -4.0F, 5.5F, 60.0F});

/// Written by PCL 1.13.0: 6 x 4 points of x = 0.5 column, y = -0.25 row, z = 1 but for point 7,
/// which is nan, and a colour.
const string pcd_compressed =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\n"
    "TYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 6\nHEIGHT 4\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 24\n"
    "DATA binary_compressed\n" +
    from_hex(
        "57000000800100000100006000033f000080200300c0200304004000002020036000200fe0381700802049e00a"
        "030180be2073e00a030100bf202fe00a0300402013e00b03409fe00f0301c07f2063a0c3e02d0703302010ffe0"
        "51030110ff");

const string ply_ascii =
    "ply\n"
    "format ascii 1.0\n"
    "comment made by hand\n"
    "element vertex 2\n"
    "property float x\n"
    "property float y\n"
    "property float z\n"
    "end_header\n"
    "1 2 3\n"
    "-4 5.5 6e1\n";

string ply_binary(bool swapped) {
  return replaced(ply_ascii.substr(0, ply_ascii.find("1 2 3")), "ascii",
                  swapped ? "binary_big_endian" : "binary_little_endian") +
         bytes_of<float>({1.0F, 2.0F, 3.0F, -4.0F, 5.5F, 60.0F}, swapped);
}

/// A PLY with a list before x, y, z, one behind, and elements with lists around the vertices.
string ply_with_lists(bool swapped) {
  const auto one = [&](auto value) { return bytes_of<decltype(value)>({value}, swapped); };
  string body = one(std::uint8_t{2}) + one(1.5F) + one(2.5F);  // camera
  body += one(std::int16_t{1}) + one(7.0) + one(1.0) + one(std::int32_t{2}) + one(3.0F) +
          one(std::uint8_t{0});
  body += one(std::int16_t{0}) + one(-4.0) + one(std::int32_t{5}) + one(60.0F) +
          one(std::uint8_t{1}) + one(std::int32_t{9});
  body += one(std::uint8_t{3}) + one(std::int32_t{0}) + one(std::int32_t{1}) +
          one(std::int32_t{0});  // face
  return string("ply\nformat ") + (swapped ? "binary_big_endian" : "binary_little_endian") +
         " 1.0\nelement camera 1\nproperty list uchar float k\nelement vertex 2\n"
         "property list int16 float64 tags\nproperty double x\nproperty int y\n"
         "property float32 z\nproperty list uchar int more\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n" +
         body;
}

TEST(ReadCloud, EveryFormat) {
  for (const string& content : {pcd_ascii, pcd_binary, ply_ascii, ply_binary(false),
                                ply_binary(true), string("1 2 3\n-4 5.5 6e1\n")}) {
    const Cloud cloud = read_content(content);
    expect_points(cloud, two_points);
    EXPECT_EQ(cloud.width, 2u);
    EXPECT_EQ(cloud.height, 1u);
  }
}

TEST(ReadCloud, CompressedPcdOfPcl) {
  const Cloud cloud = read_content(pcd_compressed);
  EXPECT_EQ(cloud.width, 6u);
  EXPECT_EQ(cloud.height, 4u);
  Points expected;
  for (int i = 0; i < 24; ++i) {
    expected.emplace_back(0.5 * (i % 6), -0.25 * (i / 6), i == 7 ? nan : 1.0);
  }
  expect_points(cloud, expected);
}

TEST(ReadCloud, NumbersOfEveryTypeAmongOtherFields) {
  const string head =
      "VERSION .7\nFIELDS rgb _ z y _ x\nSIZE 4 1 8 1 2 2\nTYPE U U F I U U\n"
      "COUNT 1 3 1 1 2 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  const string row = bytes_of<char>({1, 2, 3, 4, 5, 6, 7}) + bytes_of<double>({0.1}) +
                     bytes_of<signed char>({-100}) + bytes_of<std::uint16_t>({1, 2, 65535});
  expect_points(read_content(head + "binary\n" + row), {{65535.0, -100.0, 0.1}});
  expect_points(read_content(head + "ascii\n7 1 1 1 0.1 -100 1 2 65535\n"),
                {{65535.0, -100.0, 0.1}});
  string ply =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty uchar red\nproperty short x\n"
      "property uint y\nproperty char z\nend_header\n";
  ply += bytes_of<unsigned char>({9}) + bytes_of<std::int16_t>({-300}, true) +
         bytes_of<std::uint32_t>({4000000000U}, true) + bytes_of<signed char>({-5});
  expect_points(read_content(ply), {{-300.0, 4e9, -5.0}});
}

TEST(ReadCloud, ListsAreSkippedByTheirLength) {
  expect_points(read_content(ply_with_lists(false)), {{1.0, 2.0, 3.0}, {-4.0, 5.0, 60.0}});
  expect_points(read_content(ply_with_lists(true)), {{1.0, 2.0, 3.0}, {-4.0, 5.0, 60.0}});
  expect_points(
      read_content("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int i\n"
                   "element vertex 1\nproperty list char float t\nproperty float z\n"
                   "property float y\nproperty float x\nend_header\n3 0 0 0\n2 8 9 3 2 1\n"),
      {{1.0, 2.0, 3.0}});
}

// As PDAL, Open3D and Ouster write PCD, and PDAL PLY: letters of the other case, no VERSION.
TEST(ReadCloud, DialectsOfOtherPrograms) {
  const auto dialect = [](string text, const std::vector<std::pair<string, string>>& changes) {
    for (const auto& [from, to] : changes) text = replaced(text, from, to);
    return text;
  };
  const std::vector<string> files = {
      dialect(pcd_ascii, {{"x y z", "X Y Z"}}),
      dialect(pcd_ascii, {{"F F F", "f f f"}}),
      dialect(pcd_ascii, {{"ascii", "ASCII"}}),
      dialect(pcd_ascii, {{"VERSION 0.7\n", ""}, {"VIEWPOINT 0 0 0 1 0 0 0\n", ""}}),
      dialect(pcd_ascii,
              {{"# .PCD v0.7 - Point Cloud Data file format\n", ""}, {"VERSION 0.7\n", ""}}),
      dialect(pcd_ascii, {{"FIELDS", "COLUMNS"}}),
      dialect(pcd_binary, {{"x y z", "X Y Z"}, {"DATA binary", "DATA BINARY"}}),
      dialect(ply_ascii, {{"float x", "float X"}, {"float y", "float Y"}, {"float z", "float Z"}}),
  };
  const Cloud expected = read_cloud(TempFile(pcd_ascii).path());
  ASSERT_EQ(expected.points.size(), 2U);
  for (const string& file : files) {
    SCOPED_TRACE(file);
    EXPECT_EQ(read_cloud(TempFile(file).path()).points, expected.points);
  }
}

TEST(ReadCloud, OfFieldsOfEitherCaseTheSmallOnesCount) {
  const string both =
      replaced(replaced(replaced(replaced(pcd_ascii, "x y z", "x y z X"), "4 4 4", "4 4 4 4"),
                        "F F F", "F F F F"),
               "1 1 1", "1 1 1 1");
  const Cloud cloud =
      read_cloud(TempFile(both.substr(0, both.find("ascii\n") + 6) + "1 2 3 9\n4 5 6 9\n").path());
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3d(4, 5, 6));
}

TEST(ReadCloud, LineEndsAndPaddingOfOtherSystems) {
  const auto with_crlf = [](string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != string::npos; at += 2) {
      text.insert(at, "\r");
    }
    return text;
  };
  for (const string& content :
       {with_crlf(pcd_ascii), with_crlf(ply_ascii), with_crlf("x,y,z\n1,2,3\n-4,5.5,6e1\n"),
        pcd_binary + string(100, '\0'), pcd_binary + "\n", pcd_ascii + "\n\n",
        string("\xEF\xBB\xBF"
               "1 2 3\n-4 5.5 6e1")}) {
    expect_points(read_content(content), two_points);
  }
}

TEST(ReadCloud, TextInManyDialects) {
  for (const string content :
       {"1 2 3\n-4 5.5 6e1", "1\t2\t3\n-4\t5.5\t6e1\n", "1,2,3\n-4,5.5,6e1\n",
        "1; 2; 3\n-4; 5.5; 6e1\n", "# a comment\n// another\n\n  1  +2 3 255 name\n-4 5.5 60\n",
        "x y z\n1 2 3\n-4 5.5 60\n", "\"X\",\"Y\",\"Z\"\n1, 2, 3\n-4, 5.5, 60\n",
        "id,z,y,x\na,3,2,1\nb,60,5.5,-4\n", ",x,y,z\n0,1,2,3\n1,-4,5.5,60\n"}) {
    SCOPED_TRACE(content);
    expect_points(read_content(content), two_points);
  }
}

TEST(ReadCloud, PointsThatAreNotFiniteKeepTheirPlace) {
  const Points points = {{nan, nan, nan}, {1.0, infinity, -infinity}};
  const string rows = "nan NaN -nan\n1 inf -Infinity\n";
  expect_points(read_content(pcd_ascii.substr(0, pcd_ascii.find("1 2 3")) + rows), points);
  expect_points(read_content(ply_ascii.substr(0, ply_ascii.find("1 2 3")) + rows), points);
  expect_points(read_content(rows), points);
}

TEST(ReadCloud, CloudsWithoutPointsAreClouds) {
  const string none =
      replaced(replaced(pcd_head("ascii"), "WIDTH 2", "WIDTH 0"), "POINTS 2", "POINTS 0");
  EXPECT_TRUE(read_content(none).points.empty());
  EXPECT_TRUE(read_content(replaced(none, "ascii", "binary")).points.empty());
}

TEST(ReadCloud, DoesNotFollowTheLocale) {
  for (const char* locale : {"de_DE.UTF-8", "tr_TR.UTF-8"}) {
    if (std::setlocale(LC_ALL, locale) == nullptr) continue;
    expect_points(read_content(pcd_ascii), two_points);
    expect_points(read_content("1 2 3\n-4 5.5 60\n"), two_points);
  }
  std::setlocale(LC_ALL, "C");
}

/// All points of a file as they stream by, and how they came.
struct Streamed {
  Cloud cloud;
  std::size_t largest = 0;
};
Streamed streamed(const string& path) {
  Streamed all;
  stream_cloud(path, [&all](const Points& points) {
    all.largest = std::max(all.largest, points.size());
    all.cloud.points.insert(all.cloud.points.end(), points.begin(), points.end());
  });
  return all;
}

TEST(StreamCloud, GivesThePointsOfReadCloudAroundEveryBoundary) {
  Random random(3);
  for (const int count : {0, 1, 2047, 2048, 2049, 4096, 30000}) {
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
      cloud.points.emplace_back(random.normal(), random.normal(), 1e6 * random.normal());
    }
    cloud.width = cloud.points.size();
    for (const auto& format : {CloudFormat{"pcd", true}, CloudFormat{"pcd"},
                               CloudFormat{"ply", true}, CloudFormat{"ply"}, CloudFormat{"xyz"}}) {
      if (count == 0 && format.name == "xyz") continue;
      const TempFile file;
      write_cloud(file.path(), cloud, format);
      const Streamed all = streamed(file.path());
      expect_points(all.cloud, cloud.points);
      expect_points(read_cloud(file.path()), cloud.points);
      EXPECT_LE(all.largest, 4096u);
    }
  }
}

TEST(StreamCloud, ListsStandAcrossTheWindow) {
  string body;
  Points expected;
  for (int i = 0; i < 40000; ++i) {
    const auto length = static_cast<std::uint8_t>(i % 7);
    body += bytes_of<std::uint8_t>({length}) + string(4U * length, 'x') +
            bytes_of<float>({0.5F * static_cast<float>(i), 1.0F, -2.0F});
    expected.emplace_back(0.5 * i, 1.0, -2.0);
  }
  const TempFile file(
      "ply\nformat binary_little_endian 1.0\nelement noise 30000\nproperty double t\n"
      "element vertex 40000\nproperty list uchar int i\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n" +
      string(240000, 'y') + body);
  expect_points(streamed(file.path()).cloud, expected);
}

/// LZF that repeats the block of 8192 bytes before as often as it can.
string packed_lzf(const string& bytes) {
  constexpr std::size_t back = 8192;
  string out;
  std::size_t at = 0;
  while (at < bytes.size()) {
    std::size_t same = 0;
    while (at >= back && same < 264 && at + same < bytes.size() &&
           bytes[at + same] == bytes[at + same - back]) {
      ++same;
    }
    if (same >= 9) {
      out += string("\xff") + static_cast<char>(same - 9) + '\xff';
      at += same;
      continue;
    }
    const std::size_t run = std::min<std::size_t>(32, bytes.size() - at);
    out += static_cast<char>(run - 1) + bytes.substr(at, run);
    at += run;
  }
  return out;
}

// Blocks of 240000 bytes, far longer than what unpacking keeps at hand, between fields to skip.
TEST(StreamCloud, CompressedFieldsLongerThanTheWindow) {
  Points expected;
  std::array<string, 3> fields;
  for (int i = 0; i < 60000; ++i) {
    const Eigen::Vector3f p(static_cast<float>(i % 2048), 0.25F * static_cast<float>(i / 500),
                            static_cast<float>(i % 3));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fields[axis] += bytes_of<float>({p[static_cast<Eigen::Index>(axis)]});
    }
    expected.push_back(p.cast<double>());
  }
  const string block = string(60000, 'a') + fields[2] + fields[0] + string(120000, 'b') + fields[1];
  const string packed = packed_lzf(block);
  ASSERT_LT(packed.size(), block.size());
  const TempFile file(
      "VERSION 0.7\nFIELDS _ z x t y\nSIZE 1 4 4 2 4\nTYPE U F F U F\nWIDTH 60000\nHEIGHT 1\n"
      "POINTS 60000\nDATA binary_compressed\n" +
      bytes_of<std::uint32_t>(
          {static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(block.size())}) +
      packed);
  expect_points(streamed(file.path()).cloud, expected);
  expect_points(read_cloud(file.path()), expected);
}

TEST(StreamCloud, RefusesWithTheErrorsOfReadCloud) {
  for (const string& content :
       {string("1 2 3\n4 5\n"), replaced(pcd_ascii, "POINTS 2", "POINTS 3"), pcd_binary + "abc",
        ply_ascii + "1 2 3\n", string("LASF"), string()}) {
    const TempFile file(content);
    const string error = error_about([&] { read_cloud(file.path()); }, file.path());
    EXPECT_EQ(error_about([&] { streamed(file.path()); }, file.path()), error);
    EXPECT_NE(error, "no error");
  }
}

TEST(StreamCloud, NoLimitHoldsForWhatIsNotKept) {
  const TempFile temp(replaced(replaced(pcd_head("binary"), "WIDTH 2", "WIDTH 500000000"),
                               "POINTS 2", "POINTS 500000000"));
  const auto head = static_cast<off_t>(std::filesystem::file_size(temp.path()));
  ASSERT_EQ(::truncate(temp.path().c_str(), head + off_t{12} * 500000000), 0);  // sparse: zeros
  struct Enough {};
  std::size_t points = 0;
  EXPECT_THROW(stream_cloud(temp.path(),
                            [&points](const Points& some) {
                              points += some.size();
                              if (points > 10000) throw Enough{};
                            }),
               Enough);
  EXPECT_NE(error_about([&] { read_cloud(temp.path()); }, temp.path()).find("4.000 GiB of memory"),
            string::npos);
}

struct BadFile {
  string content;
  string message;  ///< what the error must hold
};

void expect_refused(const std::vector<BadFile>& corpus) {
  for (const BadFile& bad : corpus) {
    const string error = error_of_content(bad.content);
    EXPECT_NE(error.find(bad.message), string::npos)
        << "for:\n"
        << bad.content.substr(0, 400) << "\nfound:    " << error << "\nexpected: " << bad.message;
  }
}

string with_pcd(const string& from, const string& to) { return replaced(pcd_ascii, from, to); }
string with_pcd_binary(const string& from, const string& to) {
  return replaced(pcd_binary, from, to);
}

TEST(BadPcd, NumbersOfTheHeader) {
  expect_refused({
      {with_pcd("WIDTH 2", "WIDTH -2"), "line 7: found '-2', expected a whole number"},
      {with_pcd("WIDTH 2", "WIDTH 2.0"), "found '2.0'"},
      {with_pcd("WIDTH 2", "WIDTH 2x"), "found '2x'"},
      {with_pcd("WIDTH 2", "WIDTH 0x2"), "found '0x2'"},
      {with_pcd("WIDTH 2", "WIDTH +2"), "found '+2'"},
      {with_pcd("WIDTH 2", "WIDTH"), "line 7: found 0 values of WIDTH, expected 1"},
      {with_pcd("WIDTH 2", "WIDTH 2 2"), "found 2 values of WIDTH, expected 1"},
      {with_pcd("WIDTH 2", "WIDTH 3"), "line 11: found POINTS 2, expected WIDTH x HEIGHT = 3 x 1"},
      {with_pcd("HEIGHT 1", "HEIGHT 2"), "expected WIDTH x HEIGHT = 2 x 2"},
      {with_pcd("POINTS 2", "POINTS 3"), "found POINTS 3, expected WIDTH x HEIGHT = 2 x 1"},
      {with_pcd("WIDTH 2", "WIDTH 99999999999999999999"), "found '99999999999999999999'"},
      {replaced(with_pcd("WIDTH 2", "WIDTH 9223372036854775809"), "HEIGHT 1", "HEIGHT 2"),
       "expected WIDTH x HEIGHT = 9223372036854775809 x 2"},  // 2 modulo 2^64
      {replaced(with_pcd_binary("WIDTH 2", "WIDTH 4000000000"), "POINTS 2", "POINTS 4000000000"),
       "24 bytes of data, expected 4000000000 points of 12 bytes"},
      {replaced(with_pcd_binary("WIDTH 2", "WIDTH 1537228672809129302"), "POINTS 2",
                "POINTS 1537228672809129302"),
       "24 bytes of data"},  // times 12 is 8 modulo 2^64
      {replaced(with_pcd("WIDTH 2", "WIDTH 4000000000"), "POINTS 2", "POINTS 4000000000"),
       "found the end after 2 rows, expected 4000000000"},
      {replaced(with_pcd_binary("WIDTH 2", "WIDTH 1"), "POINTS 2", "POINTS 1"),
       "found 12 bytes more, expected the end of the file"},
      {with_pcd("VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 0 0 0 1 0 0"),
       "found 6 values of VIEWPOINT, expected 7"},
      {with_pcd("VIEWPOINT 0 0 0 1", "VIEWPOINT 0 0 a 1"), "line 9: found 'a', expected a number"},
      {with_pcd("VERSION 0.7", "VERSION 7"), "found VERSION '7', expected 0.5, 0.6 or 0.7"},
  });
}

TEST(BadPcd, Fields) {
  string names = "FIELDS x y z";
  for (int i = 0; i < 62; ++i) names += " f";
  expect_refused({
      {with_pcd("FIELDS x y z", "FIELDS x y"), "line 3: found field z 0 times"},
      {with_pcd("FIELDS x y z", "FIELDS x y y"), "found field y 2 times"},
      {with_pcd("FIELDS x y z", "FIELDS x Y Z"), "found field y 0 times"},
      {with_pcd("FIELDS x y z", "FIELDS X Y Y"), "found field y 2 times"},
      {with_pcd("FIELDS x y z", "FIELDS"), "found field x 0 times"},
      {with_pcd("FIELDS x y z", "FIELDS x y z rgb"), "line 4: found 3 values of SIZE, expected 4"},
      {with_pcd("FIELDS x y z", names), "found 65 fields, expected at most 64"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4"), "found 2 values of SIZE, expected 3"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4 4 4"), "found 4 values of SIZE, expected 3"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4 0"), "found SIZE '0', expected 1, 2, 4 or 8"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4 3"), "found SIZE '3'"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4 -4"), "found '-4'"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4 2"), "line 5: found TYPE F of SIZE 2, expected SIZE 4"},
      {with_pcd("SIZE 4 4 4", "SIZE 4 4 4294967300"), "found SIZE '4294967300'"},
      {with_pcd("TYPE F F F", "TYPE F F"), "found 2 values of TYPE, expected 3"},
      {with_pcd("TYPE F F F", "TYPE F F D"), "found TYPE 'D', expected I, U or F"},
      {with_pcd("TYPE F F F", "TYPE FFF F F"), "found TYPE 'FFF'"},
      {with_pcd("TYPE F F F", "TYPE F F IU"), "found TYPE 'IU'"},
      {with_pcd("TYPE F F F", "TYPE F F d"), "found TYPE 'd', expected I, U or F"},
      {with_pcd("COUNT 1 1 1", "COUNT 1 1"), "found 2 values of COUNT, expected 3"},
      {with_pcd("COUNT 1 1 1", "COUNT 1 1 0"), "found COUNT '0', expected 1 .. 4096"},
      {with_pcd("COUNT 1 1 1", "COUNT 1 1 2"), "found COUNT '2' of field z, expected 1"},
      {with_pcd("COUNT 1 1 1", "COUNT 1 1 -1"), "found '-1'"},
      {with_pcd("COUNT 1 1 1", "COUNT 1 1 4097"), "found COUNT '4097'"},
      {"VERSION 0.7\nFIELDS x y z a\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 600\nWIDTH 1\n"
       "HEIGHT 1\nPOINTS 1\nDATA binary\n",
       "found points of 4812 bytes, expected at most 4096"},
  });
}

TEST(BadPcd, ShapeOfTheHeader) {
  expect_refused({
      {pcd_ascii.substr(0, 43), "line 2: found the end of the file, expected VERSION"},
      {pcd_ascii.substr(0, pcd_ascii.find("DATA")), "found the end of the file, expected DATA"},
      {with_pcd("VERSION 0.7\nFIELDS x y z\n", ""), "line 2: found 'SIZE', expected VERSION"},
      {with_pcd("FIELDS x y z\n", ""), "line 3: found 'SIZE', expected FIELDS"},
      {with_pcd("SIZE 4 4 4\n", ""), "line 4: found 'TYPE', expected SIZE"},
      {with_pcd("TYPE F F F\n", ""), "found 'COUNT', expected TYPE"},
      {with_pcd("WIDTH 2\n", ""), "found 'HEIGHT', expected WIDTH"},
      {with_pcd("HEIGHT 1\n", ""), "found 'VIEWPOINT', expected HEIGHT"},
      {with_pcd("POINTS 2\n", ""), "found 'DATA', expected POINTS"},
      {with_pcd("DATA ascii\n", ""), "found '1', expected DATA"},
      {with_pcd("FIELDS x y z\n", "FIELDS x y z\nFIELDS x y z\n"), "found 'FIELDS', expected SIZE"},
      {with_pcd("TYPE F F F\n", "TYPE F F F\nFIELDS x\n"), "found 'FIELDS', expected COUNT"},
      {with_pcd("WIDTH 2\nHEIGHT 1\n", "HEIGHT 1\nWIDTH 2\n"), "found 'HEIGHT', expected WIDTH"},
      {with_pcd("WIDTH", "width"), "found 'width', expected WIDTH"},
      {with_pcd("WIDTH", "COLOUR red\nWIDTH"), "found 'COLOUR', expected WIDTH"},
      {with_pcd("DATA ascii", "DATA text"), "found DATA 'text', expected ascii, binary or"},
      {with_pcd("DATA ascii", "DATA"), "found 0 values of DATA, expected 1"},
      {with_pcd("DATA ascii", "DATA binary_compressed_lzma"),
       "found DATA 'binary_compressed_lzma'"},
      {with_pcd("VERSION 0.7\n", "#" + string(5000, 'x') + "\nVERSION 0.7\n"),
       "line 2: found a line of more than 4096 bytes"},
      {with_pcd("VERSION 0.7\n",
                [] {
                  string comments;
                  for (int i = 0; i < 20; ++i) comments += "#" + string(4000, 'x') + "\n";
                  return comments + "VERSION 0.7\n";
                }()),
       "found a header of more than 65536 bytes"},
      {with_pcd("FIELDS", string("FIE\0LDS", 7)), "found 'FIE?LDS', expected FIELDS"},
  });
}

TEST(BadPcd, Rows) {
  expect_refused({
      {with_pcd("1 2 3\n", "1 2\n"), "line 12: found 2 values, expected 3"},
      {with_pcd("1 2 3\n", "1 2 3 4\n"), "line 12: found 4 values, expected 3"},
      {with_pcd("1 2 3\n", "1 2 3m\n"), "line 12: found '3m', expected a number"},
      {with_pcd("1 2 3\n", "1 2 x\n"), "found 'x'"},
      {with_pcd("1 2 3\n", "1,2,3\n"), "found '1,2,3'"},
      {with_pcd("1 2 3\n", "1 2,5 3\n"), "found '2,5'"},
      {with_pcd("1 2 3\n", "1 2 0x3\n"), "found '0x3'"},
      {with_pcd("1 2 3\n", "1 2 1e999\n"), "found '1e999'"},
      {with_pcd("1 2 3\n", "1 2 1e\n"), "found '1e'"},
      {with_pcd("1 2 3\n", "1 2 +-3\n"), "found '+-3'"},
      {with_pcd("1 2 3\n", ""), "line 13: found the end after 1 rows, expected 2"},
      {with_pcd("1 2 3\n", "1 2 3\n1 2 3\n"), "line 14: found more rows, expected the end after"},
      {with_pcd("1 2 3\n", "1 2 3\n# end\n"), "line 13: found '#', expected a number"},
      {with_pcd("1 2 3\n", string("1 2 3\0\n", 7)), "found '3?', expected a number"},
      {with_pcd("1 2 3\n", string(9000, '1') + "\n"), "a line of more than 4096 bytes"},
  });
}

string compressed(std::uint32_t packed, std::uint32_t unpacked, const string& data) {
  return pcd_head("binary_compressed") + bytes_of<std::uint32_t>({packed, unpacked}) + data;
}

TEST(BadPcd, BinaryAndCompressedParts) {
  const string literals = "\x17" + string(24, 'a');
  ASSERT_EQ(read_content(compressed(25, 24, literals)).points.size(), 2u);
  expect_refused({
      {pcd_binary.substr(0, pcd_binary.size() - 1), "23 bytes of data, expected 2 points"},
      {pcd_head("binary"), "found 0 bytes of data"},
      {pcd_binary + "abc", "found 3 bytes more, expected the end of the file"},
      {pcd_binary + string(5000, '\0'), "found 5000 bytes more"},
      {pcd_head("binary_compressed"), "found 0 bytes of data, expected two sizes of 4 bytes"},
      {pcd_head("binary_compressed") + "abc", "found 3 bytes of data"},
      {compressed(26, 24, literals), "found 25 compressed bytes, expected 26"},
      {compressed(0xFFFFFFFFU, 24, literals), "found 25 compressed bytes, expected 4294967295"},
      {compressed(24, 24, literals), "found 1 bytes more"},
      {compressed(25, 25, literals), "an uncompressed size of 25, expected 2 points of 12 bytes"},
      {compressed(25, 0, literals), "an uncompressed size of 0"},
      {compressed(25, 0xFFFFFFFFU, literals), "an uncompressed size of 4294967295"},
      {compressed(0, 24, ""), "found 0 bytes for 24, expected a compression ratio of at most 256"},
      {compressed(24, 24, "\x16" + string(23, 'a')),
       "found damaged compressed data"},                                             // too little
      {compressed(27, 24, literals + string("\0a", 2)), "damaged compressed data"},  // too much
      {compressed(4, 24,
                  "\x1f"
                  "abc"),
       "damaged compressed data"},  // run leaves the input
      {compressed(2, 24, string("\xe0\x10", 2)), "damaged compressed data"},  // cut reference
      {compressed(1, 24, "\x20"), "damaged compressed data"},
      {compressed(25, 24, string("\0a\x20\x01\x13", 5) + string(20, 'b')),
       "damaged compressed data"},  // one byte before the start
      {compressed(4, 24, string("\0a\x20\x05", 4)), "damaged compressed data"},  // before the start
      {compressed(5, 24, string("\0a\xe0\xff\0", 5)), "damaged compressed data"},  // beyond the end
      {replaced(replaced(compressed(25, 24, literals), "WIDTH 2", "WIDTH 400000000"), "POINTS 2",
                "POINTS 400000000"),
       "an uncompressed size of 24, expected 400000000 points"},
  });
}

string with_ply(const string& from, const string& to) { return replaced(ply_ascii, from, to); }

TEST(BadPly, Header) {
  expect_refused({
      {"ply\n", "line 2: found the end of the file, expected end_header"},
      {ply_ascii.substr(0, ply_ascii.find("end_header")), "found the end of the file"},
      {with_ply("format ascii 1.0\n", ""), "line 3: found 'element vertex 2', expected format"},
      {with_ply("ascii 1.0", "ascii 2.0"), "line 2: found 'format ascii 2.0', expected format"},
      {with_ply("ascii", "binary"), "found 'format binary 1.0'"},
      {with_ply("element vertex 2", "element vertex"), "line 4: found 'element vertex'"},
      {with_ply("element vertex 2", "element vertex -2"), "found '-2', expected a whole number"},
      {with_ply("element vertex 2", "element vertex 2.5"), "found '2.5'"},
      {with_ply("vertex 2", "vertex 99999999999999999999"), "found '99999999999999999999'"},
      {with_ply("element vertex 2\n", ""), "found 'property', expected element"},
      {with_ply("vertex 2", "point 2"), "found 0 elements called vertex, expected one"},
      {with_ply("end_header",
                "element vertex 2\nproperty float x\nproperty float y\n"
                "property float z\nend_header"),
       "found 2 elements called vertex"},
      {with_ply("property float y\n", ""), "found property y 0 times"},
      {with_ply("property float y", "property float x"), "found property x 2 times"},
      {with_ply("property float y", "property list uchar float y"), "found property y 0 times"},
      {with_ply("property float y", "property real y"), "line 6: found type 'real'"},
      {with_ply("property float y", "property float"), "found 'property float', expected property"},
      {with_ply("property float y", "property list float int y"),
       "found a list length of type 'float', expected an integer type"},
      {with_ply("end_header", "element face 1\nend_header"), "found element 'face' without a"},
      {with_ply("end_header", "colour red\nend_header"), "line 8: found 'colour'"},
      {with_ply("made by hand", string(5000, 'x')), "line 3: found a line of more than 4096 bytes"},
      {with_ply("end_header",
                [] {
                  string properties;
                  for (int i = 0; i < 62; ++i) properties += "property float f\n";
                  return properties + "end_header";
                }()),
       "found more than 64 elements or properties"},
  });
}

TEST(BadPly, Body) {
  const string binary = ply_binary(false);
  const string lists = ply_with_lists(false);
  const string face = bytes_of<unsigned char>({3}) + bytes_of<std::int32_t>({0, 1, 0});
  string negative = replaced(lists, "list uchar float k", "list char float k");
  negative[negative.find("end_header\n") + 11] = '\xFF';
  expect_refused({
      {with_ply("1 2 3\n", "1 2\n"), "line 9: found the end of the line, expected a value"},
      {with_ply("1 2 3\n", "1 2 3 4\n"), "line 9: found '4', expected the end of the row"},
      {with_ply("1 2 3\n", "1 2 c\n"), "line 9: found 'c', expected a number"},
      {with_ply("1 2 3\n", ""), "found the end after 1 rows of element 'vertex', expected 2"},
      {with_ply("1 2 3\n", "1 2 3\n7 8 9\n"), "expected the end after the last element"},
      {with_ply("vertex 2", "vertex 4000000000"), "found the end after 2 rows"},
      {binary.substr(0, binary.size() - 1), "found 23 bytes of data, expected 2 times 12 bytes"},
      {binary + "abc", "found 3 bytes more"},
      {replaced(binary, "vertex 2", "vertex 1537228672809129302"), "found 24 bytes of data"},
      {lists.substr(0, lists.size() - 1), "expected 3 times 4 bytes of element 'face'"},
      {replaced(lists, face, "\xFF" + face.substr(1)), "expected 255 times 4 bytes"},
      {replaced(lists, "face 1", "face 2"), "found 0 bytes of data, expected 1 times 1 bytes"},
      {replaced(lists, "face 1", "face 9000000000000000000"), "found 13 bytes of data"},
      {negative, "found a list of negative length"},
  });
}

TEST(BadText, IsNotACloud) {
  expect_refused({
      {"", "is empty"},
      {"Hello, this is a letter\nand no cloud.\n",
       "line 1: found 'Hello, this is a letter', expected numbers, or names of columns"},
      {"x y z\nnot a number\n", "line 2: found 'not', expected a number"},
      {"# only\n// comments\n", "line 3: found no row of numbers, expected x y z"},
      {"x y z\n", "found no row of numbers"},
      {"1 2\n3 4\n", "line 1: found 2 columns, expected x, y and z"},
      {"1 2 3\n4 5\n", "line 2: found 2 columns"},
      {"1 2 3\n4 5 a\n", "line 2: found 'a', expected a number"},
      {"1 2 3\n4,5,6\n", "line 2: found 1 columns"},
      {"1,5 2,5 3,5\n", "line 1: found '5 2', expected a number"},
      {"1,5;2,5;3,5\n", "line 1: found '1,5;2,5;3,5', expected numbers"},
      {"1,,3\n", "found '', expected a number"},
      {"east north height\n1 2 3\n", "line 1: found 'east north height'"},
      {"x x y z\n1 2 3 4\n", "line 1: found 'x x y z'"},
      {"{\"points\": []}\n", "line 1: found '{\"points\": []}'"},
      {string("1\0 2\0 3\0", 8), "byte 1: found the byte 0, expected a cloud as PCD, PLY, LAS"},
      {"ASTM-E57\x01",
       "byte 0: found an E57 file, expected a cloud as PCD, PLY, LAS, GeoTIFF, ESRI ASCII "
       "grid, OBJ or XYZ text; convert it by "
       "pdal "
       "translate in.e57 out.las, or CloudCompare -SILENT -O in.e57"},
      {"SQLite format 3",
       "found a recording (ROS 2 bag) or another database, expected a cloud as PCD, PLY, LAS, "
       "GeoTIFF, "
       "ESRI ASCII grid, OBJ or XYZ text; inspect-cloud FILE lists its topics, and writes one, "
       "FILE:TOPIC@TIME, as a "
       "cloud"},
      {"\x89MCAP0\r\n", "found a recording (MCAP)"},
      {"#ROSBAG V2.0\n", "found a recording (ROS 1 bag)"},
      {"\x89PNG\r\n\x1a\n", "found a PNG image"},
      {string("II*\0\x08\0\0\0", 8), "byte 8: beyond the end of the file, which has 8 bytes"},
      {string("MM\0*\0\0\0\x08", 8), "byte 8: beyond the end of the file"},
      {string("II+\0\x08\0\0\0", 8), "byte 8: beyond the end of the file"},
      {"ncols 4\nnrows 3\n", "line 3: cellsize is missing in the head"},
      {"<?xml version=\"1.0\"?>\n<!-- of a survey -->\n<LandXML version=\"1.2\">\n",
       "byte 0: found a LandXML file, expected a cloud"},
      {"\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<gml>\n", "found an XML file"},
      {"  0\r\nSECTION\r\n  2\r\nHEADER\r\n", "found a DXF drawing"},
      {"0\nSECTION\n2\nENTITIES\n", "found a DXF drawing"},
      {string("AutoCAD Binary DXF\r\n\x1A\0", 22), "found a DXF drawing"},
      {"PK\x03\x04", "found a ZIP archive"},
      {"1 2 3\n" + string(9000, '1'), "line 2: found a line of more than 4096 bytes"},
      {"PLY\nformat ascii 1.0\n", "line 1: found 'PLY'"},
  });
}

TEST(ReadCloud, VerticesOfTheMeshesOfScanningApps) {
  for (const string& content :
       {string("# a phone\nmtllib scan.mtl\no Scan\nv 1 2 3\nv -4 5.5 6e1\nvt 0 1\nvn 0 1 0\n"
               "usemtl m\ns off\nf 1/1/1 2/1/1 1/1/1\n"),
        string("v 1 2 3 0.5 0.4 0.3\r\n\r\n#\r\nv -4 5.5 6e1 0.5 0.4 0.3\r\nf 1 2 1\r\n"),
        string("\n  v 1 2 3 1.0\ng hole\n#comment\nf 1 1 1\nv -4 5.5 60 1.0")}) {
    expect_points(read_content(content), two_points);
  }
}

TEST(BadObj, IsRefused) {
  expect_refused({
      {"o Scan\nf 1 2 3\n", "line 3: found no vertex, expected v x y z"},
      {"v 1 2\n", "line 1: found the end of the line, expected v x y z"},
      {"v 1 2 3\nv 1 2 x\n", "line 2: found 'x', expected a number"},
      {"v 1 2 3\nw 4 5 6\n", "line 2: found 'w', expected v, vn, vt, f or another word of OBJ"},
  });
}

TEST(BadPlace, OnlyRegularFilesAreRead) {
  const TempFile temp;
  const auto error = [&](const string& path) {
    return error_about([&] { read_cloud(path); }, path);
  };
  EXPECT_EQ(error(temp.path()), "is empty");
  EXPECT_EQ(error(testing::TempDir()), "is not a regular file");
  EXPECT_EQ(error("/dev/zero"), "is not a regular file");
  EXPECT_EQ(error("/dev/null"), "is not a regular file");
  EXPECT_EQ(error("/no/such.pcd"), "cannot be opened: No such file or directory");
  std::filesystem::remove(temp.path());
  ASSERT_EQ(::mkfifo(temp.path().c_str(), 0600), 0);
  EXPECT_EQ(error(temp.path()), "is not a regular file");
  std::filesystem::remove(temp.path());
  std::filesystem::create_symlink(temp.path(), temp.path());
  EXPECT_NE(error(temp.path()).find("cannot be opened"), string::npos);
}

TEST(BadPlace, HugeFilesAreRefusedBeforeMemoryIsAskedFor) {
  const TempFile temp(pcd_ascii);
  ASSERT_EQ(::truncate(temp.path().c_str(), off_t{1} << 40), 0);
  EXPECT_NE(error_about([&] { read_cloud(temp.path()); }, temp.path())
                .find("expected what fits into 4.000 GiB of memory"),
            string::npos);
}

TEST(BadPlace, TheMemoryLimitCountsFileAndPoints) {
  for (const string& content : {pcd_ascii, pcd_binary, pcd_compressed, ply_ascii, ply_binary(false),
                                ply_with_lists(true), string("1 2 3\n-4 5.5 60\n")}) {
    const TempFile temp(content);
    EXPECT_NE(error_about([&] { read_cloud(temp.path(), content.size() + 20); }, temp.path())
                  .find("of memory"),
              string::npos);
    EXPECT_NO_THROW(read_cloud(temp.path(), content.size() + 2000));
  }
}

Cloud sample_cloud(double scale, bool with_nan) {
  Random random(5);
  Cloud cloud;
  for (int i = 0; i < 60; ++i) {
    cloud.points.push_back(scale *
                           Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
  }
  if (with_nan) cloud.points[7] = {nan, infinity, -infinity};
  cloud.width = 60;
  return cloud;
}

const std::vector<CloudFormat> all_formats = {CloudFormat{"pcd", true}, CloudFormat{"pcd"},
                                              CloudFormat{"ply", true}, CloudFormat{"ply"},
                                              CloudFormat{"xyz"}};

TEST(WriteCloud, RoundTripIsExact) {
  Cloud small = sample_cloud(1.0, true);
  for (auto& point : small.points) point = (1024.0 * point.array()).round() / 1024.0;  // as floats
  for (const Cloud& cloud : {small, sample_cloud(1e7, true), sample_cloud(1e300, false)}) {
    for (const CloudFormat& format : all_formats) {
      const TempFile file;
      write_cloud(file.path(), cloud, format);
      expect_points(read_cloud(file.path()), cloud.points);
    }
  }
}

TEST(WriteCloud, ACloudWithoutPointsIsReadBack) {
  for (const CloudFormat& format : all_formats) {
    const TempFile file;
    write_cloud(file.path(), Cloud{}, format);
    const Cloud back = read_cloud(file.path());
    EXPECT_TRUE(back.points.empty()) << format.name;
    EXPECT_EQ(back.width * back.height, 0U) << format.name;
  }
}

TEST(WriteCloud, TextKeepsEveryDigit) {
  const Cloud cloud = sample_cloud(1.0, true);
  for (const auto& format :
       {CloudFormat{"pcd", true}, CloudFormat{"ply", true}, CloudFormat{"xyz"}}) {
    const TempFile file;
    write_cloud(file.path(), cloud, format);
    expect_points(read_cloud(file.path()), cloud.points);
  }
}

TEST(WriteCloud, BinaryTakesFloat64OnlyWhereAPointWouldMoveByOverATenthOfAMillimetre) {
  for (const auto& [scale, bytes] :
       std::vector<std::pair<double, std::size_t>>{{1.0, 4}, {100.0, 4}, {1e4, 8}, {5e6, 8}}) {
    const Cloud cloud = sample_cloud(scale, false);
    const TempFile file;
    write_cloud(file.path(), cloud, CloudFormat{"pcd"});
    const string content = content_of(file.path());
    EXPECT_NE(content.find("SIZE " + std::to_string(bytes)), string::npos) << scale;
    EXPECT_EQ(content.size() - content.find("DATA binary\n") - 12, 60 * 3 * bytes);
    const Cloud back = read_cloud(file.path());
    for (std::size_t i = 0; i < 60; ++i) {
      EXPECT_LE((back.points[i] - cloud.points[i]).norm(), 1e-4);
    }
  }
}

TEST(WriteCloud, PcdKeepsTheOrderOfAnOrganisedCloud) {
  Cloud cloud = sample_cloud(1.0, true);
  cloud.width = 12;
  cloud.height = 5;
  for (const auto& format : {CloudFormat{"pcd", true}, CloudFormat{"pcd"}}) {
    const TempFile file;
    write_cloud(file.path(), cloud, format);
    EXPECT_EQ(read_cloud(file.path()).width, 12u);
    EXPECT_EQ(read_cloud(file.path()).height, 5u);
  }
  cloud.height = 4;
  const TempFile file;
  EXPECT_EQ(error_about([&] { write_cloud(file.path(), cloud, CloudFormat{"xyz"}); }, file.path(),
                        ErrorKind::bad_input),
            "a cloud of 60 points must be width x height, is 12 x 4");
}

TEST(WriteCloud, AFileThatCannotBeWrittenIsAnError) {
  const string path = "/no/such/folder/a.pcd";
  EXPECT_EQ(
      error_about([&] { write_cloud(path, sample_cloud(1.0, false), CloudFormat{"xyz"}); }, path),
      "cannot be written: No such file or directory");
}

TEST(WriteCloud, AFormatThatIsNoneIsAnError) {
  const string path = "a.las";
  EXPECT_EQ(error_about([&] { write_cloud(path, sample_cloud(1.0, false), {"las"}); }, path,
                        ErrorKind::bad_input),
            "'las' is not a supported output format");
}

TEST(WriteCloud, TheNameAsksForTheFormat) {
  EXPECT_EQ(cloud_endings(), ".pcd, .ply, .xyz, .txt or .asc");
  EXPECT_EQ(cloud_format_of_name("a/b.pcd").name, "pcd");
  EXPECT_EQ(cloud_format_of_name("B.PLY").name, "ply");
  EXPECT_EQ(cloud_format_of_name("a.xyz").name, "xyz");
  EXPECT_EQ(cloud_format_of_name("a.b.txt").name, "xyz");
  EXPECT_EQ(cloud_format_of_name("a.asc").name, "xyz");
  for (const string name : {"a.e57", "pcd", "a.pcd/b", "a.", ""}) {
    EXPECT_EQ(error_about([&] { cloud_format_of_name(name); }, name, ErrorKind::bad_input),
              "the name of a cloud must end in .pcd, .ply, .xyz, .txt or .asc");
  }
}

TEST(ReadFrame, ReadsWhatIsWritten) {
  const TempFile file;
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
  frame.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  frame.topRightCorner<3, 1>() = Eigen::Vector3d(1.0 / 3.0, -1e6 / 7.0, 2.5);
  write_frame(file.path(), frame);
  EXPECT_EQ(read_frame(file.path()), frame);
}

TEST(ReadFrame, SixteenNumbersOfARigidMotion) {
  const TempFile file("0 -1 0 5 # turned left\n1 0 0 -6\n\n0 0 1 0.5\n0 0 0 1\n");
  Eigen::Matrix4d expected;
  expected << 0, -1, 0, 5, 1, 0, 0, -6, 0, 0, 1, 0.5, 0, 0, 0, 1;
  EXPECT_EQ(read_frame(file.path()), expected);
}

TEST(ReadFrame, AnythingElseIsRefused) {
  const auto error = [](const string& content) {
    const TempFile file(content);
    return error_about([&] { read_frame(file.path()); }, file.path());
  };
  EXPECT_EQ(error("1 0 0 0 0 1 0 0 0 0 1 0"), "a frame: found 12 numbers, expected 4 rows of 4");
  EXPECT_EQ(error("1 0 0 x"), "line 1: found 'x', expected a number");
  EXPECT_EQ(error("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n"),
            "a frame: found another last row, expected 0 0 0 1");
  EXPECT_EQ(error("1 0 0 0\n0 1 0 0\n0 0 1 nan\n0 0 0 1\n"),
            "a frame: found a number that is not finite, expected finite numbers");
  EXPECT_EQ(error("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n"),
            "a frame: found a mirroring (determinant -1), expected a rotation");
  EXPECT_NE(error("2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n").find("found a matrix R with an entry 3"),
            string::npos);
  EXPECT_EQ(error(""), "is empty");
}

/// A quarter turn to the left and (1, 2, 3).
Eigen::Matrix4d quarter_turn() {
  Eigen::Matrix4d frame;
  frame << 0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1;
  return frame;
}

TEST(ReadFrame, TransformsAndPosesAsRosWritesThem) {
  const string numbers =
      "translation:\n      x: 1.0\n      y: 2.0\n      z: 3.0\n    rotation:\n      x: 0.0\n"
      "      y: 0.0\n      z: 0.7071067811865476\n      w: 0.7071067811865476\n";
  const string stamped =
      "header:\n    stamp:\n      sec: 5\n      nanosec: 0\n    frame_id: map\n"
      "  child_frame_id: lidar\n  transform:\n    " +
      numbers;
  const std::vector<string> contents = {
      "transforms:\n- " + stamped + "---\n",  // ros2 topic echo /tf_static
      // rostopic echo of ROS 1
      "transforms: \n  - \n    header: \n      seq: 0\n      frame_id: \"/world\"\n"
      "    child_frame_id: \"lidar\"\n    transform: \n      translation: \n        x: 1.0\n"
      "        y: 2.0\n        z: 3.0\n      rotation: \n        x: 0.0\n        y: 0.0\n"
      "        z: 0.70710678\n        w: 0.70710678\n---\n",
      "    " + numbers,  // Transform
      // Odometry, PoseWithCovarianceStamped
      "pose:\n  pose:\n    position: {x: 1, y: 2, z: 3}\n"
      "    orientation: {x: 0, y: 0, z: -0.70710678, w: -0.70710678}\n  covariance:\n  - 0.0\n",
      R"({"header": {"frame_id": "map"}, "transform": {"translation": {"x": 1, "y": 2, "z": 3},
          "rotation": {"x": 0, "y": 0, "z": 0.7071, "w": 0.7071}}})",
      R"({"position": {"x": 1, "y": 2, "z": 3},
          "orientation": {"x": 0, "y": 0, "z": 0.7071, "w": 0.7071}})",
      // tf2_echo
      "[INFO] [1783248767.16] [tf2_echo]: Waiting for transform\nAt time 20.274000000\n"
      "- Translation: [1.000, 2.000, 3.000]\n"
      "- Rotation: in Quaternion (xyzw) [0.000, -0.000, 0.707, 0.707]\n"
      "- Rotation: in RPY (radian) [0.000, 0.000, 1.571]\n"};
  for (const string& content : contents) {
    SCOPED_TRACE(content);
    const TempFile file(content);
    const Eigen::Matrix4d frame = read_frame(file.path());
    EXPECT_LT((frame - quarter_turn()).norm(), 1e-6);
    const Eigen::Matrix3d rotation = frame.topLeftCorner<3, 3>();
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(ReadFrame, OtherMessagesAreRefused) {
  const auto error = [](const string& content) {
    const TempFile file(content);
    return error_about([&] { read_frame(file.path()); }, file.path());
  };
  const string none =
      "a frame: found neither numbers nor a translation or position, expected 4 "
      "rows of 4 numbers, or a transform or pose as ROS writes it";
  EXPECT_EQ(error("Dear reader\n").substr(0, none.size()), none);
  EXPECT_EQ(error("{}").substr(0, none.size()), none);
  const string pose = R"({"position": {"x": 1, "y": 2, "z": 3}, "orientation": )";
  EXPECT_EQ(error(pose + R"({"x": 0, "y": 0, "z": 0.5, "w": 0.7}})"),
            "pose of a scan: the quaternion's norm is 0.8602325267042626, must be 1 to 0.001");
  EXPECT_EQ(error(pose + R"({"x": 0, "y": 0, "z": 0}})"), "orientation.w: is missing");
  EXPECT_EQ(error(pose + R"({"x": 0, "y": 0, "z": "a", "w": 1}})"),
            "orientation.z: is \"a\", expected a number");
  EXPECT_EQ(error(R"({"position": 5})"), "position: expected an object");
  EXPECT_EQ(error("rotation: {w: .nan}\nmy_position: 1\n").substr(0, 47),
            "a frame: found neither translation nor position");
  EXPECT_EQ(
      error("translation: {x: nan, y: 0, z: 0}\nrotation: {x: 0, y: 0, z: 0, w: 1}").substr(0, 24),
      "translation.x: is nan, m");
  const string item = "{transform: {translation: {x: 0, y: 0, z: 0}}}";
  EXPECT_EQ(error("transforms: [" + item + ", " + item + "]"), "transforms: holds 2, must be one");
  EXPECT_EQ(error("position: {x: 1}\n---\nposition: {x: 2}\n"),
            "line 3: found 'position: {x: 2}', expected the end of the file after one document");
  EXPECT_NE(error("- Translation: [1, 2]\n- Rotation: in Quaternion [0, 0, 0, 1]\n")
                .find("found 2 and 4 numbers"),
            string::npos);
  EXPECT_NE(error("- Translation: [1, 2, x]\n- Rotation: in Quaternion [0, 0, 0, 1]\n")
                .find("found 'x', expected a number"),
            string::npos);
  EXPECT_NE(error("- Translation: 1\n- Rotation: in Quaternion\n").find("found no Translation:"),
            string::npos);
}

void mutate(string& content, Random& random) {
  for (auto changes = 1 + random.index(4); changes > 0 && !content.empty(); --changes) {
    const std::size_t at = random.index(content.size());
    switch (random.index(6)) {
      case 0:
        content[at] = static_cast<char>(random.index(256));
        break;
      case 1:
        content[at] = static_cast<char>(content[at] ^ (1 << random.index(8)));
        break;
      case 2:
        content.erase(at, 1 + random.index(16));
        break;
      case 3:
        content.insert(at, content.substr(random.index(content.size()), 1 + random.index(16)));
        break;
      case 4:
        content.resize(at);
        break;
      default:
        content.insert(at, std::to_string(random.bits()));
    }
  }
}

TEST(Mutations, AreReadOrRefusedButNeverCrash) {
  Random random(1);
  const std::vector<string> seeds = {pcd_ascii,
                                     pcd_binary,
                                     pcd_compressed,
                                     ply_ascii,
                                     ply_binary(false),
                                     ply_binary(true),
                                     ply_with_lists(false),
                                     "x,y,z\n1,2,3\n-4,5.5,6e1\n",
                                     "o a\nv 1 2 3\nv -4 5.5 6e1\nf 1 2 1\n"};
  for (const string& seed : seeds) {
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
      string content = seed;
      mutate(content, random);
      const TempFile file(content);
      try {
        const Cloud cloud = read_cloud(file.path());
        EXPECT_EQ(cloud.width * cloud.height, cloud.points.size());
        EXPECT_LE(cloud.points.size(), content.size());
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::bad_file);
        ++refused;
      }
    }
    EXPECT_GT(refused, 1000);
  }
}

string shared_file(const string& name) { return string(EXCAVPLAN_SHARED_DATA) + "/" + name; }

TEST(RealScans, AreReadWhole) {
  if (!std::filesystem::exists(shared_file("dig-pair-livox"))) {
    GTEST_SKIP() << "no real scans in " << EXCAVPLAN_SHARED_DATA;
  }
  EXPECT_EQ(read_cloud(shared_file("dig-pair-livox/before.pcd")).points.size(), 100645u);
  EXPECT_EQ(read_cloud(shared_file("dig-pair-livox/after.pcd")).points.size(), 87900u);
  EXPECT_NO_THROW(read_frame(shared_file("dig-pair-livox/before_frame.txt")));
  EXPECT_NO_THROW(read_frame(shared_file("dig-pair-livox/after_frame.txt")));
  const CloudSummary terrain = summarise(read_cloud(shared_file("site-terrain/terrain.pcd")));
  EXPECT_EQ(terrain.finite_points, 56758u);
  EXPECT_NEAR(terrain.max.x() - terrain.min.x(), 76.0, 1.0);
  EXPECT_NEAR(terrain.max.y() - terrain.min.y(), 129.0, 1.0);
  EXPECT_NEAR(terrain.min.z(), -3.7, 0.1);
  EXPECT_NEAR(terrain.max.z(), 8.1, 0.1);
  EXPECT_NE(
      error_about([] { read_cloud(shared_file("site-terrain/rosbag2_static_terrain_0.db3")); },
                  shared_file("site-terrain/rosbag2_static_terrain_0.db3"))
          .find("ROS 2 bag"),
      string::npos);
}

// Fields in capital letters, TYPE in small ones, DATA in capital ones: one scene.
TEST(ReportedFiles, DialectsOfPcdHoldTheSameScene) {
  const string folder = shared_file("reported/cloud-dialects/");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no reported files in " << folder;
  for (const char* const scan : {"a", "b"}) {
    std::vector<CloudSummary> found;
    for (const char* const kind : {"_upper.pcd", "_lowertype.pcd", "_DATA.pcd"}) {
      found.push_back(summarise(read_cloud(folder + scan + kind)));
      EXPECT_EQ(found.back().finite_points, 16100U) << scan << kind;
      EXPECT_LT((found.back().centroid - found.front().centroid).norm(), 1e-4);
    }
  }
}

TEST(CloudFile, ViewpointOfPcdIsWhereTheSensorStood) {
  const TempFile none(pcd_ascii);
  EXPECT_FALSE(read_sensor_origin(none.path()));
  EXPECT_FALSE(read_cloud(none.path()).sensor_origin);
  const TempFile file(replaced(pcd_ascii, "0 0 0 1 0 0 0", "2.5 -1 3 1 0 0 0"));
  ASSERT_TRUE(read_sensor_origin(file.path()));
  EXPECT_EQ(*read_sensor_origin(file.path()), Eigen::Vector3d(2.5, -1.0, 3.0));
  Cloud cloud = read_cloud(file.path());
  EXPECT_EQ(cloud.sensor_origin, Eigen::Vector3d(2.5, -1.0, 3.0));

  Eigen::Matrix4d shift = Eigen::Matrix4d::Identity();
  shift(2, 3) = 1.5;
  transform(cloud, shift);
  for (const bool text : {true, false}) {
    write_cloud(file.path(), cloud, CloudFormat{"pcd", text});
    EXPECT_EQ(read_cloud(file.path()).sensor_origin, Eigen::Vector3d(2.5, -1.0, 4.5));
  }
  write_cloud(file.path(), cloud, CloudFormat{"ply"});
  EXPECT_FALSE(read_sensor_origin(file.path()));
}

}  // namespace
}  // namespace excavplan
