// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/plan/plan_motion.hpp>
#include <excavplan/survey/density_estimate.hpp>

/// @file
/// The dig cycle of a robot: its messages in, density and plan out. Knows the bytes of ROS 1 and
/// ROS 2 messages and needs neither (docs/ros.md).

namespace excavplan {

/// A message of a robot as it was sent.
struct RobotMessage {
  std::string topic;   ///< "/points"; transforms on one that ends in "tf_static" hold at all times
  std::string type;    ///< as ROS 2 spells it: "sensor_msgs/msg/PointCloud2"
  bool is_cdr = true;  ///< of ROS 2; false: of ROS 1
  std::string_view bytes;  ///< serialized
};

/// Settings of a session.
struct DigCycleSettings {
  Machine machine;                    ///< that digs; its robot_joints name the joint states
  SoilKind soil;                      ///< kind of the ground
  DensityLaw law;                     ///< of digs of this machine in this soil
  GroundDensity density{50.0, 25.0};  ///< until one was estimated
  std::size_t scans = 5;              ///< messages in a scan, averaged if they can be; 1 .. 100
  std::string site_frame = {};        ///< into which /tf puts the points; empty: not by /tf
  /// Puts the points, or the site frame of /tf, into that of the machine: origin on the swing axis
  /// at ground level, x forward, z up.
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();
  /// Points of boom, arm and bucket are left out, by the joint states; needs scans in the frame of
  /// the machine.
  bool machine_in_view = false;
  /// The dig that is scanned is the last plan of the session, if there is one, whose path corrects
  /// for the soil that fell back.
  bool digs_as_planned = true;
  DensityOptions estimate = {};  ///< `dug_path` is set by the session
  PlanOptions plan = {};         ///< how the next dig is planned; its cycle is that of the motion
  bool whole_cycle = false;      ///< as CycleWayOptions::whole_cycle
  MotionOptions motion = {};     ///< of the trajectory that is sent
};

/// Settings of a machine in a soil by a law, each a shipped name or a file.
/// @param law  empty: the shipped one of machine and soil
/// @throws Error as shipped_or_file(), load_machine(), load_soil() and load_density_law()
DigCycleSettings shipped_settings(const std::string& machine, const std::string& soil,
                                  const std::string& law = "");

/// Where a session is in the cycle.
enum class CycleStage {
  before,   ///< scans count as before the dig
  digging,  ///< scans do not count
  after,    ///< scans count as after the dig, until there are enough
  done,     ///< there are; further ones count as before the next dig
};
/// "before", "digging", "after" or "done".
const char* name(CycleStage stage);

/// The density by the last dig.
struct CycleEstimate {
  DensityEstimate estimate;       ///< as estimate_density() gives it
  std::size_t before = 0;         ///< messages in the scan before
  std::size_t after = 0;          ///< and in that after
  bool adopted = false;           ///< the next plan is for this density
  std::vector<Warning> warnings;  ///< of the estimate, and fewer_scans, not_averaged
};

/// The next dig.
struct CyclePlan {
  DigPlan plan;                   ///< as plan_dig() gives it
  GroundDensity density{0.0};     ///< that it is for
  bool density_is_stated = true;  ///< that of the settings: no dig gave one to trust
  bool previous_density = false;  ///< the last estimate was not to be trusted and is not used
  JointMotion motion;             ///< from where the joints stand; without points if there is none
  bool trustworthy = true;        ///< false after a warning that ends trust
  /// Of the plan, of the ground, and previous_density (the last estimate was not trustworthy),
  /// level_ground (no scan yet), posture_unknown (the motion begins above the dig), no_motion *
  /// (the ground is in the way, or a joint stands beyond its limits).
  std::vector<Warning> warnings;
};

/// Takes the messages of a robot and answers. Not for several threads at a time.
class DigCycleSession {
 public:
  static constexpr std::size_t most_scans = 100;  ///< of DigCycleSettings::scans; ours

  /// @throws Error (bad_input) if `scans` is out of range or a number of the matrix not finite;
  /// further settings are checked when they are used
  explicit DigCycleSession(DigCycleSettings settings);
  ~DigCycleSession();
  DigCycleSession(DigCycleSession&&) noexcept;             ///< the other may only be destroyed then
  DigCycleSession& operator=(DigCycleSession&&) noexcept;  ///< the same

  /// Takes points (PointCloud2, Livox), transforms or joint states.
  /// @throws Error (bad_file) if the message is damaged, or of a type that is not read here; the
  /// session is then as before
  void take(const RobotMessage& message);

  /// The dig begins: the latest scans are those before it.
  /// @throws Error (bad_input) if there is none; the session is then as before
  void start_dig();
  /// The dig is over: what comes now shows the ground after it.
  /// @throws Error (bad_input) unless digging
  void end_dig();

  CycleStage stage() const;              ///< where the session is
  std::size_t scans() const;             ///< messages that wait as the next scan
  std::size_t scans_wanted() const;      ///< those of the settings
  const GroundDensity& density() const;  ///< that the next plan is for

  /// The density by the scans before and after the last dig. One to trust is adopted.
  /// @throws Error (bad_input) if scans are missing; (bad_file) as estimate_density(), and if no
  /// transform leads to a scan
  CycleEstimate estimate();
  /// The next dig for density(), on the ground as last scanned.
  /// @throws Error as plan_dig() and terrain_from_scan()
  CyclePlan plan();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "after 2 of 5": the stage and the messages that wait as the next scan.
std::string describe(const DigCycleSession& session);

/// As JSON with the keys that estimate-density prints, as far as it has them; plan-path
/// \-\-density-from reads it (docs/ros.md#answers).
std::string to_json(const CycleEstimate& estimate);
/// As JSON with the keys that plan-path prints, as far as it has them (docs/ros.md#answers).
std::string to_json(const CyclePlan& plan);

}  // namespace excavplan
