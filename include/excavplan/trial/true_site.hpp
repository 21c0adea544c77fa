// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <excavplan/job/job_step.hpp>
#include <excavplan/planning/dig_cycle.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/trial/hidden_site.hpp>

/// @file
/// A machine on the true ground of a site, which does the steps of a job.

namespace excavplan {

/// When trials begin, 2026-01-01, since 1970-01-01 UTC; ours [s].
inline constexpr double trial_begin = 1767225600.0;

/// What a move costs; ours, as a machine of 12 t on its tracks: 2 km/h, and a third of its weight
/// as rolling resistance.
struct MoveCost {
  double time = 9.0;               ///< of any move: front down, front up [s]
  double time_per_metre = 2.0;     ///< [s/m]
  double energy = 30e3;            ///< [J]
  double energy_per_metre = 15e3;  ///< [J/m]
};

/// How the truth is simulated.
struct TruthOptions {
  SimulatorKind simulator = default_simulator();  ///< that digs; planners use their own
  std::uint64_t seed = 1;                         ///< of all draws
  bool scans_each_dig = false;                    ///< a scan is made after each dig as well
  MoveCost move = {};                             ///< of each move
  double scan_time = 3.0;                         ///< [s]
  double wait_time = 60.0;                        ///< of JobAction::wait; ours [s]
};

/// What a step did, and cost.
struct TrueStep {
  StepReport report;           ///< what the planner is told
  double time = 0.0;           ///< of the whole cycle, the move or the scan [s]
  double scan_time = 0.0;      ///< of a scan, part of it [s]
  double energy = 0.0;         ///< of the joints over it [J]
  double payload_mass = 0.0;   ///< true [kg]
  std::optional<Stall> stall;  ///< of a dig that the machine did not finish
};

/// Dry mass that was moved [kg]: cut = lying + hauled, to rounding.
struct SolidsLedger {
  double cut = 0.0;     ///< taken from the bank, by digs and by slides
  double lying = 0.0;   ///< gained by the loose soil of the site
  double hauled = 0.0;  ///< by trucks
  double held = 0.0;    ///< by the bucket, since it was dumped last
};

/// The true ground and the machine on it.
///
/// A dig: the tracking errors shift its path, and the joints follow by inverse kinematics in the
/// plane of the path; also in a lane, whose front reaches a little farther. The bucket turns as
/// much as keeps its heel off the ground. The machine digs until it has finished or stalls; what is
/// then in the bucket is dumped, or kept (JobStep::keeps_load); what it cannot hold falls where the
/// path ends. A load that is carried through a dig changes nothing in it but the lift after it.
/// Where the bank was cut its void ratios are set anew (set_void_ratios()). The line of a dig and
/// the dump are off as the known pose of the machine is. Tracks leave no mark, and the ground holds
/// the machine everywhere.
class TrueSite {
 public:
  /// @throws Error (bad_input) as require_machine() and SimulatorKind::make()
  TrueSite(const HiddenSite& site, const Machine& machine, const TruthOptions& options = {});
  ~TrueSite();
  TrueSite(TrueSite&&) noexcept;             ///< the other may only be destroyed then
  TrueSite& operator=(TrueSite&&) noexcept;  ///< the same

  /// Does a step. @throws Error (bad_input) naming the step, if its path or its dump leave the
  /// ground, or the dump is out of reach
  TrueStep execute(const JobStep& step);
  /// A scan from where the machine stands.
  Scan scan();

  /// As it truly is now.
  const Terrain& ground() const;
  const BasePose& known_base() const;  ///< where the machine is said to stand
  /// Where the machine truly stands.
  const BasePose& true_base() const;
  double time() const;  ///< since 1970-01-01 UTC [s]
  /// From the first dig on.
  const SolidsLedger& solids() const;
  /// When cells of ground() were last seen, since 1970-01-01 UTC [s]; NaN: never.
  const Eigen::ArrayXXd& seen_at() const;
  /// Share of cells of an area that were seen since they last changed by more than the tolerance;
  /// of an empty area 0. @param area  NaN outside, on the cells of ground()
  double seen_share(const HeightMap& area) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace excavplan
