// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/belief/density_belief.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <excavplan/base/data_files.hpp>

#include "base/random.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

BankPart part(double x, double y, double depth, double volume = 0.1) {
  return {{x, y, depth}, volume};
}

/// A survey with scans numbered from `scan`, and the payload of every second dig.
DigEvidence some_dig(int i) {
  Random random(7, static_cast<std::uint64_t>(i));
  DigEvidence dig;
  for (int p = 0; p < 3; ++p) {
    dig.bank.push_back(part(random.uniform(0.0, 8.0), random.uniform(-3.0, 3.0),
                            random.uniform(0.0, 0.8), random.uniform(0.1, 1.0)));
  }
  dig.survey = SurveyReading{
      random.uniform(20.0, 90.0), random.uniform(2.0, 5.0), {{i, -2.0}, {i + 1, 2.0}}};
  if (i % 2 == 0) dig.payload_percent = Measured{random.uniform(20.0, 90.0), 4.0};
  if (i % 3 == 0) {
    dig.resistance.push_back({random.uniform(-0.5, 0.5), 0.2, {50.0, 0.015, 0.8}});
  }
  return dig;
}

std::vector<DigEvidence> some_digs(int count) {
  std::vector<DigEvidence> digs;
  digs.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) digs.push_back(some_dig(i));
  return digs;
}

std::vector<GroundPlace> some_places(int count) {
  Random random(11);
  std::vector<GroundPlace> places;
  places.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    places.push_back({random.uniform(-2.0, 12.0), random.uniform(-4.0, 4.0),
                      0.1 * static_cast<double>(random.index(8))});
  }
  return places;
}

// ---- Exact Bayes, dense: all places as one normal vector, all readings at once ------------------

struct Reading {
  VectorXd gains;  ///< of the places, then law's error, payload's error, ln(strength)
  double value = 0.0;
  double variance = 0.0;
  std::vector<ScanError> scans;
};

class DenseBayes {
 public:
  DenseBayes(const BeliefSettings& s, std::vector<GroundPlace> places)
      : places_(std::move(places)), count_(static_cast<Eigen::Index>(places_.size())) {
    prior_ = MatrixXd::Zero(count_ + 3, count_ + 3);
    for (Eigen::Index i = 0; i < count_; ++i) {
      for (Eigen::Index j = 0; j < count_; ++j) prior_(i, j) = covariance(s, at(i), at(j));
    }
    prior_(count_, count_) = std::pow(s.law_sd_percent, 2);
    prior_(count_ + 1, count_ + 1) = std::pow(s.payload_sd_percent, 2);
    prior_(count_ + 2, count_ + 2) = std::pow(s.log_strength_sd, 2);
    mean_ = VectorXd::Zero(count_ + 3);
    mean_.head(count_).setConstant(s.mean_percent);
  }

  static double covariance(const BeliefSettings& s, const GroundPlace& a, const GroundPlace& b) {
    const auto matern = [](double r, double l) {
      return (1.0 + std::sqrt(3.0) * r / l) * std::exp(-std::sqrt(3.0) * r / l);
    };
    return std::pow(s.level_sd_percent, 2) +
           std::pow(s.trend_sd_percent_per_m, 2) * a.depth * b.depth +
           std::pow(s.spread_percent, 2) * matern(std::hypot(a.x - b.x, a.y - b.y), s.length) *
               matern(std::abs(a.depth - b.depth), s.depth_length);
  }

  /// @param first  place of the first part of its bank
  void add(const DigEvidence& dig, Eigen::Index first) {
    VectorXd weights = VectorXd::Zero(count_ + 3);
    double volume = 0.0;
    for (const BankPart& of_bank : dig.bank) volume += of_bank.volume;
    for (std::size_t p = 0; p < dig.bank.size(); ++p) {
      weights(first + static_cast<Eigen::Index>(p)) = dig.bank[p].volume / volume;
    }
    if (dig.survey) {
      push(weights, count_, dig.survey->raw_percent, std::pow(dig.survey->sd_percent, 2));
      readings_.back().scans = dig.survey->scans;
    }
    if (dig.payload_percent) {
      push(weights, count_ + 1, dig.payload_percent->value, std::pow(dig.payload_percent->sd, 2));
    }
    for (const ResistanceReading& r : dig.resistance) {
      push(r.law.rise_per_percent * weights, count_ + 2,
           r.log_ratio + r.law.rise_per_percent * r.law.at_percent, r.sd * r.sd,
           r.law.strength_share);
    }
  }

  void solve() {
    const auto n = static_cast<Eigen::Index>(readings_.size());
    MatrixXd gains(n, count_ + 3);
    MatrixXd noise = MatrixXd::Zero(n, n);
    VectorXd off(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Reading& one = readings_[static_cast<std::size_t>(i)];
      gains.row(i) = one.gains.transpose();
      noise(i, i) = one.variance;
      off(i) = one.value - one.gains.dot(mean_);
      for (Eigen::Index j = 0; j < n; ++j) {
        for (const ScanError& a : one.scans) {
          for (const ScanError& b : readings_[static_cast<std::size_t>(j)].scans) {
            if (a.scan == b.scan) noise(i, j) += a.effect_percent * b.effect_percent;
          }
        }
      }
    }
    const MatrixXd cross = prior_ * gains.transpose();
    const Eigen::LDLT<MatrixXd> total(gains * cross + noise);
    mean = mean_ + cross * total.solve(off);
    posterior = prior_ - cross * total.solve(cross.transpose());
  }

  VectorXd mean;
  MatrixXd posterior;

 private:
  const GroundPlace& at(Eigen::Index i) const { return places_[static_cast<std::size_t>(i)]; }
  void push(VectorXd gains, Eigen::Index state, double value, double variance, double share = 1.0) {
    gains(state) = share;
    readings_.push_back({std::move(gains), value, variance, {}});
  }

  std::vector<GroundPlace> places_;
  Eigen::Index count_;
  MatrixXd prior_;
  VectorXd mean_;
  std::vector<Reading> readings_;
};

double largest(const VectorXd& values) { return values.cwiseAbs().maxCoeff(); }

struct ExactAnswer {
  VectorXd mean;
  MatrixXd posterior;
  Eigen::Index places = 0;
};

ExactAnswer exact_answer(const BeliefSettings& settings, const std::vector<DigEvidence>& digs,
                         std::vector<GroundPlace> places) {
  const auto own = static_cast<Eigen::Index>(places.size());
  for (const DigEvidence& dig : digs) {
    for (const BankPart& of_bank : dig.bank) places.push_back(of_bank.place);
  }
  DenseBayes exact(settings, places);
  Eigen::Index first = own;
  for (const DigEvidence& dig : digs) {
    exact.add(dig, first);
    first += static_cast<Eigen::Index>(dig.bank.size());
  }
  exact.solve();
  return {exact.mean, exact.posterior, own};
}

// ---- Exactness ----------------------------------------------------------------------------------

TEST(DensityBelief, IsExactBayesWithAllReadingsAndSharedScans) {
  const std::vector<DigEvidence> digs = some_digs(12);
  const std::vector<GroundPlace> places = some_places(30);
  const BeliefSettings settings;
  const ExactAnswer exact = exact_answer(settings, digs, places);
  const DensityBelief belief(settings, digs);
  const BelievedDensity found = belief.at(places);
  EXPECT_LT(largest(found.raw_percent.matrix() - exact.mean.head(exact.places)), 1e-8);
  EXPECT_LT(largest(found.sd_percent.matrix() -
                    exact.posterior.diagonal().head(exact.places).cwiseSqrt()),
            1e-8);
  const CommonStates states = belief.common_states();
  const Eigen::Index first = exact.mean.size() - 3;
  for (const auto& [state, i] : {std::pair{states.law_error_percent, first},
                                 std::pair{states.payload_error_percent, first + 1},
                                 std::pair{states.log_strength, first + 2}}) {
    EXPECT_NEAR(state.value, exact.mean(i), 1e-9);
    EXPECT_NEAR(state.sd, std::sqrt(exact.posterior(i, i)), 1e-9);
  }
}

TEST(DensityBelief, WithoutDigsItIsAsBeforeAny) {
  const BeliefSettings settings;
  const DensityBelief belief(settings);
  const BelievedDensity at = belief.at(some_places(3));
  const BelievedMeans means = belief.means_of({{part(1.0, 0.0, 0.2)}, {part(2.0, 0.5, 0.4)}});
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_EQ(at.raw_percent(i), settings.mean_percent);
    EXPECT_EQ(means.raw_percent(i), settings.mean_percent);
    EXPECT_GT(at.sd_percent(i), 0.0);
    EXPECT_GT(means.covariance(i, i), means.covariance(0, 1));
  }
  EXPECT_EQ(belief.common_states().law_error_percent.value, 0.0);
  EXPECT_EQ(belief.log_likelihood(), 0.0);
}

TEST(DensityBelief, GivesMeansOfPartsWithTheirCovariance) {
  const std::vector<DigEvidence> digs = some_digs(9);
  const std::vector<GroundPlace> places = some_places(6);
  const ExactAnswer exact = exact_answer({}, digs, places);
  MatrixXd weights = MatrixXd::Zero(2, exact.mean.size());
  weights.row(0).head(3) << 0.2, 0.3, 0.5;
  weights.row(1).segment(3, 3) << 0.6, 0.1, 0.3;
  std::vector<std::vector<BankPart>> parts(2);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t of = i / 3;
    parts[of].push_back(
        {places[i], 7.0 * weights(static_cast<Eigen::Index>(of), static_cast<Eigen::Index>(i))});
  }
  const DensityBelief belief({}, digs);
  const BelievedMeans found = belief.means_of(parts);
  EXPECT_LT(largest(found.raw_percent - weights * exact.mean), 1e-8);
  const MatrixXd off = found.covariance - weights * exact.posterior * weights.transpose();
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-7);
  const GroundDensity density = belief.ground_density(parts[0]);
  EXPECT_NEAR(density.percent, found.raw_percent(0), 1e-12);
  EXPECT_NEAR(density.sd_percent, std::sqrt(found.covariance(0, 0)), 1e-12);
  EXPECT_TRUE(density.trustworthy);
}

TEST(DensityBelief, SequenceAndBatchAgreeInAnyOrder) {
  std::vector<DigEvidence> digs = some_digs(40);
  const std::vector<GroundPlace> places = some_places(50);
  const BelievedDensity batch = DensityBelief({}, digs).at(places);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    for (std::size_t i = digs.size() - 1; i > 0; --i) std::swap(digs[i], digs[random.index(i + 1)]);
    DensityBelief belief;
    for (const DigEvidence& dig : digs) belief.add(dig);
    const BelievedDensity found = belief.at(places);
    EXPECT_LT((found.raw_percent - batch.raw_percent).abs().maxCoeff(), 1e-8);
    EXPECT_LT((found.sd_percent - batch.sd_percent).abs().maxCoeff(), 1e-8);
  }
}

TEST(DensityBelief, NoDeviationGrowsByMoreEvidence) {
  const std::vector<GroundPlace> places = some_places(40);
  DensityBelief belief;
  Eigen::ArrayXd sd = belief.at(places).sd_percent;
  EXPECT_NEAR(sd(0), std::sqrt(25.0 * 25.0 + 100.0 + std::pow(5.0 * places[0].depth, 2)), 1e-12);
  for (int i = 0; i < 60; ++i) {
    DigEvidence dig = some_dig(i);
    dig.limits = {{i % 4 == 0, i % 4 == 0 ? 0.1 : -0.4, 0.3, {50.0, 0.015, 0.8}}};
    belief.add(dig);
    const Eigen::ArrayXd now = belief.at(places).sd_percent;
    EXPECT_LT((now - sd).maxCoeff(), 1e-9);
    sd = now;
  }
}

TEST(DensityBelief, TakesBackTheLastDigExactly) {
  const std::vector<GroundPlace> places = some_places(20);
  DensityBelief belief({}, some_digs(6));
  const BelievedDensity before = belief.at(places);
  belief.add(some_dig(6));
  EXPECT_TRUE(belief.drop_last());
  EXPECT_EQ(belief.digs().size(), 6U);
  EXPECT_TRUE((belief.at(places).raw_percent == before.raw_percent).all());
  EXPECT_TRUE((belief.at(places).sd_percent == before.sd_percent).all());
  DensityBelief none;
  EXPECT_FALSE(none.drop_last());
}

TEST(DensityBelief, ForgetsTheOldestBeyondItsMostAndTakesThatBackToo) {
  const std::vector<GroundPlace> places = some_places(5);
  DensityBelief belief({}, some_digs(DensityBelief::most_digs));
  const BelievedDensity before = belief.at(places);
  belief.add(some_dig(1000));
  EXPECT_EQ(belief.digs().size(), DensityBelief::most_digs);
  EXPECT_TRUE(belief.forgotten().has_value());
  belief.drop_last();
  EXPECT_FALSE(belief.forgotten().has_value());
  EXPECT_TRUE((belief.at(places).raw_percent == before.raw_percent).all());
}

TEST(DensityBelief, ACopyIsItsOwn) {
  DensityBelief belief({}, some_digs(3));
  DensityBelief copy = belief;
  copy.add(some_dig(3));
  EXPECT_EQ(belief.digs().size(), 3U);
  const std::vector<GroundPlace> places = some_places(3);
  EXPECT_FALSE((belief.at(places).sd_percent == copy.at(places).sd_percent).all());
  belief = copy;
  EXPECT_TRUE((belief.at(places).sd_percent == copy.at(places).sd_percent).all());
}

// ---- What teaches and what does not -------------------------------------------------------------

TEST(DensityBelief, SoilThatIsMostlyLooseIsNoNews) {
  const std::vector<GroundPlace> places = some_places(4);
  DensityBelief belief;
  const BelievedDensity before = belief.at(places);
  DigEvidence dig = some_dig(0);
  dig.bank_share = 0.33;
  belief.add(dig);
  DigEvidence nothing;
  nothing.survey = SurveyReading{20.0, 1.0};
  belief.add(nothing);  // no bank
  EXPECT_EQ(belief.digs().size(), 2U);
  EXPECT_TRUE((belief.at(places).raw_percent == before.raw_percent).all());
  EXPECT_FALSE(belief.ground_density({part(0, 0, 0)}).trustworthy);
  dig.bank_share = 0.34;
  belief.add(dig);
  EXPECT_FALSE((belief.at(places).raw_percent == before.raw_percent).all());
}

TEST(DensityBelief, OnlyWhatIsReadIsClipped) {
  DensityBelief belief;
  for (int i = 0; i < 4; ++i) {
    DigEvidence dig;
    dig.bank = {part(0.0, 0.0, 0.0)};
    dig.survey = SurveyReading{130.0, 1.0};
    belief.add(dig);
  }
  const BelievedDensity found = belief.at({{0.0, 0.0, 0.0}});
  EXPECT_GT(found.raw_percent(0), 120.0);
  EXPECT_EQ(found.percent()(0), 100.0);
  EXPECT_EQ(found.interval_percent()[1](0), 100.0);
  EXPECT_EQ(belief.ground_density({part(0, 0, 0)}).percent, 100.0);
}

TEST(DensityBelief, OnlyPayloadSeparatesTheLawsError) {
  BeliefSettings settings;
  DensityBelief surveys(settings);
  for (int i = 0; i < 100; ++i) {
    DigEvidence dig;
    dig.bank = {part(0.1 * i, 0.0, 0.1)};
    dig.survey = SurveyReading{60.0, 3.0};
    surveys.add(dig);
  }
  // With the level free within 25 points a common error of 4.2 stays nearly whole.
  EXPECT_GT(surveys.common_states().law_error_percent.sd, 4.0);
  DensityBelief both = surveys;
  DigEvidence weighed;
  weighed.bank = {part(5.0, 0.0, 0.1)};
  weighed.payload_percent = Measured{55.0, 2.0};
  both.add(weighed);
  EXPECT_LT(both.common_states().law_error_percent.sd, 3.5);
  EXPECT_GT(both.common_states().law_error_percent.value, 0.5);
}

TEST(DensityBelief, EnergyTeachesTheStrengthWhereTheDensityIsKnown) {
  DensityBelief belief;
  for (int i = 0; i < 8; ++i) {
    DigEvidence dig;
    dig.bank = {part(0.5 * i, 0.0, 0.1)};
    dig.survey = SurveyReading{50.0, 3.0};
    dig.payload_percent = Measured{50.0, 3.0};
    dig.resistance = {{0.8 * std::log(1.5), 0.15, {50.0, 0.015, 0.8}}};
    belief.add(dig);
  }
  const Measured strength = belief.common_states().log_strength;
  EXPECT_NEAR(strength.value, std::log(1.5), 2.0 * strength.sd);
  EXPECT_LT(strength.sd, 0.12);
  EXPECT_GT(strength.value, 0.25);
}

/// Mean and deviation of the density of one place after a limit, by sums over density and strength.
Measured by_sums(const BeliefSettings& s, const LimitReading& limit) {
  const double sd = std::hypot(s.level_sd_percent, s.spread_percent);
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (int i = -300; i <= 300; ++i) {
    for (int j = -100; j <= 100; ++j) {
      const double d = s.mean_percent + 0.02 * i * sd;
      const double f = 0.06 * j * s.log_strength_sd;
      const double margin = limit.log_margin +
                            limit.law.rise_per_percent * (d - limit.law.at_percent) +
                            limit.law.strength_share * f;
      const double chance =
          0.5 * std::erfc(-(limit.was_met ? margin : -margin) / limit.sd / std::sqrt(2.0));
      const double weight = std::exp(-0.5 * (0.02 * i * 0.02 * i + 0.06 * j * 0.06 * j)) * chance;
      sum += weight;
      first += weight * d;
      second += weight * d * d;
    }
  }
  return {first / sum, std::sqrt(second / sum - std::pow(first / sum, 2))};
}

TEST(DensityBelief, ALimitHasTheMomentsOfItsProbit) {
  const BeliefSettings settings;
  for (const LimitReading& limit : {LimitReading{true, -0.5, 0.3, {50.0, 0.02, 0.8}},
                                    LimitReading{false, 0.3, 0.2, {40.0, 0.02, 0.5}},
                                    LimitReading{false, -0.2, 0.4, {50.0, 0.01, 1.0}}}) {
    DensityBelief belief;
    DigEvidence dig;
    dig.bank = {part(1.0, 2.0, 0.0)};
    dig.limits = {limit};
    belief.add(dig);
    const BelievedDensity found = belief.at({{1.0, 2.0, 0.0}});
    const Measured expected = by_sums(settings, limit);
    EXPECT_NEAR(found.raw_percent(0), expected.value, 0.01);
    EXPECT_NEAR(found.sd_percent(0), expected.sd, 0.01);
  }
}

TEST(DensityBelief, AStallWhereNoneCouldBeTeachesWithoutBounds) {
  DensityBelief belief;
  DigEvidence dig;
  dig.bank = {part(0.0, 0.0, 0.0)};
  dig.limits = {{true, -15.0, 0.1, {50.0, 0.02, 0.8}}, {false, -19.0, 0.1, {50.0, 0.02, 0.8}}};
  belief.add(dig);
  const BelievedDensity found = belief.at({{0.0, 0.0, 0.0}});
  EXPECT_TRUE(std::isfinite(found.raw_percent(0)));
  EXPECT_GT(found.raw_percent(0), 100.0);
  EXPECT_GT(found.sd_percent(0), 0.0);
}

TEST(DensityBelief, PlacesOverDepthAreSeenByDigsThatReachThem) {
  DensityBelief belief;
  DigEvidence dig;
  dig.bank = {part(0.0, 0.0, 0.1)};
  dig.survey = SurveyReading{80.0, 2.0};
  belief.add(dig);
  const Eigen::ArrayXd sd =
      belief.at({{0.0, 0.0, 0.1}, {0.0, 0.0, 1.0}, {0.0, 0.0, 4.0}}).sd_percent;
  EXPECT_LT(sd(0) + 1.0, sd(1));
  EXPECT_LT(sd(1) + 1.0, sd(2));
}

// ---- Condensed banks ----------------------------------------------------------------------------

TEST(Condensed, HasTheCovarianceOfTheWholeBankWithinOnePercent) {
  // A dig of 3 m by 0.7 m down to 0.4 m, at a heading of 0.5 rad, deeper at its end.
  std::vector<BankPart> bank;
  for (int i = 0; i < 30; ++i) {
    for (int j = -3; j <= 3; ++j) {
      for (int k = 0; k < 4; ++k) {
        const double along = 0.1 * i;
        const double across = 0.1 * j;
        bank.push_back(part(along * std::cos(0.5) - across * std::sin(0.5),
                            along * std::sin(0.5) + across * std::cos(0.5),
                            0.05 + 0.1 * k * (0.5 + i / 60.0), 0.001));
      }
    }
  }
  const std::vector<BankPart> few = condensed(bank);
  ASSERT_EQ(few.size(), 4U);
  BeliefSettings field;
  field.level_sd_percent = 0.0;
  field.trend_sd_percent_per_m = 0.0;
  field.length = 4.0;
  const auto covariance = [&](const std::vector<BankPart>& a, const std::vector<BankPart>& b) {
    double sum = 0.0;
    for (const BankPart& one : a) {
      for (const BankPart& other : b) {
        sum += one.volume * other.volume * DenseBayes::covariance(field, one.place, other.place);
      }
    }
    const auto volume = [](const std::vector<BankPart>& of) {
      return std::accumulate(of.begin(), of.end(), 0.0,
                             [](double v, const BankPart& p) { return v + p.volume; });
    };
    return sum / volume(a) / volume(b);
  };
  EXPECT_NEAR(covariance(few, few) / covariance(bank, bank), 1.0, 0.01);
  const std::vector<BankPart> cell = {part(1.0, 0.5, 0.2)};
  EXPECT_NEAR(covariance(few, cell) / covariance(bank, cell), 1.0, 0.01);
  const std::vector<BankPart> far = {part(-3.0, 0.5, 0.6)};
  EXPECT_NEAR(covariance(few, far) / covariance(bank, far), 1.0, 0.01);
}

TEST(Condensed, FourPartsStayAsTheyAre) {
  const std::vector<BankPart> four = {part(0, 0, 0), part(5, 0, 0), part(0, 5, 1), part(9, 9, 9)};
  const std::vector<BankPart> same = condensed(four);
  ASSERT_EQ(same.size(), 4U);
  EXPECT_EQ(same[3].place.depth, 9.0);
}

// ---- Payload ------------------------------------------------------------------------------------

TEST(DensityOfBank, IsTheInverseOfTheBankState) {
  const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  for (const double d : {0.0, 35.0, 100.0}) {
    const double mass = 0.4 * bank_state(soil, d).bulk_density;
    const Measured found = density_of_bank(soil, {mass, 0.02 * mass}, {0.4, 0.0});
    EXPECT_NEAR(found.value, d, 1e-9);
    const Measured heavier = density_of_bank(soil, {mass * 1.0001, 0.0}, {0.4, 0.0});
    EXPECT_NEAR(found.sd, 0.02 * (heavier.value - d) / 0.0001, 0.01);
  }
  EXPECT_EQ(test::error_of([&] {
              density_of_bank(soil, {0.0, 0.0}, {1.0, 0.0});
            }),
            "mass [kg] or volume [m^3] of bank is 0, must be above 0 and finite");
}

// ---- Errors -------------------------------------------------------------------------------------

TEST(DensityBelief, RefusesWhatIsNoEvidence) {
  DensityBelief belief;
  const auto error = [&](auto change) {
    DigEvidence dig = some_dig(0);
    dig.limits = {{}};
    change(dig);
    return test::error_of([&] { belief.add(dig); });
  };
  using D = DigEvidence;
  EXPECT_EQ(error([](D& d) { d.bank_share = 1.1; }),
            "dig: share of bank is 1.1, must be in 0 .. 1");
  EXPECT_EQ(error([](D& d) { d.survey->raw_percent = NAN; }),
            "survey: density [%] is nan, must be in -10000 .. 10000");
  EXPECT_EQ(error([](D& d) { d.survey->sd_percent = -1.0; }),
            "survey: its sd [points] is -1, must be at least 0 and finite");
  EXPECT_EQ(error([](D& d) { d.survey->scans[0].effect_percent = NAN; }),
            "survey: effect of a scan [points] is nan, must be in -10000 .. 10000");
  EXPECT_EQ(error([](D& d) { d.payload_percent->sd = INFINITY; }),
            "payload: its sd [points] is inf, must be at least 0 and finite");
  EXPECT_EQ(error([](D& d) { d.resistance[0].log_ratio = 30.0; }),
            "resistance: ln(measured / foretold) is 30, must be in -20 .. 20");
  EXPECT_EQ(error([](D& d) { d.resistance[0].law.rise_per_percent = 2.0; }),
            "resistance: rise of the logarithm [1/%] is 2, must be in -1 .. 1");
  EXPECT_EQ(error([](D& d) { d.limits[0].law.strength_share = 2.0; }),
            "resistance: share that grows with the strength is 2, must be in 0 .. 1");
  EXPECT_EQ(error([](D& d) { d.bank[0].volume = -1.0; }),
            "bank: a volume [m^3] is -1, must be at least 0 and finite");
  EXPECT_EQ(error([](D& d) { d.bank[0].place.x = NAN; }), "bank: a place is nan, must be finite");
  EXPECT_TRUE(belief.digs().empty());
  BeliefSettings settings;
  settings.length = 0.0;
  EXPECT_EQ(test::error_of([&] { DensityBelief{settings}; }),
            "belief: correlation length [m] is 0, must be in 0.01 .. 10000");
  EXPECT_EQ(test::error_of([&] {
              belief.at({{NAN, 0.0, 0.0}});
            }),
            "a place of the ground [m] is nan, must be finite");
  EXPECT_EQ(test::error_of([] { DensityBelief({}, std::vector<DigEvidence>(201)); }),
            "belief: digs is 201, must be at most 200");
}

// ---- Map ----------------------------------------------------------------------------------------

TEST(DensityBelief, IsDrawnAsAMap) {
  const DensityBelief belief({}, some_digs(5));
  HeightMap grid = flat_ground({0.0, -1.0, 3.0, 1.0}, 0.5);
  const LayeredMap map = belief_map(belief, grid, 0.3);
  ASSERT_EQ(map.layers.size(), 2U);
  EXPECT_EQ(map.layers[0].name, "density_percent");
  EXPECT_EQ(map.layers[1].name, "density_sd_percent");
  const BelievedDensity one = belief.at({{grid.x(4), grid.y(2), 0.3}});
  EXPECT_NEAR(map.layers[0].values(2, 4), one.percent()(0), 1e-12);
  EXPECT_NEAR(map.layers[1].values(2, 4), one.sd_percent(0), 1e-12);
}

}  // namespace
}  // namespace excavplan
