// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "recording/ros_messages.hpp"

/// @file Where frames stand in one another at a time. Private to the library.

namespace excavplan {

/// The tree that transforms of a recording make. Each frame has one parent; a static transform
/// holds at all times, the last one that was recorded, others hold between their stamps: positions
/// are interpolated linearly, orientations along the shortest arc (slerp, Shoemake 1985).
class TransformTree {
 public:
  /// `file` and `start`, the first message of the recording [ns since 1970], are for messages.
  TransformTree(std::string file, std::int64_t start, std::vector<StampedTransform> transforms);

  /// The parent of no other frame, but the child of one: where a sensor is, not a map or machine.
  bool is_leaf(const std::string& frame) const;
  std::vector<std::string> frames() const;  ///< sorted

  /// p_target = T p_source at a time [ns since 1970].
  ///
  /// A pose holds up to 0.1 s before the first and after the last stamp, and none is interpolated
  /// between stamps more than 1 s apart between which the frame moved (ours).
  /// @throws Error (bad_file) if no chain joins the frames, naming where it breaks; if a frame of
  /// it has two parents, two publishers that disagree, or is its own ancestor; if it is not known
  /// at that time, or is no motion
  Eigen::Isometry3d lookup(const std::string& target, const std::string& source,
                           std::int64_t time) const;

  /// True if a frame moved in `target`, or in the root of its tree if that is empty, by more than
  /// 1 cm or 0.1 deg (ours) in any link between them. @throws Error (bad_file) as lookup() if a
  /// target is named and no chain leads there
  bool moved(const std::string& target, const std::string& source, std::int64_t from,
             std::int64_t to) const;

  /// The delay of recording behind stamp which is nearest to a given one [ns]: of each link between
  /// the frames that is not static the median. None of static links alone. @throws Error (bad_file)
  /// if no chain joins them
  std::optional<std::int64_t> delay(const std::string& target, const std::string& source,
                                    std::int64_t near) const;

 private:
  struct Sample {
    std::int64_t stamp = 0;
    Eigen::Vector4d rotation;
    Eigen::Vector3d translation;
    std::int64_t delay = 0;
  };
  /// From a frame to its parent.
  struct Link {
    std::string parent;
    std::string other_parent;  ///< which must not be
    bool is_static = false;
    bool is_disputed = false;        ///< two publishers disagree
    std::vector<Sample> overridden;  ///< static ones of a link that is not
    std::vector<Sample> samples;     ///< sorted by stamp; one if static
  };
  using Links = std::map<std::string, Link>;
  /// From a frame towards the root.
  struct Climb {
    std::vector<Links::const_iterator> links;
    std::string end;      ///< the frame where it stopped
    std::string problem;  ///< why it could not go on; empty at the root or where it was to stop
  };
  /// The links that lead from two frames up to where they meet.
  struct Chain {
    std::vector<Links::const_iterator> of_target;
    std::vector<Links::const_iterator> of_source;
  };

  Climb climb(const std::string& frame, const std::vector<std::string>& until) const;
  Chain chain(const std::string& target, const std::string& source) const;
  Eigen::Isometry3d pose(Links::const_iterator link, std::int64_t time) const;
  Eigen::Isometry3d pose(Links::const_iterator link, const Sample& sample) const;
  static bool moved(const Link& link, std::int64_t from, std::int64_t to);
  static bool apart(const Sample& one, const Sample& other);
  static bool disputed(const Link& link);
  std::string time_text(std::int64_t time) const;
  std::string frame_list() const;
  void require_frame(const std::string& frame) const;
  [[noreturn]] void refuse(const std::string& why) const;

  std::string file_;
  std::int64_t start_;
  Links links_;  ///< by the child's name
};

}  // namespace excavplan
