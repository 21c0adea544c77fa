// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "belief/density_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace excavplan {
namespace {

constexpr double root_3 = 1.7320508075688772;

constexpr double farthest = 700.0;  // scaled distance, beyond which exp(-x) is no double

/// exp(-x) for x in 0 .. farthest within 1e-12: by powers of two and a Taylor series, without
/// branches and calls: compilers compute several at once.
inline double decay(double x) {
  constexpr double shifter = 6755399441055744.0;  // 1.5 2^52: the sum's last bits are an integer
  const double shifted = x * 1.4426950408889634 + shifter;
  const double r = (shifted - shifter) * 0.6931471805599453 - x;  // within 0.35
  const double r2 = r * r;
  const double r4 = r2 * r2;
  const double low = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
  const double middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
  const double high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0);
  const double series = low + r4 * (middle + r4 * high);
  std::uint64_t bits = 0;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (std::uint64_t{1023} - bits) << 52;  // 2^-n
  double power = 0.0;
  std::memcpy(&power, &bits, sizeof power);
  return series * power;
}

/// In place.
void decay_all(Eigen::ArrayXd& numbers) {
  double* const values = numbers.data();
  const Eigen::Index count = numbers.size();
  for (Eigen::Index i = 0; i < count; ++i) values[i] = decay(values[i]);
}

/// Matern 3/2.
double correlation(double scaled) {
  const double bounded = std::min(scaled, farthest);
  return (1.0 + bounded) * decay(bounded);
}

bool same_column(const GroundPlace& a, const GroundPlace& b) { return a.x == b.x && a.y == b.y; }

/// The first place of the next column.
std::size_t end_of_column(const FieldPart& part, std::size_t first) {
  std::size_t end = first + 1;
  while (end < part.places.size() && same_column(part.places[first].at, part.places[end].at)) ++end;
  return end;
}

}  // namespace

FieldPart field_part(const std::vector<BankPart>& bank) {
  FieldPart part;
  double volume = 0.0;
  for (const BankPart& of_bank : bank) volume += of_bank.volume;
  for (const BankPart& of_bank : bank) {
    const double weight = of_bank.volume / volume;
    part.places.push_back({of_bank.place, weight});
    part.depth += weight * of_bank.place.depth;
  }
  return part;
}

FieldPoints::FieldPoints(const std::vector<GroundPlace>& places)
    : x(static_cast<Eigen::Index>(places.size())), y(x.size()), layer(places.size()) {
  for (const GroundPlace& place : places) depths.push_back(place.depth);
  std::sort(depths.begin(), depths.end());
  depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    x(static_cast<Eigen::Index>(i)) = places[i].x;
    y(static_cast<Eigen::Index>(i)) = places[i].y;
    const auto at = std::lower_bound(depths.begin(), depths.end(), places[i].depth);
    layer[i] = static_cast<std::size_t>(at - depths.begin());
  }
}

void FieldParts::add(FieldPart part) {
  for (const FieldPart::Place& place : part.places) {
    x_.push_back(place.at.x);
    y_.push_back(place.at.y);
    depth_.push_back(place.at.depth);
  }
  parts_.push_back(std::move(part));
}

DensityField::DensityField(const BeliefSettings& settings)
    : level_variance_(std::pow(settings.level_sd_percent, 2)),
      trend_variance_(std::pow(settings.trend_sd_percent_per_m, 2)),
      spread_variance_(std::pow(settings.spread_percent, 2)),
      scale_(root_3 / settings.length),
      depth_scale_(root_3 / settings.depth_length) {}

double DensityField::variance(double depth) const {
  return level_variance_ + trend_variance_ * depth * depth + spread_variance_;
}

double DensityField::covariance(const FieldPart& a, const FieldPart& b) const {
  FieldParts parts;
  parts.add(b);
  return covariances(a, parts)(0);
}

Eigen::VectorXd DensityField::covariances(const FieldPart& part, const FieldParts& parts) const {
  using Numbers = Eigen::Map<const Eigen::ArrayXd>;
  const auto count = static_cast<Eigen::Index>(parts.x_.size());
  const Numbers x(parts.x_.data(), count);
  const Numbers y(parts.y_.data(), count);
  const Numbers depth(parts.depth_.data(), count);
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(count);
  Eigen::ArrayXd in_plan(count);
  Eigen::ArrayXd over_depth(count);
  Eigen::ArrayXd both(count);
  const GroundPlace* column = nullptr;
  for (const FieldPart::Place& place : part.places) {
    if (column == nullptr || !same_column(*column, place.at)) {
      in_plan = scale_ * ((x - place.at.x).square() + (y - place.at.y).square()).sqrt();
    }
    column = &place.at;
    over_depth = depth_scale_ * (depth - place.at.depth).abs();
    both = (in_plan + over_depth).min(farthest);
    decay_all(both);
    sum += place.weight * (1.0 + in_plan) * (1.0 + over_depth) * both;
  }
  Eigen::VectorXd result(parts.size());
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    const FieldPart& other = parts.parts_[static_cast<std::size_t>(i)];
    double field = 0.0;
    for (const FieldPart::Place& place : other.places) field += place.weight * sum(at++);
    result(i) =
        level_variance_ + trend_variance_ * part.depth * other.depth + spread_variance_ * field;
  }
  return result;
}

void DensityField::covariances(const FieldPart& part, const FieldPoints& points, Eigen::Index first,
                               Eigen::Ref<Eigen::ArrayXd> result) const {
  const Eigen::Index count = result.size();
  const auto layer = [&](Eigen::Index i) {
    return points.layer[static_cast<std::size_t>(first + i)];
  };
  const double slope = trend_variance_ * part.depth;
  result.setConstant(level_variance_ + slope * points.depths.front());
  if (points.depths.size() > 1) {
    for (Eigen::Index i = 0; i < count; ++i) {
      result(i) = level_variance_ + slope * points.depths[layer(i)];
    }
  }
  std::vector<double> factor(points.depths.size());
  Eigen::ArrayXd in_plan(count);
  Eigen::ArrayXd decayed(count);
  for (std::size_t j = 0; j < part.places.size();) {
    const GroundPlace& column = part.places[j].at;
    std::fill(factor.begin(), factor.end(), 0.0);
    for (const std::size_t end = end_of_column(part, j); j < end; ++j) {
      for (std::size_t k = 0; k < factor.size(); ++k) {
        factor[k] +=
            spread_variance_ * part.places[j].weight *
            correlation(depth_scale_ * std::abs(part.places[j].at.depth - points.depths[k]));
      }
    }
    in_plan = scale_ * ((points.x.segment(first, count) - column.x).square() +
                        (points.y.segment(first, count) - column.y).square())
                           .sqrt()
                           .min(farthest);
    decayed = in_plan;
    decay_all(decayed);
    if (factor.size() == 1) {
      result += factor.front() * (1.0 + in_plan) * decayed;
    } else {
      for (Eigen::Index i = 0; i < count; ++i) {
        result(i) += factor[layer(i)] * (1.0 + in_plan(i)) * decayed(i);
      }
    }
  }
}

}  // namespace excavplan
