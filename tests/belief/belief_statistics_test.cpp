// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/belief/density_belief.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "base/random.hpp"

/// @file
/// The belief beside exact Bayes with the true hyperparameters, over simulated fields. Fields and
/// exact Bayes are of this file, dense and over cells.

namespace excavplan {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int digs = 10;
constexpr double cell = 0.25;

/// What the ground and its surveys are.
struct Truth {
  double level_sd = 20.0;  ///< of the field's mean about 50
  double sd = 10.0;
  double length = 4.0;
  double law_sd = 4.2;
  double survey_sd = 3.5;
};

double matern(double r, double length) {
  const double a = std::sqrt(3.0) * r / length;
  return (1.0 + a) * std::exp(-a);
}

/// Ten digs and the next one along a trench of two lanes, each of 2.5 m by 0.5 m in cells.
struct Layout {
  std::vector<std::vector<BankPart>> banks;
  std::vector<GroundPlace> cells;  ///< of all digs, one after another
  MatrixXd weights;                ///< digs + 1 x cells
  MatrixXd correlation;            ///< of the cells, with its factor
  MatrixXd factor;

  Layout(std::uint64_t seed, double length) {
    Random random(seed, 1);
    for (int i = 0; i <= digs; ++i) {
      const int station = i / 2;
      const double x = 1.6 * station + random.uniform(-0.3, 0.3);
      const double y = (i % 2 == 0 ? -0.4 : 0.4) + random.uniform(-0.1, 0.1);
      std::vector<BankPart> bank;
      for (int a = 0; a < 10; ++a) {
        for (int b = 0; b < 2; ++b) {
          bank.push_back({{x + cell * a, y + cell * b, 0.2}, random.uniform(0.01, 0.03)});
          cells.push_back(bank.back().place);
        }
      }
      banks.push_back(bank);
    }
    const auto count = static_cast<Eigen::Index>(cells.size());
    weights = MatrixXd::Zero(digs + 1, count);
    for (Eigen::Index i = 0; i <= digs; ++i) {
      for (Eigen::Index j = 0; j < 20; ++j) {
        weights(i, 20 * i + j) =
            banks[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].volume;
      }
      weights.row(i) /= weights.row(i).sum();
    }
    correlation.resize(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < count; ++j) {
        const GroundPlace& a = cells[static_cast<std::size_t>(i)];
        const GroundPlace& b = cells[static_cast<std::size_t>(j)];
        correlation(i, j) = matern(std::hypot(a.x - b.x, a.y - b.y), length);
      }
    }
    const MatrixXd nugget = 1e-9 * MatrixXd::Identity(count, count);
    factor = Eigen::LLT<MatrixXd>(correlation + nugget).matrixL();
  }
};

/// One ground with the surveys of its digs.
struct Ground {
  VectorXd density;  ///< of the cells
  VectorXd surveys;  ///< of all digs

  Ground(const Layout& layout, const Truth& truth, std::uint64_t seed) {
    Random random(seed, 2);
    VectorXd normals(layout.factor.rows());
    for (double& normal : normals) normal = random.normal();
    const double level = 50.0 + truth.level_sd * random.normal();
    density = level + (truth.sd * (layout.factor * normals)).array();
    surveys = layout.weights * density;
    const double law_error = truth.law_sd * random.normal();
    for (double& survey : surveys) survey += law_error + truth.survey_sd * random.normal();
  }
};

/// Exact Bayes of the cells of the next dig.
struct Exact {
  MatrixXd gain;
  VectorXd sd;

  Exact(const Layout& layout, const Truth& truth) {
    const auto count = static_cast<Eigen::Index>(layout.cells.size());
    const MatrixXd prior = MatrixXd::Constant(count, count, std::pow(truth.level_sd, 2)) +
                           std::pow(truth.sd, 2) * layout.correlation;
    const MatrixXd w = layout.weights.topRows(digs);
    const MatrixXd noise = MatrixXd::Constant(digs, digs, std::pow(truth.law_sd, 2)) +
                           std::pow(truth.survey_sd, 2) * MatrixXd::Identity(digs, digs);
    const MatrixXd cross = prior.bottomRows(20) * w.transpose();
    const MatrixXd total = w * prior * w.transpose() + noise;
    gain = Eigen::LLT<MatrixXd>(total).solve(cross.transpose()).transpose();
    sd = (prior.bottomRightCorner(20, 20) - gain * cross.transpose()).diagonal().cwiseSqrt();
  }
};

/// What a belief and exact Bayes make of many grounds.
struct Score {
  double squares = 0.0;  ///< of errors on cells of the next dig
  double exact_squares = 0.0;
  double squares_of_all = 0.0;  ///< on cells of all digs
  int cells = 0;
  int inside = 0;
  double innovations = 0.0;  ///< squares, each foretold before it was seen
  int readings = 0;

  double rms() const { return std::sqrt(squares / cells); }
  double ratio() const { return std::sqrt(squares / exact_squares); }
  double rms_of_all() const { return std::sqrt(squares_of_all); }
  double share_inside() const { return static_cast<double>(inside) / cells; }
  double innovation() const { return innovations / readings; }
};

DigEvidence evidence(const Layout& layout, const Ground& ground, const Truth& truth, int dig) {
  DigEvidence result;
  result.bank = layout.banks[static_cast<std::size_t>(dig)];
  result.survey = SurveyReading{ground.surveys(dig), truth.survey_sd};
  return result;
}

constexpr int grounds = 600;
constexpr int grounds_of_a_layout = 50;

/// Adds what one ground gives.
void score_ground(const Layout& layout, const Truth& truth, std::uint64_t seed, bool refits,
                  Score& score) {
  const Exact exact(layout, truth);
  const Ground ground(layout, truth, seed);
  DensityBelief belief;
  for (int i = 0; i < digs; ++i) {
    if (refits && i > 0) belief.refit();
    belief.add(evidence(layout, ground, truth, i));
    score.innovations += std::pow(belief.innovations().back(), 2);
    ++score.readings;
  }
  if (refits) belief.refit();
  const BelievedDensity found = belief.at({layout.cells.end() - 20, layout.cells.end()});
  const VectorXd expected =
      50.0 + (exact.gain * (ground.surveys.head(digs).array() - 50.0).matrix()).array();
  const VectorXd next = ground.density.tail(20);
  for (Eigen::Index i = 0; i < 20; ++i) {
    const double error = found.raw_percent(i) - next(i);
    score.squares += error * error;
    score.exact_squares += std::pow(expected(i) - next(i), 2);
    if (std::abs(error) <= 1.96 * found.sd_percent(i)) ++score.inside;
    ++score.cells;
  }
  const Eigen::ArrayXd all = belief.at(layout.cells).raw_percent - ground.density.array();
  score.squares_of_all += all.square().mean() / grounds;
}

Score score(const Truth& truth, bool refits) {
  Score score;
  for (int first = 0; first < grounds; first += grounds_of_a_layout) {
    const Layout layout(static_cast<std::uint64_t>(first), truth.length);
    for (int i = first; i < first + grounds_of_a_layout; ++i) {
      score_ground(layout, truth, static_cast<std::uint64_t>(i), refits, score);
    }
  }
  ::testing::Test::RecordProperty("times_exact", std::to_string(score.ratio()));
  ::testing::Test::RecordProperty("inside", std::to_string(score.share_inside()));
  ::testing::Test::RecordProperty("innovations", std::to_string(score.innovation()));
  return score;
}

void expect_near_exact_bayes(const Score& score) {
  EXPECT_LT(score.ratio(), 1.05);
  EXPECT_GT(score.share_inside(), 0.93);
  EXPECT_LT(score.share_inside(), 0.97);
  EXPECT_GT(score.innovation(), 0.9);
  EXPECT_LT(score.innovation(), 1.1);
}

TEST(BeliefStatistics, IsNearExactBayesWithTheUsualSettings) {
  expect_near_exact_bayes(score({}, false));
}

TEST(BeliefStatistics, IsNearExactBayesWithWhatIsRefittedAfterEachDig) {
  expect_near_exact_bayes(score({}, true));
}

TEST(BeliefStatistics, ErrsByLessThanTwoAndAHalfPointsOnConstantSoil) {
  const Score constant = score({20.0, 1e-3, 4.0, 0.0, 3.5}, true);
  EXPECT_LT(constant.rms(), 2.5);
  EXPECT_LT(constant.rms_of_all(), 2.5);
}

/// Other fields than the usual: what is lost against exact Bayes stays small, their intervals do
/// not, as ten digs tell little of a spread and a length.
TEST(BeliefStatistics, LosesLittleOnOtherFields) {
  for (const Truth& truth : {Truth{20.0, 10.0, 1.5, 4.2, 3.5}, Truth{20.0, 7.5, 15.0, 4.2, 3.5},
                             Truth{20.0, 18.0, 4.0, 4.2, 3.5}}) {
    const Score other = score(truth, true);
    EXPECT_LT(other.ratio(), 1.08);
    EXPECT_GT(other.share_inside(), 0.86);
  }
}

}  // namespace
}  // namespace excavplan
