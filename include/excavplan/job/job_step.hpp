// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/warning.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/machine/base_pose.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/way.hpp>

/// @file
/// What a job asks of its machine, one step after the other, and what it is told of each.

namespace excavplan {

/// What the machine does in a step.
enum class JobAction {
  dig,     ///< digs and dumps, for volume
  finish,  ///< the same along the floor, for its shape
  move,    ///< goes to another place
  scan,    ///< scans the ground from where it stands
  wait,    ///< for what the reason says
  stop,    ///< the job has ended, as the reason says
};
/// "dig", as in files.
const char* name(JobAction action);
/// Whether the bucket goes through the ground: JobAction::dig or JobAction::finish.
bool digs(JobAction action);

/// What a step is expected to lift and cost.
struct ForetoldStep {
  double payload_mass = 0.0;                 ///< [kg]
  double energy = 0.0;                       ///< of the joints over the whole cycle [J]
  double time = 0.0;                         ///< of the whole cycle [s]
  std::array<double, 2> payload_interval{};  ///< 95 % [kg]
  std::array<double, 2> energy_interval{};   ///< 95 % [J]
};

/// Soil that passes left in the bucket, and where the front holds it.
struct CarriedLoad {
  double volume = 0.0;                       ///< loose [m^3]
  FrontJoints joints = FrontJoints::Zero();  ///< at rest, the swing from the base's heading [rad]
};

/// One step of a job.
struct JobStep {
  long long id = 0;                  ///< rises from step to step
  JobAction what = JobAction::stop;  ///< what to do
  BasePose base;                     ///< where the machine stands; of a move: where it goes
  /// Of the line of the dig, or of a scan the middle of what it sees, to the left of the base
  /// [rad].
  double swung = 0.0;
  double lane = 0.0;  ///< of that line to the left of the swing axis [m]
  DigPath path;       ///< of a dig, in the frame of its line (dig_line())
  /// Of the bucket pin where the bucket opens, where it does, in the site's frame [m].
  Eigen::Vector3d dump = Eigen::Vector3d::Zero();
  /// The bucket does not open: it goes back with its load, to which the next dig adds.
  bool keeps_load = false;
  std::optional<CarriedLoad> carried;  ///< as the step begins
  bool dumps_first = false;            ///< what is carried, before all else of the step
  std::optional<int> truck;            ///< that is loaded, from 1
  ForetoldStep predicted;              ///< of a dig
  bool trustworthy = true;             ///< false after a warning that ends trust
  std::vector<Warning> warnings;       ///< about this step
  std::string reason;                  ///< of a scan, a wait or a stop

  bool digs() const { return excavplan::digs(what); }  ///< whether it is a dig, for volume or shape
  bool moves_front() const { return digs() || dumps_first; }  ///< whether boom, arm or bucket move
  bool ends_finished() const;  ///< a stop, as the ground is within the tolerance
};
/// The reason of such a stop.
inline constexpr const char* finished_reason = "finished";

/// What became of a step.
struct StepReport {
  std::optional<Scan> scan;            ///< of the ground after it, in the site's frame
  double time = 0.0;                   ///< when, since 1970-01-01 UTC [s]
  std::optional<double> payload_mass;  ///< by the scale [kg]
  std::optional<double> joint_work;    ///< of the joints over the whole cycle [J]
  bool stalled = false;                ///< the machine could not finish the path
  std::optional<BasePose> base;        ///< where the machine stands now; nothing: as the step says
};

/// What no such step can have led to is of another one.
/// @throws Error (bad_input) if a number is not finite, a mass or a work is below 0, one is larger
/// than any machine's (1e6 kg, 1e12 J), a base beyond 1e9 m or a time beyond 1e11 s, or a payload
/// or a stall is of a step that does not dig
void require_report(const JobStep& step, const StepReport& report);

/// What no such machine can have done in that step, mostly as a number has another unit.
/// @throws Error (bad_input) naming number, value and rule, if a payload is more than three buckets
/// (ours), work of the joints is 20 times what was foretold, or a fiftieth of it though the dig did
/// not stall, or the machine stands 10 m from where the step has it
void require_plausible(const JobStep& step, const StepReport& report, const Machine& machine);

/// Who decides the steps: SiteJob, or another policy that is to be compared with it.
class JobPlanner {
 public:
  virtual ~JobPlanner() = default;
  /// The step to do now; the same until done() is told of it.
  virtual JobStep next() = 0;
  /// @param step  JobStep::id. Of another than the present one nothing changes.
  virtual void done(long long step, const StepReport& report) = 0;
};

}  // namespace excavplan
