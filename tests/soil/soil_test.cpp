// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/loose_soil.hpp>
#include <excavplan/soil/soil.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

SoilKind shipped(const std::string& name) {
  return load_soil(find_data_file("soils/" + name + ".json"));
}

const std::vector<std::string> kinds = {"loam", "sand", "clay", "gravel"};

/// One row of the published table of the default loam (docs/methods.md#soil), as printed.
struct LoamRow {
  double d, e, dry, bulk, unit_weight_kn, cohesion_kpa, phi_deg, delta_deg, cone_kpa, k;
};

const LoamRow loam_table[] = {
    {0, 1.300, 1165, 1305, 12.8, 4.0, 28, 18.7, 630, 0.993},
    {10, 1.212, 1212, 1357, 13.3, 5.0, 29, 19.3, 705, 1.032},
    {20, 1.123, 1262, 1414, 13.9, 6.2, 30, 20.0, 797, 1.075},
    {30, 1.035, 1317, 1475, 14.5, 7.7, 31, 20.7, 911, 1.122},
    {40, 0.946, 1377, 1542, 15.1, 9.5, 32, 21.3, 1054, 1.173},
    {50, 0.858, 1443, 1616, 15.9, 11.8, 33, 22.0, 1236, 1.229},
    {60, 0.769, 1515, 1697, 16.6, 14.7, 34, 22.7, 1472, 1.291},
    {70, 0.681, 1595, 1786, 17.5, 18.3, 35, 23.3, 1787, 1.358},
    {80, 0.592, 1683, 1885, 18.5, 22.7, 36, 24.0, 2216, 1.434},
    {90, 0.504, 1782, 1996, 19.6, 28.2, 37, 24.7, 2819, 1.518},
    {100, 0.415, 1894, 2121, 20.8, 35.0, 38, 25.3, 3695, 1.613},
};

TEST(Soil, LoamGivesThePublishedTableToItsPrintedDigits) {
  // The table was computed before its void ratios were rounded, and with g = 9.81 m/s^2.
  SoilKind loam = shipped("loam");
  EXPECT_NEAR(loam.void_ratio_min, 1.3 - 0.384739 * 2.3, 2e-4);
  EXPECT_NEAR(loam.void_ratio_loose, 0.992619 * 2.3 - 1.0, 2e-4);
  loam.void_ratio_min = 1.3 - 0.384739 * 2.3;
  loam.void_ratio_loose = 0.992619 * 2.3 - 1.0;
  for (const LoamRow& row : loam_table) {
    SCOPED_TRACE(row.d);
    const SoilState state = bank_state(loam, row.d);
    constexpr double half = 0.5 + 1e-6;
    EXPECT_NEAR(state.relative_density, row.d / 100.0, 1e-12);
    EXPECT_NEAR(state.void_ratio, row.e, half * 1e-3);
    EXPECT_NEAR(state.dry_density, row.dry, half);
    EXPECT_NEAR(state.bulk_density, row.bulk, half);
    EXPECT_NEAR(state.unit_weight * 9.81 / gravity / 1e3, row.unit_weight_kn, half * 0.1);
    EXPECT_NEAR(state.cohesion / 1e3, row.cohesion_kpa, half * 0.1);
    EXPECT_NEAR(state.adhesion, 0.25 * state.cohesion, 1e-9);
    EXPECT_NEAR(state.friction_angle / degree, row.phi_deg, 1e-3);
    EXPECT_NEAR(state.tool_friction_angle / degree, row.delta_deg, half * 0.1);
    EXPECT_NEAR(cone_index(loam, state, 0.15) / 1e3, row.cone_kpa, half);
    EXPECT_NEAR(bulking_of_density(loam, row.d), row.k, half * 1e-3);
  }
}

TEST(Soil, ConeIndexPassesThroughBothMeasurements) {
  const SoilKind loam = shipped("loam");
  SoilState state;
  state.bulk_density = 1170.0;
  EXPECT_NEAR(cone_index(loam, state, 0.1), 470e3, 1.0);
  state.bulk_density = 1680.0;
  EXPECT_NEAR(cone_index(loam, state, 0.1), 1420e3, 1e3);
}

TEST(Soil, StressLawGivesBaldisResistance) {
  SoilKind soil = shipped("loam");
  soil.cone_index_law = ConeIndexLaw::stress;
  soil.cone_index_reference = 157e3;
  soil.cone_index_rate = 2.41;
  soil.cone_index_stress_exponent = 0.55;
  EXPECT_NEAR(cone_index(soil, bank_state(soil, 10.0), 0.15), 292e3, 1e3);
  EXPECT_NEAR(cone_index(soil, bank_state(soil, 40.0), 0.15), 646e3, 1e3);
  EXPECT_NEAR(cone_index(soil, bank_state(soil, 80.0), 0.15), 1892e3, 1e3);
}

TEST(Soil, StressLawStaysPositiveAtAndAboveTheSurface) {
  const SoilKind sand = shipped("sand");
  const SoilState state = bank_state(sand, 50.0);
  const double surface = cone_index(sand, state, 0.0);
  EXPECT_GT(surface, 0.0);
  EXPECT_EQ(surface, cone_index(sand, state, -1.0));
  EXPECT_EQ(surface, cone_index(sand, state, 0.01));
  EXPECT_GT(cone_index(sand, state, 0.02), surface);
}

TEST(Soil, GravelResistsHalfAsMuchAgainAsSandOfTheSameStress) {
  const SoilKind gravel = shipped("gravel");
  const SoilKind sand = shipped("sand");
  SoilState state = bank_state(sand, 50.0);
  EXPECT_NEAR(cone_index(gravel, state, 0.2) / cone_index(sand, state, 0.2), 1.5, 1e-9);
}

TEST(Soil, OtherKindsBulkAsPublished) {
  EXPECT_NEAR(bulking_of_density(shipped("sand"), 50.0), 1.11, 0.005);
  EXPECT_NEAR(bulking_of_density(shipped("sand"), 100.0), 1.26, 0.005);
  EXPECT_NEAR(bulking_of_density(shipped("gravel"), 50.0), 1.12, 0.005);
  EXPECT_NEAR(bulking_of_density(shipped("gravel"), 100.0), 1.28, 0.005);
  EXPECT_NEAR(bulking_of_density(shipped("clay"), 50.0), 1.21, 0.005);
  EXPECT_NEAR(bulking_of_density(shipped("clay"), 100.0), 1.59, 0.005);
}

TEST(Soil, OrdinaryBankStatesSwellAsInHandbooks) {
  for (const double d : {40.0, 50.0, 60.0}) {
    EXPECT_GE(bulking_of_density(shipped("loam"), d), 1.17);  // MLIT cohesive 1.25, loam 1.23
    EXPECT_LE(bulking_of_density(shipped("loam"), d), 1.30);
    EXPECT_GE(bulking_of_density(shipped("clay"), d), 1.15);  // clay and gravel 1.15
    EXPECT_LE(bulking_of_density(shipped("clay"), d), 1.40);  // damp clay 1.40
    EXPECT_GE(bulking_of_density(shipped("sand"), d), 1.05);
    EXPECT_LE(bulking_of_density(shipped("sand"), d), 1.30);
    EXPECT_GE(bulking_of_density(shipped("gravel"), d), 1.05);
    EXPECT_LE(bulking_of_density(shipped("gravel"), d), 1.20);
  }
}

TEST(Soil, EveryKindStaysPhysicalOverTheWholeRange) {
  for (const std::string& name : kinds) {
    const SoilKind soil = shipped(name);
    EXPECT_EQ(soil.name, name);
    double last_k = 0.0;
    double last_cone_index = 0.0;
    for (int d = 0; d <= 100; ++d) {
      SCOPED_TRACE(name + " " + std::to_string(d));
      const SoilState state = bank_state(soil, d);
      EXPECT_GT(state.saturation, 0.0);
      EXPECT_LT(state.saturation, 1.0);
      const double water = state.bulk_density - state.dry_density;
      EXPECT_NEAR(water, soil.water_content * state.dry_density, 1e-9);
      EXPECT_NEAR(state.unit_weight, state.bulk_density * 9.80665, 1e-9);
      EXPECT_GE(state.cohesion, 0.0);
      EXPECT_LE(state.tool_friction_angle, state.friction_angle + 1e-12);
      const double k = bulking_of_density(soil, d);
      EXPECT_NEAR(k, state.dry_density / loose_state(soil).dry_density, 1e-12) << "solids";
      EXPECT_GT(k, last_k);
      const double resistance = cone_index(soil, state, 0.2);
      EXPECT_GT(resistance, last_cone_index);
      last_k = k;
      last_cone_index = resistance;
    }
  }
}

TEST(Soil, DugSoilIsNearItsLoosestWithoutCohesion) {
  for (const std::string& name : kinds) {
    SCOPED_TRACE(name);
    const SoilKind soil = shipped(name);
    const SoilState loose = loose_state(soil);
    EXPECT_EQ(loose.void_ratio, soil.void_ratio_loose);
    EXPECT_GE(loose.relative_density, 0.0);
    EXPECT_LE(loose.relative_density, 0.1);
    EXPECT_EQ(loose.cohesion, 0.0);
    EXPECT_EQ(loose.adhesion, 0.0);
    EXPECT_EQ(loose.friction_angle, soil.friction_loosest);
  }
}

TEST(Soil, WallOfFiveKilopascalStandsTwoAndAHalfMetres) {
  SoilState state;
  state.cohesion = 5000.0;
  state.friction_angle = 30.0 * degree;
  state.unit_weight = 13.3e3;
  EXPECT_NEAR(critical_height(state), 2.6, 0.05);
  state.friction_angle = 0.0;
  EXPECT_NEAR(critical_height(state), 4.0 * 5000.0 / 13.3e3, 1e-12);
  EXPECT_EQ(critical_height(loose_state(shipped("loam"))), 0.0);
}

TEST(Soil, FingerprintChangesWithEveryNumberAndNotWithTheName) {
  const SoilKind loam = shipped("loam");
  std::set<std::string> seen = {fingerprint(loam)};
  for (const auto number :
       {&SoilKind::specific_gravity, &SoilKind::water_content, &SoilKind::void_ratio_max,
        &SoilKind::void_ratio_min, &SoilKind::void_ratio_loose, &SoilKind::cohesion_loosest,
        &SoilKind::cohesion_growth, &SoilKind::friction_loosest, &SoilKind::friction_gain,
        &SoilKind::tool_friction_ratio, &SoilKind::adhesion_ratio, &SoilKind::angle_of_repose,
        &SoilKind::cone_index_reference, &SoilKind::cone_index_rate,
        &SoilKind::cone_index_reference_density, &SoilKind::cone_index_stress_exponent}) {
    SoilKind other = loam;
    other.*number += 1e-9;
    EXPECT_TRUE(seen.insert(fingerprint(other)).second);
  }
  SoilKind renamed = loam;
  renamed.name = "another";
  EXPECT_EQ(fingerprint(renamed), fingerprint(loam));
}

TEST(Soil, DensityOutsideItsRangeIsRefused) {
  const SoilKind loam = shipped("loam");
  for (const double wrong : {-0.1, 100.1, std::nan("")}) {
    EXPECT_THROW(bank_state(loam, wrong), Error);
    EXPECT_THROW(bulking_of_density(loam, wrong), Error);
  }
  EXPECT_EQ(test::error_of([&] { bank_state(loam, 120.0); }),
            "relative density is 120 %, must be in 0 .. 100 %");
}

std::string loam_text() {
  std::ifstream in(find_data_file("soils/loam.json"));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The message load_soil() gives for the loam file with one piece of text exchanged, without the
/// file's name.
std::string message_of(const std::string& from, const std::string& to) {
  std::string text = loam_text();
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return "the loam file does not hold " + from;
  text.replace(at, from.size(), to);
  const std::string path =
      testing::TempDir() + "excavplan_soil_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << text;
  const std::string message = test::error_about([&] { load_soil(path); }, path);
  std::remove(path.c_str());
  return message;
}

TEST(SoilFile, BrokenRulesAreNamedWithFileKeyAndValue) {
  const struct {
    const char *from, *to, *expected;
  } cases[] = {
      {"\"void_ratio_min\": 0.415", "\"void_ratio_min\": 1.4",
       "void_ratio_min: is 1.4, must be below void_ratio_max (1.3)"},
      {"\"void_ratio_loose\": 1.283", "\"void_ratio_loose\": 1.31",
       "void_ratio_loose: is 1.31, must be above void_ratio_min (0.415) and not above "
       "void_ratio_max (1.3)"},
      {"\"void_ratio_loose\": 1.283", "\"void_ratio_loose\": 0.4", "void_ratio_loose: is 0.4"},
      {"\"water_content\": 0.12", "\"water_content\": 0.2",
       "water_content: is 0.2, which fills the pores of the densest state"},
      {"\"specific_gravity\": 2.68", "\"specific_gravity\": 0", "specific_gravity: is 0, must be"},
      {"\"friction_gain_rad\": 0.174533", "\"friction_gain_rad\": 0.9",
       "friction_gain_rad: is 0.9, which makes the friction angle of the densest state"},
      {"\"angle_of_repose_rad\": 0.610865", "\"angle_of_repose_rad\": 35",
       "angle_of_repose_rad: is 35, must be in"},
      {"\"cohesion_loosest_pa\": 4000", "\"cohesion_loosest_pa\": -1",
       "cohesion_loosest_pa: is -1"},
      {"\"cohesion_loosest_pa\": 4000", "\"cohesion_loosest_kpa\": 4",
       "cohesion_loosest_pa: is missing"},
      {"\"law\": \"bulk_density\"", "\"law\": \"moon\"",
       "cone_index.law: is 'moon', must be 'bulk_density' or 'stress'"},
      {"\"law\": \"bulk_density\"", "\"law\": \"stress\"", "cone_index.rate: is missing"},
      {"\"water_content\": 0.12", "\"water_content\": 0.12, \"colour\": 1",
       "colour: is not a key of this file"},
  };
  for (const auto& broken : cases) {
    const std::string message = message_of(broken.from, broken.to);
    EXPECT_NE(message.find(broken.expected), std::string::npos)
        << "expected '" << broken.expected << "' in '" << message << "'";
  }
}

TEST(SoilFile, MissingFileIsNamed) {
  const std::string missing = "no/such/soil.json";
  EXPECT_NE(test::error_about([&] { load_soil(missing); }, missing), "no error");
}

TEST(Soil, StateOfAVoidRatioIsThatOfItsDensity) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  for (const double density : {0.0, 12.5, 60.0, 100.0}) {
    const SoilState state = bank_state(loam, density);
    const SoilState same = bank_state_of_void_ratio(loam, state.void_ratio);
    EXPECT_NEAR(same.cohesion, state.cohesion, 1e-9 * state.cohesion);
    EXPECT_NEAR(same.friction_angle, state.friction_angle, 1e-12);
    EXPECT_NEAR(same.dry_density, state.dry_density, 1e-9 * state.dry_density);
  }
  EXPECT_EQ(test::error_of([&] { bank_state_of_void_ratio(loam, 1.4); }),
            "void ratio of loam is 1.4, must be in 0.415 .. 1.3");
}

TEST(LooseSoil, IsWeakerThanTheBankAndGainsStrengthAsItIsCompacted) {
  for (const std::string& name : kinds) {
    SCOPED_TRACE(name);
    const SoilKind soil = shipped(name);
    SoilState last = loose_state(soil);
    for (double e = soil.void_ratio_loose; e > soil.void_ratio_min; e -= 0.02) {
      const SoilState state = loose_state_of_void_ratio(soil, e);
      const SoilState bank = bank_state_of_void_ratio(soil, e);
      EXPECT_NEAR(state.unit_weight, bank.unit_weight, 1e-9 * bank.unit_weight);
      EXPECT_LE(state.cohesion, bank.cohesion);
      EXPECT_LE(state.friction_angle, bank.friction_angle);
      EXPECT_GE(state.cohesion, last.cohesion);
      EXPECT_LE(state.cohesion - last.cohesion,
                0.2 * soil.cohesion_loosest * std::exp(soil.cohesion_growth));
      EXPECT_GE(state.friction_angle, last.friction_angle);
      EXPECT_GE(cone_index(soil, state, 0.2), cone_index(soil, last, 0.2));
      last = state;
    }
    const SoilState densest = loose_state_of_void_ratio(soil, soil.void_ratio_min);
    EXPECT_NEAR(densest.friction_angle, soil.friction_loosest + soil.friction_gain, 1e-12);
  }
  const SoilKind loam = shipped("loam");
  EXPECT_EQ(test::error_of([&] { loose_state_of_void_ratio(loam, 1.29); }),
            "void ratio of loose loam is 1.29, must be in 0.415 .. 1.283");
}

TEST(LooseSoil, CompactsWithTheLogarithmOfThePressure) {
  for (const std::string& name : kinds) {
    const SoilKind soil = shipped(name);
    const double loose = soil.void_ratio_loose;
    EXPECT_EQ(compacted_void_ratio(soil, loose, 5000.0), loose);
    const double ten = loose - compacted_void_ratio(soil, loose, 5e4);
    EXPECT_NEAR(ten, 0.3 * (loose - 0.27), 1e-12);
    EXPECT_NEAR(loose - compacted_void_ratio(soil, loose, 5000.0 * std::sqrt(10.0)), 0.5 * ten,
                1e-12);
    EXPECT_EQ(compacted_void_ratio(soil, loose, 1e30), soil.void_ratio_min);
    EXPECT_EQ(compacted_void_ratio(soil, soil.void_ratio_min, 2e4), soil.void_ratio_min);
  }
  const SoilKind loam = shipped("loam");
  EXPECT_EQ(test::error_of([&] { compacted_void_ratio(loam, 1.0, -1.0); }),
            "pressure on loose soil [Pa] is -1, must be not negative and finite");
}

}  // namespace
}  // namespace excavplan
