// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/earthmoving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double degree = pi / 180.0;

double cot(double angle) { return 1.0 / std::tan(angle); }

constexpr double lowest_failure = 2.0 * degree;

/// Golden section between two angles, to `tolerance`.
template <typename Function>
double least_between(double low, double high, double tolerance, const Function& function) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double at_a = function(a);
  double at_b = function(b);
  while (high - low > tolerance) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = function(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = function(b);
    }
  }
  return 0.5 * (low + high);
}

/// Minimum of a function of the failure angle: the best of a 1 deg scan, then golden section.
template <typename Function>
std::optional<double> least_failure_angle(double highest, double tolerance,
                                          const Function& function) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double angle = lowest_failure; angle < highest; angle += degree) {
    if (const double value = function(angle); value < least) {
      least = value;
      best = angle;
    }
  }
  if (std::isinf(least)) return std::nullopt;
  return least_between(std::max(lowest_failure, best - degree), std::min(highest, best + degree),
                       tolerance, function);
}

double highest_failure_angle(const CuttingWedge& wedge) {
  return std::min(pi / 2.0, pi - wedge.rake - wedge.tool_friction - wedge.friction) - 0.1 * degree;
}

}  // namespace

std::optional<EarthmovingFactors> earthmoving_factors(const CuttingWedge& wedge, double failure) {
  const double cot_plane = cot(failure + wedge.friction);
  const double cot_rake = cot(wedge.rake);
  const double face = wedge.rake + wedge.tool_friction;
  EarthmovingFactors n;
  n.rake = wedge.rake;
  n.failure = failure;
  n.D = std::cos(face) + std::sin(face) * cot_plane;
  if (!(n.D > 0.0)) return std::nullopt;
  const double weight = (std::cos(wedge.slope) + std::sin(wedge.slope) * cot_plane) / n.D;
  n.Q = weight;
  n.q = (cot_rake + cot(failure)) * weight;
  n.gamma = 0.5 * n.q;
  n.c = (1.0 + cot(failure) * cot_plane) / n.D;
  n.ca = (1.0 - cot_rake * cot_plane) / n.D;
  return n;
}

namespace {

double gravity_factor(const CuttingWedge& wedge, double failure) {
  const auto n = earthmoving_factors(wedge, failure);
  return n && n->gamma > 0.0 ? n->gamma : std::numeric_limits<double>::infinity();
}

/// The critical angle of a wedge little different from one whose angle is known, to 1e-6 rad: the
/// factors, which have their minimum there, are then exact to rounding.
double critical_failure_near(const CuttingWedge& wedge, double guess) {
  const auto factor = [&](double failure) { return gravity_factor(wedge, failure); };
  const double highest = highest_failure_angle(wedge);
  const double low = std::max(lowest_failure, guess - 4.0 * degree);
  const double high = std::min(highest, guess + 4.0 * degree);
  if (high > low) {
    const double found = least_between(low, high, 1e-6, factor);
    if (found > low + 1e-5 && found < high - 1e-5) return found;
  }
  return least_failure_angle(highest, 1e-6, factor).value_or(highest);
}

}  // namespace

std::optional<double> critical_failure_angle(const CuttingWedge& wedge) {
  return least_failure_angle(highest_failure_angle(wedge), 1e-8,
                             [&](double failure) { return gravity_factor(wedge, failure); });
}

EarthmovingFactors crescent_factors(const CuttingWedge& wedge, double failure, double width_ratio) {
  const double reach = cot(wedge.rake) + cot(failure);  // r / t
  const double side =
      std::sqrt(cot(failure) * cot(failure) + 2.0 * cot(wedge.rake) * cot(failure)) / width_ratio;
  EarthmovingFactors n;
  n.rake = wedge.rake;
  n.failure = failure;
  n.D = cot(wedge.rake + wedge.tool_friction) + cot(failure + wedge.friction);
  n.gamma = 0.5 * reach * (1.0 + 2.0 / 3.0 * side) / n.D;
  n.c = (1.0 + cot(failure) * cot(failure + wedge.friction)) * (1.0 + side) / n.D;
  n.q = reach * (1.0 + side) / n.D;
  return n;
}

double side_plane_force(const CuttingWedge& wedge, const EarthmovingFactors& factors,
                        const SoilStrength& strength, double depth) {
  const double area = 0.5 * depth * depth * (cot(wedge.rake) + cot(factors.failure));
  const double pressure = (1.0 - std::sin(wedge.friction)) * strength.unit_weight * depth / 3.0;
  return 2.0 * area * (strength.cohesion + pressure * std::tan(wedge.friction));
}

double side_plane_share(const CuttingWedge& wedge, const EarthmovingFactors& factors) {
  const double beta = factors.failure;
  return (std::sin(beta) + std::cos(beta) * cot(beta + wedge.friction)) / factors.D;
}

namespace {
constexpr int rakes = 45;
constexpr int slopes = 19;
constexpr double lowest_rake = 10.0 * degree;
constexpr double rake_step = 2.5 * degree;
constexpr double highest_slope = 40.0 * degree;
}  // namespace

CriticalWedges::CriticalWedges(double friction, double tool_friction)
    : friction_(friction), tool_friction_(tool_friction) {
  require(friction < 60.0 * degree, "earthmoving: friction angle", friction,
          "below 60 deg, in rad");
  require(tool_friction >= 0.0 && tool_friction <= friction, "earthmoving: tool friction angle",
          tool_friction, "in 0 .. " + number_text(friction) + " rad, that of the soil");
  // Nearer than 20 deg to the locked wedge the equation is not used: a dead wedge forms there.
  highest_rake_ = std::min(lowest_rake + (rakes - 1) * rake_step,
                           pi - friction - tool_friction - 20.0 * degree);
  // Ground that falls away as steeply as it can stand needs no force: stay 5 deg from there.
  lowest_slope_ = -std::max(0.0, friction - 5.0 * degree);
  slope_step_ = (highest_slope - lowest_slope_) / (slopes - 1);
  failure_.reserve(std::size_t{rakes} * slopes);
  for (int i = 0; i < rakes; ++i) {
    for (int j = 0; j < slopes; ++j) {
      const CuttingWedge wedge{std::min(lowest_rake + i * rake_step, highest_rake_), friction,
                               tool_friction, lowest_slope_ + j * slope_step_};
      failure_.push_back(critical_failure_near(wedge, failure_.empty() ? 0.0 : failure_.back()));
    }
  }
}

CriticalWedges::Held CriticalWedges::held(double rake, double slope) const {
  return {std::clamp(rake, lowest_rake, highest_rake_),
          std::clamp(slope, lowest_slope_, highest_slope)};
}

double CriticalWedges::failure_at(const Held& wedge) const {
  const double u = (wedge.rake - lowest_rake) / rake_step;
  const double v = (wedge.slope - lowest_slope_) / slope_step_;
  const auto i = static_cast<std::size_t>(std::min(u, rakes - 2.0));
  const auto j = static_cast<std::size_t>(std::min(v, slopes - 2.0));
  const double s = u - static_cast<double>(i);
  const double t = v - static_cast<double>(j);
  const double* cell = &failure_[i * slopes + j];
  return (1.0 - s) * ((1.0 - t) * cell[0] + t * cell[1]) +
         s * ((1.0 - t) * cell[slopes] + t * cell[slopes + 1]);
}

EarthmovingFactors CriticalWedges::at(double rake, double slope) const {
  const Held wedge = held(rake, slope);
  return earthmoving_factors({wedge.rake, friction_, tool_friction_, wedge.slope},
                             failure_at(wedge))
      .value();
}

FrictionWedges::FrictionWedges(double lowest, double highest, double tool_ratio) : lowest_(lowest) {
  const double widest = 2.5 * degree;
  const auto steps = std::max(1, static_cast<int>(std::ceil((highest - lowest) / widest)));
  step_ = (highest - lowest) / steps;
  require(lowest <= highest, "earthmoving: lowest friction angle", lowest,
          "at most the highest, " + number_text(highest) + " rad");
  require(tool_ratio >= 0.0 && tool_ratio <= 1.0, "earthmoving: tool friction ratio", tool_ratio,
          "in 0 .. 1");
  for (int i = 0; i <= (step_ > 0.0 ? steps : 0); ++i) {
    tables_.emplace_back(lowest + i * step_, tool_ratio * (lowest + i * step_));
  }
}

EarthmovingFactors FrictionWedges::at(double rake, double slope, double friction) const {
  if (tables_.size() == 1) return tables_.front().at(rake, slope);
  const auto last = static_cast<double>(tables_.size() - 1);
  const double u = std::clamp((friction - lowest_) / step_, 0.0, last);
  const auto i = static_cast<std::size_t>(std::min(u, last - 1.0));
  const double t = u - static_cast<double>(i);
  const CriticalWedges& a = tables_[i];
  const CriticalWedges& b = tables_[i + 1];
  // What both tables hold: a wedge of the higher friction locks at a lower rake.
  const CriticalWedges::Held of_b = b.held(rake, slope);
  const CriticalWedges::Held wedge = a.held(of_b.rake, of_b.slope);
  const double failure = (1.0 - t) * a.failure_at(wedge) + t * b.failure_at(wedge);
  const double phi = (1.0 - t) * a.friction_ + t * b.friction_;
  const double delta = (1.0 - t) * a.tool_friction_ + t * b.tool_friction_;
  return earthmoving_factors({wedge.rake, phi, delta, wedge.slope}, failure).value();
}

double blunt_edge_ratio(double edge_angle, double friction, double tool_friction) {
  const double sin_phi = std::sin(friction);
  const double ratio = friction > 0.0 ? std::min(1.0, std::sin(tool_friction) / sin_phi) : 0.0;
  const double turn = std::asin(ratio);
  if (edge_angle < 0.5 * (turn - tool_friction)) {
    return (1.0 - sin_phi * std::cos(2.0 * edge_angle)) / (1.0 - sin_phi);
  }
  const double sin_delta = std::sin(tool_friction);
  const double root = std::sqrt(std::max(0.0, sin_phi * sin_phi - sin_delta * sin_delta));
  const double cos_delta = std::cos(tool_friction);
  return cos_delta * (cos_delta + root) / (1.0 - sin_phi) *
         std::exp((2.0 * edge_angle - pi + tool_friction + turn) * std::tan(friction));
}

}  // namespace excavplan
