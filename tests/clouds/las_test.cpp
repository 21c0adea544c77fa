// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/types.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>
#include <excavplan/clouds/cloud.hpp>
#include "base/random.hpp"

#include <excavplan/scans/scan_surface.hpp>

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/las_file.hpp"

namespace excavplan {
namespace {

using test::error_about;
using test::LasFile;

class TempLas {
 public:
  explicit TempLas(const std::string& content)
      : path_(testing::TempDir() + "excavplan_las_" + std::to_string(::getpid()) + ".las") {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TempLas() { std::filesystem::remove(path_); }
  TempLas(const TempLas&) = delete;
  TempLas& operator=(const TempLas&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Cloud read_bytes(const std::string& bytes) { return read_cloud(TempLas(bytes).path()); }

void expect_two_points(const LasFile& file) {
  const Cloud cloud = read_bytes(file.bytes());
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.width, 2u);
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3d(-4.0, 5.5, 60.0));
}

TEST(ReadLas, EveryVersionAndPointFormat) {
  constexpr int last_format[] = {1, 1, 3, 5, 10};
  for (int minor = 0; minor <= 4; ++minor) {
    for (int format = 0; format <= last_format[minor]; ++format) {
      SCOPED_TRACE("LAS 1." + std::to_string(minor) + ", format " + std::to_string(format));
      LasFile file;
      file.minor = minor;
      file.format = format;
      expect_two_points(file);
      file.has_old_count = minor < 4;
      file.extra_bytes = 5;
      file.more_header = 3;
      file.records = {"", std::string(65535, 'r')};
      if (minor == 4) file.extended = {std::string(100000, 'e'), ""};
      expect_two_points(file);
    }
  }
}

TEST(ReadLas, KeepsTheDigitsOfMapCoordinates) {
  LasFile file;
  file.offset = {500000.0, 5800000.0, 0.0};
  file.scale = {0.0001, 0.001, 0.01};
  file.points = {{{-1234567, 654321, -7}}, {{2147483647, -2147483647 - 1, 0}}};
  const Cloud cloud = read_bytes(file.bytes());
  const double last_digit = 2e-9;  // of a double at 6e6
  EXPECT_NEAR(cloud.points[0].x(), 499876.5433, last_digit);
  EXPECT_NEAR(cloud.points[0].y(), 5800654.321, last_digit);
  EXPECT_NEAR(cloud.points[0].z(), -0.07, last_digit);
  EXPECT_NEAR(cloud.points[1].x(), 714748.3647, last_digit);
  EXPECT_NEAR(cloud.points[1].y(), 3652516.352, last_digit);
}

TEST(ReadLas, LeavesOutWhatIsWithheldOrNoise) {
  for (const int format : {0, 5, 6, 10}) {
    LasFile file;
    file.minor = 4;
    file.format = format;
    file.points = {{{1, 0, 0}, 2},       {{2, 0, 0}, 7}, {{3, 0, 0}, 18}, {{4, 0, 0}, 2, true},
                   {{5, 0, 0}, 7, true}, {{6, 0, 0}, 0}, {{7, 0, 0}, 12}};
    file.scale.setOnes();
    const Cloud cloud = read_bytes(file.bytes());
    ASSERT_EQ(cloud.points.size(), 3u) << format;
    EXPECT_EQ(cloud.width, 3u);
    EXPECT_EQ(cloud.points[0].x(), 1.0);
    EXPECT_EQ(cloud.points[1].x(), 6.0);
    EXPECT_EQ(cloud.points[2].x(), 7.0);
  }
}

TEST(ReadLas, ClassesAbove31AreNoNoise) {
  LasFile file;
  file.minor = 4;
  file.format = 6;
  file.points = {{{1, 0, 0}, 7 + 32}, {{2, 0, 0}, 18 + 64}, {{3, 0, 0}, 255}};
  EXPECT_EQ(read_bytes(file.bytes()).points.size(), 3u);
}

TEST(ReadLas, FlagsAreNotThoseOfTheOtherFormats) {
  std::string old = LasFile{}.bytes();
  old[227 + 15] = '\x02' | '\x40' | '\x20';  // synthetic, key point
  EXPECT_EQ(read_bytes(old).points.size(), 2u);
  LasFile file;
  file.minor = 4;
  file.format = 6;
  std::string bytes = file.bytes();
  bytes[375 + 15] = '\x8B';  // synthetic, key point, overlap, a bit of the other flags
  EXPECT_EQ(read_bytes(bytes).points.size(), 2u);
}

TEST(ReadLas, PointsStandAcrossTheWindow) {
  Random random(4);
  for (const std::size_t extra : {0u, 40000u}) {
    LasFile file;
    file.extra_bytes = extra;
    file.points.resize(extra == 0 ? 30000 : 200);
    for (std::size_t i = 0; i < file.points.size(); ++i) {
      file.points[i].xyz = {static_cast<std::int32_t>(i), -static_cast<std::int32_t>(i), 7};
    }
    const TempLas temp(file.bytes());
    std::size_t next = 0;
    stream_cloud(temp.path(), [&](const std::vector<Eigen::Vector3d>& points) {
      for (const Eigen::Vector3d& p : points) {
        ASSERT_EQ(
            p, 0.001 * Eigen::Vector3d(static_cast<double>(next), -static_cast<double>(next), 7.0));
        ++next;
      }
    });
    EXPECT_EQ(next, file.points.size());
  }
}

TEST(ReadLas, AFileMayBeLargerThanMemory) {
  LasFile file;
  file.minor = 4;
  file.points.clear();
  std::string head = file.bytes();
  constexpr std::uint64_t count = 5000000000;  // more than the older count holds
  LasFile::put(head, 247, count);
  const TempLas temp(head);
  ASSERT_EQ(::truncate(temp.path().c_str(), static_cast<off_t>(head.size() + 20 * count)), 0);
  struct Enough {};
  std::size_t points = 0;
  EXPECT_THROW(stream_cloud(temp.path(),
                            [&points](const std::vector<Eigen::Vector3d>& some) {
                              points += some.size();
                              if (points > 10000) throw Enough{};
                            }),
               Enough);
  EXPECT_NE(error_about([&] { read_cloud(temp.path()); }, temp.path()).find("4.000 GiB of memory"),
            std::string::npos);
}

TEST(ReadLas, AFileWithoutPointsIsACloud) {
  LasFile file;
  file.points.clear();
  EXPECT_TRUE(read_bytes(file.bytes()).points.empty());
}

TEST(ReadLas, WaveformsMayFollowThePoints) {
  LasFile file;
  file.minor = 3;
  file.format = 4;
  std::string bytes = file.bytes();
  LasFile::put<std::uint64_t>(bytes, 227, bytes.size());
  EXPECT_EQ(read_bytes(bytes + std::string(9000, 'w')).points.size(), 2u);
}

TEST(ReadLas, IsReadAndNotWritten) {
  const std::string expected =
      "LAS is read, not written; the name must end in .pcd, .ply, .xyz, .txt or .asc";
  for (const std::string name : {"a.las", "a.LAZ"}) {
    EXPECT_EQ(error_about([&] { cloud_format_of_name(name); }, name, ErrorKind::bad_input),
              expected);
  }
}

using Change = std::function<void(std::string& bytes)>;

template <typename T>
Change set(std::size_t at, T value) {
  return [at, value](std::string& bytes) { LasFile::put(bytes, at, value); };
}
Change cut(std::size_t size) {
  return [size](std::string& bytes) { bytes.resize(size); };
}
Change add(const std::string& more) {
  return [more](std::string& bytes) { bytes += more; };
}

struct BadLas {
  int minor;
  Change change;
  std::string message;
};

void expect_refused_las(const std::vector<BadLas>& corpus) {
  for (const BadLas& bad : corpus) {
    LasFile file;
    file.minor = bad.minor;
    file.records = {std::string(100, 'r')};
    std::string bytes = file.bytes();
    bad.change(bytes);
    const TempLas temp(bytes);
    const std::string error = error_about([&] { read_cloud(temp.path()); }, temp.path());
    EXPECT_NE(error.find(bad.message), std::string::npos)
        << "found:    " << error << "\nexpected: " << bad.message;
  }
}

TEST(BadLas, TheHeadDoesNotHold) {
  const std::string size = "byte 94: found a header of ";
  expect_refused_las({
      {2, cut(4), "byte 4: found the end of the file, expected a LAS header of 227 bytes"},
      {2, cut(5), "byte 5: found the end of the file"},
      {2, cut(226), "byte 226: found the end of the file"},
      {2, set<std::uint8_t>(24, 0), "byte 24: found LAS 0.2, expected 1.0 to 1.4"},
      {2, set<std::uint8_t>(24, 2), "found LAS 2.2"},
      {2, set<std::uint8_t>(25, 5), "found LAS 1.5"},
      {2, set<std::uint8_t>(25, 255), "found LAS 1.255"},
      {2, set<std::uint8_t>(25, 3), size + "227 bytes, expected 235 or more"},
      {2, set<std::uint8_t>(25, 4), size + "227 bytes, expected 375 or more"},
      {2, set<std::uint16_t>(94, 0), size + "0 bytes, expected 227 or more"},
      {2, set<std::uint16_t>(94, 226), size + "226 bytes"},
      {2, set<std::uint16_t>(94, 65535), size + "65535 bytes"},
      {4, cut(374), size + "375 bytes, expected 375 or more, and no more than the file has"},
      {4, cut(300), size + "375 bytes"},
      {4, set<std::uint16_t>(94, 374), size + "374 bytes, expected 375 or more"},
      {2, set<std::uint32_t>(96, 0), "byte 96: found points at byte 0, expected behind the header"},
      {2, set<std::uint32_t>(96, 226), "found points at byte 226"},
      {2, set<std::uint32_t>(96, 100000), "found points at byte 100000"},
      {2, set<std::uint32_t>(96, 0xFFFFFFFFU), "found points at byte 4294967295"},
      {2, cut(300), "found points at byte 381, expected behind the header of 227 bytes, within"},
  });
}

TEST(BadLas, ThePointsAreNone) {
  expect_refused_las({
      {2, set<std::uint8_t>(104, 11), "byte 104: found point format 11, expected 0 to 10"},
      {2, set<std::uint8_t>(104, 63), "found point format 63"},
      {2, set<std::uint8_t>(104, 1), "byte 105: found points of 20 bytes, expected 28 or more for"},
      {4, set<std::uint8_t>(104, 10),
       "points of 20 bytes, expected 67 or more for point format 10"},
      {2, set<std::uint16_t>(105, 0), "found points of 0 bytes, expected 20 or more"},
      {2, set<std::uint16_t>(105, 19), "found points of 19 bytes"},
      {2, set<std::uint16_t>(105, 65535),
       "byte 381: found 40 bytes of points, expected 2 of 65535"},
      {2, set<std::uint32_t>(107, 3), "found 40 bytes of points, expected 3 of 20 bytes"},
      {2, set<std::uint32_t>(107, 0xFFFFFFFFU), "expected 4294967295 of 20 bytes"},
      {2, cut(420), "byte 381: found 39 bytes of points, expected 2 of 20"},
      {2, cut(381), "found 0 bytes of points"},
      {2, set<std::uint32_t>(107, 1),
       "byte 401: found 20 bytes more, expected the end of the file"},
      {2, add("more"), "byte 421: found 4 bytes more, expected the end of the file after the last"},
      {2, add(std::string(5000, '\0')), "byte 421: found 5000 bytes more"},
      {4, set<std::uint64_t>(247, 3), "byte 247: found 3 points, expected 2, as at byte 107"},
      {4, set<std::uint64_t>(247, ~std::uint64_t{0}), "found 18446744073709551615 points"},
      {4,
       [](std::string& bytes) {
         set<std::uint32_t>(107, 0)(bytes);
         set<std::uint64_t>(247, ~std::uint64_t{0} / 10)(bytes);  // times 20 it is small again
       },
       "found 40 bytes of points, expected 1844674407370955161 of 20"},
  });
}

TEST(BadLas, ScaleAndOffsetAreNone) {
  const std::string scale = "byte 131: found a scale factor that is 0, negative or not finite";
  expect_refused_las({{2, set(131, 0.0), scale},
                      {2, set(139, -0.001), scale},
                      {2, set(147, nan), scale},
                      {2, set(147, infinity), scale},
                      {2, set(155, nan), "byte 155: found an offset that is not finite"},
                      {2, set(171, -infinity), "byte 155: found an offset that is not finite"}});
}

TEST(BadLas, RecordsDoNotFit) {
  const std::string record = "byte 227: found variable length record 1 of 1 reaching past the ";
  expect_refused_las({
      {2, set<std::uint16_t>(227 + 20, 101), record + "first point, expected its end by byte 381"},
      {2, set<std::uint16_t>(227 + 20, 65535), record},
      {2, set<std::uint32_t>(100, 2), "byte 381: found variable length record 2 of 2 reaching"},
      {2, set<std::uint32_t>(100, 0xFFFFFFFFU), "variable length record 2 of 4294967295 reaching"},
      {4, set<std::uint32_t>(243, 1),
       "byte 235: found 1 extended records from byte 0, expected them"},
      {4,
       [](std::string& bytes) {
         set<std::uint32_t>(243, 0xFFFFFFFFU)(bytes);
         set<std::uint64_t>(235, bytes.size())(bytes);
       },
       "found 4294967295 extended records from byte 569"},
      {4,
       [](std::string& bytes) {
         set<std::uint32_t>(243, 1)(bytes);
         set<std::uint64_t>(235, ~std::uint64_t{0})(bytes);
       },
       "found 1 extended records from byte 18446744073709551615"},
      {4,
       [](std::string& bytes) {
         set<std::uint32_t>(243, 1)(bytes);
         set<std::uint64_t>(235, 568)(bytes);  // within the last point
         bytes += std::string(60, '\0');
       },
       "expected them between the points, which end at byte 569, and the end of the file at 629"},
  });
}

constexpr std::int32_t highest = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min();

TEST(BadLas, CoordinatesBeyondTheIntegersNameOffsetAndScale) {
  LasFile file;
  file.points.assign(20, {{1000, lowest, 3}});
  const TempLas saturated(file.bytes());
  EXPECT_EQ(
      error_about([&] { read_cloud(saturated.path()); }, saturated.path()),
      "found 20 of 20 points at the limit of a 32-bit integer in y: its offset 0 with the "
      "scale factor 0.001 cannot hold the coordinates, which are lost; write it anew from its "
      "source with an offset near the points, e.g. pdal translate in.laz out.las "
      "--writers.las.offset_y=auto");
  file.points.resize(900, {{1000, 2000, 3000}});
  for (std::size_t i = 0; i < 20; ++i) file.points[i] = {{highest, 2, 3}};
  const TempLas in_x(file.bytes());
  EXPECT_NE(error_about([&] { read_cloud(in_x.path()); }, in_x.path()).find("20 of 900 points at"),
            std::string::npos);
  file.points.resize(2100, {{1000, 2000, 3000}});  // 0.95 %: stray points
  EXPECT_EQ(read_bytes(file.bytes()).points.size(), 2100U);
}

/// A GeoKeyDirectoryTag of these keys and values.
std::string geokeys(const std::vector<std::pair<int, int>>& keys) {
  std::string record(8 + 8 * keys.size(), '\0');
  for (std::size_t i = 0; i < keys.size(); ++i) {
    LasFile::put(record, 8 + 8 * i, static_cast<std::uint16_t>(keys[i].first));
    LasFile::put(record, 12 + 8 * i, std::uint16_t{1});
    LasFile::put(record, 14 + 8 * i, static_cast<std::uint16_t>(keys[i].second));
  }
  return record;
}

/// What is wrong with a file whose coordinate system is said by this record, read in this unit.
std::string error_of_system(const std::string& record, bool is_text, double unit = 1.0) {
  LasFile file;
  file.records = {record};
  file.record_kind = is_text ? 2112 : 34735;
  const TempLas las(file.bytes());
  Scan scan;
  scan.files = {las.path()};
  scan.unit = unit;
  return error_about([&] { outline(scan); }, las.path());
}

const std::string wgs84 =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257]],"
    "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]";

std::string projected(const std::string& unit) {
  return "PROJCS[\"a plane\"," + wgs84 + ",PROJECTION[\"Transverse_Mercator\"],UNIT[" + unit +
         ",AUTHORITY[\"EPSG\",\"9003\"]],AXIS[\"X\",EAST]]";
}

TEST(ReadLas, GeographicCoordinatesAreNamed) {
  const std::string degrees =
      "found geographic coordinates (degrees of longitude and latitude) by its coordinate system";
  for (const std::string& error :
       {error_of_system(geokeys({{1024, 2}, {2048, 4326}}), false), error_of_system(wgs84, true),
        error_of_system("GEOGCRS[\"WGS 84\",CS[ellipsoidal,2],UNIT[\"degree\",0.017]]", true)}) {
    EXPECT_EQ(error.substr(0, degrees.size()), degrees) << error;
  }
  EXPECT_NE(error_of_system(geokeys({{1024, 3}}), false).find("geocentric"), std::string::npos);
}

TEST(ReadLas, UnitsOfTheCoordinateSystemAreNamed) {
  const std::string give_feet =
      "m by its coordinate system, but they are read in units of 1 m: "
      "give `unit` ft";
  for (const std::string& error :
       {error_of_system(geokeys({{1024, 1}, {3076, 9002}}), false),
        error_of_system(geokeys({{1024, 1}, {3076, 9003}}), false),
        error_of_system(projected("\"US survey foot\",0.304800609601219"), true)}) {
    EXPECT_NE(error.find(give_feet), std::string::npos) << error;
  }
  EXPECT_EQ(error_of_system(geokeys({{3076, 9003}}), false, 0.3048), "no error");
  EXPECT_EQ(error_of_system(projected("\"metre\",1"), true), "no error");
  EXPECT_EQ(error_of_system(geokeys({{1024, 1}, {3076, 9001}, {4099, 9001}}), false), "no error");
  EXPECT_NE(error_of_system(projected("\"metre\",1"), true, 0.3048).find("give `unit` m"),
            std::string::npos);
  EXPECT_NE(error_of_system("COMPD_CS[\"two\"," + projected("\"metre\",1") +
                                ",VERT_CS[\"up\",VERT_DATUM[\"d\",2005],UNIT[\"foot\",0.3048]]]",
                            true)
                .find("found z in units of 0.3048 m and x, y in units of 1 m"),
            std::string::npos);
  EXPECT_NE(error_of_system(geokeys({{3076, 9001}, {4099, 9003}}), false).find("found z in units"),
            std::string::npos);
}

TEST(ReadLas, ARecordThatSaysNothingIsNoUnit) {
  for (const std::string text :
       {"", "PROJCS[", "PROJCS[\"a\",UNIT[\"m\"", "PROJCS[\"a\",UNIT[\"m\",]]",
        "UNIT[\"foot\",0.3]", "PROJCS[\"a\",UNIT[\"m\",-1]]", "PROJCS[\"a\",UNIT[\"m\",nan]]"}) {
    EXPECT_EQ(error_of_system(text, true), "no error") << text;
    EXPECT_EQ(error_of_system(text, false), "no error") << text;
  }
}

TEST(BadLas, ReportedSaturationIsNamed) {
  const std::string path = std::string(EXCAVPLAN_SHARED_DATA) + "/reported/las-saturated/a.las";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  EXPECT_NE(error_about([&] { read_cloud(path); }, path)
                .find("found 44969 of 44969 points at the limit of a 32-bit integer in y"),
            std::string::npos);
}

TEST(BadLas, CompressedPointsNameThePrograms) {
  const std::string convert =
      "expected uncompressed LAS: convert it by pdal translate in.laz out.las, or laszip -i";
  expect_refused_las({
      {2, set<std::uint8_t>(104, 128), "byte 104: found points compressed as LAZ, " + convert},
      {4, set<std::uint8_t>(104, 128 + 6), "found points compressed as LAZ, " + convert},
      {2, set<std::uint8_t>(104, 64), "found points compressed as LAZ, " + convert},
  });
  LasFile file;
  file.record_user = "laszip encoded";
  file.records = {std::string(34, '\0')};
  const TempLas temp(file.bytes());
  EXPECT_NE(error_about([&] { read_cloud(temp.path()); }, temp.path())
                .find("byte 227: found a record of LASzip, " + convert),
            std::string::npos);
}

TEST(BadLas, MutationsAreReadOrRefusedButNeverCrash) {
  Random random(2);
  for (const int minor : {2, 3, 4}) {
    LasFile file;
    file.minor = minor;
    file.format = minor == 4 ? 6 : 1;
    file.records = {"abc", std::string(40, 'x')};
    if (minor == 4) file.extended = {"tail"};
    const std::string seed = file.bytes();
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
      std::string bytes = seed;
      for (auto changes = 1 + random.index(3); changes > 0; --changes) {
        const std::size_t head = random.index(3) == 0 ? bytes.size() : 260;
        bytes[random.index(std::min(head, bytes.size()))] = static_cast<char>(random.index(256));
        if (random.index(10) == 0) bytes.resize(1 + random.index(bytes.size()));
      }
      const TempLas temp(bytes);
      try {
        const Cloud cloud = read_cloud(temp.path());
        EXPECT_LE(cloud.points.size() * 20, bytes.size());
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::bad_file);
        ++refused;
      }
    }
    EXPECT_GT(refused, 500);
  }
}

}  // namespace
}  // namespace excavplan
