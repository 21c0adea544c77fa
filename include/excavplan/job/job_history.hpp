// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/design/job_design.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/job/job_step.hpp>

/// @file
/// What was done in a job, step by step, with the ground after each.

namespace excavplan {

/// A block of cells in a new state.
struct CellPatch {
  Eigen::Index row = 0;  ///< of the block's first cell on the whole grid
  Eigen::Index col = 0;  ///< likewise
  Eigen::ArrayXXd z;     ///< empty: nothing changed
};

/// A step that was done, or a scan that no step asked for.
struct JobEvent {
  JobAction what = JobAction::wait;    ///< never JobAction::stop
  long long step = 0;                  ///< JobStep::id; 0: no step asked for it
  double at = 0.0;                     ///< when it was over, since 1970-01-01 UTC [s]
  double time = 0.0;                   ///< that it took [s]
  std::optional<double> energy;        ///< of the joints, and of a move [J]
  std::optional<double> payload_mass;  ///< by the scale [kg]
  ForetoldStep predicted;              ///< of a dig
  BasePose base;                       ///< where the machine stood; after a move: stands
  Eigen::Vector3d dump = Eigen::Vector3d::Zero();  ///< JobStep::dump, of a dig
  bool keeps_load = false;                         ///< JobStep::keeps_load: there was no dump
  std::optional<int> truck;                        ///< that was loaded
  bool stalled = false;                            ///< the machine did not finish its path
  bool scanned = false;                            ///< the ground was scanned in it, or after it
  bool trustworthy = true;                         ///< as its step
  std::vector<Warning> warnings;                   ///< of the step, and of a scan that came with it
  std::string reason;                              ///< JobStep::reason
  double left_volume = 0.0;                        ///< of the design after it [m^3]

  CellPatch surface;  ///< of JobHistory::before after it [m]
  CellPatch seen_at;  ///< JobHistory::seen_at after it [s]

  bool digs() const { return excavplan::digs(what); }  ///< whether it is a dig, for volume or shape
};
/// What step and report say of a step: nothing of the ground, and as its time what was foretold.
JobEvent event_of(const JobStep& step, const StepReport& report);

/// A job from its first ground to the last step done. Heights are kept in millimetres, of each step
/// only the cells between those that it changed.
struct JobHistory {
  JobDesign design;            ///< as it was told when the job began
  double design_volume = 0.0;  ///< to be taken out before the first step [m^3]
  HeightMap target;            ///< height of the design; NaN outside of its footprint [m]
  HeightMap before;  ///< surface before the first step, on the same grid; NaN: not known [m]
  Eigen::ArrayXXd
      seen_at;         ///< when a cell was last seen then, since 1970-01-01 UTC [s]; NaN: never
  double begin = 0.0;  ///< since 1970-01-01 UTC [s]
  std::vector<JobEvent> events;  ///< in their order

  /// The ground at one time.
  struct Ground {
    HeightMap surface;        ///< as `before`
    Eigen::ArrayXXd seen_at;  ///< likewise
  };
  /// After so many events. @throws Error (bad_input) if there are fewer
  Ground ground(std::size_t events_done) const;
  /// Hands on the ground before the first event and after each, with the number of events done.
  void play(const std::function<void(std::size_t, const Ground&)>& visit) const;
};

/// Writes a history, event by event.
class JobRecorder {
 public:
  /// @param history  without events. @throws Error (bad_input) unless its layers are of one size
  explicit JobRecorder(JobHistory history);

  /// @param after  on the same grid; its heights are rounded. @throws Error (bad_input) otherwise
  void add(JobEvent event, const JobHistory::Ground& after);
  /// As add(), of an event whose patches are known.
  void add(JobEvent event);
  /// Takes the last events back until so many are left.
  void cut(std::size_t events);

  const JobHistory& history() const { return history_; }  ///< so far
  const JobHistory::Ground& now() const { return now_; }  ///< after the last event

 private:
  JobHistory history_;
  JobHistory::Ground now_;
};

}  // namespace excavplan
