// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/soil/density_fit.hpp>
#include <excavplan/soil/soil_scatter.hpp>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "support/cases.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

/// Any soil that load_soil() would take.
SoilKind any_soil(Random& random) {
  SoilKind soil;
  soil.name = "any";
  soil.specific_gravity = random.uniform(2.4, 2.9);
  soil.void_ratio_min = random.uniform(0.2, 0.8);
  soil.water_content = random.uniform(0.0, soil.void_ratio_min / soil.specific_gravity);
  soil.void_ratio_max = soil.void_ratio_min + random.uniform(0.1, 1.0);
  soil.void_ratio_loose = random.uniform(soil.void_ratio_min, soil.void_ratio_max);
  soil.cohesion_loosest = random.uniform(0.0, 2e4);
  soil.cohesion_growth = random.uniform(0.0, 3.0);
  soil.friction_loosest = random.uniform(0.1, 0.6);
  soil.friction_gain = random.uniform(0.0, 0.3);
  soil.tool_friction_ratio = random.uniform(0.1, 1.0);
  soil.adhesion_ratio = random.uniform(0.0, 1.0);
  soil.angle_of_repose = random.uniform(0.3, 0.7);
  soil.cone_index_reference = random.uniform(1e5, 2e6);
  soil.cone_index_rate = random.uniform(0.0, 0.02);
  soil.cone_index_reference_density = 1500.0;
  return soil;
}

/// Any law of this form that a file may hold and a soil may have.
DensityForm any_form(Random& random) {
  if (random.uniform() < 0.5) {
    DensityLine line;
    line.a = random.uniform(50.0, 1000.0);
    line.b = -line.a * random.uniform(0.8, 1.3);
    line.residual_sd = random.uniform(0.0, 10.0);
    line.residual_growth = random.uniform(-1.0, 1.0);
    return line;
  }
  DensityClosedForm form;
  form.A = random.uniform(0.5, 1.2);
  form.B = random.uniform(-0.2, 0.2);
  form.r = random.uniform(0.05, 0.7);
  form.residual_sd = random.uniform(0.0, 10.0);
  form.residual_growth = random.uniform(-1.0, 1.0);
  return form;
}

TEST(SoilProperties, LawsAreInverseAndRise) {
  for_cases([](Random& random) {
    const DensityForm form = any_form(random);
    const double d = random.uniform(-50.0, 130.0);
    const double k = bulking_of_density(form, d);
    EXPECT_NEAR(density_of_bulking(form, k), d, 1e-7);
    EXPECT_NEAR(bulking_of_density(form, density_of_bulking(form, k)), k, 1e-9);
    EXPECT_GT(density_of_bulking(form, k + 1e-3), density_of_bulking(form, k));
    EXPECT_GT(bulking_of_density(form, d + 1.0), k);
  });
}

TEST(SoilProperties, SlopesOfLawsAreTheirDerivatives) {
  for_cases([](Random& random) {
    const DensityForm form = any_form(random);
    const double k = bulking_of_density(form, random.uniform(0.0, 100.0));
    constexpr double h = 1e-5;
    const double difference =
        (density_of_bulking(form, k + h) - density_of_bulking(form, k - h)) / (2.0 * h);
    EXPECT_NEAR(density_slope(form, k) / difference, 1.0, 1e-5);
  });
}

/// Below k = B the closed form has no density: it ends at -1000 %, however small the factor.
TEST(SoilProperties, LawsOfAnyFactorAreFiniteAndNeverFall) {
  for_cases([](Random& random) {
    DensityForm form = any_form(random);
    if (auto* closed = std::get_if<DensityClosedForm>(&form)) closed->B = random.uniform(0.0, 2.0);
    const double k = random.uniform(1e-6, 3.0);
    const double d = density_of_bulking(form, k);
    EXPECT_TRUE(std::isfinite(d));
    if (std::holds_alternative<DensityClosedForm>(form)) {
      EXPECT_GE(d, -1000.0 - 1e-6);
    }
    EXPECT_GE(density_of_bulking(form, k + 0.01), d);
    EXPECT_GT(density_slope(form, k), 0.0);
  });
}

TEST(SoilProperties, AnEstimateContainsItselfAndStaysInRange) {
  for_cases([](Random& random) {
    DensityLaw law;
    law.form = law.freed_form = any_form(random);
    const Measured k{random.uniform(0.5, 2.5), random.uniform(0.0, 0.2)};
    const RelativeDensity estimate = relative_density(law, k);
    const auto [low, high] = estimate.interval_percent;
    EXPECT_TRUE(0.0 <= low && low <= estimate.percent);
    EXPECT_TRUE(estimate.percent <= high && high <= 100.0);
    const double excess = std::abs(estimate.raw_percent - estimate.percent);
    EXPECT_GE(estimate.sd_percent, excess);
    if (excess == 0.0) {
      EXPECT_TRUE(estimate.trustworthy);
    }
    EXPECT_EQ(estimate.warnings.empty(), excess == 0.0);
    // a scan that says less never makes the estimate surer
    EXPECT_GE(relative_density(law, {k.value, 2.0 * k.sd}).sd_percent, estimate.sd_percent);
  });
}

/// Of the bank and of loose soil the same solids: k is the ratio of their dry densities.
TEST(SoilProperties, BulkingConservesSolids) {
  for_cases([](Random& random) {
    const SoilKind soil = any_soil(random);
    const double d = random.uniform(0.0, 100.0);
    const SoilState bank = bank_state(soil, d);
    const double k = bulking_of_density(soil, d);
    EXPECT_NEAR(k * loose_state(soil).dry_density / bank.dry_density, 1.0, 1e-12);
    EXPECT_NEAR(density_of_bulking(density_law_of(soil).form, k), d, 1e-8);
    EXPECT_NEAR(density_of_bulk_density(soil, bank.bulk_density), d, 1e-9);
  });
}

/// Solids, water and air of a cubic metre add up: rho = (1 - n) G_s rho_w + S n rho_w.
TEST(SoilProperties, StatesFillACubicMetre) {
  for_cases([](Random& random) {
    const SoilKind soil = any_soil(random);
    const SoilState state = bank_state(soil, random.uniform(0.0, 100.0));
    const double porosity = state.void_ratio / (1.0 + state.void_ratio);
    const double solids = (1.0 - porosity) * soil.specific_gravity * water_density;
    const double water = state.saturation * porosity * water_density;
    EXPECT_NEAR(state.dry_density, solids, 1e-9);
    EXPECT_NEAR(state.bulk_density, solids + water, 1e-9);
    EXPECT_NEAR(state.unit_weight, gravity * (solids + water), 1e-8);
  });
}

TEST(SoilProperties, DenserSoilIsStrongerAndHeavier) {
  for_cases([](Random& random) {
    const SoilKind soil = any_soil(random);
    const double d = random.uniform(0.0, 99.0);
    const SoilState a = bank_state(soil, d);
    const SoilState b = bank_state(soil, d + 1.0);
    EXPECT_GT(b.bulk_density, a.bulk_density);
    EXPECT_GE(b.cohesion, a.cohesion);
    EXPECT_GE(b.friction_angle, a.friction_angle);
    EXPECT_GE(cone_index(soil, b, 0.2), cone_index(soil, a, 0.2));
    EXPECT_NEAR(bank_state_of_void_ratio(soil, a.void_ratio).relative_density, d / 100.0, 1e-12);
  });
}

/// Void ratios of peat are accepted, those above 20 are not (docs/formats.md).
TEST(SoilProperties, VoidRatiosMayBeLarge) {
  const TemporaryFolder folder;
  nlohmann::json file = nlohmann::json::parse(content_of(find_data_file("soils/loam.json")));
  for (const double largest : {2.5, 9.0, 19.9, 20.1}) {
    file["void_ratio_max"] = largest;
    file["void_ratio_loose"] = largest;
    const std::string path = folder.write("soil" + std::to_string(largest), file.dump());
    if (largest > 20.0) {
      EXPECT_THROW(load_soil(path), Error);
    } else {
      EXPECT_EQ(load_soil(path).void_ratio_loose, largest);
    }
  }
}

TEST(SoilProperties, DrawnSoilsAreSoils) {
  for_cases([](Random& random) {
    const SoilKind soil = any_soil(random);
    const std::uint64_t seed = random.bits();
    const SoilKind drawn = drawn_soil(soil, {}, seed);
    EXPECT_TRUE(0.0 < drawn.void_ratio_min && drawn.void_ratio_min < drawn.void_ratio_max);
    EXPECT_TRUE(drawn.void_ratio_min <= drawn.void_ratio_loose &&
                drawn.void_ratio_loose <= drawn.void_ratio_max);
    EXPECT_TRUE(drawn.water_content >= 0.0 && bank_state(drawn, 100.0).saturation <= 1.0 + 1e-12);
    EXPECT_EQ(fingerprint(drawn), fingerprint(drawn_soil(soil, {}, seed)));
  });
}

/// Over many sites each dry density scatters as stated, and the loose one with that at e_max.
TEST(SoilProperties, DrawnSoilsScatterAsStated) {
  SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  soil.specific_gravity = 2.65;
  soil.water_content = 0.05;
  soil.void_ratio_min = 0.4;
  soil.void_ratio_max = 1.2;
  soil.void_ratio_loose = 0.8;
  const SoilScatter scatter;
  constexpr int draws = 10000;
  Eigen::Array4d squares = Eigen::Array4d::Zero();
  for (std::uint64_t seed = 0; seed < draws; ++seed) {
    const SoilKind drawn = drawn_soil(soil, scatter, seed);
    const auto ratio = [](double before, double after) { return (1 + before) / (1 + after) - 1; };
    const double loosest = ratio(soil.void_ratio_max, drawn.void_ratio_max);
    const double loose = ratio(soil.void_ratio_loose, drawn.void_ratio_loose);
    squares += Eigen::Array4d(loosest, ratio(soil.void_ratio_min, drawn.void_ratio_min),
                              (1 + loose) / (1 + loosest) - 1,
                              drawn.water_content / soil.water_content - 1)
                   .square();
  }
  const Eigen::Array4d stated(scatter.limit_density, scatter.limit_density, scatter.loose_density,
                              scatter.water_content);
  // the standard error of a deviation from 10^4 draws is 0.7 %
  EXPECT_LT(((squares / draws).sqrt() / stated - 1.0).abs().maxCoeff(), 0.03);
}

/// What the law file's digs follow exactly is found again.
TEST(SoilProperties, FitsFindTheLawOfExactDigs) {
  for_cases(
      [](Random& random) {
        const DensityForm form = any_form(random);
        std::vector<BulkingSample> samples;
        for (double d = 0.0; d <= 100.0; d += 12.5) {
          samples.push_back({bulking_of_density(form, d), d});
        }
        if (samples.front().bulking_factor <= 0.0) return;
        const bool is_line = std::holds_alternative<DensityLine>(form);
        const DensityForm fit =
            is_line ? DensityForm(fit_line(samples)) : DensityForm(fit_closed_form(samples));
        for (const BulkingSample& sample : samples) {
          EXPECT_NEAR(density_of_bulking(fit, sample.bulking_factor), sample.density_percent, 0.01);
        }
      },
      1000);
}

/// Also a line that hardly rises is one.
TEST(SoilProperties, FitsOfShallowLinesAreFound) {
  for_cases([](Random& random) {
    const double slope = random.uniform(0.01, 2.0);
    std::vector<BulkingSample> samples;
    for (double k = 1.0; k < 2.0; k += 0.2) samples.push_back({k, 50.0 + slope * (k - 1.5)});
    EXPECT_NEAR(fit_line(samples).a, slope, 1e-9);
    for (BulkingSample& sample : samples) sample.density_percent = 100.0 - sample.density_percent;
    EXPECT_THROW(fit_line(samples), Error);
  });
}

/// k = after / before by propagation of errors, with the covariance, against a small change of it.
TEST(SoilProperties, TheErrorOfABulkingFactorIsThatOfItsVolumes) {
  for_cases([](Random& random) {
    VolumeChange change;
    change.before = {random.uniform(0.1, 1.0), 0.0};
    change.after = {random.uniform(0.1, 2.0), 0.0};
    change.before.sd = change.before.value * random.uniform(0.0, 0.1);
    change.after.sd = change.after.value * random.uniform(0.0, 0.1);
    const double correlation = random.uniform(-0.99, 0.99);
    change.covariance_before_after = correlation * change.before.sd * change.after.sd;
    const auto k = [&](double before, double after) {
      return (change.after.value + after) / (change.before.value + before);
    };
    constexpr double h = 1e-6;
    const double by_before = (k(h, 0.0) - k(-h, 0.0)) / (2.0 * h) * change.before.sd;
    const double by_after = (k(0.0, h) - k(0.0, -h)) / (2.0 * h) * change.after.sd;
    const double variance =
        by_before * by_before + by_after * by_after + 2.0 * correlation * by_before * by_after;
    const auto found = bulking_factor(change);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->value, k(0.0, 0.0), 1e-12);
    EXPECT_NEAR(found->sd, std::sqrt(variance), 1e-6);
  });
}

TEST(SoilProperties, FallbackIsTakenOutByTheBalanceOfVolumes) {
  for_cases([](Random& random) {
    // a cut of 1 m^3 swells by k; the share f of the cut refills, so that the hole seems smaller
    const double k = random.uniform(1.0, 1.8);
    const double f = random.uniform(0.0, 0.5);
    const double hole = 1.0 - f;
    const double heap = k - f;
    EXPECT_NEAR(free_of_fallback(heap / hole, f), k, 1e-12);
  });
}

}  // namespace
}  // namespace excavplan::test
