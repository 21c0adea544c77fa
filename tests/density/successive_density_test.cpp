// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/successive_density.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>

#include "base/random.hpp"
#include "base/text.hpp"
#include "support/errors.hpp"
#include "support/soil_digs.hpp"

/// @file
/// The densities of successive digs in one soil, combined.

namespace excavplan {
namespace {

using test::has;

/// On a line without curvature.
RelativeDensity density_of(double percent, double independent_sd, double shared_sd) {
  RelativeDensity density;
  density.percent = density.raw_percent = percent;
  density.sd_given_law_percent = independent_sd;
  set_error(density, std::hypot(independent_sd, shared_sd));
  return density;
}

TEST(SuccessiveDensity, TenDigsAverageTheirMeasurementsButNotTheSoil) {
  const double independent = 6.0, shared = 3.0;
  RelativeDensity known = density_of(40.0, independent, shared);
  for (int dig = 2; dig <= 10; ++dig) {
    const auto both =
        combined(prior_of(known, 0.0), density_of(40.0 + (dig % 2), independent, shared));
    EXPECT_LT(both.density.sd_percent, known.sd_percent);
    EXPECT_NEAR(both.shared_sd_percent, shared, 1e-9);
    known = both.density;
  }
  EXPECT_NEAR(known.sd_given_law_percent, independent / std::sqrt(10.0), 1e-9);
  EXPECT_NEAR(known.percent, 40.4, 1e-9);
  for (int dig = 0; dig < 1000; ++dig) {
    known = combined(prior_of(known, 0.0), density_of(40.0, independent, shared)).density;
  }
  EXPECT_NEAR(known.sd_percent, shared, 0.01);
  EXPECT_GE(known.sd_percent, shared);
}

TEST(SuccessiveDensity, AGroundThatDriftsIsForgotten) {
  const RelativeDensity now = density_of(40.0, 3.0, 2.0);
  const auto near = combined(prior_of(density_of(46.0, 3.0, 2.0), 4.0), now);
  EXPECT_NEAR(near.weight, 9.0 / (9.0 + 9.0 + 16.0), 1e-12);
  EXPECT_NEAR(near.density.percent, 40.0 + 6.0 * near.weight, 1e-9);
  EXPECT_NEAR(near.disagreement, -6.0 / std::sqrt(34.0), 1e-9);
  EXPECT_LT(combined(prior_of(density_of(46.0, 3.0, 2.0), 100.0), now).weight, 0.001);
}

TEST(SuccessiveDensity, DigsThatDisagreeAreNotCombined) {
  const RelativeDensity now = density_of(40.0, 3.0, 2.0);
  const auto apart = combined(prior_of(density_of(70.0, 3.0, 2.0)), now);
  EXPECT_TRUE(apart.disagrees());
  EXPECT_EQ(apart.density.percent, now.percent);
  EXPECT_EQ(apart.density.sd_percent, now.sd_percent);
  EXPECT_FALSE(apart.density.trustworthy);
}

TEST(SuccessiveDensity, APriorDoesNotRestoreTrust) {
  const RelativeDensity above = [] {
    RelativeDensity density = density_of(100.0, 2.0, 2.0);
    density.raw_percent = 107.0;
    set_error(density, std::sqrt(8.0));
    return density;
  }();
  ASSERT_FALSE(above.trustworthy);
  EXPECT_FALSE(combined(prior_of(density_of(98.0, 2.0, 2.0)), above).density.trustworthy);
}

TEST(SuccessiveDensity, RefusesErrorsThatAreNone) {
  const RelativeDensity now = density_of(40.0, 3.0, 2.0);
  EXPECT_THROW(combined(prior_of(now, -1.0), now), Error);
  EXPECT_THROW(combined(prior_of(now, std::nan("")), now), Error);
  EXPECT_THROW(combined({std::nan(""), 1.0, 1.0}, now), Error);
}

/// Ten digs each in drawn soils, surveyed by height maps with noise.
class Successive : public testing::Test {
 protected:
  struct Sums {
    test::Coverage last;      ///< the density after all digs
    test::Coverage alone;     ///< by the last dig alone
    test::Coverage averaged;  ///< as if nothing of their errors were shared

    void print(const std::string& what) const {
      std::cout << "  " << what << ", inside / rms / sd: one dig " << text(alone) << ", all "
                << text(last) << ", taken as independent " << text(averaged) << '\n';
    }
    static std::string text(const test::Coverage& sum) {
      return readable(100.0 * sum.share(), 3) + " % / " + readable(sum.rms(), 3) + " / " +
             readable(sum.mean_sd(), 3);
    }
  };

  /// One density and one soil for all digs of a run: what differs is the noise of the surveys.
  Sums runs(const SoilLaw& kind, int count, double volume_error) const {
    constexpr int digs = 10;
    Sums sums;
    for (int run = 0; run < count; ++run) {
      Random random(static_cast<std::uint64_t>(run), 5);
      const SoilKind soil = drawn_soil(kind.soil, {}, random.bits());
      const double truth = random.uniform(10.0, 90.0);
      const auto volumes = run_scene(digger_, soil, truth, ground_).volumes;
      DensityOptions options;
      options.soil.kind = kind.soil;
      DensityOptions naive = options;
      for (int dig = 1; dig <= digs; ++dig) {
        const auto change = test::measured(volumes, volume_error, random);
        const auto all = test::estimate_of(change, kind.law, options);
        const auto averaged = test::estimate_of(change, kind.law, naive);
        options.prior = prior_of(*all.density, 0.0);
        options.prior->trustworthy = all.trustworthy;
        naive.prior = PriorDensity{averaged.density->raw_percent, averaged.density->sd_percent};
        naive.prior->drift_sd_percent = 0.0;
        if (dig < digs) continue;
        sums.last.add(*all.density, truth);
        sums.alone.add(all.successive ? all.successive->this_dig : *all.density, truth);
        sums.averaged.add(*averaged.density, truth);
      }
    }
    return sums;
  }

  /// That of digs along the fixed path.
  SoilLaw law_of_path(const SoilKind& soil) const {
    return {soil, law_of(calibrate_path(machine_, soil, paper_fixed_path())), 1.0};
  }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const Machine digger_ = that_never_stalls(machine_);
  const SoilKind loam_ = load_soil(find_data_file("soils/loam.json"));
  const Terrain ground_ =
      undisturbed(flat_ground(scene_extent(machine_, default_dump_point()), 0.05));
};

TEST_F(Successive, IntervalsHoldTheTruthAsOftenAsTheyState) {
  const SoilLaw loam = law_of_path(loam_);
  for (const double volume_error : {0.005, 0.02}) {
    const Sums sums = runs(loam, 200, volume_error);
    sums.print("volumes to " + readable(100.0 * volume_error, 2) + " %");
    EXPECT_GE(sums.last.share(), 0.90);
    EXPECT_LE(sums.last.share(), 0.99);
    EXPECT_LT(sums.last.rms(), sums.alone.rms());
    EXPECT_LT(sums.last.mean_sd(), sums.alone.mean_sd());
    EXPECT_LT(sums.averaged.share(), 0.85);
  }
}

TEST_F(Successive, AnUntrustedPriorIsLeftOutWithAWarning) {
  test::SoilDigOptions dug;
  dug.density_percent = 40.0;
  const auto change = test::random_dig(machine_, loam_, 3, dug).change;
  const DensityLaw law = load_density_law(find_data_file("laws/zx120-loam.json"));
  DensityOptions options;
  options.soil.kind = loam_;
  const auto alone = test::estimate_of(change, law, options);
  options.prior = PriorDensity{alone.density->raw_percent + 5.0, 1.0, 2.0, 3.0, false};
  const auto estimate = test::estimate_of(change, law, options);
  EXPECT_FALSE(estimate.successive);
  EXPECT_TRUE(estimate.trustworthy);
  EXPECT_TRUE(has(estimate.warnings, "prior_not_trustworthy"));
  EXPECT_EQ(estimate.density->percent, alone.density->percent);
  options.prior->trustworthy = true;
  const auto joined = test::estimate_of(change, law, options);
  EXPECT_GT(joined.density->percent, alone.density->percent);
  options.prior->raw_percent += 40.0;
  const auto apart = test::estimate_of(change, law, options);
  EXPECT_TRUE(has(apart.warnings, "prior_disagrees"));
  EXPECT_FALSE(apart.trustworthy);
}

}  // namespace
}  // namespace excavplan
