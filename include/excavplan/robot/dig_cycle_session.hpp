// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/robot/dig_cycle_settings.hpp>
#include <excavplan/site/site_event.hpp>

/// @file
/// The dig cycle of a robot: its messages in, density and plan out. Knows the bytes of ROS 1 and
/// ROS 2 messages and needs neither (docs/ros.md).

namespace excavplan {

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
  DensityEstimate estimate;  ///< as estimate_density() gives it
  std::size_t before = 0;    ///< messages in the scan before; 0: the site knows the ground
  std::size_t after = 0;     ///< and in that after
  bool adopted = false;      ///< the next plan is for this density
  /// Of the estimate, and fewer_scans, not_averaged, early_points (some were left out, measured
  /// before the dig was over), not_stamped (whether points were is not known).
  std::vector<Warning> warnings;
  std::optional<SiteUpdate> site = {};  ///< with a site: its answer, but for the estimate
};

/// The next dig.
struct CyclePlan {
  DigPlan plan;                   ///< as plan_dig() gives it
  GroundDensity density{0.0};     ///< that it is for
  bool density_is_stated = true;  ///< that of the settings: no dig gave one to trust
  bool previous_density = false;  ///< the last estimate was not to be trusted and is not used
  JointMotion motion;             ///< from where the joints stand; without points if there is none
  /// Of the motion: which plan it is of, on a scan of when; nothing: there is no motion.
  std::optional<PlanStamp> stamp;
  /// Of the scan that it is on, when it was planned [s]; nothing: its messages do not tell.
  std::optional<double> scan_age;
  bool posture_known = false;  ///< of the machine; if not the motion begins above the dig
  bool trustworthy = true;     ///< false after a warning that ends trust
  /// Of the settings, of the plan, of the ground, and previous_density (the last estimate failed or
  /// was not trustworthy), level_ground * (no scan yet, unless DigCycleSettings::level_ground),
  /// ground_before_dig * (no scan since the last dig began), posture_unknown (the motion begins
  /// above the dig), not_standing * (a joint turned within the last half second, or its states do
  /// not reach back so far), search_stopped (by its time), no_motion * (the ground is in the way,
  /// or a joint stands beyond its limits), scan_old * (DigCycleSettings::oldest_scan), and
  /// start_left *, stale_plan * and foreign_plan * of confirm_start(). On a site also those of the
  /// first scan of this session (scan_not_taken *), and scan_old * without one.
  std::vector<Warning> warnings;
};

/// Takes the messages of a robot and answers. Not for several threads at a time.
class DigCycleSession {
 public:
  static constexpr std::size_t most_scans = 100;  ///< of DigCycleSettings::scans; ours

  /// @throws Error (bad_input) as check(DigCycleSettings); as Site() for writing
  explicit DigCycleSession(DigCycleSettings settings);
  ~DigCycleSession();
  DigCycleSession(DigCycleSession&&) noexcept;             ///< the other may only be destroyed then
  DigCycleSession& operator=(DigCycleSession&&) noexcept;  ///< the same

  /// Takes points (PointCloud2, Livox), transforms or joint states.
  /// @throws Error (bad_file) if the message is damaged, or of a type that is not read here; the
  /// session is then as before
  void take(const RobotMessage& message);

  /// The dig begins: the latest scans are those before it.
  /// @param time  when [ns]. Points that were measured before the last mark and come after it are
  /// left out; nothing: what comes counts
  /// @throws Error (bad_input) if there is none and no site knows the ground; the session is then
  /// as before
  void start_dig(std::optional<std::int64_t> time = {});
  /// The dig is over: what is measured from now on shows the ground after it.
  /// @param time  the same; nothing: that of start_dig() holds
  /// @throws Error (bad_input) unless digging
  void end_dig(std::optional<std::int64_t> time = {});

  CycleStage stage() const;              ///< where the session is
  std::size_t scans() const;             ///< messages that wait as the next scan
  std::size_t scans_wanted() const;      ///< those of the settings
  std::size_t early_scans() const;       ///< messages left out since the last start_dig()
  const GroundDensity& density() const;  ///< that the next plan is for

  /// The density by the scans before and after the last dig. One to trust is adopted. A site takes
  /// the dig in, once, and needs no scan before if it took one since the dig before.
  /// @throws Error (bad_input) if scans are missing; (bad_file) as estimate_density(), and if no
  /// transform leads to a scan
  CycleEstimate estimate();
  /// The next dig for density(), on the ground as last scanned; as plan_on_site() on a site, which
  /// takes in the first scan of the session before.
  /// @param time  now, by the clock of the marks [ns], for the age of joint states; nothing: that
  /// of the newest message
  /// @throws Error as plan_dig() and terrain_from_scan()
  CyclePlan plan(std::optional<std::int64_t> time = {});
  /// To be called when the messages that came while the session planned have been taken, before
  /// the motion is sent: adds start_left * if the machine may not stand where it begins, and
  /// doubts_of() its stamp.
  /// @param time  as of plan()
  void confirm_start(CyclePlan& plan, std::optional<std::int64_t> time = {});
  /// Why a motion, of a file for instance, is not to be driven now: stale_plan * if its scan has
  /// become too old, foreign_plan * if it is not of the last plan of this session, of which no dig
  /// has begun, or of a machine that stood elsewhere. @param time  as of plan()
  std::vector<Warning> doubts_of(const std::optional<PlanStamp>& stamp,
                                 std::optional<std::int64_t> time = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "after 2 of 5": the stage and the messages that wait as the next scan; ", 3 too early": of
/// early_scans().
std::string describe(const DigCycleSession& session);

/// As JSON with the keys that estimate-density prints, as far as it has them; plan-path
/// \-\-density-from reads it (docs/ros.md#answers).
std::string to_json(const CycleEstimate& answer);
/// As JSON with the keys that plan-path prints, as far as it has them (docs/ros.md#answers).
std::string to_json(const CyclePlan& answer);

}  // namespace excavplan
