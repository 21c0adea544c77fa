// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "belief/dual_form.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/statistics.hpp"

namespace excavplan {
namespace {

constexpr double least_sd_percent = 0.1;  // of a density that is read [points]; ours
constexpr double least_log_sd = 0.01;     // of a logarithm that is read; ours
constexpr double least_news = 1e-6;       // of a limit, part of the variance that it takes; ours
constexpr Eigen::Index block = 128;       // points that are predicted at once, to stay in the cache

enum State { law_error, payload_error, log_strength };

double at_least(double sd, double least) { return std::pow(std::max(sd, least), 2); }

LinearReading reading_of(const SurveyReading& survey) {
  LinearReading reading{survey.raw_percent};
  reading.states(law_error) = 1.0;
  reading.variance = at_least(survey.sd_percent, least_sd_percent);
  reading.scans = survey.scans;
  return reading;
}

LinearReading reading_of_payload(const Measured& percent) {
  LinearReading reading{percent.value};
  reading.states(payload_error) = 1.0;
  reading.variance = at_least(percent.sd, least_sd_percent);
  return reading;
}

/// Of the logarithm of a figure over what was foretold for a density of 0.
LinearReading reading_of(const ResistanceLaw& law, double log_ratio, double sd) {
  LinearReading reading{log_ratio + law.rise_per_percent * law.at_percent, law.rise_per_percent};
  reading.states(log_strength) = law.strength_share;
  reading.variance = at_least(sd, least_log_sd);
  return reading;
}

double shared_covariance(const LinearReading& a, const LinearReading& b) {
  double covariance = 0.0;
  for (const ScanError& one : a.scans) {
    for (const ScanError& other : b.scans) {
      if (one.scan == other.scan) covariance += one.effect_percent * other.effect_percent;
    }
  }
  return covariance;
}

/// Density over distribution of a standard normal.
double inverse_mills(double z) {
  constexpr double far = -20.0;
  if (z < far) return -z - 1.0 / z + 2.0 / (z * z * z);
  return std::exp(-0.5 * z * z) / (std::sqrt(2.0 * pi) * normal_cdf(z));
}

/// With room for more: at least doubled where it does not suffice.
void make_room(Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index columns) {
  if (matrix.rows() >= rows && matrix.cols() >= columns) return;
  const auto grown = [](Eigen::Index has, Eigen::Index needs) {
    return has >= needs ? has : std::max<Eigen::Index>({needs, 2 * has, 16});
  };
  const Eigen::Index old_rows = matrix.rows();
  const Eigen::Index old_columns = matrix.cols();
  matrix.conservativeResize(grown(old_rows, rows), grown(old_columns, columns));
  matrix.bottomRows(matrix.rows() - old_rows).setZero();
  matrix.rightCols(matrix.cols() - old_columns).setZero();
}

}  // namespace

DualForm::DualForm(const BeliefSettings& settings)
    : settings_(settings),
      field_(settings),
      state_variances_(std::pow(settings.law_sd_percent, 2),
                       std::pow(settings.payload_sd_percent, 2),
                       std::pow(settings.log_strength_sd, 2)) {}

void DualForm::add(const DigEvidence& dig) {
  const bool has_reading =
      dig.survey || dig.payload_percent || !dig.resistance.empty() || !dig.limits.empty();
  if (dig.bank.empty() || dig.bank_share < least_bank_share || !has_reading) return;
  parts_.add(field_part(dig.bank));
  first_rows_.push_back(static_cast<Eigen::Index>(rows_.size()));
  const Eigen::Index digs = parts_.size();
  make_room(part_covariance_, digs, digs);
  part_covariance_.col(digs - 1).head(digs) = field_.covariances(parts_.all().back(), parts_);
  make_room(triangle_, digs, digs);
  if (dig.survey) append(reading_of(*dig.survey));
  if (dig.payload_percent) append(reading_of_payload(*dig.payload_percent));
  for (const ResistanceReading& resistance : dig.resistance) {
    append(reading_of(resistance.law, resistance.log_ratio, resistance.sd));
  }
  for (const LimitReading& limit : dig.limits) append(limit);
}

DualForm::Foretold DualForm::foretold(const LinearReading& reading) const {
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  const Eigen::Index last = parts_.size() - 1;
  const StateVector states = state_variances_.cwiseProduct(reading.states);
  Foretold result;
  result.factor.resize(rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const Row& row = rows_[static_cast<std::size_t>(r)];
    result.factor(r) =
        reading.density_gain * row.reading.density_gain * part_covariance_(row.dig, last) +
        states.dot(row.reading.states) + shared_covariance(reading, row.reading);
  }
  factor_.topLeftCorner(rows, rows).triangularView<Eigen::Lower>().solveInPlace(result.factor);
  result.mean =
      reading.density_gain * settings_.mean_percent + result.factor.dot(innovations_.head(rows));
  result.variance = std::pow(reading.density_gain, 2) * part_covariance_(last, last) +
                    states.dot(reading.states) - result.factor.squaredNorm();
  return result;
}

void DualForm::append(const LinearReading& reading, bool is_limit) {
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  const Eigen::Index digs = parts_.size();
  reserve(rows + 1, digs);
  const Foretold before = foretold(reading);
  const double own = reading.variance + shared_covariance(reading, reading);
  // In exact arithmetic what was foretold has a variance of at least 0.
  const double sd = std::sqrt(std::max(before.variance + own, reading.variance));
  factor_.row(rows).head(rows) = before.factor.transpose();
  factor_(rows, rows) = sd;
  innovations_(rows) = (reading.value - before.mean) / sd;

  Eigen::VectorXd gains(digs);  // a dig has none in rows before its first
  for (Eigen::Index d = 0; d < digs; ++d) {
    const Eigen::Index count = rows - first_rows_[static_cast<std::size_t>(d)];
    gains(d) = -gains_.col(d).segment(rows - count, count).dot(before.factor.tail(count));
  }
  gains(digs - 1) += reading.density_gain;
  gains /= sd;
  gains_.row(rows).head(digs) = gains.transpose();
  state_gains_.row(rows) =
      (reading.states - state_gains_.topRows(rows).transpose() * before.factor).transpose() / sd;
  rows_.push_back({reading, digs - 1, is_limit});
  extend_triangle(std::move(gains));
}

/// The normal distribution of the same mean and variance as that foretold times the probability of
/// what happened, as a reading of the margin.
void DualForm::append(const LimitReading& limit) {
  LinearReading reading = reading_of(limit.law, 0.0, limit.sd);
  const double threshold = reading.value - limit.log_margin;
  const Foretold before = foretold(reading);
  const double side = limit.was_met ? 1.0 : -1.0;
  const double sd = std::sqrt(std::max(before.variance, 0.0) + reading.variance);
  const double z = side * (before.mean - threshold) / sd;
  const double mills = inverse_mills(z);
  const double curvature = mills * (z + mills) / (sd * sd);
  if (!(curvature * before.variance > least_news)) return;
  reading.value = before.mean + side * mills / (sd * curvature);
  reading.variance = 1.0 / curvature - before.variance;
  append(reading, true);
}

void DualForm::extend_triangle(Eigen::VectorXd row) {
  const Eigen::Index digs = parts_.size();
  const bool is_first = rows_.size() == 1 || rows_[rows_.size() - 2].dig != digs - 1;
  if (is_first) {
    triangle_.row(digs - 1).head(digs) = row.transpose();
    return;
  }
  for (Eigen::Index j = digs - 1; j >= 0; --j) {
    const double length = std::hypot(triangle_(j, j), row(j));
    if (length == 0.0) continue;
    const double cosine = triangle_(j, j) / length;
    const double sine = row(j) / length;
    const Eigen::VectorXd kept = triangle_.row(j).head(j + 1).transpose();
    triangle_.row(j).head(j + 1) = (cosine * kept + sine * row.head(j + 1)).transpose();
    row.head(j + 1) = cosine * row.head(j + 1) - sine * kept;
  }
}

void DualForm::reserve(Eigen::Index rows, Eigen::Index digs) {
  make_room(factor_, rows, rows);
  make_room(gains_, rows, digs);
  make_room(state_gains_, rows, state_variances_.size());
  if (innovations_.size() < rows) innovations_.conservativeResize(factor_.rows());
}

BelievedDensity DualForm::at(const FieldPoints& points) const {
  const Eigen::Index digs = parts_.size();
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  const Eigen::Index count = points.x.size();
  const Eigen::VectorXd weights =
      gains_.topLeftCorner(rows, digs).transpose() * innovations_.head(rows);
  const Eigen::MatrixXd triangle = triangle_.topLeftCorner(digs, digs).transpose();
  BelievedDensity result{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  Eigen::ArrayXXd covariances(block, digs);
  Eigen::MatrixXd explained(block, digs);
  for (Eigen::Index first = 0; first < count; first += block) {
    const Eigen::Index size = std::min(block, count - first);
    covariances.resize(size, digs);
    for (Eigen::Index d = 0; d < digs; ++d) {
      field_.covariances(parts_.all()[static_cast<std::size_t>(d)], points, first,
                         covariances.col(d));
    }
    result.raw_percent.segment(first, size) =
        settings_.mean_percent + (covariances.matrix() * weights).array();
    if (digs > 0)
      explained.noalias() = covariances.matrix() * triangle.triangularView<Eigen::Upper>();
    for (Eigen::Index i = 0; i < size; ++i) {
      const double depth = points.depths[points.layer[static_cast<std::size_t>(first + i)]];
      result.sd_percent(first + i) = field_.variance(depth);
    }
    auto variances = result.sd_percent.segment(first, size);
    for (Eigen::Index d = 0; d < digs; ++d) variances -= explained.col(d).array().square();
    variances = variances.max(0.0).sqrt();
  }
  return result;
}

BelievedMeans DualForm::means_of(const std::vector<FieldPart>& parts) const {
  const Eigen::Index digs = parts_.size();
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  const auto count = static_cast<Eigen::Index>(parts.size());
  Eigen::MatrixXd with_digs(digs, count);
  BelievedMeans result{Eigen::VectorXd(count), Eigen::MatrixXd(count, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const FieldPart& part = parts[static_cast<std::size_t>(i)];
    with_digs.col(i) = field_.covariances(part, parts_);
    for (Eigen::Index j = 0; j <= i; ++j) {
      result.covariance(i, j) = result.covariance(j, i) =
          field_.covariance(parts[static_cast<std::size_t>(j)], part);
    }
  }
  if (digs == 0) {  // a triangle without a first element may not be multiplied
    result.raw_percent.setConstant(settings_.mean_percent);
    return result;
  }
  const Eigen::VectorXd weights =
      gains_.topLeftCorner(rows, digs).transpose() * innovations_.head(rows);
  result.raw_percent = with_digs.transpose() * weights;
  result.raw_percent.array() += settings_.mean_percent;
  const Eigen::MatrixXd explained =
      triangle_.topLeftCorner(digs, digs).triangularView<Eigen::Lower>() * with_digs;
  result.covariance -= explained.transpose() * explained;
  result.covariance.diagonal() = result.covariance.diagonal().cwiseMax(0.0);
  return result;
}

CommonStates DualForm::common_states() const {
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  const Eigen::MatrixXd gains = state_gains_.topRows(rows) * state_variances_.asDiagonal();
  const StateVector mean = gains.transpose() * innovations_.head(rows);
  const StateVector variance = state_variances_ - gains.colwise().squaredNorm().transpose();
  const auto state = [&](State i) {
    return Measured{mean(i), std::sqrt(std::max(0.0, variance(i)))};
  };
  return {state(law_error), state(payload_error), state(log_strength)};
}

std::vector<double> DualForm::innovations() const {
  std::vector<double> result;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    if (!rows_[r].is_limit) result.push_back(innovations_(static_cast<Eigen::Index>(r)));
  }
  return result;
}

double DualForm::log_likelihood() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    if (rows_[i].is_limit) continue;
    sum -= 0.5 * std::pow(innovations_(r), 2) + std::log(factor_(r, r)) + 0.5 * std::log(2.0 * pi);
  }
  return sum;
}

}  // namespace excavplan
