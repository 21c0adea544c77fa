// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "belief/density_field.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan {
namespace {

constexpr double root_3 = 1.7320508075688772;

/// Matern 3/2.
double correlation(double distance, double length) {
  const double a = root_3 * distance / length;
  return (1.0 + a) * std::exp(-a);
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

double DensityField::variance(double depth) const {
  return std::pow(settings_.level_sd_percent, 2) + std::pow(settings_.spread_percent, 2) +
         std::pow(settings_.trend_sd_percent_per_m * depth, 2);
}

double DensityField::covariance(const FieldPart& a, const FieldPart& b) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    for (std::size_t j = 0; j < b.places.size();) {
      const GroundPlace& one = a.places[i].at;
      const GroundPlace& other = b.places[j].at;
      const double distance =
          std::sqrt(std::pow(one.x - other.x, 2) + std::pow(one.y - other.y, 2));
      double over_depth = 0.0;
      for (const std::size_t end = end_of_column(b, j); j < end; ++j) {
        over_depth += b.places[j].weight * correlation(std::abs(one.depth - b.places[j].at.depth),
                                                       settings_.depth_length);
      }
      sum += a.places[i].weight * correlation(distance, settings_.length) * over_depth;
    }
  }
  return std::pow(settings_.level_sd_percent, 2) + std::pow(settings_.spread_percent, 2) * sum +
         std::pow(settings_.trend_sd_percent_per_m, 2) * a.depth * b.depth;
}

void DensityField::covariances(const FieldPart& part, const FieldPoints& points, Eigen::Index first,
                               Eigen::Ref<Eigen::ArrayXd> result) const {
  const Eigen::Index count = result.size();
  std::vector<double> factor(points.depths.size());
  const auto layer = [&](Eigen::Index i) {
    return points.layer[static_cast<std::size_t>(first + i)];
  };
  const double level = std::pow(settings_.level_sd_percent, 2);
  const double slope = std::pow(settings_.trend_sd_percent_per_m, 2) * part.depth;
  for (Eigen::Index i = 0; i < count; ++i) result(i) = level + slope * points.depths[layer(i)];

  const double scale = root_3 / settings_.length;
  Eigen::ArrayXd a(count);
  for (std::size_t j = 0; j < part.places.size();) {
    const GroundPlace& column = part.places[j].at;
    std::fill(factor.begin(), factor.end(), 0.0);
    for (const std::size_t end = end_of_column(part, j); j < end; ++j) {
      const double weight = std::pow(settings_.spread_percent, 2) * part.places[j].weight;
      for (std::size_t k = 0; k < factor.size(); ++k) {
        factor[k] += weight * correlation(std::abs(part.places[j].at.depth - points.depths[k]),
                                          settings_.depth_length);
      }
    }
    a = scale * ((points.x.segment(first, count) - column.x).square() +
                 (points.y.segment(first, count) - column.y).square())
                    .sqrt();
    a = (1.0 + a) * (-a).exp();
    if (factor.size() == 1) {
      result += factor.front() * a;
    } else {
      for (Eigen::Index i = 0; i < count; ++i) result(i) += factor[layer(i)] * a(i);
    }
  }
}

}  // namespace excavplan
