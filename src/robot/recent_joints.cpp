// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/recent_joints.hpp"

#include <algorithm>
#include <iterator>

#include "recording/times.hpp"

namespace excavplan {
namespace {

constexpr std::int64_t joints_kept = 10'000'000'000;  // [ns]
constexpr std::size_t most_samples = 20000;           // ours: 2 kHz

bool earlier(const JointSample& sample, std::int64_t time) { return sample.time < time; }

}  // namespace

void RecentJoints::add(const std::string& name, const JointSample& sample) {
  std::deque<JointSample>& samples = joints_[name];
  if (!samples.empty() && sample.time < later(samples.back().time, -joints_kept)) samples.clear();
  auto place = samples.end();
  while (place != samples.begin() && sample.time < std::prev(place)->time) --place;
  if (place != samples.begin() && std::prev(place)->time == sample.time) {
    *std::prev(place) = sample;
  } else {
    samples.insert(place, sample);
  }
  while (samples.size() > most_samples ||
         samples.front().time < later(samples.back().time, -joints_kept)) {
    samples.pop_front();
  }
}

std::optional<JointSample> RecentJoints::nearest(const std::string& name, std::int64_t time) const {
  const auto joint = joints_.find(name);
  if (joint == joints_.end()) return {};
  const std::deque<JointSample>& samples = joint->second;
  const auto after = std::lower_bound(samples.begin(), samples.end(), time, earlier);
  if (after == samples.begin()) return *after;
  const JointSample& before = *std::prev(after);
  return after == samples.end() || time_between(before.time, time) < time_between(time, after->time)
             ? before
             : *after;
}

std::optional<double> RecentJoints::turned(const std::string& name, std::int64_t span) const {
  const auto joint = joints_.find(name);
  if (joint == joints_.end()) return {};
  const std::deque<JointSample>& samples = joint->second;
  double lowest = samples.back().position, highest = lowest;
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
    lowest = std::min(lowest, sample->position);
    highest = std::max(highest, sample->position);
    if (sample->time <= later(samples.back().time, -span)) return highest - lowest;
  }
  return {};
}

bool RecentJoints::reaches(const std::string& name, std::int64_t time) const {
  const auto joint = joints_.find(name);
  return joint != joints_.end() && joint->second.back().time >= time;
}

}  // namespace excavplan
