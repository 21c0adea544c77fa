// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil/earthmoving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

double cot(double angle) { return 1.0 / std::tan(angle); }

constexpr double lowest_failure = 2.0 * degree;

double highest_failure_angle(const CuttingWedge& wedge) {
  return std::min(pi / 2.0, pi - wedge.rake - wedge.tool_friction - wedge.friction) - 0.1 * degree;
}

}  // namespace

std::optional<EarthmovingFactors> earthmoving_factors(const CuttingWedge& wedge, double failure) {
  const double cot_plane = cot(failure + wedge.friction);
  const double face = wedge.rake + wedge.tool_friction;
  EarthmovingFactors n;
  n.rake = wedge.rake;
  n.failure = failure;
  n.sin_face = std::sin(face);
  n.cos_face = std::cos(face);
  n.D = n.cos_face + n.sin_face * cot_plane;
  if (!(n.D > 0.0)) return std::nullopt;
  n.cot_rake = cot(wedge.rake);
  n.cot_failure = cot(failure);
  const double weight = (std::cos(wedge.slope) + std::sin(wedge.slope) * cot_plane) / n.D;
  n.Q = weight;
  n.q = (n.cot_rake + n.cot_failure) * weight;
  n.gamma = 0.5 * n.q;
  n.c = (1.0 + n.cot_failure * cot_plane) / n.D;
  n.ca = (1.0 - n.cot_rake * cot_plane) / n.D;
  return n;
}

namespace {

double gravity_factor(const CuttingWedge& wedge, double failure) {
  const auto n = earthmoving_factors(wedge, failure);
  return n && n->gamma > 0.0 ? n->gamma : std::numeric_limits<double>::infinity();
}

}  // namespace

// With u = cot(failure + friction) the factor is a quotient of two quadratics, and where its slope
// is zero is a quadratic as well. Its roots and the ends of the range are where it can be least.
std::optional<double> critical_failure_angle(const CuttingWedge& wedge) {
  const double sin_phi = std::sin(wedge.friction);
  const double cos_phi = std::cos(wedge.friction);
  const double cot_rake = cot(wedge.rake);
  const double sin_face = std::sin(wedge.rake + wedge.tool_friction);
  const double cos_face = std::cos(wedge.rake + wedge.tool_friction);
  // (a + b u)(cos slope + u sin slope) / ((cos phi - u sin phi)(cos face + u sin face))
  const double a = cot_rake * cos_phi + sin_phi;
  const double b = cos_phi - cot_rake * sin_phi;
  const double sin_slope = std::sin(wedge.slope);
  const double cos_slope = std::cos(wedge.slope);
  const double n0 = a * cos_slope, n1 = b * cos_slope + a * sin_slope, n2 = b * sin_slope;
  const double d0 = cos_phi * cos_face, d1 = cos_phi * sin_face - sin_phi * cos_face,
               d2 = -sin_phi * sin_face;
  const double square = n2 * d1 - n1 * d2;
  const double linear = n2 * d0 - n0 * d2;
  const double constant = n1 * d0 - n0 * d1;
  const double root = std::sqrt(std::max(0.0, linear * linear - square * constant));
  const double larger = -(linear + std::copysign(root, linear));
  const double highest = highest_failure_angle(wedge);
  std::optional<double> best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double failure) {
    if (!(failure >= lowest_failure && failure <= highest)) return;
    if (const double factor = gravity_factor(wedge, failure); factor < least) {
      least = factor;
      best = failure;
    }
  };
  for (const double u : {larger / square, constant / larger}) {
    consider(std::atan2(1.0, u) - wedge.friction);
  }
  consider(lowest_failure);
  consider(highest);
  return best;
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

SoilAtRest::SoilAtRest(double friction)
    : pressure(1.0 - std::sin(friction)), tangent(std::tan(friction)) {}

double side_plane_force(const EarthmovingFactors& factors, const SoilStrength& strength,
                        const SoilAtRest& rest, double depth) {
  const double area = 0.5 * depth * depth * (factors.cot_rake + factors.cot_failure);
  const double pressure = rest.pressure * strength.unit_weight * depth / 3.0;
  return 2.0 * area * (strength.cohesion + pressure * rest.tangent);
}

double side_plane_force(const CuttingWedge& wedge, const EarthmovingFactors& factors,
                        const SoilStrength& strength, double depth) {
  return side_plane_force(factors, strength, SoilAtRest(wedge.friction), depth);
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
      failure_.push_back(critical_failure_angle(wedge).value_or(highest_failure_angle(wedge)));
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
