// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "controller/recent_transforms.hpp"

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

constexpr std::int64_t kept = 10'000'000'000;  // [ns]; ours
constexpr std::size_t most_moving = 50000;     // ours: 500 links at 10 Hz
constexpr std::size_t most_fixed = 10000;      // ours

}  // namespace

void RecentTransforms::add(std::vector<StampedTransform> transforms) {
  for (StampedTransform& transform : transforms) {
    if (!transform.is_static) {
      moving_.push_back(std::move(transform));
      continue;
    }
    const auto link = std::make_pair(transform.parent, transform.child);
    if (fixed_.size() >= most_fixed && fixed_.count(link) == 0) {
      throw Error(ErrorKind::bad_file,
                  "transforms: more than " + std::to_string(most_fixed) + " static ones");
    }
    fixed_[link] = std::move(transform);
  }
  while (!moving_.empty() &&
         (moving_.size() > most_moving || moving_.front().stamp < moving_.back().stamp - kept)) {
    moving_.pop_front();
  }
}

TransformTree RecentTransforms::tree() const {
  std::vector<StampedTransform> all(moving_.begin(), moving_.end());
  for (const auto& [link, transform] : fixed_) all.push_back(transform);
  return TransformTree("transforms", moving_.empty() ? 0 : moving_.front().stamp, std::move(all));
}

}  // namespace excavplan
