// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/machine/way.hpp>
#include <excavplan/robot/dig_cycle_settings.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "robot/live_scan.hpp"
#include "robot/message_clock.hpp"
#include "robot/recent_joints.hpp"
#include "robot/recent_transforms.hpp"

/// @file What the messages of a robot tell of it. Private to the library.

namespace excavplan {

using LiveTime =
    std::optional<std::int64_t>;  ///< by the clock of who receives; unset: not known [ns]

/// Seconds from one time to another.
double seconds_between(std::int64_t from, std::int64_t to);
/// Whether the clock of who receives was set back since a mark, so that it does not hold.
bool is_set_back(const RobotMessage& message, LiveTime mark);
/// "2 of 5".
std::string count_text(std::size_t found, std::size_t wanted);
/// "2 of 5, 3 too early".
std::string scans_text(std::size_t found, std::size_t wanted, std::size_t early);

/// Names joints as a robot does.
/// @param names  of boom, arm, bucket and swing; empty: they keep theirs
/// @param where  in front of the message of an error
/// @throws Error (bad_input) if it is of another length
void name_joints(const std::vector<std::string>& names, RobotJoints& joints,
                 const std::string& where);

/// How its messages are read.
struct LiveSettings {
  Machine machine;                                               ///< robot_joints names them
  std::string site_frame = {};                                   ///< as of DigCycleSettings
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();  ///< likewise
  bool machine_in_view = false;                                  ///< likewise
  double oldest_joints = 1.0;                                    ///< likewise [s]
};

/// Where its joints stand, and how its points come into one frame.
class LiveRobot {
 public:
  explicit LiveRobot(LiveSettings settings) : settings_(std::move(settings)) {}

  /// Takes transforms and joint states. @return points, which are the caller's to keep
  /// @throws Error (bad_file) if the message is damaged, or of a type that is not read here;
  /// nothing is changed then
  std::optional<LiveFrame> take(const RobotMessage& message);

  LiveTime now() const { return now_; }  ///< when the newest message came, or as told since
  void tell_time(LiveTime now) {
    if (now) now_ = now;
  }

  /// Why the posture at a time, or now, is not known; empty if it is.
  std::string joint_problem(LiveTime at) const;
  /// Why the machine may be moving; empty if it stands.
  std::string moving_problem() const;
  /// Why it does not stand now where a motion begins; empty if it does.
  std::string start_problem(const JointMotion& motion) const;
  /// Where a motion begins: sensors of joints that stand at a limit read a little beyond it.
  std::optional<FrontJoints> start() const;

  /// Finds poses that are not known yet; `all`: an error where one stays unknown.
  void settle(std::vector<LiveFrame>& frames, bool all) const;
  /// Finds postures that are not known yet, once the joint states reach the time of the points;
  /// `all`: by those that came.
  void settle_postures(std::vector<LiveFrame>& frames, bool all) const;
  /// Whether all poses are known, and the postures that are asked for.
  bool is_settled(const std::vector<LiveFrame>& frames) const;
  /// Frames as one scan in the frame that the settings say, its machine in that of its own.
  /// @param averaged  turns false where they had to be joined
  /// @throws Error as TransformTree::lookup(); (bad_input) if the machine is in view and its
  /// posture not known
  Scan scan_of(std::vector<LiveFrame>& frames, const std::string& name, bool& averaged) const;

 private:
  LiveTime time_of(const RobotMessage& message, std::int64_t stamp);
  void come(const RobotMessage& message, LiveTime time);
  void take_joints(const std::vector<std::pair<std::string, double>>& positions, LiveTime time);
  std::optional<JointSample> sample(const std::string& joint, LiveTime at) const;
  std::optional<MachinePosture> posture(LiveTime at) const;

  LiveSettings settings_;
  RecentTransforms transforms_;
  RecentJoints joints_;                         // of the settings' names
  std::map<std::string, MessageClock> clocks_;  // by topic
  LiveTime now_;
};

}  // namespace excavplan
