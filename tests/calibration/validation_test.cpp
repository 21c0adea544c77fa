// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "base/random.hpp"
#include "support/machine_file.hpp"

/// @file
/// The built-in simulator against what others published and what must hold for any soil. The
/// figures stand in docs/validation.md.

namespace excavplan {
namespace {

class Validation : public testing::Test {
 protected:
  static DigParameters random_parameters(Random& random) {
    DigParameters parameters;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      parameters.*info.field = random.uniform(info.lower, info.upper);
    }
    return parameters;
  }

  DigResult fixed_dig(double density, double cell, double step = 0.025) const {
    const Terrain ground = level_planning_ground(machine_, cell);
    DigPathOptions options;
    options.step = step;
    const auto path = make_dig_path(machine_, paper_fixed_path(), 6.0,
                                    boom_plane_profile(ground.surface()), options);
    return HeightMapSimulator(machine_, loam_, density).dig(ground, std::get<DigPath>(path));
  }

  double measured_bulking(double density, double cell) const {
    CalibrationOptions options;
    options.densities_percent = {density, 20, 60, 90};
    options.cell_size = cell;
    return calibrate_density(machine_, loam_, options).samples[0].bulking_factor_measured;
  }

  const Machine machine_ = test::zx120_held_down();
  const SoilKind loam_ = load_soil(find_data_file("soils/loam.json"));
};

TEST_F(Validation, SolidsSurviveAThousandDigsOnRoughGround) {
  Random random(2026);
  const Eigen::Vector2d dump_at(5.5, 4.0);
  Terrain ground = undisturbed(flat_ground(scene_extent(machine_, dump_at), 0.1));
  for (double& z : ground.bank.z.reshaped()) z += 0.03 * random.normal();
  std::optional<double> solids;
  int digs = 0;
  while (digs < 1000) {
    const HeightMapSimulator simulator(machine_, loam_, 50.0);
    const auto path = make_dig_path_anywhere(machine_, random_parameters(random),
                                             boom_plane_profile(ground.surface()));
    if (!std::holds_alternative<DigPath>(path)) continue;
    DigOptions options;
    options.dump_at = dump_at + Eigen::Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
    DigResult result = simulator.dig(ground, std::get<DigPath>(path), options);
    ASSERT_NEAR(result.soil.solids_after, result.soil.solids_before,
                1e-9 * result.soil.solids_before);
    apply(result.patch, ground);
    const double bank = ground.bank.z.sum() * simulator.bank().dry_density;
    const double loose = ground.loose.sum() * simulator.loose().dry_density;
    const double mass = (bank + loose) * 0.01;
    if (!solids) solids = mass;
    ASSERT_NEAR(mass, *solids, 1e-9 * 1e5);  // the map holds some 10^5 kg above its lowest point
    ++digs;
    // Soil that piles up out of reach of the digs is carried back, so that there is always some.
    if (digs % 50 == 0) {
      ground.bank.z += ground.loose * simulator.loose().dry_density / simulator.bank().dry_density;
      ground.loose.setZero();
    }
  }
  EXPECT_GE(ground.loose.minCoeff(), 0.0);
  EXPECT_TRUE(ground.bank.z.allFinite());
}

TEST_F(Validation, ConvergesWithTheGrid) {
  for (const double density : {10.0, 40.0, 80.0}) {
    const DigResult coarse = fixed_dig(density, 0.05);
    const DigResult fine = fixed_dig(density, 0.025);
    const DigResult finest = fixed_dig(density, 0.0125);
    const auto change = [](double a, double b) { return std::abs(a / b - 1.0); };
    EXPECT_LT(change(coarse.payload_mass, fine.payload_mass), 0.03) << density;
    EXPECT_LT(change(fine.payload_mass, finest.payload_mass), 0.015) << density;
    EXPECT_LT(change(coarse.energy.total, fine.energy.total), 0.03) << density;
    EXPECT_LT(change(fine.energy.total, finest.energy.total), 0.015) << density;
    const double k[] = {measured_bulking(density, 0.05), measured_bulking(density, 0.025),
                        measured_bulking(density, 0.0125)};
    EXPECT_LT(change(k[0], k[1]), 0.03) << density;
    EXPECT_LT(change(k[1], k[2]), 0.015) << density;
  }
}

TEST_F(Validation, ConvergesWithTheStep) {
  for (const double density : {10.0, 40.0, 80.0}) {
    const DigResult whole = fixed_dig(density, 0.05, 0.025);
    const DigResult half = fixed_dig(density, 0.05, 0.0125);
    EXPECT_NEAR(whole.payload_mass, half.payload_mass, 0.015 * half.payload_mass) << density;
    EXPECT_NEAR(whole.energy.total, half.energy.total, 0.01 * half.energy.total) << density;
  }
}

// ASABE D497, mouldboard plough, 20 cm, 3-7 km/h, medium soil: 49-63 kJ/m3 (+-50 %); the cutting
// share of a medium loam must be of that order: 30-100 kJ per bank m3.
TEST_F(Validation, CuttingEnergyIsThatOfAPlough) {
  const DigResult result = fixed_dig(40.0, 0.05);
  const double specific = result.energy.soil / 1000.0 / result.soil.bank_cut;
  EXPECT_GT(specific, 30.0);
  EXPECT_LT(specific, 100.0);
}

// Caterpillar, loam: bank 1540, loose 1250 kg/m3; earth 1.20-1.30 (handbook swell factors).
TEST_F(Validation, OrdinaryLoamSwellsAsHandbooksSay) {
  for (const double density : {45.0, 50.0, 60.0}) {
    const double k = bulking_of_density(loam_, density);
    EXPECT_GT(k, 1.20);
    EXPECT_LT(k, 1.30);
  }
}

// The machine's catalogue digging force at the bucket is 99 kN, that of the arm 63 kN: it drives
// the bucket along its floor into all but the hardest soil.
TEST_F(Validation, LipForceStaysBelowTheMachinesDiggingForce) {
  for (const double density : {0.0, 50.0, 90.0}) {
    const DigResult result = fixed_dig(density, 0.05);
    EXPECT_FALSE(result.stall) << density;
    EXPECT_LT(result.peak_force, 99e3);
    EXPECT_GT(result.peak_force, 1e3);
  }
  const DigResult hardest = fixed_dig(100.0, 0.05);
  ASSERT_TRUE(hardest.stall);
  EXPECT_EQ(hardest.stall->joint, Joint::arm);
  EXPECT_GT(hardest.peak_force, 63e3);
}

/// FNV-1a over the bytes of numbers.
class Hash {
 public:
  void add(double value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 1099511628211ULL;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

/// What this machine's C library makes of the functions the simulator calls.
std::uint64_t hash_of_mathematics() {
  Hash hash;
  for (int i = 1; i <= 1000; ++i) {
    const double x = 0.0015 * i;
    for (const double y : {std::sin(x), std::cos(x), std::tan(x), std::exp(x), std::atan2(x, 0.7),
                           std::hypot(x, 0.3), std::acos(0.6 * x), std::asin(0.6 * x)}) {
      hash.add(y);
    }
  }
  return hash.value();
}

// One number for g++ and clang++, -O0 and -O3: no fused multiply-add, no reordered sums.
TEST_F(Validation, SameBytesFromEveryCompilerAndOptimisationLevel) {
  if (hash_of_mathematics() != 0xe221c715684e55b4ULL) {
    GTEST_SKIP() << "this C library rounds otherwise than the one of the golden number: 0x"
                 << std::hex << hash_of_mathematics();
  }
  const DigResult result = fixed_dig(80.0, 0.05);
  Hash hash;
  for (const double z : result.patch.bank.reshaped()) hash.add(z);
  for (const double loose : result.patch.loose.reshaped()) hash.add(loose);
  hash.add(result.payload_mass);
  hash.add(result.energy.total);
  EXPECT_EQ(hash.value(), 0xf1e773fde2ffa617ULL) << "0x" << std::hex << hash.value();
}

// Its path and its density are in the middle of what is drawn from.
TEST_F(Validation, TheScatterOfOneDrawIsTheErrorOfADigInTheMiddle) {
  CalibrationOptions options;
  options.densities_percent = {0.0, 30.0, 60.0, 100.0};
  options.cell_size = 0.2;
  options.draws = 1;
  options.scatter = {0.0, 0.0, 0.0};  // in the very soil
  const DensityCalibration calibration = calibrate_density(machine_, loam_, options);
  SceneOptions middle;
  middle.path = {0.8, 0.4, 1.65};
  const Terrain ground = undisturbed(flat_ground(scene_extent(machine_, middle.dump_at), 0.05));
  const double k =
      run_scene(that_never_stalls(machine_), loam_, 50.0, ground, middle).volumes.bulking_factor;
  for (const char* key : {"line_as_measured", "closed_form_as_measured"}) {
    const DensityForm& form = calibration.form(key);
    EXPECT_NEAR(residual_sd_at(form, 50.0), std::abs(density_of_bulking(form, k) - 50.0), 1e-6)
        << key;
  }
}

// A soil of another site keeps the name of its kind.
TEST_F(Validation, TheUsualLawIsThatOfTheVerySameSoilNotOfTheSameName) {
  SoilKind own = loam_;
  own.void_ratio_loose *= 0.95;
  std::vector<SoilLaw> known(2);
  known[0].soil = loam_;
  known[0].law.name = "of loam";
  known[1].soil = own;
  known[1].law.name = "of its own";
  EXPECT_EQ(usual_law(machine_, loam_, known).name, "of loam");
  EXPECT_EQ(usual_law(machine_, own, known).name, "of its own");
}

}  // namespace
}  // namespace excavplan
