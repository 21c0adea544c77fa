// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/earthmoving.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180.0;

double cot(double angle) { return 1.0 / std::tan(angle); }

/// Minimum of a function of the failure angle: the best of a 1 deg scan, then golden section.
template <typename Function>
std::optional<double> least_failure_angle(double highest, const Function& function) {
  const double lowest = 2.0 * degree;
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double angle = lowest; angle < highest; angle += degree) {
    if (const double value = function(angle); value < least) {
      least = value;
      best = angle;
    }
  }
  if (std::isinf(least)) return std::nullopt;
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = std::max(lowest, best - degree);
  double high = std::min(highest, best + degree);
  while (high - low > 1e-8) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    (function(a) < function(b) ? high : low) = function(a) < function(b) ? b : a;
  }
  return 0.5 * (low + high);
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

std::optional<double> critical_failure_angle(const CuttingWedge& wedge) {
  return least_failure_angle(highest_failure_angle(wedge), [&](double failure) {
    const auto n = earthmoving_factors(wedge, failure);
    return n && n->gamma > 0.0 ? n->gamma : std::numeric_limits<double>::infinity();
  });
}

EarthmovingFactors crescent_factors(const CuttingWedge& wedge, double failure, double width_ratio) {
  const double reach = cot(wedge.rake) + cot(failure);  // r / t
  const double side =
      std::sqrt(cot(failure) * cot(failure) + 2.0 * cot(wedge.rake) * cot(failure)) / width_ratio;
  EarthmovingFactors n;
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
  if (!(tool_friction >= 0.0 && tool_friction <= friction && friction < 60.0 * degree)) {
    throw Error(ErrorKind::bad_input,
                "earthmoving: friction angles must be 0 <= tool <= soil < 60 deg, got " +
                    std::to_string(tool_friction / degree) + " and " +
                    std::to_string(friction / degree));
  }
  // Nearer than 20 deg to the locked wedge the equation is not used: a dead wedge forms there.
  highest_rake_ = std::min(lowest_rake + (rakes - 1) * rake_step,
                           pi - friction - tool_friction - 20.0 * degree);
  // Ground that falls away as steeply as it can stand needs no force: stay 5 deg from there.
  lowest_slope_ = -std::max(0.0, friction - 5.0 * degree);
  slope_step_ = (highest_slope - lowest_slope_) / (slopes - 1);
  failure_.reserve(rakes * slopes);
  for (int i = 0; i < rakes; ++i) {
    for (int j = 0; j < slopes; ++j) {
      const CuttingWedge wedge{std::min(lowest_rake + i * rake_step, highest_rake_), friction,
                               tool_friction, lowest_slope_ + j * slope_step_};
      failure_.push_back(critical_failure_angle(wedge).value_or(highest_failure_angle(wedge)));
    }
  }
}

EarthmovingFactors CriticalWedges::at(double rake, double slope) const {
  const double held_rake = std::clamp(rake, lowest_rake, highest_rake_);
  const double held_slope = std::clamp(slope, lowest_slope_, highest_slope);
  const double u = (held_rake - lowest_rake) / rake_step;
  const double v = (held_slope - lowest_slope_) / slope_step_;
  const auto i = static_cast<std::size_t>(std::min(u, rakes - 2.0));
  const auto j = static_cast<std::size_t>(std::min(v, slopes - 2.0));
  const double s = u - static_cast<double>(i);
  const double t = v - static_cast<double>(j);
  const double* cell = &failure_[i * slopes + j];
  const double failure = (1.0 - s) * ((1.0 - t) * cell[0] + t * cell[1]) +
                         s * ((1.0 - t) * cell[slopes] + t * cell[slopes + 1]);
  const CuttingWedge wedge{held_rake, friction_, tool_friction_, held_slope};
  return earthmoving_factors(wedge, failure).value();
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
