// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

/// @file
/// The fundamental equation of earthmoving: the force of soil that fails along a plane ahead of a
/// tool.
///
///     P / b = gamma t^2 N_gamma + c t N_c + q t N_q + Q N_Q + c_a t N_ca
///
/// P is the resultant on the tool's face, at the soil-tool friction angle to its normal. Sources:
/// Reece 1964; McKyes, Soil Cutting and Tillage, 1985; slope terms derived from the same wedge
/// (`docs/methods.md#earthmoving`). Angles in [rad].

namespace excavplan {

/// The wedge between tool face, failure plane and surface.
struct CuttingWedge {
  double rake = 0.0;           ///< rho, between the tool's face and the surface ahead, in (0, pi)
  double friction = 0.0;       ///< phi, inside the soil
  double tool_friction = 0.0;  ///< delta, between soil and tool
  double slope = 0.0;          ///< alpha, of the surface along the travel, positive uphill
};

/// The factors N of the equation, and the wedge they are for.
struct EarthmovingFactors {
  double gamma = 0.0;    ///< of the weight of the wedge
  double c = 0.0;        ///< of cohesion
  double q = 0.0;        ///< of a surcharge pressure
  double Q = 0.0;        ///< of a surcharge weight per width; use q or Q
  double ca = 0.0;       ///< of adhesion
  double rake = 0.0;     ///< rho of the wedge
  double failure = 0.0;  ///< beta, of the failure plane from the surface
  double D = 0.0;        ///< common denominator

  // Of the angles above; the force on the face is at rake + tool friction to the surface.
  double sin_face = 0.0, cos_face = 0.0, cot_rake = 0.0, cot_failure = 0.0;
};

/// Factors for a given failure angle. Nothing if that wedge cannot slide (denominator <= 0).
std::optional<EarthmovingFactors> earthmoving_factors(const CuttingWedge& wedge, double failure);

/// The failure angle of least N_gamma (McKyes 1985), in closed form.
///
/// @return nothing if no wedge can slide: rake + tool friction + friction too near to pi
std::optional<double> critical_failure_angle(const CuttingWedge& wedge);

/// Factors of the horizontal force per width of a narrow blade with side crescents (McKyes and
/// Ali 1977), level ground. `width_ratio` is b / t. An upper bound for a bucket, whose side plates
/// suppress the crescents; the simulators use side planes.
EarthmovingFactors crescent_factors(const CuttingWedge& wedge, double failure, double width_ratio);

/// Soil of a wedge.
struct SoilStrength {
  double unit_weight = 0.0;  ///< [N/m^3]
  double cohesion = 0.0;     ///< [Pa]
  double adhesion = 0.0;     ///< [Pa]
};

/// Of soil that does not yield sideways.
struct SoilAtRest {
  explicit SoilAtRest(double friction);

  double pressure;  ///< sideways over downwards, 1 - sin(friction) (Jaky 1944) [-]
  double tangent;   ///< of the friction angle
};

/// Cohesion and friction on the two vertical side planes of a wedge of this depth [m], to be added
/// to P times side_plane_share() [N] (Perumpral type; `docs/methods.md#earthmoving`).
/// @param factors  of earthmoving_factors()
double side_plane_force(const EarthmovingFactors& factors, const SoilStrength& strength,
                        const SoilAtRest& rest, double depth);
double side_plane_force(const CuttingWedge& wedge, const EarthmovingFactors& factors,
                        const SoilStrength& strength, double depth);

/// Factor from side_plane_force() to the force on the tool [-].
double side_plane_share(const CuttingWedge& wedge, const EarthmovingFactors& factors);

/// Factors at the critical failure angle over all rakes and slopes, tabulated once for a soil.
class CriticalWedges {
 public:
  /// Makes the table.
  /// @throws Error (bad_input) unless 0 <= tool_friction <= friction < 60 deg
  CriticalWedges(double friction, double tool_friction);

  /// Factors for this rake and slope [rad]. The rake is clamped to 10 .. 120 deg and to 20 deg
  /// below the rake at which no wedge can slide, the slope to -(friction - 5 deg) .. 40 deg.
  EarthmovingFactors at(double rake, double slope) const;

 private:
  friend class FrictionWedges;
  struct Held {
    double rake;
    double slope;
  };
  Held held(double rake, double slope) const;
  double failure_at(const Held& wedge) const;

  double friction_;
  double tool_friction_;
  double highest_rake_;
  double lowest_slope_;
  double slope_step_;
  std::vector<double> failure_;  ///< [rake index * slopes + slope index]
};

/// The same for a range of friction angles with a constant ratio of tool friction: for ground of
/// uneven density. The failure angle is interpolated between tables at most 2.5 deg of friction
/// apart.
class FrictionWedges {
 public:
  /// Makes the tables.
  /// @throws Error (bad_input) unless 0 <= lowest <= highest < 60 deg and tool_ratio is in 0 .. 1
  FrictionWedges(double lowest, double highest, double tool_ratio);

  /// Factors; `friction` is clamped to the range, rake and slope as by CriticalWedges.
  EarthmovingFactors at(double rake, double slope, double friction) const;

 private:
  double lowest_;
  double step_;
  std::vector<CriticalWedges> tables_;
};

/// Ratio of the passive pressure on a blunt edge to the pressure in the soil: A(x) of Balovnev 1983
/// for an edge at angle x.
double blunt_edge_ratio(double edge_angle, double friction, double tool_friction);

}  // namespace excavplan
