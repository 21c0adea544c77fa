// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "support/depth_png.hpp"
#include "support/tool_answers.hpp"

/// @file
/// depth-to-cloud: a depth image becomes a cloud in the site frame.

namespace excavplan::test {
namespace {

TEST_F(Tools, DepthImageBecomesACloudInTheSiteFrame) {
  // 5 m above (3, 1), looking down: right is -y, down in the image is -x.
  const std::string pose = folder.write("pose.txt", "0 -1 0 3\n-1 0 0 1\n0 0 -1 5\n0 0 0 1\n");
  std::vector<std::uint16_t> depth(16 * 12, 5000);
  depth.back() = 0;             // nothing seen
  depth[2 * 16 + 12] = 0x1234;  // 4.66 m: both bytes count
  Words words = depth_run(folder);
  folder.write("depth.png", png_of(16, depth));
  words = words + Words{"--pose", pose};
  const json result = answer("depth-to-cloud", words);
  EXPECT_EQ(result.at("points"), 192);
  EXPECT_EQ(result.at("finite_points"), 191);
  EXPECT_EQ(result.at("width"), 16);
  EXPECT_EQ(result.at("height"), 12);
  EXPECT_EQ(result.at("frame"), "site");

  const json cloud = answer("inspect-cloud", {folder.file("cloud.xyz")});
  EXPECT_EQ(cloud.at("finite_points"), 191);
  const double z = 4.66;  // pixel (12, 2): 4 right of and 4 above the centre
  EXPECT_NEAR(number(cloud, "/max_m/2"), 5.0 - z, 1e-6);
  EXPECT_NEAR(number(cloud, "/min_m/2"), 0.0, 1e-6);
  EXPECT_NEAR(number(cloud, "/max_m/0"), 3.0 + 6.0 / 50.0 * 5.0, 1e-6);
  EXPECT_NEAR(number(cloud, "/min_m/0"), 3.0 - 5.0 / 50.0 * 5.0, 1e-6);
  EXPECT_NEAR(number(cloud, "/min_m/1"), 1.0 - 7.0 / 40.0 * 5.0, 1e-6);
  std::istringstream lines(content_of(folder.file("cloud.xyz")));
  std::string names;
  std::getline(lines, names);
  bool found = false;
  for (double px, py, pz; lines >> px >> py >> pz;) {
    found = found || (std::abs(px - (3.0 + 4.0 / 50.0 * z)) < 1e-6 &&
                      std::abs(py - (1.0 - 4.0 / 40.0 * z)) < 1e-6 && std::abs(pz - 0.34) < 1e-6);
  }
  EXPECT_TRUE(found);
}

TEST_F(Tools, ACountIsOfTheUnitThatIsSaid) {
  Words words = depth_run(folder);
  folder.write("depth.png", png_of(16, std::vector<std::uint16_t>(16 * 12, 20000)));
  for (const auto& [unit, depth] : {std::pair{"0.25mm", 5.0}, {"0.125mm", 2.5}}) {
    answer("depth-to-cloud", words + Words{"--depth-unit", unit});
    const json cloud = answer("inspect-cloud", {folder.file("cloud.xyz")});
    EXPECT_NEAR(number(cloud, "/max_m/2"), depth, 1e-6);
    EXPECT_NEAR(number(cloud, "/min_m/2"), depth, 1e-6);
  }
}

/// A bare number is in metres.
TEST_F(BadInput, CountsOfCentimetresAreRefused) {
  const Words words = depth_run(folder);
  for (const char* const metres : {"0.25", "0.125", "0.25m", "0.011"}) {
    refused(2, "as in 0.25mm", "depth-to-cloud", words + Words{"--depth-unit", metres});
  }
  refused(2, "--depth-unit must be above 0 m", "depth-to-cloud",
          words + Words{"--depth-unit", "0"});
}

TEST_F(BadInput, DepthImagesAreRefusedWithTheReason) {
  const Words words = depth_run(folder);
  refused(3, "not a PNG image", "depth-to-cloud",
          {letter, "--intrinsics", words[2], "--out", words[4]});
  refused(3, "letter.txt: line 2: found", "depth-to-cloud",
          {words[0], "--intrinsics", letter, "--out", words[4]});
  refused(3, "letter.txt: ", "depth-to-cloud", words + Words{"--pose", letter});
}

}  // namespace
}  // namespace excavplan::test
