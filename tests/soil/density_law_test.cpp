// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/density_law.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/soil/soil.hpp>
#include "base/random.hpp"

#include "support/errors.hpp"

namespace excavplan {
namespace {

constexpr double paper_r = 0.384739;
constexpr double paper_k0 = 0.992619;

DensityLine paper_line() { return {161.57, -152.87, 0.9811, 0.0}; }
DensityClosedForm paper_closed_form() { return {paper_k0, 0.0, paper_r, 1.0, 0.0}; }

DensityLaw law_of(const DensityForm& form) { return {"test", "test", form}; }

/// k = B + A / (1 - r d) at d = 0, 5 .. 100 %, with noise of k.
std::vector<BulkingSample> hyperbola(const DensityClosedForm& form, double noise = 0.0,
                                     std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<BulkingSample> samples;
  for (int d = 0; d <= 100; d += 5) {
    const double k = form.B + form.A / (1.0 - form.r * d / 100.0);
    samples.push_back({k + noise * random.normal(), static_cast<double>(d)});
  }
  return samples;
}

std::string message_of(const std::vector<BulkingSample>& samples, bool line) {
  return test::error_of([&] {
    if (line) {
      fit_line(samples);
    } else {
      fit_closed_form(samples);
    }
  });
}

TEST(DensityFit, LineThroughTheHyperbolaIsThePublishedOne) {
  const DensityLine line = fit_line(hyperbola(paper_closed_form()));
  EXPECT_NEAR(line.a, 161.570, 0.001);
  EXPECT_NEAR(line.b, -152.870, 0.001);
  EXPECT_NEAR(line.r2, 0.98294, 5e-6);
  EXPECT_NEAR(line.residual_sd, 30.2765 * std::sqrt((1.0 - line.r2) * 21.0 / 19.0), 1e-3);
}

TEST(DensityFit, PublishedLineWithCloddySoilKeepsAllThreePublishedFigures) {
  const DensityLine line = fit_line(hyperbola({0.930, 0.065, 0.4004, 0.0, 0.0}));
  EXPECT_NEAR(line.a, 161.57, 0.2);  // the three constants are published to three digits
  EXPECT_NEAR(line.b, -152.87, 0.3);
  EXPECT_NEAR(line.r2, 0.9811, 1e-4);
}

TEST(DensityFit, ClosedFormRecoversExactHyperbolas) {
  for (const double B : {-0.2, 0.0, 0.065, 0.3}) {
    for (const double r : {0.05, 0.2, paper_r, 0.6, 0.9}) {
      SCOPED_TRACE("B " + std::to_string(B) + ", r " + std::to_string(r));
      const DensityClosedForm fit = fit_closed_form(hyperbola({paper_k0, B, r, 0.0, 0.0}));
      EXPECT_NEAR(fit.r, r, 1e-6);
      EXPECT_NEAR(fit.A, paper_k0, 1e-6 / r);
      EXPECT_NEAR(fit.B, B, 1e-6 / r);
      EXPECT_NEAR(fit.r2, 1.0, 1e-9);
      EXPECT_NEAR(fit.residual_sd, 0.0, 1e-5);
    }
  }
}

TEST(DensityFit, ClosedFormExplainsNoisyDigsBetterThanTheLine) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<BulkingSample> samples = hyperbola(paper_closed_form(), 0.008, seed);
    const DensityClosedForm closed = fit_closed_form(samples);
    const DensityLine line = fit_line(samples);
    EXPECT_GT(closed.r2, line.r2);
    EXPECT_LT(closed.residual_sd, 2.5);
    EXPECT_GT(line.residual_sd, 3.0);
    EXPECT_NEAR(density_of_bulking(closed, 1.229), 50.0, 3.0);
  }
}

TEST(DensityFit, SamplesThatCannotFitAreRefused) {
  EXPECT_EQ(message_of({{1.0, 0.0}, {1.1, 20.0}, {1.1, 30.0}}, true),
            "a density line needs samples of at least 3 different bulking factors");
  EXPECT_EQ(message_of({{1.0, 0.0}, {1.1, 20.0}, {1.3, 60.0}, {1.4, 60.0}}, false),
            "a closed density law needs samples of at least 4 different densities, there are 3");
  const std::vector<BulkingSample> falling = {{1.6, 0.0}, {1.4, 30.0}, {1.2, 60.0}, {1.0, 100.0}};
  EXPECT_NE(message_of(falling, true).find("must grow with density"), std::string::npos);
  EXPECT_NE(message_of(falling, false).find("must grow with density"), std::string::npos);
  EXPECT_EQ(message_of({{1.0, 0.0}, {-1.0, 20.0}, {1.2, 30.0}}, true),
            "sample 2: bulking factor -1 at 20 %; the factor must be above 0 and at most 1000, the "
            "density in 0 .. 100 %");
  EXPECT_NE(message_of({{1.0, 0.0}, {1e300, 50.0}, {1e308, 100.0}}, true).find("factor 1e+300 at"),
            std::string::npos);
  EXPECT_NE(message_of({{1.0, 0.0}, {1.1, 101.0}}, false).find("at 101 %"), std::string::npos);
  EXPECT_NE(message_of({{std::nan(""), 0.0}}, true).find("sample 1"), std::string::npos);
}

TEST(DensityForm, EachDirectionUndoesTheOther) {
  for (const DensityForm& form : {DensityForm(paper_line()), DensityForm(paper_closed_form()),
                                  DensityForm(DensityClosedForm{0.93, 0.065, 0.4004, 0.0, 0.0})}) {
    for (int d = -20; d <= 150; d += 5) {
      const double k = bulking_of_density(form, d);
      EXPECT_NEAR(density_of_bulking(form, k), d, 1e-10);
      constexpr double step = 1e-6;
      const double slope =
          (density_of_bulking(form, k + step) - density_of_bulking(form, k - step)) / (2.0 * step);
      EXPECT_NEAR(density_slope(form, k), slope, 1e-5 * slope);
    }
  }
}

TEST(DensityForm, LineMissesTheHyperbolaByTheKnownErrors) {
  const auto line_error = [](double d) {
    return density_of_bulking(paper_line(), bulking_of_density(paper_closed_form(), d)) - d;
  };
  EXPECT_NEAR(line_error(0.0), 7.5, 0.05);
  EXPECT_NEAR(line_error(10.0), 3.9, 0.05);
  EXPECT_NEAR(line_error(40.0), -3.3, 0.05);
  EXPECT_NEAR(line_error(55.0), -4.45, 0.01);
  EXPECT_NEAR(line_error(80.0), -1.2, 0.05);
  EXPECT_NEAR(line_error(100.0), 7.8, 0.05);
}

TEST(DensityForm, ClosedFormAgreesWithTheDefaultLoam) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  for (int d = 0; d <= 100; d += 10) {
    EXPECT_NEAR(bulking_of_density(paper_closed_form(), d), bulking_of_density(loam, d), 2e-4);
  }
}

TEST(DensityLaw, OfASoilIsWhatConservationOfSolidsGives) {
  const SoilKind clay = load_soil(find_data_file("soils/clay.json"));
  const DensityLaw law = density_law_of(clay);
  EXPECT_EQ(law.soil, clay.name);
  for (int d = 0; d <= 100; d += 20) {
    const double k = bulking_of_density(clay, d);
    EXPECT_NEAR(density_of_bulking(law.form, k), d, 1e-9);
    EXPECT_NEAR(density_of_bulking(law.freed_form, k), d, 1e-9);
  }
  const RelativeDensity found = relative_density(law, {bulking_of_density(clay, 50.0), 0.01});
  EXPECT_NEAR(found.sd_percent, 0.01 * density_slope(law.form, bulking_of_density(clay, 50.0)),
              1e-12);
}

TEST(DensityForm, ClosedFormStaysFiniteWhereItHasNoDensity) {
  const DensityClosedForm form{0.93, 0.5, 0.4, 0.0, 0.0};
  for (const double k : {0.5, 0.4, 1e-300}) {
    EXPECT_NEAR(density_of_bulking(form, k), -1000.0, 1e-9);
    EXPECT_TRUE(std::isfinite(density_slope(form, k)));
  }
  EXPECT_THROW(bulking_of_density(form, 250.0), Error);
  EXPECT_NO_THROW(bulking_of_density(form, 249.0));
}

struct FivePointRow {
  double d, k, line_error_percent, closed_error_percent;
};

/// Error of k that makes an error of 5 points in d (docs/methods.md#density-law).
const FivePointRow five_points[] = {{0, 0.993, 3.12, 1.92},
                                    {25, 1.098, 2.82, 2.13},
                                    {50, 1.229, 2.52, 2.38},
                                    {80, 1.434, 2.16, 2.78},
                                    {100, 1.613, 1.92, 3.13}};

TEST(RelativeDensity, ErrorOfTheFactorBecomesTheKnownErrorOfDensity) {
  for (const FivePointRow& row : five_points) {
    SCOPED_TRACE(row.d);
    const Measured for_line{row.k, row.k * row.line_error_percent / 100.0};
    EXPECT_NEAR(relative_density(law_of(paper_line()), for_line).sd_given_law_percent, 5.0, 0.03);
    const Measured for_closed{row.k, row.k * row.closed_error_percent / 100.0};
    const RelativeDensity closed = relative_density(law_of(paper_closed_form()), for_closed);
    EXPECT_NEAR(closed.sd_given_law_percent, 5.0, 0.03);
    EXPECT_NEAR(closed.raw_percent, row.d, 0.15);
  }
}

TEST(RelativeDensity, ScatterOfTheLawAddsInSquare) {
  DensityLine line = paper_line();
  line.residual_sd = 4.2;
  const RelativeDensity estimate = relative_density(law_of(line), {1.25, 0.01});
  EXPECT_NEAR(estimate.sd_percent, std::hypot(1.6157, 4.2), 1e-9);
  EXPECT_NEAR(estimate.percent, 161.57 * 1.25 - 152.87, 1e-9);
  EXPECT_EQ(estimate.percent, estimate.raw_percent);
  EXPECT_NEAR(estimate.interval_percent[0], estimate.percent - 1.96 * estimate.sd_percent, 1e-9);
  EXPECT_NEAR(estimate.interval_percent[1], estimate.percent + 1.96 * estimate.sd_percent, 1e-9);
  EXPECT_TRUE(estimate.trustworthy);
  EXPECT_TRUE(estimate.warnings.empty());
}

TEST(RelativeDensity, AboveTheRangeIsClampedAndWarned) {
  // Table 5 of the paper: hard soil came out above 100 %.
  const RelativeDensity estimate = relative_density(law_of(paper_line()), {1.75, 0.01});
  EXPECT_EQ(estimate.percent, 100.0);
  EXPECT_NEAR(estimate.raw_percent, 129.8775, 1e-9);
  // One-sided, and as wide as the law is off.
  EXPECT_EQ(estimate.interval_percent[1], 100.0);
  EXPECT_NEAR(estimate.sd_percent, std::hypot(29.8775, 1.6157), 1e-9);
  EXPECT_NEAR(estimate.interval_percent[0], 100.0 - 1.96 * estimate.sd_percent, 1e-9);
  EXPECT_FALSE(estimate.trustworthy);
  ASSERT_EQ(estimate.warnings.size(), 1u);
  EXPECT_EQ(estimate.warnings[0].code, WarningCode::density_above_range);
  EXPECT_NE(estimate.warnings[0].message.find("129.9 %"), std::string::npos);
  EXPECT_NE(estimate.warnings[0].message.find("blocks"), std::string::npos);
  EXPECT_NE(estimate.warnings[0].message.find("fell back"), std::string::npos);
}

TEST(RelativeDensity, BelowTheRangeIsClampedAndWarned) {
  const RelativeDensity estimate = relative_density(law_of(paper_closed_form()), {0.9, 0.01});
  EXPECT_EQ(estimate.percent, 0.0);
  EXPECT_LT(estimate.raw_percent, -20.0);
  EXPECT_FALSE(estimate.trustworthy);
  ASSERT_EQ(estimate.warnings.size(), 1u);
  EXPECT_EQ(estimate.warnings[0].code, WarningCode::density_below_range);
}

TEST(RelativeDensity, OutsideTheRangeByLessThanItsErrorIsTrusted) {
  const RelativeDensity estimate = relative_density(law_of(paper_line()), {1.59, 0.03});
  EXPECT_GT(estimate.raw_percent, 100.0);
  EXPECT_EQ(estimate.percent, 100.0);
  EXPECT_TRUE(estimate.trustworthy);
  EXPECT_EQ(estimate.warnings.size(), 1u);
  EXPECT_LT(estimate.interval_percent[0], 100.0);
}

TEST(RelativeDensity, IntervalHoldsTheTruthAsOftenAsItSays) {
  const DensityLaw law = law_of(paper_closed_form());
  Random random(7);
  int inside = 0;
  constexpr int trials = 2000;
  for (int i = 0; i < trials; ++i) {
    const double d = random.uniform(20.0, 80.0);
    const double k = bulking_of_density(law.form, d);
    const RelativeDensity estimate = relative_density(law, {k + 0.01 * random.normal(), 0.01});
    inside += estimate.interval_percent[0] <= d && d <= estimate.interval_percent[1] ? 1 : 0;
  }
  EXPECT_NEAR(inside / static_cast<double>(trials), 0.95, 0.015);
}

TEST(RelativeDensity, ImpossibleFactorsAreRefused) {
  const DensityLaw law = law_of(paper_line());
  EXPECT_THROW(relative_density(law, {0.0, 0.1}), Error);
  EXPECT_THROW(relative_density(law, {-1.0, 0.1}), Error);
  EXPECT_THROW(relative_density(law, {std::nan(""), 0.1}), Error);
  EXPECT_THROW(relative_density(law, {INFINITY, 0.1}), Error);
  EXPECT_THROW(relative_density(law, {1.2, std::nan("")}), Error);
  EXPECT_THROW(relative_density(law, {1.2, -0.1}), Error);
}

class LawFile : public testing::Test {
 protected:
  LawFile() : path_(testing::TempDir() + "excavplan_law_" + std::to_string(::getpid()) + ".json") {}
  ~LawFile() override { std::remove(path_.c_str()); }

  DensityLaw load(const std::string& text) const {
    std::ofstream(path_) << text;
    return load_density_law(path_);
  }
  std::string message(std::string text, const std::string& from, const std::string& to) const {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "no " + from + " in the file";
    return test::error_about([&] { load(text.replace(at, from.size(), to)); }, path_);
  }
  static DensityCalibration calibration() {
    DensityCalibration made;
    made.name = "loam";
    made.source = "test";
    made.use = "closed_form_as_measured";
    made.forms = {{"line", DensityLine{160.0, -150.0, 0.98, 4.0}},
                  {"closed_form", DensityClosedForm{1.0 / 3.0, 0.1, 0.4, 0.999, 0.5}},
                  {"closed_form_as_measured", DensityClosedForm{0.9, -0.1, 0.41, 0.998, 0.75}}};
    made.samples.push_back({50.0, 1.23, 1.25, 1.22, 0.08});
    return made;
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST_F(LawFile, PaperLawIsShippedAsPublished) {
  const DensityLaw law = load_density_law(find_data_file("laws/paper.json"));
  EXPECT_EQ(law.name, "paper");
  const auto line = std::get<DensityLine>(law.form);
  EXPECT_EQ(line.a, 161.57);
  EXPECT_EQ(line.b, -152.87);
  EXPECT_EQ(line.r2, 0.9811);
  EXPECT_NEAR(line.residual_sd, 30.2765 * std::sqrt(1.0 - 0.9811), 0.05);
  EXPECT_EQ(std::get<DensityLine>(law.freed_form).a, 161.57);  // it has no other
}

TEST_F(LawFile, AFormAsMeasuredHasItsFreedTwin) {
  const DensityLaw law = load(to_json(calibration()));
  EXPECT_EQ(std::get<DensityClosedForm>(law.form).B, -0.1);
  EXPECT_EQ(std::get<DensityClosedForm>(law.freed_form).B, 0.1);
}

TEST_F(LawFile, WhatIsWrittenIsReadBack) {
  DensityCalibration made = calibration();
  const auto measured = std::get<DensityClosedForm>(load(to_json(made)).form);
  EXPECT_EQ(measured.B, -0.1);
  EXPECT_EQ(measured.residual_sd, 0.75);
  made.use = "closed_form";
  EXPECT_EQ(std::get<DensityClosedForm>(load(to_json(made)).form).A, 1.0 / 3.0);
  made.use = "line";
  EXPECT_EQ(std::get<DensityLine>(load(to_json(made)).form).a, 160.0);
}

TEST_F(LawFile, WhatItWasMeasuredOnIsReadBack) {
  DensityCalibration made = calibration();
  EXPECT_FALSE(load(to_json(made)).path);  // files without these keys are read too
  made.soil = "loam";
  made.machine = "zx120";
  made.simulator = "height-map 4";
  made.path = {1.0, 0.5, 2.5};
  made.any_path = true;
  std::get<DensityClosedForm>(made.forms[2].form).residual_growth = 0.5;
  for (const DensityLaw& law : {load(to_json(made)), excavplan::law_of(made)}) {
    EXPECT_EQ(law.soil, "loam");
    EXPECT_EQ(law.machine, "zx120");
    EXPECT_EQ(law.simulator, "height-map 4");
    EXPECT_EQ(law.path, made.path);
    EXPECT_TRUE(law.any_path);
    EXPECT_NEAR(residual_sd_at(law.form, 50.0), 0.75, 1e-12);
    EXPECT_NEAR(residual_sd_at(law.form, 0.0), 0.375, 1e-12);
    EXPECT_NEAR(residual_sd_at(law.form, 130.0), 1.125, 1e-12);
  }
}

/// Digs whose density by this law errs by a deviation that is linear in the density.
std::vector<BulkingSample> scattered(const DensityClosedForm& exact, double at_0, double at_100) {
  Random random(5);
  std::vector<BulkingSample> digs;
  for (int i = 0; i < 8000; ++i) {
    const double d = random.uniform(0.0, 100.0);
    const double error = (at_0 + (at_100 - at_0) * d / 100.0) * random.normal();
    digs.push_back({bulking_of_density(exact, d + error), d});
  }
  return digs;
}

TEST(DensityFit, ScatterIsThatOfTheDigsAndGrowsWithThem) {
  const DensityClosedForm exact = paper_closed_form();
  for (const auto& [at_0, at_100] : {std::pair{3.0, 6.0}, {1.0, 8.0}, {6.0, 2.0}, {4.0, 4.0}}) {
    SCOPED_TRACE(at_0);
    DensityForm form = exact;
    set_scatter(form, scattered(exact, at_0, at_100));
    EXPECT_NEAR(residual_sd_at(form, 50.0), 0.5 * (at_0 + at_100), 0.15);
    EXPECT_NEAR(residual_sd_at(form, 0.0), at_0, 0.3);
    EXPECT_NEAR(residual_sd_at(form, 100.0), at_100, 0.3);
  }
}

TEST(DensityFit, ScatterIsNowhereBelowZero) {
  const DensityClosedForm exact = paper_closed_form();
  std::vector<BulkingSample> digs;
  for (const double d : {10.0, 20.0, 60.0, 70.0, 80.0, 90.0}) {
    digs.push_back({bulking_of_density(exact, d < 50.0 ? d : d + 5.0), d});
  }
  DensityForm form = exact;
  set_scatter(form, digs);
  EXPECT_EQ(residual_sd_at(form, 0.0), 0.0);
  double square = 0.0;
  for (int d = 0; d < 100; ++d) square += std::pow(residual_sd_at(form, d + 0.5), 2) / 100.0;
  EXPECT_NEAR(square, 25.0 * 4.0 / 6.0, 0.01) << "the mean square is that of the digs";
}

TEST_F(LawFile, EveryFormIsFittedWrittenAndReadUnderItsKey) {
  const auto samples = hyperbola(paper_closed_form(), 0.008);
  DensityCalibration made = calibration();
  made.forms = fit_density_forms(samples, "_as_measured");
  ASSERT_EQ(made.forms.size(), std::variant_size_v<DensityForm>);
  EXPECT_EQ(std::get<DensityLine>(made.form("line_as_measured")).a, fit_line(samples).a);
  EXPECT_EQ(std::get<DensityClosedForm>(made.form("closed_form_as_measured")).r,
            fit_closed_form(samples).r);
  EXPECT_THROW(made.form("line"), Error);
  for (const DensityFit& fit : made.forms) {
    made.use = fit.key;
    const DensityForm read = load(to_json(made)).form;
    EXPECT_EQ(formula(read), formula(fit.form));
    EXPECT_EQ(density_of_bulking(read, 1.2), density_of_bulking(fit.form, 1.2)) << fit.key;
  }
}

TEST_F(LawFile, BrokenRulesAreNamed) {
  const std::string text = to_json(calibration());
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::string& expected) {
    const std::string found = message(text, from, to);
    EXPECT_NE(found.find(expected), std::string::npos) << found;
  };
  expect("\"use\": \"closed_form_as_measured\"", "\"use\": \"line_as_measured\"",
         "use: is 'line_as_measured', must name a form in this file");
  expect("\"r\": 0.41", "\"r\": 1.0", "closed_form_as_measured.r: is 1, must be in");
  expect("\"A\": 0.9", "\"A\": -0.9", "closed_form_as_measured.A: is -0.9, must be in");
  expect("\"a\": 160.0", "\"a\": 0", "line.a: is 0, must be in");
  expect("\"r2\": 0.98,", "\"rr\": 0.98,", "line.r2: is missing");
  expect("\"name\"", "\"names\"", "name: is missing");
  expect("\"source\"", "\"x\": 1, \"source\"", "x: is not a key of this file");
  expect("excavplan-density-law", "excavplan-soil", "format: is 'excavplan-soil'");
}

// ---- true and measured factor -------------------------------------------------------------------

/// A dig of a known fallback: soil in the hole is missing from both volumes.
DensityCalibration::Sample dig_with_fallback(double density, double fallback) {
  const double k = bulking_of_density(paper_closed_form(), density);
  const double cut = 0.3;
  const double in_hole = fallback * cut;
  return {density, k, (k * cut - in_hole) / (cut - in_hole), k, fallback};
}

TEST(BulkingDifference, IsWhatFallbackHidesAtItsWorst) {
  DensityCalibration calibration;
  calibration.forms = {{"closed_form", paper_closed_form()}};
  calibration.samples = {dig_with_fallback(20.0, 0.01), dig_with_fallback(80.0, 0.04),
                         dig_with_fallback(100.0, 0.0)};
  const auto difference = bulking_difference(calibration);
  ASSERT_TRUE(difference.has_value());
  EXPECT_EQ(difference->largest.density_percent, 80.0);
  const double k = paper_k0 / (1.0 - 0.8 * paper_r);
  const double measured = k + 0.04 / 0.96 * (k - 1.0);
  EXPECT_NEAR(difference->largest.bulking_factor_measured, measured, 1e-12);
  EXPECT_NEAR(difference->density_points, 100.0 / paper_r * (1.0 - paper_k0 / measured) - 80.0,
              1e-9);
  EXPECT_EQ(difference->unexplained, 0.0);

  calibration.samples[0].bulking_factor -= 0.003;
  EXPECT_NEAR(bulking_difference(calibration)->unexplained, 0.003, 1e-12);
}

TEST(BulkingDifference, IsUnknownWhereTheTrueFactorIs) {
  DensityCalibration calibration;
  calibration.forms = {{"closed_form", paper_closed_form()}};
  EXPECT_FALSE(bulking_difference(calibration).has_value());
  calibration.samples = {dig_with_fallback(20.0, 0.01), {40.0, 1.17, 0.0, 0.0, 0.0}};
  EXPECT_FALSE(bulking_difference(calibration).has_value());
}

}  // namespace
}  // namespace excavplan
