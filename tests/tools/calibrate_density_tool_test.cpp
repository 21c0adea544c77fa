// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/tool_answers.hpp"

/// @file
/// calibrate-density: the law it fits to digs of the simulator or to samples.

namespace excavplan::test {
namespace {

TEST_F(Tools, CalibrateDensityGivesTheKeysOfTheContract) {
  const json result = answer("calibrate-density", {});
  expect_keys(result, "number",
              {"line/a", "line/b", "line/r2", "closed_form/r2", "line_as_measured/a",
               "line_as_measured/b", "line_as_measured/r2"});
  ASSERT_EQ(result.at("samples").size(), 21U);
  for (std::size_t i = 0; i < 21; ++i) {
    const json& sample = result["samples"][i];
    expect_keys(
        sample, "number",
        {"bulking_factor", "bulking_factor_measured", "bulking_factor_true", "fallback_fraction"});
    EXPECT_DOUBLE_EQ(number(sample, "/density_percent"), 5.0 * static_cast<double>(i));
  }
  EXPECT_GT(number(result, "/closed_form/r2"), number(result, "/line/r2"));
}

TEST_F(Tools, CalibrateDensityReportsTheDifferenceOfTrueAndMeasuredFactors) {
  const Words overfills = {"--path", "45deg,0.35m,2m"};
  const json result = answer("calibrate-density", overfills);
  const json& difference = result.at("largest_difference");
  const double percent = number(difference, "/density_percent");
  const double fallback = number(difference, "/fallback_fraction");
  const double k = number(difference, "/bulking_factor_true");
  double largest = 0.0;
  for (const json& sample : result["samples"]) {
    largest = std::max(largest, std::abs(number(sample, "/bulking_factor_measured") -
                                         number(sample, "/bulking_factor_true")));
  }
  EXPECT_NEAR(std::abs(number(difference, "/bulking_factor_measured") - k), largest, 1e-12);
  EXPECT_NEAR(number(difference, "/bulking_factor_measured"), (k - fallback) / (1.0 - fallback),
              1e-6 + number(difference, "/unexplained"));
  const std::string text = run_program("calibrate-density", overfills).out;
  for (const std::string& part :
       {"largest difference at " + std::to_string(static_cast<int>(percent)),
        std::string(" by dry mass, "), std::string(" points too "),
        std::string(" % of the cut soil fell back into the hole")}) {
    EXPECT_TRUE(contains(text, part)) << part << '\n' << text;
  }
}

TEST_F(Tools, CalibrateDensityNamesTheSimulatorItDug) {
  const json section =
      answer("calibrate-density", {"--simulator", "section", "--densities", "0:25:100"});
  EXPECT_TRUE(contains(section.at("source"), "section")) << section.at("source");
  const json usual = answer("calibrate-density", {"--densities", "0:25:100"});
  EXPECT_TRUE(contains(usual.at("source"), "height-map")) << usual.at("source");
  EXPECT_NE(number(section, "/line/a"), number(usual, "/line/a"));
}

TEST_F(Tools, CalibrateDensitySaysOnWhichDigsTheLawIs) {
  const json any = answer("calibrate-density", {"--densities", "0:25:100"});
  EXPECT_EQ(any["soil"], "loam");
  EXPECT_EQ(any["machine"], "zx120");
  EXPECT_TRUE(contains(any["simulator"], "height-map"));
  EXPECT_EQ(any["any_path"], true);
  EXPECT_EQ(any["scatter"]["draws"], 200);
  const json one = answer("calibrate-density", {"--densities", "0:25:100", "--path",
                                                "45deg,0.35m,1.5m", "--draws", "40"});
  EXPECT_EQ(one["path"], any["path"]);
  EXPECT_EQ(one["any_path"], false);
  EXPECT_LT(number(one, "/closed_form_as_measured/residual_sd_percent"),
            0.8 * number(any, "/closed_form_as_measured/residual_sd_percent"));
  EXPECT_EQ(one["closed_form_as_measured"]["A"], any["closed_form_as_measured"]["A"]);
  const json none = answer("calibrate-density", {"--densities", "0:25:100", "--draws", "0"});
  EXPECT_LT(number(none, "/closed_form_as_measured/residual_sd_percent"), 0.1);
}

// The samples lie 0.0005 points above or below d = 200 k - 190, orthogonally to 1 and k: with two
// numbers fitted, sqrt(4 / (4 - 2)) of 0.0005 points are left.
TEST_F(Tools, CalibrateDensityPrintsSmallNumbersAndNoRoundingErrors) {
  const auto line_of = [&](const std::string& densities) {
    const std::string text =
        run_program("calibrate-density", {"--samples", folder.write("digs.csv", densities)}).out;
    return text.substr(0, text.find('\n'));
  };
  const std::string columns = "bulking_factor,density_percent\n";
  EXPECT_TRUE(contains(line_of(columns + "1,10.0005\n1.1,29.9995\n1.2,49.9995\n1.3,70.0005\n"),
                       "residual_sd_percent 0.00070711"));
  const std::string exact = line_of(columns + "1,10\n1.1,30\n1.2,50\n1.3,70\n");
  EXPECT_EQ(exact.substr(exact.rfind(' ')), " 0.0000") << exact;
}

TEST_F(Tools, MeasuredSamplesHaveTheirOwnSoilAndPath) {
  const std::string samples =
      folder.write("digs.csv", "bulking_factor,density_percent\n1,10\n1.1,30\n1.2,52\n1.3,70\n");
  const Words words = {"--samples", samples};
  EXPECT_TRUE(answer("calibrate-density", words).at("warnings").empty());
  const json ignored = answer("calibrate-density", words + Words{"--soil", "sand", "--draws", "5"});
  ASSERT_TRUE(warns(ignored, "options_ignored")) << ignored;
  EXPECT_TRUE(contains(ignored.at("warnings")[0].at("message"), "--soil, --draws"));
}

TEST_F(BadInput, TablesThatHoldNoSamplesAreRefused) {
  refused(3, "letter.txt: ", "calibrate-density", {"--samples", letter});
  const std::string one = folder.write("one.csv", "bulking_factor,density_percent\n1.1,20\n");
  refused(3, "one.csv: ", "calibrate-density", {"--samples", one, "--out", folder.file("law")});
}

}  // namespace
}  // namespace excavplan::test
