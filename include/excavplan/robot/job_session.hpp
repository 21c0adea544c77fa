// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/job/job_progress.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/machine/motion.hpp>
#include <excavplan/robot/dig_cycle_settings.hpp>

/// @file
/// A job that a robot does: its messages in, one step after the other out. Needs no ROS
/// (docs/ros.md#jobs).

namespace excavplan {

/// Settings of a session.
struct JobSessionSettings {
  std::string folder;                            ///< of a job that plan-site began
  std::size_t scans = DigCycleSettings{}.scans;  ///< as DigCycleSettings::scans
  std::string site_frame = {};                   ///< the same
  /// Puts the points, or the site frame of /tf, into the frame of the job's site.
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();
  /// Of boom, arm, bucket and swing in joint states and motions; empty: those of the machine.
  std::vector<std::string> joint_names = {};
  /// Points of boom, arm and bucket are left out, by the joint states and the pose of the job.
  bool machine_in_view = false;
  double oldest_joints = DigCycleSettings{}.oldest_joints;  ///< as DigCycleSettings::oldest_joints
  MotionOptions motion = {};                                ///< of the trajectory that is sent
};

/// @throws Error (bad_input) naming a member that is out of range
void check(const JobSessionSettings& settings);

/// The step to do now.
struct SessionStep {
  /// Its warnings are also those of the motion: posture_unknown (it is not known from where), and,
  /// ending trust, not_standing, start_left (confirm_start()), no_motion.
  JobStep step;
  JointMotion
      motion;  ///< from where the joints stand; without points if the front stays or has none
  bool posture_known =
      false;  ///< of the machine; if not the motion begins where that of the job does
};
/// Whether the machine may do it: it is trusted and, where the front moves, begins where that
/// stands.
bool may_be_driven(const SessionStep& step);

/// What is told when the motion of a step has ended.
struct MotionReport {
  long long step = 0;                  ///< JobStep::id
  std::optional<double> payload_mass;  ///< as StepReport::payload_mass [kg]
  std::optional<double> joint_work;    ///< as StepReport::joint_work [J]
  bool stalled = false;                ///< as StepReport::stalled
  std::optional<BasePose> base;        ///< as StepReport::base; its height is that of the step
};

/// What became of a step.
struct StepOutcome {
  JobStep step;                   ///< that was done
  std::vector<Warning> warnings;  ///< of its scan, such as scan_not_taken
  JobProgress progress;           ///< of the job after it
};

/// Where a session is in a step.
enum class SessionStage {
  idle,      ///< plan() is to come
  driving,   ///< the machine does the step, until report()
  scanning,  ///< the motion has ended: what is measured from now on is the step's scan
};

/// Does a job of a folder with the messages of a robot. Not for several threads at a time, and
/// alone on its folder while it lives. All but a scan that is being collected is in the folder: a
/// later session goes on with the same step.
class JobSession {
 public:
  /// @throws Error (bad_input) as check(); (bad_file) as load_order() and SiteJob::resume()
  explicit JobSession(JobSessionSettings settings);
  ~JobSession();
  JobSession(JobSession&&) noexcept;             ///< the other may only be destroyed then
  JobSession& operator=(JobSession&&) noexcept;  ///< the same

  /// As DigCycleSession::take().
  void take(const RobotMessage& message);

  /// The step to do, the same until it is done, with its motion from where the joints stand now. A
  /// scan that was being collected is dropped.
  /// @param time  as of DigCycleSession::plan()
  /// @throws Error as SiteJob::next()
  SessionStep plan(std::optional<std::int64_t> time = {});
  /// As DigCycleSession::confirm_start().
  void confirm_start(SessionStep& step, std::optional<std::int64_t> time = {});

  /// The motion of the step has ended. Needs no plan() before it in this session. The same report
  /// again, while the step's scan is collected, changes nothing.
  /// @param time  when [ns]: points that were measured before are left out, unless the clock is set
  /// back; nothing: what comes counts
  /// @throws Error (bad_input) if it is of another step than the present one, differs from that
  /// whose scan is collected, or as require_report(); nothing is changed then
  void report(const MotionReport& report, std::optional<std::int64_t> time = {});
  /// Hands the reported step to the job; one that asks for a scan when that is complete, and the
  /// transforms and joint states of its points have come, for which it waits `longest_wait`.
  /// @param time  as of plan()
  /// @return nothing until then
  /// @throws Error as SiteJob::done(), and if no transform leads to a scan; the step is then to be
  /// reported again
  std::optional<StepOutcome> finish(std::optional<std::int64_t> time = {});
  static constexpr double longest_wait = 2.0;  ///< by the clock of the messages; ours [s]
  /// Gives up driving or scanning; the step stays as it is.
  void leave();

  SessionStage stage() const;        ///< where the session is
  std::size_t scans() const;         ///< messages in the scan that is collected
  std::size_t scans_wanted() const;  ///< those of the settings
  std::size_t early_scans() const;   ///< messages measured before the motion ended, left out
  JobProgress progress() const;      ///< of the job
  const Machine& machine() const;    ///< of the job, its joints as the settings name them

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "idle", "driving", "scan 2 of 5"; ", 3 too early": of early_scans().
std::string describe(const JobSession& session);

/// As JSON with the keys of `plan-site next`, but for the file of the trajectory
/// (docs/ros.md#jobs).
std::string to_json(const SessionStep& step);

}  // namespace excavplan
