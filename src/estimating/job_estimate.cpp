// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/estimating/job_estimate.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/kinematics.hpp>

#include "base/check.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "efficiency/student.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr double idle_sd = 0.25;      // of ln of the idle flow
constexpr double drive_sd = 0.27;     // of ln of work over fuel: the model makes 0.17 of the fuel
                                      // work, 0.10 is published for whole excavators
constexpr double fill = 0.95;         // of the load of a truck
constexpr double fill_sd = 0.05;      // of ln of it
constexpr double joint_share = 0.9;   // of an engine's rated power that a machine file states
constexpr double unlike_sd = 0.25;    // of ln, for each thing in which a job is not as those played
constexpr double like = 2.0;          // a length up to this factor off is as played
constexpr double like_density = 5.0;  // so far outside of the densities played [points]
constexpr double narrow = 0.95;       // of the width of the bucket, and the cut is wider than told
constexpr double battered = 0.05;     // share of steep faces of a design with upright walls at most

/// The figures that played jobs scale.
enum Scaled : std::size_t { digs, time, energy, fuel_volume, scaled };
using Logarithms = std::array<double, scaled>;

/// All that changes with the density.
struct AtDensity {
  PlannedDig dig;
  double swollen = 0.0;            ///< [m^3]
  double mass = 0.0;               ///< [kg]
  std::vector<Logarithms> played;  ///< by each of the played jobs
  Logarithms mean = {};
};

/// Fuel of the whole job by the work of its joints and its time [L].
double litres(const FuelModel& fuel, double work, double time) {
  return fuel.flow(work / time) * time / 1000.0;
}

class Estimator {
 public:
  Estimator(const Machine& machine, const SoilKind& soil, const JobOutline& job,
            const EstimateBasis& basis)
      : machine_(machine), soil_(soil), job_(job), basis_(basis) {}

  JobEstimate estimate() const;

 private:
  AtDensity at(double density) const;
  Logarithms by(const PlayedJob& played, const AtDensity& at) const;
  /// Deviation of the logarithm of each figure by that of the density: of those that played jobs
  /// scale, of swollen volume and of mass.
  std::array<double, scaled + 2> density_spread() const;
  double fuel_spread(const JobEstimate& estimate) const;

  const Machine& machine_;
  const SoilKind& soil_;
  const JobOutline& job_;
  const EstimateBasis& basis_;
};

AtDensity Estimator::at(double density) const {
  const auto best = best_full_dig(machine_, soil_, density, basis_.full_dig);
  require(best.has_value(), "estimate: " + machine_.name + " has no feasible dig in level " +
                                soil_.name + " of " + number_text(density) + " %");
  const double volume = job_.shape.volume.value;
  AtDensity at;
  at.dig = best->dig;
  at.swollen = volume * bulking_of_density(soil_, density);
  at.mass = volume * bank_state(soil_, density).bulk_density;
  for (const PlayedJob& each : basis_.played.jobs) at.played.push_back(by(each, at));
  for (const Logarithms& each : at.played) {
    for (std::size_t i = 0; i < scaled; ++i) {
      at.mean[i] += each[i] / static_cast<double>(at.played.size());
    }
  }
  return at;
}

Logarithms Estimator::by(const PlayedJob& played, const AtDensity& at) const {
  // Less than a load is one dig, too.
  const double of_reference = std::max(at.swollen / at.dig.payload_volume, 1.0 / played.digs);
  const double of_cycle = at.dig.cycle_energy - machine_.engine->idle_power * at.dig.cycle_time;
  const double time_taken = played.time * of_reference * at.dig.cycle_time;
  const double work = played.work * of_reference * of_cycle;
  return {std::log(played.digs * of_reference), std::log(time_taken),
          std::log(played.energy * of_reference * at.dig.cycle_energy),
          std::log(litres(basis_.fuel, work, time_taken))};
}

std::array<double, scaled + 2> Estimator::density_spread() const {
  std::array<double, scaled + 2> spread = {};
  const double sd = job_.density.sd_percent;
  const double lower = std::max(0.0, job_.density.percent - sd);
  const double upper = std::min(100.0, job_.density.percent + sd);
  if (!(upper > lower)) return spread;
  const AtDensity loose = at(lower), dense = at(upper);
  const double share = sd / (upper - lower);
  for (std::size_t i = 0; i < scaled; ++i)
    spread[i] = share * std::abs(dense.mean[i] - loose.mean[i]);
  spread[scaled] = share * std::abs(std::log(dense.swollen / loose.swollen));
  spread[scaled + 1] = share * std::abs(std::log(dense.mass / loose.mass));
  return spread;
}

/// Of one more job: Student's t of so few, in deviations of a normal distribution.
double played_spread(const std::vector<Logarithms>& played, const Logarithms& mean,
                     std::size_t figure) {
  const auto count = static_cast<double>(played.size());
  double squares = 0.0;
  for (const Logarithms& each : played) squares += std::pow(each[figure] - mean[figure], 2);
  const double sd = std::sqrt(squares / (count - 1.0) * (1.0 + 1.0 / count));
  return sd * student_quantile(0.95, count - 1.0) / two_sided_95_percent;
}

/// In what a job differs from those played, in words.
std::vector<std::string> differences(const Machine& machine, const SoilKind& soil,
                                     const JobOutline& job, const PlayedJobs& played) {
  std::vector<std::string> found;
  if (machine.name != played.machine) {
    found.push_back("the machine is " + machine.name + ", played was " + played.machine);
  }
  std::set<std::string> soils;
  double loosest = 100.0, densest = 0.0;
  for (const PlayedJob& each : played.jobs) {
    soils.insert(each.soil);
    loosest = std::min(loosest, each.density_percent);
    densest = std::max(densest, each.density_percent);
  }
  if (soils.count(soil.name) == 0) found.emplace_back("no job in " + soil.name + " was played");
  const double density = job.density.percent;
  if (density < loosest - like_density || density > densest + like_density) {
    found.push_back("the density is " + readable(density, 3) + " %, played were " +
                    readable(loosest, 2) + " to " + readable(densest, 2) + " %");
  }
  if (job.shape.steep_share > battered) {
    found.emplace_back("the design has battered faces, played were upright trenches");
  }
  const auto compare = [&](const std::string& what, double here, double there) {
    if (here <= like * there && there <= like * here) return;
    found.push_back("its " + what + " is " + readable(here, 3) + " m, played was " +
                    readable(there, 3) + " m");
  };
  const double bucket = machine.bucket.width_outside;
  if (job.shape.width < narrow * bucket) {
    found.push_back("its mean width is " + readable(job.shape.width, 3) +
                    " m, less than that of the bucket, " + readable(bucket, 3) + " m");
  }
  if (const double reach = digging_depth(machine); job.shape.depth > reach) {
    found.push_back("its mean depth is " + readable(job.shape.depth, 3) +
                    " m, deeper than the machine digs, " + readable(reach, 3) + " m");
  }
  if (const double load = loose_mass(soil, heaped_capacity(machine)); job.truck_mass < load) {
    found.push_back("a truck takes " + readable(job.truck_mass, 3) +
                    " kg, less than one bucket of loose soil, " + readable(load, 3) + " kg");
  }
  compare("length", job.shape.length, played.length);
  compare("mean width", job.shape.width, played.width);
  compare("mean depth", job.shape.depth, played.depth);
  return found;
}

/// Of the line of fuel over power: its idle flow, and what it takes beyond it for work.
double Estimator::fuel_spread(const JobEstimate& estimate) const {
  const double idle = basis_.fuel.idle_flow * estimate.time.value / 1000.0 / estimate.fuel.value;
  return std::hypot(idle * idle_sd, (1.0 - idle) * drive_sd);
}

JobEstimate Estimator::estimate() const {
  const AtDensity likely = at(job_.density.percent);
  const auto by_density = density_spread();
  JobEstimate estimate;
  estimate.unlike = differences(machine_, soil_, job_, basis_.played);
  EstimateSpread common;
  common.volume = job_.shape.volume.sd / job_.shape.volume.value;
  const auto of_ground = [&](double value, std::size_t figure) {
    EstimatedFigure found = {value, common};
    found.spread.density = by_density[figure];
    return found;
  };
  const auto scaled_by_played = [&](Scaled figure) {
    EstimatedFigure found = of_ground(std::exp(likely.mean[figure]), figure);
    found.spread.played = played_spread(likely.played, likely.mean, figure);
    found.spread.unlike = unlike_sd * std::sqrt(static_cast<double>(estimate.unlike.size()));
    return found;
  };
  estimate.swollen = of_ground(likely.swollen, scaled);
  estimate.mass = of_ground(likely.mass, scaled + 1);
  estimate.digs = scaled_by_played(digs);
  estimate.digs.least = 1.0;
  estimate.time = scaled_by_played(time);
  estimate.energy = scaled_by_played(energy);
  estimate.fuel = scaled_by_played(fuel_volume);
  estimate.fuel.spread.fuel = fuel_spread(estimate);
  estimate.truckloads = of_ground(likely.mass / (fill * job_.truck_mass), scaled + 1);
  estimate.truckloads.spread.fill = fill_sd;
  estimate.dig = likely.dig;
  estimate.reference_digs = likely.swollen / likely.dig.payload_volume;
  estimate.reference_energy =
      estimate.reference_digs * likely.dig.cycle_energy / job_.shape.volume.value;
  estimate.reference_time = estimate.reference_digs * likely.dig.cycle_time;
  return estimate;
}

}  // namespace

double EstimateSpread::total() const {
  return std::sqrt(volume * volume + density * density + played * played + unlike * unlike +
                   fuel * fuel + fill * fill);
}

std::array<double, 2> EstimatedFigure::interval() const {
  const double factor = std::exp(two_sided_95_percent * spread.total());
  return {std::max(least, value / factor), value * factor};
}

EstimateBasis shipped_basis(const Machine& machine) {
  EstimateBasis basis;
  basis.fuel = load_fuel_model(find_data_file("engines/zx120.json"));
  basis.played = load_played_jobs(find_data_file("jobs/played.json"));
  if (machine.name == basis.fuel.name || !machine.engine) return basis;
  const double size = machine.engine->power / joint_share / basis.fuel.rated_power;
  basis.fuel.rated_power *= size;
  basis.fuel.rated_flow *= size;
  basis.fuel.idle_flow *= size;
  return basis;
}

JobEstimate estimate_job(const Machine& machine, const SoilKind& soil, const JobOutline& job,
                         const EstimateBasis& basis) {
  constexpr double most = 1e9;
  require_in("estimate: volume [m3]", job.shape.volume.value, 1e-6, most);
  require_in("estimate: `density` [%]", job.density.percent, 0.0, 100.0);
  require_in("estimate: `density_sd` [points]", job.density.sd_percent, 0.0, 100.0);
  require_in("estimate: `truck_mass` [kg]", job.truck_mass, 1.0, 1e6);
  require(basis.played.jobs.size() > 1, "estimate: played jobs must be two at least");
  require(machine.engine && machine.swing,
          "estimate: " + machine.name + " states no swing or engine, so no time of a cycle");
  return Estimator(machine, soil, job, basis).estimate();
}

}  // namespace excavplan
