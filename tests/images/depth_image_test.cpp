// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/images/depth_image.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/error.hpp>
#include "base/random.hpp"

#include "support/depth_png.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using std::string;

/// Counts row by row.
struct Image {
  std::uint32_t columns = 0;
  std::vector<std::uint16_t> counts;

  std::uint16_t& at(std::size_t row, std::size_t column) { return counts[row * columns + column]; }
  string png() const { return test::png_of(columns, counts); }
};

/// With its sums right, whatever stands in it.
string png_with(const string& header, const string& packed, const string& between = "") {
  return "\x89PNG\r\n\x1a\n" + test::png_chunk("IHDR" + header) + between +
         test::png_chunk("IDAT" + packed) + test::png_chunk("IEND");
}

string header_of(std::uint32_t width, std::uint32_t height, const string& kind) {
  return test::big_endian(width) + test::big_endian(height) + kind;
}

class DepthImage : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  void write(const Image& image) const { write(image.png()); }
  void write(const string& content) const { std::ofstream(path_, std::ios::binary) << content; }
  string content() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Text of the error without the path of the file.
  string error_of(const std::function<void()>& call, ErrorKind kind = ErrorKind::bad_file) const {
    const string text = test::error_of(call, kind);
    return text.rfind(path_ + ": ", 0) == 0 ? text.substr(path_.size() + 2) : text;
  }
  string image_error() const {
    return error_of([this] { depth_image_to_cloud(path_, camera_); });
  }

  string path_ = testing::TempDir() + "excavplan_depth_" + std::to_string(::getpid()) + ".png";
  DepthIntrinsics camera_{100.0, 200.0, 1.5, 0.5};
};

Image depths() {
  return {3,
          {1000, 0, 2000,       //
           50, 20000, 20001}};  // too near, just far enough, too far
}

TEST_F(DepthImage, PixelsBecomePointsOfTheCameraFrame) {
  write(depths());
  const Cloud cloud = depth_image_to_cloud(path_, camera_);
  EXPECT_EQ(cloud.width, 3u);
  EXPECT_EQ(cloud.height, 2u);
  ASSERT_EQ(cloud.points.size(), 6u);
  EXPECT_LT((cloud.points[0] - Eigen::Vector3d(-0.015, -0.0025, 1.0)).norm(), 1e-12);
  EXPECT_LT((cloud.points[2] - Eigen::Vector3d(0.01, -0.005, 2.0)).norm(), 1e-12);
  EXPECT_LT((cloud.points[4] - Eigen::Vector3d(-0.1, 0.05, 20.0)).norm(), 1e-12);
  for (const std::size_t i : {1u, 3u, 5u}) EXPECT_TRUE(cloud.points[i].array().isNaN().all());
}

TEST_F(DepthImage, DepthUnitScalesTheCounts) {
  write(depths());
  camera_.depth_unit = 0.0001;
  camera_.min_depth = 0.0;
  EXPECT_NEAR(depth_image_to_cloud(path_, camera_).points[1 * 3].z(), 0.005, 1e-12);
}

/// Frames of one view, written beside each other.
class DepthFrames : public DepthImage {
 protected:
  void TearDown() override {
    for (const string& path : paths_) std::filesystem::remove(path);
  }
  void add(const Image& image) {
    paths_.push_back(path_ + std::to_string(paths_.size()) + ".png");
    std::ofstream(paths_.back(), std::ios::binary) << image.png();
  }
  Image frame(int depth, double noise, Random& random) const {
    Image image{16, std::vector<std::uint16_t>(16 * 12)};
    for (std::uint16_t& count : image.counts) {
      count = static_cast<std::uint16_t>(std::lround(depth + noise * random.normal()));
    }
    return image;
  }
  double rms_error(const Cloud& cloud, double depth) const {
    double sum = 0.0;
    for (const Eigen::Vector3d& p : cloud.points) sum += std::pow(p.z() - depth, 2);
    return std::sqrt(sum / static_cast<double>(cloud.points.size()));
  }

  std::vector<string> paths_;
};

TEST_F(DepthFrames, AverageOfOneIsTheImage) {
  Random random(1);
  add(frame(2000, 20.0, random));
  const AveragedDepth average = average_depth_images(paths_, camera_);
  EXPECT_EQ(average.cloud.points, depth_image_to_cloud(paths_[0], camera_).points);
  EXPECT_EQ(average.frames, std::vector<int>(16 * 12, 1));
}

TEST_F(DepthFrames, NoiseFallsWithTheSquareRootOfTheFrames) {
  Random random(2);
  for (int i = 0; i < 25; ++i) add(frame(2000, 20.0, random));
  const AveragedDepth average = average_depth_images(paths_, camera_);
  EXPECT_NEAR(rms_error(average.cloud, 2.0), 0.020 / 5.0, 0.0007);
}

TEST_F(DepthFrames, StrayDepthsAreLeftOutAndMostlyUnseenPixelsUnknown) {
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    Image image = frame(2000, 2.0, random);
    if (i < 3) image.at(0, 0) = 9000;  // a bird
    if (i < 5) image.at(0, 1) = 0;
    if (i < 6) image.at(0, 2) = 0;
    add(image);
  }
  const AveragedDepth average = average_depth_images(paths_, camera_);
  EXPECT_NEAR(average.cloud.points[0].z(), 2.0, 0.004);
  EXPECT_LE(average.frames[0], 7);
  EXPECT_NEAR(average.cloud.points[1].z(), 2.0, 0.004);
  EXPECT_LE(average.frames[1], 5);
  EXPECT_TRUE(average.cloud.points[2].array().isNaN().all());
  EXPECT_EQ(average.frames[2], 0);
}

TEST_F(DepthFrames, FramesOfDifferentSizeAreRefused) {
  Random random(4);
  add(frame(2000, 1.0, random));
  add(depths());
  EXPECT_EQ(test::error_about([&] { average_depth_images(paths_, camera_); }, paths_[1]),
            "found 3 x 2 pixels, expected 16 x 12 as in " + paths_[0]);
  EXPECT_EQ(error_of([&] { average_depth_images({}, camera_); }, ErrorKind::bad_input),
            "depth images: 0 frames, must be 1 to 10000");
}

TEST_F(DepthFrames, PointAtAPixelIsTheMedianOfItsNeighboursOnItsRay) {
  Random random(5);
  Image image = frame(2000, 0.0, random);
  image.at(5, 7) = 500;
  add(image);
  const Cloud cloud = depth_image_to_cloud(paths_[0], camera_);
  const Eigen::Vector3d p = point_at_pixel(cloud, camera_, 7.25, 5.0);
  EXPECT_LT((p - Eigen::Vector3d((7.25 - 1.5) / 100 * 2, 4.5 / 200 * 2, 2.0)).norm(), 1e-12);
  const auto error = [&](double u, double v) {
    return error_of([&] { point_at_pixel(cloud, camera_, u, v); }, ErrorKind::bad_input);
  };
  EXPECT_EQ(error(16.0, 3.0), "pixel (16, 3) is outside the image of 16 x 12");
  camera_.max_depth = 1.0;
  const Cloud nearly_empty = depth_image_to_cloud(paths_[0], camera_);
  EXPECT_EQ(
      error_of([&] { point_at_pixel(nearly_empty, camera_, 7.0, 5.0); }, ErrorKind::bad_input),
      "pixel (7, 5) has 1 pixels with a depth within 2 of it, must be 3 or more");
}

TEST_F(DepthImage, OtherFilesAreRefused) {
  EXPECT_EQ(image_error(), "cannot be opened: No such file or directory");
  write(png_with(header_of(3, 2, {8, 0, 0, 0, 0}), test::zlib_stored(string(2 * 4, '\0'))));
  EXPECT_EQ(image_error(),
            "found 8 bits of colour type 0, expected a 16-bit single-channel PNG image");
  write(png_with(header_of(3, 2, {16, 2, 0, 0, 0}), test::zlib_stored(string(2 * 19, '\0'))));
  EXPECT_EQ(image_error(),
            "found 16 bits of colour type 2, expected a 16-bit single-channel PNG image");
  write(string("VERSION 0.7\nFIELDS x y z\n"));
  EXPECT_EQ(image_error(),
            "found something that is not a PNG image, expected a 16-bit single-channel PNG image");
  write(string());
  EXPECT_NE(image_error().find("not a PNG image"), string::npos);
}

TEST_F(DepthImage, DamagedFilesAreRefused) {
  Image image{64, std::vector<std::uint16_t>(64 * 64)};
  Random random(6);
  for (std::uint16_t& count : image.counts) count = static_cast<std::uint16_t>(random.index(65536));
  write(image);
  const string whole = content();
  for (const std::size_t size : {whole.size() / 2, whole.size() / 8, std::size_t{20}}) {
    write(whole.substr(0, size));
    EXPECT_NE(image_error().find("the end of the file at byte " + std::to_string(size)),
              string::npos)
        << size;
  }
  string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(~flipped[whole.size() / 2]);
  write(flipped);
  EXPECT_NE(image_error().find("found damage before byte"), string::npos);
  string huge = whole;
  huge[16] = huge[20] = '\x7f';
  write(huge);
  EXPECT_NE(image_error().find("found damage before byte 33 (IHDR: CRC error)"), string::npos);
}

/// Packed data of a whole image.
string packed_of(const string& png) {
  const auto at = png.find("IDAT");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(png[at - 4 + i]));
  };
  return png.substr(at + 4, byte(0) << 24U | byte(1) << 16U | byte(2) << 8U | byte(3));
}

class DepthPng : public DepthImage {
 protected:
  /// What is said of a file, here and on the console.
  string said(const string& content) {
    write(content);
    testing::internal::CaptureStderr();
    const string error = image_error();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    const string expected = ", expected a 16-bit single-channel PNG image";
    const auto at = error.rfind(expected);
    return at == string::npos ? error : error.substr(0, at);
  }

  /// libpng's words about it; empty if it is not damaged.
  string damage(const string& content) {
    const string error = said(content);
    const auto at = error.find(" (");
    if (error.rfind("found damage before byte ", 0) != 0 || at == string::npos) return "";
    return error.substr(at + 2, error.size() - at - 3);
  }

  const string kind_ = {16, 0, 0, 0, 0};
  const string whole_ = test::png_of(3, {1, 2, 3, 4, 5, 6});
};

TEST_F(DepthPng, WhatIsWrongWithRightSumsIsRefusedInSilence) {
  const string packed = packed_of(whole_);
  const string header = header_of(3, 2, kind_);
  EXPECT_EQ(said(png_with(header, packed)), "no error");
  for (std::size_t i = 0; i < packed.size(); ++i) {
    string flipped = packed;
    flipped[i] = static_cast<char>(flipped[i] ^ 1);
    EXPECT_NE(damage(png_with(header, flipped)), "") << i;
    EXPECT_NE(damage(png_with(header, packed.substr(0, i))), "") << i;
  }
  EXPECT_EQ(damage(png_with(header, packed + "x")), "IDAT: Extra compressed data");
  EXPECT_EQ(damage(png_with(header_of(3, 3, kind_), packed)), "Not enough image data");
  EXPECT_EQ(damage(png_with(header_of(2, 2, kind_), packed)), "IDAT: Too much image data");
  EXPECT_EQ(damage(png_with(header_of(3, 0, kind_), packed)), "Invalid IHDR data");
  EXPECT_EQ(damage(png_with(header_of(3, 2, {16, 0, 1, 0, 0}), packed)), "Invalid IHDR data");
  EXPECT_EQ(damage(png_with(header_of(3, 2, {16, 0, 0, 0, 2}), packed)), "Invalid IHDR data");
  const string palette = test::png_chunk("PLTE" + string(6, 'x'));
  EXPECT_EQ(damage(png_with(header, packed, palette)), "PLTE: ignored in grayscale PNG");
}

/// A zlib stream of two rows of 258 black pixels, 1034 zeros: 776 of them in a stored block, the
/// rest by a reference 600 bytes back in a block of fixed codes (RFC 1951, 3.2.6).
string black_rows(const string& zlib_header) {
  const string bits =
      "110"
      "11000101"
      "10010"
      "11101010"
      "0000000"
      "0";
  string packed = zlib_header + string("\x00\x08\x03\xf7\xfc", 5) + string(776, '\0');
  for (std::size_t i = 0; i < bits.size(); i += 8) {
    unsigned byte = 0;
    for (std::size_t k = 0; k < 8; ++k) byte |= (bits[i + k] == '1' ? 1U : 0U) << k;
    packed += static_cast<char>(byte);
  }
  return packed + test::big_endian(1034U << 16U | 1U);
}

TEST_F(DepthPng, AStreamKeepsToTheWindowThatItStates) {
  const string header = header_of(258, 2, kind_);
  EXPECT_EQ(said(png_with(header, black_rows("\x78\x01"))), "no error") << "32 KiB";
  EXPECT_EQ(damage(png_with(header, black_rows("\x08\x1d"))), "IDAT: invalid distance too far back")
      << "256 bytes";
}

TEST_F(DepthPng, AnEndWithDataIsRefused) {
  const string png = whole_.substr(0, whole_.size() - 12);
  EXPECT_EQ(said(png + test::png_chunk("IEND")), "no error");
  EXPECT_EQ(damage(png + test::png_chunk("IENDx")), "IEND: invalid");
}

TEST_F(DepthPng, ChunksThatAreNotNeededDoNotMatter) {
  const string odd = test::png_chunk("gAMAxx") + test::png_chunk("iCCPz\x01") +
                     test::png_chunk("tRNS") + test::png_chunk("sBITtoo many");
  EXPECT_EQ(said(png_with(header_of(3, 2, kind_), packed_of(whole_), odd)), "no error");
  EXPECT_EQ(depth_image_to_cloud(path_, DepthIntrinsics{1.0, 1.0, 0.0, 0.0, 1.0}).points[4].z(),
            5.0);
}

TEST_F(DepthPng, InterlacedImagesAreRead) {
  // 3 x 2 in the passes of Adam7: (0, 0); (2, 0); (1, 0); row 1.
  const string rows = {0, 0, 1, 0, 0, 3, 0, 0, 2, 0, 0, 4, 0, 5, 0, 6};
  EXPECT_EQ(said(png_with(header_of(3, 2, {16, 0, 0, 0, 1}), test::zlib_stored(rows))), "no error");
  const auto points = depth_image_to_cloud(path_, {1.0, 1.0, 0.0, 0.0, 1.0}).points;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(points[i].z(), static_cast<double>(i + 1));
}

TEST_F(DepthPng, PixelsBeyondTheCeilingAreRefusedBeforeTheyAreUnpacked) {
  const string limit = " pixels, expected at most 65535 a side and 16777216 in all";
  EXPECT_EQ(said(png_with(header_of(4097, 4096, kind_), "")), "found 4097 x 4096" + limit);
  EXPECT_EQ(said(png_with(header_of(65536, 1, kind_), "")), "found 65536 x 1" + limit);
  EXPECT_EQ(damage(png_with(header_of(4096, 4096, kind_), "")), "Not enough image data");
  write(whole_);
  const std::vector<string> many(10000, path_);
  EXPECT_NO_THROW(average_depth_images({path_, path_}, camera_));
  write(Image{201, std::vector<std::uint16_t>(250 * 201)});
  EXPECT_EQ(error_of([&] { average_depth_images(many, camera_); }, ErrorKind::bad_input),
            "depth images: 10000 frames of 50250 pixels, must be at most 500000000 in all");
}

TEST_F(DepthImage, IntrinsicsOutOfRangeAreRefused) {
  write(depths());
  const auto error = [&](double DepthIntrinsics::*member, double value) {
    DepthIntrinsics camera = camera_;
    camera.*member = value;
    return error_of([&] { depth_image_to_cloud(path_, camera); }, ErrorKind::bad_input);
  };
  EXPECT_EQ(error(&DepthIntrinsics::fx, 0.0), "depth image: fx is 0, must be > 0");
  EXPECT_EQ(error(&DepthIntrinsics::fy, -1.0), "depth image: fy is -1, must be > 0");
  EXPECT_EQ(error(&DepthIntrinsics::cx, NAN), "depth image: cx is nan, must be finite");
  EXPECT_EQ(error(&DepthIntrinsics::cy, INFINITY), "depth image: cy is inf, must be finite");
  EXPECT_EQ(error(&DepthIntrinsics::depth_unit, 0.0), "depth image: depth_unit is 0, must be > 0");
  EXPECT_EQ(error(&DepthIntrinsics::min_depth, -0.1),
            "depth image: min_depth is -0.1, must be >= 0");
  EXPECT_EQ(error(&DepthIntrinsics::max_depth, 0.1),
            "depth image: max_depth is 0.1, must be > min_depth");
}

TEST_F(DepthImage, IntrinsicsAreReadFromJson) {
  const string head = R"({"format": "excavplan-depth-intrinsics", "version": 1, )";
  write(head + R"("fx": 615.5, "fy": 616, "cx": 320, "cy": 240.5})");
  DepthIntrinsics camera = load_intrinsics(path_);
  EXPECT_EQ(camera.fx, 615.5);
  EXPECT_EQ(camera.fy, 616.0);
  EXPECT_EQ(camera.cx, 320.0);
  EXPECT_EQ(camera.cy, 240.5);
  EXPECT_EQ(camera.depth_unit, 0.001);
  write(head + R"("fx": 1, "fy": 1, "cx": 0, "cy": 0, "depth_unit_m": 0.0001, "min_depth_m": 0.3,
                  "max_depth_m": 6})");
  camera = load_intrinsics(path_);
  EXPECT_EQ(camera.depth_unit, 0.0001);
  EXPECT_EQ(camera.min_depth, 0.3);
  EXPECT_EQ(camera.max_depth, 6.0);
  const auto error = [&] { return error_of([this] { load_intrinsics(path_); }); };
  write(head + R"("fx": 0, "fy": 1, "cx": 0, "cy": 0})");
  EXPECT_NE(error().find("fx: is 0, must be in"), string::npos);
  write(head + R"("fx": 1, "fy": 1, "cx": 0})");
  EXPECT_EQ(error(), "cy: is missing");
  write(head + R"("fx": 1, "fy": 1, "cx": 0, "cy": 0, "ppx": 3})");
  EXPECT_EQ(error(), "ppx: is not a key of this file");
  write(head + R"("fx": 1, "fy": 1, "cx": 0, "cy": 0, "max_depth_m": 0.1})");
  EXPECT_NE(error().find("max_depth_m: is 0.1, must be in"), string::npos);
}

TEST_F(DepthImage, IntrinsicsAreReadAsOthersWriteThem) {
  const std::vector<string> contents = {
      // write_pinhole_camera_intrinsic of Open3D: column by column
      R"({"height": 480, "intrinsic_matrix": [615.5, 0.0, 0.0, 0.0, 616.0, 0.0, 320.0, 240.5, 1.0],
          "width": 640})",
      R"({"class_name": "PinholeCameraParameters", "extrinsic": [1.0], "intrinsic": {"height": 480,
          "intrinsic_matrix": [615.5, 0, 0, 0, 616, 0, 320, 240.5, 1], "width": 640}})",
      // rs2_intrinsics of RealSense
      R"({"width": 640, "height": 480, "fx": 615.5, "fy": 616.0, "ppx": 320.0, "ppy": 240.5,
          "model": "distortion.brown_conrady", "coeffs": [0.0, 0.0, 0.0, 0.0, 0.0]})",
      "fx: 615.5\nfy: 616\ncx: 320\ncy: 240.5\nwidth: 640\nheight: 480\n",
      // camera_calibration of ROS
      "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n"
      "  cols: 3\n  data: [ 615.5,   0.   , 320.   ,\n            0.   , 616.   , 240.5  ,\n"
      "            0.   ,   0.   ,   1.   ]\ndistortion_model: plumb_bob\n"
      "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0.000, 0, 0, 0]\n",
      "%YAML:1.0\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n  rows: 3\n"
      "  cols: 3\n  dt: d\n  data: [615.5, 0, 320, 0, 616, 240.5, 0, 0, 1]\n",
      // ros2 topic echo, rostopic echo
      "header:\n  stamp:\n    sec: 1718500617\n    nanosec: 444867328\n  frame_id: optical\n"
      "height: 480\nwidth: 640\ndistortion_model: plumb_bob\nd:\n- 0.0\n- 0.0\nk:\n- 615.5\n- 0.0\n"
      "- 320.0\n- 0.0\n- 616.0\n- 240.5\n- 0.0\n- 0.0\n- 1.0\nbinning_x: 0\nbinning_y: 0\nroi:\n"
      "  x_offset: 0\n  y_offset: 0\n  do_rectify: false\n---\n",
      "header: \n  seq: 2468773\n  stamp: \n    secs: 1416402182\nheight: 480\nwidth: 640\n"
      "D: [0.0, 0.0, 0.0,\n0.0, 0.0]\nK: [615.5, 0.0, 320.0, 0.0, 616.0,\n240.5, 0.0, 0.0, 1.0]\n"
      "binning_x: 1\nroi: \n  x_offset: 0\n"};
  for (const string& content : contents) {
    SCOPED_TRACE(content);
    write(content);
    const DepthIntrinsics camera = load_intrinsics(path_);
    EXPECT_EQ(camera.fx, 615.5);
    EXPECT_EQ(camera.fy, 616.0);
    EXPECT_EQ(camera.cx, 320.0);
    EXPECT_EQ(camera.cy, 240.5);
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.height, 480);
    EXPECT_EQ(camera.depth_unit, 0.001);
  }
  const string flat = R"({"fx": 1, "fy": 1, "cx": 0, "cy": 0, "depth_scale": )";
  write(flat + "0.00025}");  // pyrealsense2: metres per count
  EXPECT_EQ(load_intrinsics(path_).depth_unit, 0.00025);
  write(flat + "4000}");  // Open3D: counts per metre
  EXPECT_EQ(load_intrinsics(path_).depth_unit, 0.00025);
  EXPECT_EQ(load_intrinsics(path_).width, 0);
}

TEST_F(DepthImage, IntrinsicsThatAreNoPinholeAreRefused) {
  const auto error = [&](const string& content) {
    write(content);
    return error_of([this] { load_intrinsics(path_); });
  };
  const string zeros = ", must be zeros: rectify the depth images";
  const string flat = R"({"fx": 1, "fy": 1, "ppx": 0, "ppy": 0, )";
  EXPECT_NE(error(flat + R"("coeffs": [0, 0.12, 0]})").find("coeffs: holds 0.12" + zeros),
            string::npos);
  const string k = "k: [600, 0, 320, 0, 600, 240, 0, 0, 1]\n";
  EXPECT_NE(error(k + "d: [0, 0, nan]\n").find("d: holds nan" + zeros), string::npos);
  EXPECT_EQ(error(k + "binning_y: 2\n"),
            "binning_y: is above 1: give the intrinsics of the binned image");
  EXPECT_EQ(error(k + "roi: {x_offset: 0, y_offset: 200}\n"),
            "roi.y_offset: is not 0: give the intrinsics of the part of the image");
  const string matrix = "must be the matrix fx 0 cx, 0 fy cy, 0 0 1, with fx and fy above 0";
  EXPECT_EQ(error("K: [0, 0, 0, 0, 0, 0, 0, 0, 0]"), "K: " + matrix);
  EXPECT_EQ(error("k: [600, 1, 320, 0, 600, 240, 0, 0, 1]"), "k: " + matrix);
  EXPECT_EQ(error("k: [600, 0, nan, 0, 600, 240, 0, 0, 1]"), "k: " + matrix);
  EXPECT_EQ(error("k: [600, 0, 320]"), "k: expected a list of 9 numbers, got [600.0,0.0,320.0]");
  EXPECT_EQ(error(R"({"intrinsic_matrix": [600, 0, 320, 0, 600, 240, 0, 0, 1]})"),
            "intrinsic_matrix (column by column): " + matrix);
  EXPECT_EQ(error("camera_matrix: {rows: 3}"), "camera_matrix.data: is missing");
  EXPECT_NE(error("camera_matrix: {data: [600, 0, 320, 0, 600, 240, 0, 0, 1]}\n"
                  "distortion_coefficients: {data: [0, -0.3]}\n")
                .find("distortion_coefficients.data: holds -0.3" + zeros),
            string::npos);
  EXPECT_EQ(error(R"({"focal": 600})").substr(0, 39), "found none of the keys format, intrinsi");
  EXPECT_EQ(error(R"({"format": "other"})"),
            "format: is 'other', expected 'excavplan-depth-intrinsics'");
  EXPECT_EQ(error("[1, 2]"), "expected keys with values, as JSON or YAML");
  EXPECT_EQ(error(R"({"fx": 1, "fy": -1, "cx": 0, "cy": 0})").substr(0, 9), "fy: is -1");
}

/// The program depth-to-cloud on what a camera 2.2 m above level ground sees, 30 deg from straight
/// down.
class DepthTool : public testing::Test {
 protected:
  static constexpr double height = 2.2;
  static constexpr double tilt = 0.5236;
  static constexpr int columns = 80;
  static constexpr int rows = 60;
  static constexpr double focal = 60.0;

  void SetUp() override {
    if (!std::filesystem::exists(string(EXCAVPLAN_BIN) + "/depth-to-cloud")) {
      GTEST_SKIP() << "built without EXCAVPLAN_TOOLS";
    }
    std::filesystem::create_directory(folder_.file("frames"));
    Random random(1);
    for (int i = 0; i < 9; ++i) {
      Image image{columns, {}};
      for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < columns; ++u) {
          const double z = depth(v) * (1.0 + 0.004 * depth(v) * random.normal());
          image.counts.push_back(static_cast<std::uint16_t>(std::lround(1000.0 * z)));
        }
      }
      folder_.write("frames/" + std::to_string(i) + ".png", image.png());
    }
    folder_.write("camera.json",
                  R"({"format": "excavplan-depth-intrinsics", "version": 1,
                      "fx": 60, "fy": 60, "cx": 40, "cy": 30})");
  }

  static double depth(int v) {
    return height / (std::cos(tilt) + std::sin(tilt) * (v - 30) / focal);
  }
  /// Where a pixel is in a site with the camera above (4, 1), facing along x.
  static Eigen::Vector3d place(int u, int v) {
    const double z = depth(v);
    const double down = (v - 30) / focal * z;
    return {4.0 - std::cos(tilt) * down + std::sin(tilt) * z, 1.0 - (u - 40) / focal * z,
            height - std::sin(tilt) * down - std::cos(tilt) * z};
  }

  test::ProgramResult run(std::vector<string> more) const {
    std::vector<string> words = {folder_.file("frames/0.png"), "--intrinsics",
                                 folder_.file("camera.json"), "--out", folder_.file("cloud.pcd")};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_program("depth-to-cloud", words);
  }
  nlohmann::json answer(std::vector<string> more) const {
    more.emplace_back("--json");
    const test::ProgramResult result = run(std::move(more));
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }

  test::TemporaryFolder folder_;
};

TEST_F(DepthTool, AveragesAFolderAndLevelsIt) {
  const auto result = answer(
      {"--average", folder_.file("frames"), "--level", "--pose-out", folder_.file("pose.txt")});
  EXPECT_EQ(result.at("frames"), 9);  // IMAGE is one of them and counts once
  EXPECT_EQ(result.at("frame"), "site");
  EXPECT_EQ(result.at("pose").at("method"), "level");
  EXPECT_NEAR(result.at("pose").at("height_m").get<double>(), height, 0.003);
  EXPECT_NEAR(result.at("pose").at("tilt_rad").get<double>(), tilt, 0.003);
  EXPECT_GT(result.at("pose").at("ground_share").get<double>(), 0.9);
  const Cloud level = read_cloud(folder_.file("cloud.pcd"));
  double squares = 0.0;
  for (const Eigen::Vector3d& p : level.points) squares += p.z() * p.z();
  const double averaged = std::sqrt(squares / static_cast<double>(level.points.size()));
  EXPECT_LT(averaged, 0.010);
  // The pose that was found serves the next scan.
  const auto next = answer({"--pose", folder_.file("pose.txt")});
  EXPECT_EQ(next.at("pose").at("method"), "given");
  EXPECT_EQ(next.at("frames"), 1);
  squares = 0.0;
  for (const Eigen::Vector3d& p : read_cloud(folder_.file("cloud.pcd")).points) {
    squares += p.z() * p.z();
  }
  EXPECT_GT(std::sqrt(squares / static_cast<double>(level.points.size())), 2.0 * averaged);
}

TEST_F(DepthTool, FindsItsPoseFromKnownPoints) {
  string table = "u_px,v_px,x_m,y_m,z_m\n";
  for (const auto& [u, v] : {std::pair(10, 10), {70, 12}, {40, 50}, {60, 40}}) {
    const Eigen::Vector3d p = place(u, v);
    table += std::to_string(u) + "," + std::to_string(v) + "," + std::to_string(p.x()) + "," +
             std::to_string(p.y()) + "," + std::to_string(p.z()) + "\n";
  }
  const auto result =
      answer({"--average", folder_.file("frames/1.png") + "," + folder_.file("frames/2.png"),
              "--points", folder_.write("points.csv", table)});
  EXPECT_EQ(result.at("frames"), 3);
  EXPECT_EQ(result.at("pose").at("method"), "points");
  EXPECT_EQ(result.at("pose").at("residuals_m").size(), 4u);
  EXPECT_LT(result.at("pose").at("residual_rms_m").get<double>(), 0.02);
  const Cloud cloud = read_cloud(folder_.file("cloud.pcd"));
  double squares = 0.0;
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      squares +=
          (cloud.points[static_cast<std::size_t>(v * columns + u)] - place(u, v)).squaredNorm();
    }
  }
  EXPECT_LT(std::sqrt(squares / (rows * columns)), 0.03);
}

TEST_F(DepthTool, PosesExcludeEachOther) {
  const auto refused = [&](std::vector<string> more, const string& text) {
    const test::ProgramResult result = run(std::move(more));
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find(text), string::npos) << result.err;
  };
  refused({"--level", "--points", "p.csv"}, "--level excludes --points");
  refused({"--pose-out", "p.txt"}, "--pose-out needs --level or --points");
  refused({"--pose", "1,2,3,0,0,0,2"}, "--pose: pose of a scan: the quaternion's norm is 2");
}

TEST_F(DepthTool, TakesAPoseOfSevenNumbers) {
  // Above (4, 1) and straight down: x of the camera to -y of the site, y to -x.
  const auto result = answer({"--pose", "4,1,2.2,0.7071067811865476,-0.7071067811865476,0,0"});
  EXPECT_EQ(result.at("pose").at("method"), "given");
  const Cloud cloud = read_cloud(folder_.file("cloud.pcd"));
  const Eigen::Vector3d middle = cloud.points[30 * columns + 40];
  EXPECT_NEAR((middle - Eigen::Vector3d(4.0, 1.0, 2.2 - depth(30))).norm(), 0.0, 0.1);
}

TEST_F(DepthTool, ImagesOfAnotherSizeThanTheIntrinsicsAreRefused) {
  folder_.write("camera.json", R"({"width": 640, "height": 480, "fx": 60, "fy": 60, "ppx": 40,
                                   "ppy": 30})");
  const test::ProgramResult result = run({});
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("found 80 x 60 pixels, expected 640 x 480 as in the intrinsics"),
            string::npos)
      << result.err;
}

}  // namespace
}  // namespace excavplan
