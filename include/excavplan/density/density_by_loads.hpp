// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/logs/dig_log.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil_scatter.hpp>

/// @file
/// The density of the ground from the work that the joints did in a dig: harder soil takes more
/// (docs/methods.md#second-densities).

namespace excavplan {

/// How the strength of soils of one kind differs from site to site: standard deviations of the
/// logarithm. Ours; Phoon and Kulhawy 1999 give 10 .. 55 % for undrained strength, 5 .. 15 % for
/// the angle of friction and 20 .. 60 % for cone resistance (recalled), within a site.
struct StrengthScatter {
  double cohesion = 0.4;        ///< of the undisturbed soil
  double adhesion_ratio = 0.4;  ///< of adhesion over cohesion
  double friction = 0.1;        ///< of both angles of friction
  double cone_index = 0.4;      ///< at any density
  /// Of the soil's resistance in the simulator about that of real soil: the eight published forces
  /// of docs/validation.md are 0.71 .. 1.23 of the computed ones.
  double simulator = 0.2;
};

/// A soil of this kind with the strength that it has at another site. The same seed gives the same.
/// @throws Error (bad_input) unless each deviation is in 0 .. 1
SoilKind drawn_strength(const SoilKind& soil, const StrengthScatter& scatter, std::uint64_t seed);

/// The work that the joints did in one dig [J], with the error of the meter.
/// @param meter_sd  of the meter, as a share of its reading
/// @throws Error (bad_file) if the log is not of the joints, holds several digs or no work;
///         (bad_input) unless the deviation is in 0 .. 1
Measured joint_work(const DigLog& log, double meter_sd);

/// A dig whose joint loads were recorded.
struct LoadedDig {
  const Machine& machine;         ///< that dug; here it never stalls
  const DigPath& path;            ///< that it dug
  const Terrain& ground;          ///< before the dig
  const SoilKind& soil;           ///< kind of the ground
  SoilScatter scatter = {};       ///< of its void ratios
  StrengthScatter strength = {};  ///< of its strength
};

/// Work of the joints over the density of the ground: of the kind, and how far soils of the kind
/// lie from it.
struct WorkOverDensity {
  /// At one density.
  struct Point {
    double density_percent = 0.0;  ///< of the ground
    double log_work = 0.0;         ///< natural logarithm of the work [J] in the kind itself
    double sd = 0.0;               ///< of that logarithm over drawn soils and simulators
    /// Covariance of that logarithm and of the density that the law of the kind gives [points].
    double with_law = 0.0;
  };
  std::vector<Point> points;  ///< from 0 to 100 %

  /// Between two points. @param density_percent  outside of 0 .. 100 the nearest
  Point at(double density_percent) const;
};

/// Digs the built-in simulator at 0, 10 .. 100 %: in the kind, and in 40 soils drawn about it.
/// @param freed_form  of the law that gives the other density
/// @throws Error (bad_input) as SoilSimulator::dig()
WorkOverDensity work_over_density(const LoadedDig& dig, const DensityForm& freed_form,
                                  unsigned threads = 0);

/// The density by the joint loads. All densities in 0 .. 100 % are equally likely before.
struct LoadsDensity {
  Measured work;  ///< of the joints [J]
  /// Mean and deviation of the posterior; none for a work more than 2.5 deviations above or below
  /// that expected at every density.
  std::optional<Measured> density_percent;
  std::array<double, 2> interval_percent = {0.0, 100.0};  ///< 95 % of it
  std::string reason = {};    ///< why there is none; empty if there is one
  RelativeDensity by_scans;   ///< the density without the loads
  RelativeDensity density;    ///< of both; that of the scans where they disagree
  double weight = 0.0;        ///< of the loads in it, 0 .. 1
  double disagreement = 0.0;  ///< work over that expected at the scans' density, in deviations
  bool disagrees() const;     ///< by more than 2.5 of them, or out of range
};

/// The posterior of the density by work alone, and its mean of least variance with `by_scans`, for
/// which the logarithm of the work is linear in the density about that one.
/// @throws Error (bad_input) unless the work is positive and finite and there are two points
LoadsDensity density_by_loads(const WorkOverDensity& expected, const Measured& work,
                              const RelativeDensity& by_scans);

}  // namespace excavplan
