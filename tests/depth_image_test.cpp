// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/depth_image.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using std::string;

class DepthImage : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  void write(const cv::Mat& image) const { cv::imwrite(path_, image); }
  void write(const string& content) const { std::ofstream(path_, std::ios::binary) << content; }
  string content() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Text of the error without the path of the file.
  string error_of(const std::function<void()>& call, ErrorKind kind = ErrorKind::bad_file) const {
    try {
      call();
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), kind);
      const string text = e.what();
      return text.rfind(path_ + ": ", 0) == 0 ? text.substr(path_.size() + 2) : text;
    }
    return "no error";
  }
  string image_error() const {
    return error_of([this] { depth_image_to_cloud(path_, camera_); });
  }

  string path_ = testing::TempDir() + "excavplan_depth_" + std::to_string(::getpid()) + ".png";
  DepthIntrinsics camera_{100.0, 200.0, 1.5, 0.5};
};

cv::Mat depths() {
  cv::Mat image(2, 3, CV_16UC1, cv::Scalar(0));
  image.at<std::uint16_t>(0, 0) = 1000;
  image.at<std::uint16_t>(0, 2) = 2000;
  image.at<std::uint16_t>(1, 0) = 50;     // too near
  image.at<std::uint16_t>(1, 1) = 20000;  // just far enough
  image.at<std::uint16_t>(1, 2) = 20001;  // too far
  return image;
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

TEST_F(DepthImage, OtherFilesAreRefused) {
  EXPECT_EQ(image_error(), "no such file, or not readable");
  write(cv::Mat(2, 3, CV_8UC1, cv::Scalar(7)));
  EXPECT_EQ(image_error(),
            "found 8 bits of colour type 0, expected a 16-bit single-channel PNG image");
  write(cv::Mat(2, 3, CV_16UC3, cv::Scalar(7)));
  EXPECT_EQ(image_error(),
            "found 16 bits of colour type 2, expected a 16-bit single-channel PNG image");
  write(string("VERSION 0.7\nFIELDS x y z\n"));
  EXPECT_EQ(image_error(),
            "found something that is not a PNG image, expected a 16-bit single-channel PNG image");
  write(string());
  EXPECT_NE(image_error().find("not a PNG image"), string::npos);
}

TEST_F(DepthImage, DamagedFilesAreRefused) {
  cv::Mat image(64, 64, CV_16UC1);
  cv::randu(image, 0, 65535);
  write(image);
  const string whole = content();
  for (const std::size_t size : {whole.size() / 2, whole.size() / 8, std::size_t{20}}) {
    write(whole.substr(0, size));
    EXPECT_NE(image_error().find(size < 33 ? "not a PNG" : "the end of the file at byte"),
              string::npos)
        << size;
  }
  string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(~flipped[whole.size() / 2]);
  write(flipped);
  EXPECT_NE(image_error().find("found damage behind byte"), string::npos);
  string huge = whole;
  huge[16] = huge[20] = '\x7f';
  write(huge);
  EXPECT_NE(image_error().find("pixels, expected"), string::npos);
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

}  // namespace
}  // namespace excavplan
