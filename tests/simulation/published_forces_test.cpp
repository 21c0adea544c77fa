// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angles.hpp"
#include "base/table.hpp"
#include "soil/earthmoving.hpp"

namespace excavplan {
namespace {

constexpr double gravity = 9.81;

// One blade in level ground and the horizontal force on it [N]. The equation is not fitted to any.
struct Blade {
  CuttingWedge wedge;
  SoilStrength soil;
  double width = 0.0;
  double depth = 0.0;
  double force = 0.0;
  double uncertainty = 0.0;
};

// Horizontal force [N] by the equation, with nothing beside the blade, with side planes, with
// crescents.
struct Equation {
  double plane = 0.0;
  double sides = 0.0;
  double crescents = 0.0;
};

double force_per_width(const EarthmovingFactors& n, const SoilStrength& soil, double depth) {
  return soil.unit_weight * depth * depth * n.gamma + soil.cohesion * depth * n.c +
         soil.adhesion * depth * n.ca;
}

Equation equation_of(const Blade& blade) {
  const CuttingWedge& wedge = blade.wedge;
  const double failure = critical_failure_angle(wedge).value();
  const EarthmovingFactors factors = earthmoving_factors(wedge, failure).value();
  const double along = std::sin(wedge.rake + wedge.tool_friction);
  Equation result;
  result.plane = blade.width * (force_per_width(factors, blade.soil, blade.depth) * along +
                                blade.soil.adhesion * blade.depth / std::tan(wedge.rake));
  result.sides = result.plane + side_plane_force(wedge, factors, blade.soil, blade.depth) *
                                    side_plane_share(wedge, factors) * along;
  const EarthmovingFactors spread = crescent_factors(wedge, failure, blade.width / blade.depth);
  result.crescents = blade.width * force_per_width(spread, blade.soil, blade.depth);
  return result;
}

// Force by the equation over the published one.
void print(const Blade& blade, const Equation& e) {
  std::printf("rake %3.0f deg, %.2f m wide, %.2f m deep, %5.0f N: ", blade.wedge.rake / degree,
              blade.width, blade.depth, blade.force);
  std::printf("2-D %.2f, with side planes %.2f, with crescents %.2f\n", e.plane / blade.force,
              e.sides / blade.force, e.crescents / blade.force);
}

std::vector<Blade> published(bool measured) {
  const Table t = Table::read(EXCAVPLAN_DATA_SOURCE "/../tests/published_forces.csv");
  std::vector<Blade> list;
  for (std::size_t i = 0; i < t.rows(); ++i) {
    const auto at = [&](const char* name) { return t.column(name)[i]; };
    if ((at("measured") != 0.0) != measured) continue;
    Blade b;
    b.wedge = {at("rake_deg") * degree, at("friction_deg") * degree,
               at("tool_friction_deg") * degree};
    b.soil = {at("density_kg_per_m3") * gravity, at("cohesion_pa"), at("adhesion_pa")};
    b.width = at("width_m");
    b.depth = at("depth_m");
    b.force = at("force_n");
    b.uncertainty = at("uncertainty_n");
    list.push_back(b);
  }
  return list;
}

TEST(PublishedForces, AnotherProgramComputesTheSame) {
  for (const Blade& blade : published(false)) {
    EXPECT_NEAR(equation_of(blade).plane, blade.force, blade.uncertainty + 0.005 * blade.force);
  }
}

// Measured blades stand between no side effect and full crescents. With the side planes that the
// simulators use the equation is 29 % low to 23 % high, 5 % high in the mean. The lowest is the
// blade 0.30 m wide at 0.10 m, whose measured force does not follow that of 0.15 m (610, 780 N).
// The ratio of crescents grows with the depth: they exaggerate the sides of a narrow blade.
TEST(PublishedForces, MeasuredBladesInSand) {
  double mean = 0.0;
  const std::vector<Blade> blades = published(true);
  ASSERT_EQ(blades.size(), 8u);
  for (const Blade& blade : blades) {
    const Equation e = equation_of(blade);
    print(blade, e);
    EXPECT_LT(e.plane, blade.force + blade.uncertainty);
    EXPECT_GT(e.crescents, blade.force - blade.uncertainty);
    EXPECT_NEAR(e.sides / blade.force, 1.0, 0.35);
    mean += e.sides / blade.force / static_cast<double>(blades.size());
  }
  EXPECT_NEAR(mean, 1.0, 0.15);
}

// Runs of a material-point simulation (README of the data). The plate goes in for depth / 0.025 m/s
// and is then drawn along; the mean is of the first 0.05 m, before the heap ahead grows.
struct Drag {
  Blade blade;
  double up = 0.0;
};

Drag drag_of(const Table& t, int run) {
  Drag drag;
  int frames = 0;
  for (std::size_t i = 0; i < t.rows(); ++i) {
    if (t.column("run")[i] != run) continue;
    drag.blade.depth = t.column("depth_m")[i];
    drag.blade.wedge = {(90.0 - t.column("angle_deg")[i]) * degree, 37.2 * degree, std::atan(0.3)};
    const double start = drag.blade.depth / 0.025 * 60.0;
    const double drawn = (t.column("frame")[i] - start) / 60.0 * t.column("speed_m_per_s")[i];
    if (drawn < 0.0 || drawn > 0.05) continue;
    drag.blade.force += t.column("force_along_n")[i];
    drag.up += t.column("force_up_n")[i];
    ++frames;
  }
  drag.blade.soil = {1731.0 * gravity, 0.0, 0.0};
  drag.blade.width = 0.457;
  drag.blade.force /= frames;
  drag.up /= frames;
  return drag;
}

class SimulatedBlades : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(path_)) GTEST_SKIP() << "no " << path_;
  }
  Drag drag(int run) const {
    Drag d = drag_of(Table::read(path_), run);
    print(d.blade, equation_of(d.blade));
    return d;
  }

 private:
  const std::string path_ = EXCAVPLAN_SHARED_DATA "/blade-mpm/forces.csv";
};

// 12 and 7 % low at 0.10 m: the plate's lower face drags too. 37 % low at 0.05 m, which is under
// four cells of the simulation's grid.
TEST_F(SimulatedBlades, UprightPlates) {
  struct Case {
    int run;
    double tolerance;
  };
  for (const Case c : {Case{231, 0.15}, Case{213, 0.15}, Case{123, 0.40}}) {
    const Blade blade = drag(c.run).blade;
    EXPECT_NEAR(equation_of(blade).sides / blade.force, 1.0, c.tolerance) << "run " << c.run;
  }
}

// Plates at 45 deg disagree: the equation has 0.12 and 0.38 of the force. They are 28 mm thick at
// a depth of 40 and 80 mm, and their lower face, turned 45 deg ahead, bears on the soil.
// What the equation leaves is a push on that face: forward and up, inside its cone of friction.
TEST_F(SimulatedBlades, ThickPlatesAtFortyFiveDegrees) {
  for (const int run : {179, 99}) {
    const Drag d = drag(run);
    const double along = equation_of(d.blade).sides;
    const double down = along / std::tan(d.blade.wedge.rake + d.blade.wedge.tool_friction);
    EXPECT_LT(along, 0.5 * d.blade.force) << "run " << run;
    const double direction = std::atan2(d.blade.force - along, d.up + down);
    EXPECT_NEAR(direction, 45.0 * degree, d.blade.wedge.tool_friction) << "run " << run;
  }
}

}  // namespace
}  // namespace excavplan
