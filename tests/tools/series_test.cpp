// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "frame/quantity.hpp"
#include "support/errors.hpp"

namespace excavplan::tools {
namespace {

using test::error_of;

using Column = std::vector<double>;

Column densities(const std::string& text) { return parse_densities("--densities", text); }

TEST(DensityList, IsOneANumberSomeOrARange) {
  EXPECT_EQ(densities("40"), (Column{40.0}));
  EXPECT_EQ(densities("10,40%,80"), (Column{10.0, 40.0, 80.0}));
  EXPECT_EQ(densities("0:25:100"), (Column{0.0, 25.0, 50.0, 75.0, 100.0}));
  EXPECT_EQ(densities("0:30:100"), (Column{0.0, 30.0, 60.0, 90.0}));
  EXPECT_EQ(densities("40:5:40"), (Column{40.0}));
}

TEST(DensityList, RangesReachTheirEndThoughStepsAreNotExact) {
  const Column list = densities("0:0.1:100");
  ASSERT_EQ(list.size(), 1001U);
  EXPECT_DOUBLE_EQ(list.back(), 100.0);
  EXPECT_DOUBLE_EQ(list[3], 0.3);
}

TEST(SlopeList, HoldsZeroExactly) {
  const std::vector<double> slopes =
      parse_series("--slopes", "-15deg:2.5deg:15deg", Quantity::angle);
  ASSERT_EQ(slopes.size(), 13U);
  EXPECT_EQ(slopes[6], 0.0);
  EXPECT_NEAR(slopes[12], -slopes[0], 1e-15);
}

TEST(DensityList, JunkIsRefused) {
  const auto message = [](const char* text) { return error_of([&] { densities(text); }); };
  for (const char* text : {"0:0:100", "0:100", "0:-5:100", "0:1e-9:100"}) {
    EXPECT_EQ(message(text), "--densities: '" + std::string(text) +
                                 "' is not first:step:last with a step above 0 and at most 10000 "
                                 "of them");
  }
  EXPECT_EQ(message("100:5:0"), "--densities: '100:5:0' holds no number");
  EXPECT_EQ(message("90:5:110"), "--densities: 105 % is outside 0 .. 100");
  EXPECT_EQ(message("40,-1"), "--densities: -1 % is outside 0 .. 100");
  for (const char* text : {"", ",", "10,,20", "a:5:100", "0:5:100:5", "0:nan:100", "40m"}) {
    EXPECT_NE(message(text), "no error") << text;
  }
}

}  // namespace
}  // namespace excavplan::tools
