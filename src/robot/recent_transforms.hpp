// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "recording/transform_tree.hpp"

/// @file The transforms that came last. Private to the library.

namespace excavplan {

/// Keeps every static transform; of each other frame those of its last 10 s (ours) and the one
/// before, so that a slow frame is known between its last two. The clock of one frame says nothing
/// about another.
class RecentTransforms {
 public:
  /// A stamp that is further back is that of a clock that was set back: its frame begins anew.
  void add(std::vector<StampedTransform> transforms);
  /// As they are now.
  TransformTree tree() const;

 private:
  using Frame = std::deque<StampedTransform>;  ///< by stamp

  void add_fixed(StampedTransform transform);
  void add_moving(StampedTransform transform);

  std::map<std::pair<std::string, std::string>, StampedTransform> fixed_;  ///< by parent and child
  std::map<std::string, Frame> moving_;                                    ///< by child
  std::size_t count_ = 0;                                                  ///< in `moving_`
};

}  // namespace excavplan
