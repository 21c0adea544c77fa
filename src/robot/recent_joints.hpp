// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

/// @file Where the joints stood. Private to the library.

namespace excavplan {

/// A joint at a time.
struct JointSample {
  std::int64_t time = 0;  ///< [ns]
  double position = 0.0;  ///< of the robot [rad]
};

/// Keeps the last 10 s of each joint (ours).
class RecentJoints {
 public:
  /// A time that is further back is that of a clock that was set back: it begins anew.
  void add(const std::string& name, const JointSample& sample);
  /// The sample nearest to a time; nothing if none came.
  std::optional<JointSample> nearest(const std::string& name, std::int64_t time) const;
  /// How far the joint turned since the last sample that is older than the newest by this span, to
  /// and fro too [rad]; nothing if there is none.
  std::optional<double> turned(const std::string& name, std::int64_t span) const;
  /// Whether a sample of that time or a later one came.
  bool reaches(const std::string& name, std::int64_t time) const;

 private:
  std::map<std::string, std::deque<JointSample>> joints_;  // by their times
};

}  // namespace excavplan
