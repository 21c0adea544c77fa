// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/skipped_parts.hpp"

namespace excavplan {
namespace {

constexpr std::size_t most_kept = 1000;  // ours

void widen(TimeRange& times, const TimeRange& by) {
  times.from = std::min(times.from, by.from);
  times.to = std::max(times.to, by.to);
}

}  // namespace

void SkippedParts::add(const std::string& why, const Loss& loss) {
  if (first_.empty()) first_ = why;
  const auto known = whys_.find(why);
  if (known != whys_.end()) {
    std::set<std::string>& topics = known->second.topics;
    widen(known->second.times, loss.times);
    if (loss.topics.empty()) topics.clear();
    if (!topics.empty()) topics.insert(loss.topics.begin(), loss.topics.end());
  } else if (whys_.size() < most_kept) {
    whys_.emplace(why, loss);
  } else {
    ++more_;
    widen(of_more_, loss.times);
  }
}

void SkippedParts::add_open(const std::string& why, std::int64_t from) {
  if (whys_.count(why) > 0) return;  // it was met before, and its end told
  open_.push_back(why);
  add(why, {{from, latest}});
}

void SkippedParts::close(std::int64_t to) {
  for (const std::string& why : open_) {
    const auto found = whys_.find(why);
    if (found != whys_.end()) found->second.times.to = std::max(found->second.times.from, to);
  }
  open_.clear();
}

std::string SkippedParts::text() const {
  if (count() == 0) return "";
  return std::to_string(count()) +
         (count() == 1 ? " part is damaged and left out: "
                       : " parts are damaged and left out, the first: ") +
         first_;
}

std::optional<std::int64_t> SkippedParts::first_lost(const std::string& topic,
                                                     const TimeRange& range) const {
  std::optional<std::int64_t> first;
  const auto look_at = [&](const TimeRange& times) {
    if (times.from > times.to || times.from > range.to || times.to < range.from) return;
    first = std::min(first.value_or(latest), std::max(times.from, range.from));
  };
  for (const auto& [why, loss] : whys_) {
    if (loss.topics.empty() || loss.topics.count(topic) > 0) look_at(loss.times);
  }
  look_at(of_more_);
  return first;
}

TimeRange about(std::int64_t middle) {
  const bool is_early = middle < earliest + longest_topic;
  const bool is_late = middle > latest - longest_topic;
  return {is_early ? earliest : middle - longest_topic, is_late ? latest : middle + longest_topic};
}

TimeRange usual_times(std::vector<std::int64_t>& times) {
  if (times.empty()) return {};
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return about(*middle);
}

}  // namespace excavplan
