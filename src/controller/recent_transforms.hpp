// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "recording/transform_tree.hpp"

/// @file The transforms that came last. Private to the library.

namespace excavplan {

/// Keeps every static transform, and the others of the last 10 s by their stamps (ours).
class RecentTransforms {
 public:
  void add(std::vector<StampedTransform> transforms);
  /// As they are now.
  TransformTree tree() const;

 private:
  std::map<std::pair<std::string, std::string>, StampedTransform> fixed_;  ///< by parent and child
  std::deque<StampedTransform> moving_;                                    ///< as they came
};

}  // namespace excavplan
