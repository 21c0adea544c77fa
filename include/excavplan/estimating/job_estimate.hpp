// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <excavplan/base/measured.hpp>
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/design/design_words.hpp>
#include <excavplan/estimating/played_jobs.hpp>
#include <excavplan/machine/fuel_model.hpp>
#include <excavplan/planning/full_dig.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// What a job is going to take, before its first bucket (docs/methods.md#estimate-of-a-job).

namespace excavplan {

/// What is to be taken out, as an estimate sees it.
struct JobShape {
  Measured volume;           ///< of the bank [m^3], > 0
  double length = 0.0;       ///< the longest in plan [m], > 0
  double width = 0.0;        ///< area in plan over it [m], > 0
  double depth = 0.0;        ///< volume over that area [m], > 0
  double steep_share = 0.0;  ///< of that area, of faces steeper than 20 degrees in the design [-]
};
/// @throws Error (bad_input) if nothing of the design is below the ground
JobShape shape_of(const DesignSurface& design, const CutAndFill& cut);
/// The cut of a design in words into level ground, without error.
/// @throws Error (bad_input) as design_of_words()
JobShape shape_on_level_ground(DesignWords words);

/// A job before its first bucket.
struct JobOutline {
  JobShape shape;                     ///< of the design over the ground
  GroundDensity density{50.0, 25.0};  ///< of the bank; unless told, ours
  double truck_mass = 15000.0;        ///< of a load [kg], > 0; ours
};

/// Deviations of the logarithm of a figure, by where they come from [-].
struct EstimateSpread {
  double volume = 0.0;   ///< of the design against the scan
  double density = 0.0;  ///< of the ground: at its deviation more and less
  double played = 0.0;   ///< from job to job among those played; Student's t for as few
  double unlike = 0.0;   ///< of a job that is not as those played
  double fuel = 0.0;     ///< of the fuel model
  double fill = 0.0;     ///< of a truck

  double total() const;  ///< in quadrature
};

/// A figure that is log-normal.
struct EstimatedFigure {
  double value = 0.0;     ///< in the unit of the figure
  EstimateSpread spread;  ///< of that value
  double least = 0.0;     ///< less is impossible

  std::array<double, 2> interval() const;  ///< 95 %
};

/// What a job takes.
struct JobEstimate {
  EstimatedFigure swollen;          ///< volume as it lies loose [m^3]
  EstimatedFigure mass;             ///< moist [kg]
  EstimatedFigure digs;             ///< with those that finish, one at least
  EstimatedFigure time;             ///< with moves and scans [s]
  EstimatedFigure energy;           ///< of cycles and moves [J]
  EstimatedFigure fuel;             ///< [L]
  EstimatedFigure truckloads;       ///< if all soil goes by truck
  PlannedDig dig;                   ///< the best full dig at the likely density
  double reference_digs = 0.0;      ///< of it, that the swollen volume takes
  double reference_energy = 0.0;    ///< R: of these [J/m^3], of the design
  double reference_time = 0.0;      ///< of these [s]
  std::vector<std::string> unlike;  ///< in what the job differs from those played

  bool trustworthy() const { return unlike.empty(); }  ///< whether played jobs were like this one
};

/// What an estimate is about, in words.
struct EstimatedJob {
  std::string design;   ///< "trench 10x0.7x1.2m"; may be empty
  std::string soil;     ///< its name
  std::string machine;  ///< its name
};

/// What estimates rest on.
struct EstimateBasis {
  FuelModel fuel;                ///< of the machine's engine
  PlayedJobs played;             ///< jobs by which the reference is scaled
  FullDigOptions full_dig = {};  ///< of the best full dig, by which energy and time are foretold
};

/// What is shipped: the fuel model of the zx120, scaled to the engine of another machine, and the
/// played jobs. @throws Error (bad_file)
EstimateBasis shipped_basis(const Machine& machine);

/// Swollen volume over the payload of the best full dig, times what played jobs took over that.
/// @throws Error (bad_input) as best_full_dig(), or if a number is out of range, or no dig is
/// feasible
JobEstimate estimate_job(const Machine& machine, const SoilKind& soil, const JobOutline& job,
                         const EstimateBasis& basis);

}  // namespace excavplan
