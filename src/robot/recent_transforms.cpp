// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/recent_transforms.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include <excavplan/base/error.hpp>

#include "recording/times.hpp"

namespace excavplan {
namespace {

constexpr std::int64_t kept = 10'000'000'000;  // [ns]
constexpr std::size_t most_moving = 50000;     // ours: 500 links at 10 Hz
constexpr std::size_t most_frames = 10000;     // ours

void require_room(std::size_t frames, const char* kind) {
  if (frames < most_frames) return;
  throw Error(ErrorKind::bad_file,
              "transforms: more than " + std::to_string(most_frames) + " " + kind + " ones");
}

}  // namespace

void RecentTransforms::add(std::vector<StampedTransform> transforms) {
  for (StampedTransform& transform : transforms) {
    transform.is_static ? add_fixed(std::move(transform)) : add_moving(std::move(transform));
  }
}

void RecentTransforms::add_fixed(StampedTransform transform) {
  const auto link = std::make_pair(transform.parent, transform.child);
  if (fixed_.count(link) == 0) require_room(fixed_.size(), "static");
  fixed_[link] = std::move(transform);
}

void RecentTransforms::add_moving(StampedTransform transform) {
  if (moving_.count(transform.child) == 0) require_room(moving_.size(), "moving");
  Frame& frame = moving_[transform.child];
  const auto drop_first = [&](Frame& of) {
    of.pop_front();
    --count_;
  };
  while (!frame.empty() && transform.stamp < later(frame.back().stamp, -kept)) drop_first(frame);
  auto place = frame.end();
  while (place != frame.begin() && transform.stamp < std::prev(place)->stamp) --place;
  frame.insert(place, std::move(transform));
  ++count_;
  while (frame.size() > 1 && frame[1].stamp < later(frame.back().stamp, -kept)) drop_first(frame);
  if (count_ <= most_moving) return;
  const auto largest = std::max_element(
      moving_.begin(), moving_.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  drop_first(largest->second);
}

TransformTree RecentTransforms::tree() const {
  std::vector<StampedTransform> all;
  all.reserve(count_ + fixed_.size());
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const auto& [child, frame] : moving_) {
    first = std::min(first, frame.front().stamp);
    all.insert(all.end(), frame.begin(), frame.end());
  }
  for (const auto& [link, transform] : fixed_) all.push_back(transform);
  return {"transforms", moving_.empty() ? 0 : first, std::move(all)};
}

}  // namespace excavplan
