// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil/earthmoving.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"

namespace excavplan {
namespace {

CuttingWedge wedge_of(double rake, double friction, double tool_friction, double slope = 0.0) {
  return {rake * degree, friction * degree, tool_friction * degree, slope * degree};
}

// Unit values worked out by hand from the equation (docs/methods.md#earthmoving).
struct UnitValue {
  double rake, failure, friction, tool_friction, slope;
  double gamma, c, Q, ca, D;
};
class EarthmovingUnitValues : public testing::TestWithParam<UnitValue> {};

TEST_P(EarthmovingUnitValues, MatchTheTable) {
  const UnitValue& v = GetParam();
  const auto n = earthmoving_factors(wedge_of(v.rake, v.friction, v.tool_friction, v.slope),
                                     v.failure * degree);
  ASSERT_TRUE(n);
  EXPECT_NEAR(n->gamma, v.gamma, 1e-4 * v.gamma);
  EXPECT_NEAR(n->c, v.c, 1e-4 * v.c);
  EXPECT_NEAR(n->Q, v.Q, 1e-4 * v.Q);
  EXPECT_NEAR(n->ca, v.ca, 1e-4);
  EXPECT_NEAR(n->D, v.D, 1e-4 * v.D);
}

INSTANTIATE_TEST_SUITE_P(
    Earthmoving, EarthmovingUnitValues,
    testing::Values(UnitValue{90, 30, 30, 0, 0, 1.50000, 3.46410, 1.73205, 1.73205, 0.57735},
                    UnitValue{45, 30, 35, 22, 0, 1.66595, 2.20456, 1.21956, 0.65087, 0.81997},
                    UnitValue{45, 30, 35, 22, 10, 1.77553, 2.20456, 1.29978, 0.65087, 0.81997},
                    UnitValue{45, 30, 35, 22, -10, 1.50574, 2.20456, 1.10228, 0.65087, 0.81997},
                    UnitValue{30, 35, 30, 20, 0, 1.58010, 1.66596, 1.00000, 0.19233, 1.00000},
                    UnitValue{60, 27, 32, 21.333, 0, 1.70538, 2.92639, 1.34284, 0.87700, 0.74469}));

TEST(Earthmoving, CriticalFailureAngleOfASmoothWallIsRankines) {
  for (const double friction : {20.0, 30.0, 40.0}) {
    const auto failure = critical_failure_angle(wedge_of(90, friction, 0));
    ASSERT_TRUE(failure);
    EXPECT_NEAR(*failure, (45.0 - friction / 2.0) * degree, 1e-6);
    const auto n = earthmoving_factors(wedge_of(90, friction, 0), *failure);
    const double passive = std::pow(std::tan((45.0 + friction / 2.0) * degree), 2);
    EXPECT_NEAR(n->gamma, passive / 2.0, 1e-9);
    EXPECT_NEAR(n->c, 2.0 * std::sqrt(passive), 1e-6);
  }
}

TEST(Earthmoving, CriticalFailureAnglesMatchTheTable) {
  EXPECT_NEAR(critical_failure_angle(wedge_of(45, 35, 22)).value() / degree, 31.63, 0.01);
  EXPECT_NEAR(critical_failure_angle(wedge_of(60, 35, 22)).value() / degree, 27.02, 0.01);
  EXPECT_NEAR(critical_failure_angle(wedge_of(30, 30, 20)).value() / degree, 35.93, 0.02);
  EXPECT_NEAR(critical_failure_angle(wedge_of(45, 35, 22, 15)).value() / degree, 36.70, 0.01);
  EXPECT_NEAR(critical_failure_angle(wedge_of(45, 35, 22, -15)).value() / degree, 25.39, 0.01);
}

// gamma 15 kN/m3, c 10 kPa, t 0.3 m, b 1 m: P = 8862.69 N, H = 8158.15 N, V = 3462.93 N.
TEST(Earthmoving, ForceMatchesTheWorkedExample) {
  const CuttingWedge wedge = wedge_of(45, 35, 22);
  const auto n = earthmoving_factors(wedge, 30 * degree);
  const double force = 15e3 * 0.09 * n->gamma + 10e3 * 0.3 * n->c;
  EXPECT_NEAR(force, 8862.69, 0.9);
  EXPECT_NEAR(force * std::sin(67 * degree), 8158.15, 0.9);
  EXPECT_NEAR(force * std::cos(67 * degree), 3462.93, 0.4);
}

TEST(Earthmoving, CrescentsMatchTheTableAndTendToTheWideBlade) {
  const CuttingWedge wedge = wedge_of(45, 35, 22);
  const auto per_width = [&](double width) {
    const EarthmovingFactors n = crescent_factors(wedge, 30 * degree, width / 0.3);
    return 15e3 * 0.09 * n.gamma + 10e3 * 0.3 * n.c;
  };
  EXPECT_NEAR(per_width(0.9), 14487.0, 1.5);
  EXPECT_NEAR(per_width(0.33), 25419.0, 3.0);
  const auto two_d = earthmoving_factors(wedge, 30 * degree);
  const double wide = (15e3 * 0.09 * two_d->gamma + 10e3 * 0.3 * two_d->c) * std::sin(67 * degree);
  EXPECT_NEAR(per_width(1e7), wide, 1e-4 * wide);
}

// b 0.9 m: 2-D 7.34 kN, with side planes 9.95 kN (horizontal, kN over the blade's width).
TEST(Earthmoving, SidePlanesMatchTheTable) {
  const CuttingWedge wedge = wedge_of(45, 35, 22);
  const auto n = earthmoving_factors(wedge, 30 * degree).value();
  const double two_d = 0.9 * (15e3 * 0.09 * n.gamma + 10e3 * 0.3 * n.c);
  const double sides =
      side_plane_force(wedge, n, {15e3, 10e3, 0.0}, 0.3) * side_plane_share(wedge, n);
  EXPECT_NEAR(two_d * std::sin(67 * degree), 7.34e3, 10.0);
  EXPECT_NEAR((two_d + sides) * std::sin(67 * degree), 9.95e3, 10.0);
}

TEST(Earthmoving, TableOfCriticalWedgesIsWithinHalfAPerCent) {
  const CriticalWedges wedges(32 * degree, 21 * degree);
  for (double rake = 11; rake < 100; rake += 3.7) {
    for (double slope = -26; slope < 39; slope += 4.3) {
      const CuttingWedge wedge = wedge_of(rake, 32, 21, slope);
      const auto exact = earthmoving_factors(wedge, critical_failure_angle(wedge).value()).value();
      EXPECT_NEAR(wedges.at(rake * degree, slope * degree).gamma, exact.gamma, 5e-3 * exact.gamma)
          << rake << " " << slope;
    }
  }
}

TEST(Earthmoving, AWedgeThatCannotSlideIsAValue) {
  EXPECT_FALSE(earthmoving_factors(wedge_of(120, 40, 30), 60 * degree));
  EXPECT_FALSE(critical_failure_angle(wedge_of(120, 40, 30)));
  EXPECT_THROW(CriticalWedges(70 * degree, 10 * degree), Error);
}

// Between the tables of two friction angles, against tables made for the angle itself.
TEST(FrictionWedges, FactorsAreThoseOfTheFrictionAskedFor) {
  const FrictionWedges wedges(28 * degree, 38 * degree, 2.0 / 3.0);
  for (const double friction : {28.0, 29.3, 33.0, 36.7, 38.0}) {
    const CriticalWedges own(friction * degree, friction * degree * 2.0 / 3.0);
    for (const double rake : {12.0, 30.0, 55.0, 80.0}) {
      for (const double slope : {-15.0, 0.0, 20.0}) {
        const EarthmovingFactors a = wedges.at(rake * degree, slope * degree, friction * degree);
        const EarthmovingFactors b = own.at(rake * degree, slope * degree);
        EXPECT_NEAR(a.gamma, b.gamma, 1e-4 * b.gamma);
        EXPECT_NEAR(a.c, b.c, 5e-3 * b.c);
        EXPECT_NEAR(a.ca, b.ca, 2e-2 * std::abs(b.ca));
      }
    }
  }
  EXPECT_THROW(FrictionWedges(0.6, 0.5, 0.5), Error);
  EXPECT_THROW(FrictionWedges(0.5, 0.6, 1.5), Error);
}

}  // namespace
}  // namespace excavplan
