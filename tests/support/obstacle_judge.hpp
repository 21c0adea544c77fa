// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <excavplan/planning/plan_motion.hpp>

#include "support/obstacle_scenes.hpp"

namespace excavplan::test {

/// What became of the motion of a whole cycle in a scene.
struct SceneVerdict {
  bool trusted = false;  ///< there is a motion, and nothing ends trust in it
  double nearest = 1e9;  ///< of it to a shape that at least three rays hit [m]
  bool clear = false;    ///< the motion for level ground keeps 0.5 m from all, all of it was seen
  bool in_the_way = false;  ///< that motion hits something
  std::string text;         ///< what happened

  bool hits() const { return trusted && nearest < 0.1; }
  bool is_false_alarm() const { return clear && !trusted; }
};

/// Motions of a zx120 in random scenes from their scans, judged on the true shapes. Half of the
/// scenes have an earlier scan as surroundings: people then moved since.
class ObstacleJudge {
 public:
  ObstacleJudge();
  SceneVerdict judge(std::uint64_t number) const;

 private:
  Machine machine_;
  DigPlan plan_;
};

}  // namespace excavplan::test
