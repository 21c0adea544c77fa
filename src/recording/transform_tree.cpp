// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/transform_tree.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "recording/times.hpp"

namespace excavplan {
namespace {

// Ours.
constexpr std::int64_t longest_hold = 100000000;   // before the first and after the last [ns]
constexpr std::int64_t longest_gap = 1000000000;   // over which a frame may move [ns]
constexpr double standing_distance = 0.01;         // [m]
constexpr double standing_angle = 0.1 * pi / 180;  // [rad]
constexpr std::size_t longest_chain = 1000;        // [link]
constexpr double unit_tolerance = 0.01;            // of the length of a quaternion

}  // namespace

TransformTree::TransformTree(std::string file, std::int64_t start,
                             std::vector<StampedTransform> transforms)
    : file_(std::move(file)), start_(start) {
  for (StampedTransform& transform : transforms) {
    const auto [entry, is_new] = links_.try_emplace(std::move(transform.child));
    Link& link = entry->second;
    if (is_new) {
      link.parent = std::move(transform.parent);
      link.is_static = transform.is_static;
    } else if (link.parent != transform.parent) {
      link.other_parent = std::move(transform.parent);
    }
    const Sample sample = {transform.stamp, transform.rotation, transform.translation,
                           transform.delay};
    if (transform.is_static && !link.is_static) {
      link.overridden = {sample};
      continue;
    }
    if (link.is_static && !transform.is_static) link.overridden = link.samples;
    if (link.is_static) link.samples.clear();
    link.is_static = transform.is_static;
    link.samples.push_back(sample);
  }
  for (auto& [child, link] : links_) {
    std::stable_sort(link.samples.begin(), link.samples.end(),
                     [](const Sample& a, const Sample& b) { return a.stamp < b.stamp; });
    link.is_disputed = disputed(link);
  }
}

bool TransformTree::is_leaf(const std::string& frame) const {
  return links_.count(frame) > 0 &&
         std::none_of(links_.begin(), links_.end(),
                      [&](const auto& link) { return link.second.parent == frame; });
}

std::vector<std::string> TransformTree::frames() const {
  std::vector<std::string> names;
  for (const auto& [child, link] : links_) {
    names.push_back(child);
    names.push_back(link.parent);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Eigen::Isometry3d TransformTree::lookup(const std::string& target, const std::string& source,
                                        std::int64_t time) const {
  const Chain between = chain(target, source);
  const auto up = [&](const std::vector<Links::const_iterator>& links) {
    Eigen::Isometry3d above_from_below = Eigen::Isometry3d::Identity();
    for (const auto link : links) above_from_below = pose(link, time) * above_from_below;
    return above_from_below;
  };
  return up(between.of_target).inverse() * up(between.of_source);
}

bool TransformTree::moved(const std::string& target, const std::string& source, std::int64_t from,
                          std::int64_t to) const {
  const Chain between = target.empty() ? Chain{{}, climb(source, {}).links} : chain(target, source);
  const auto any = [&](const std::vector<Links::const_iterator>& links) {
    return std::any_of(links.begin(), links.end(),
                       [&](const auto link) { return moved(link->second, from, to); });
  };
  return any(between.of_target) || any(between.of_source);
}

std::optional<std::int64_t> TransformTree::delay(const std::string& target,
                                                 const std::string& source,
                                                 std::int64_t near) const {
  const Chain between = chain(target, source);
  std::optional<std::int64_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const auto* links : {&between.of_target, &between.of_source}) {
    for (const auto link : *links) {
      if (link->second.is_static) continue;
      std::vector<std::int64_t> delays;
      for (const Sample& sample : link->second.samples) delays.push_back(sample.delay);
      const std::int64_t usual = median(delays);
      const double away = std::abs(static_cast<double>(usual) - static_cast<double>(near));
      if (!(away < least)) continue;
      least = away;
      nearest = usual;
    }
  }
  return nearest;
}

TransformTree::Climb TransformTree::climb(const std::string& frame,
                                          const std::vector<std::string>& until) const {
  Climb path;
  path.end = frame;
  while (std::find(until.begin(), until.end(), path.end) == until.end()) {
    const auto link = links_.find(path.end);
    if (link == links_.end()) break;
    if (!link->second.other_parent.empty()) {
      path.problem = "found transforms of " + in_quotes(link->first) + " in " +
                     in_quotes(link->second.parent) + " and in " +
                     in_quotes(link->second.other_parent) + ", expected one parent of each frame";
      break;
    }
    if (link->second.is_disputed) {
      path.problem = "found transforms of " + in_quotes(link->first) + " in " +
                     in_quotes(link->second.parent) +
                     " that differ at one time, as of two publishers, expected one of each frame";
      break;
    }
    if (path.links.size() == longest_chain) {
      path.problem = "found more than " + std::to_string(longest_chain) + " frames above " +
                     in_quotes(frame) + ", expected a tree without a cycle";
      break;
    }
    path.links.push_back(link);
    path.end = link->second.parent;
  }
  return path;
}

TransformTree::Chain TransformTree::chain(const std::string& target,
                                          const std::string& source) const {
  if (target == source) return {};
  require_frame(target);
  require_frame(source);
  Climb of_source = climb(source, {target});
  std::vector<std::string> above = {source};
  for (const auto link : of_source.links) above.push_back(link->second.parent);
  Climb of_target = climb(target, above);
  const auto meeting = std::find(above.begin(), above.end(), of_target.end);
  if (meeting == above.end()) {
    for (const Climb* path : {&of_source, &of_target}) {
      if (!path->problem.empty()) refuse(path->problem);
    }
    refuse("found no transforms that lead from " + in_quotes(source) + " to " + in_quotes(target) +
           ": those of " + in_quotes(source) + " end at " + in_quotes(of_source.end) +
           ", those of " + in_quotes(target) + " at " + in_quotes(of_target.end) + "; " +
           frame_list());
  }
  of_source.links.resize(static_cast<std::size_t>(meeting - above.begin()));
  return {std::move(of_target.links), std::move(of_source.links)};
}

Eigen::Isometry3d TransformTree::pose(Links::const_iterator link, const Sample& sample) const {
  const double length = sample.rotation.norm();
  if (!(std::abs(length - 1.0) <= unit_tolerance) || !sample.translation.allFinite()) {
    std::string found;
    for (int i = 0; i < 4; ++i) found += " " + number_text(sample.rotation[i]);
    for (int i = 0; i < 3; ++i) found += " " + number_text(sample.translation[i]);
    refuse("transform of " + in_quotes(link->first) + " in " + in_quotes(link->second.parent) +
           " at " + time_text(sample.stamp) + ": found the quaternion and translation" + found +
           ", expected a quaternion of length 1 and a finite translation");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(sample.rotation / length).toRotationMatrix();
  pose.translation() = sample.translation;
  return pose;
}

Eigen::Isometry3d TransformTree::pose(Links::const_iterator link, std::int64_t time) const {
  const std::vector<Sample>& samples = link->second.samples;
  if (link->second.is_static) return pose(link, samples.front());
  const auto after =
      std::lower_bound(samples.begin(), samples.end(), time,
                       [](const Sample& sample, std::int64_t t) { return sample.stamp < t; });
  const auto before = after == samples.begin() ? after : std::prev(after);
  const std::string what =
      "transform of " + in_quotes(link->first) + " in " + in_quotes(link->second.parent);
  if (after == samples.begin() || after == samples.end()) {
    if (std::abs(time_between(before->stamp, time)) <= longest_hold) return pose(link, *before);
    refuse(what + " at " + time_text(time) + ": found it from " + time_text(samples.front().stamp) +
           " to " + time_text(samples.back().stamp) + ", expected it at that time");
  }
  if (time_between(before->stamp, after->stamp) > longest_gap && apart(*before, *after)) {
    refuse(what + " at " + time_text(time) + ": found it at " + time_text(before->stamp) +
           " and at " + time_text(after->stamp) + ", where it had moved, expected it every second");
  }
  const double part = static_cast<double>(time_between(before->stamp, time)) /
                      static_cast<double>(time_between(before->stamp, after->stamp));
  const Eigen::Isometry3d start = pose(link, *before);
  const Eigen::Isometry3d end = pose(link, *after);
  Eigen::Isometry3d between = Eigen::Isometry3d::Identity();
  between.linear() = Eigen::Quaterniond(start.linear())
                         .slerp(part, Eigen::Quaterniond(end.linear()))
                         .toRotationMatrix();
  between.translation() = start.translation() + part * (end.translation() - start.translation());
  return between;
}

bool TransformTree::moved(const Link& link, std::int64_t from, std::int64_t to) {
  if (link.is_static) return false;
  const auto earlier = [](const Sample& sample, std::int64_t t) { return sample.stamp < t; };
  auto begin = std::lower_bound(link.samples.begin(), link.samples.end(), from, earlier);
  if (begin != link.samples.begin()) --begin;
  auto end = std::lower_bound(begin, link.samples.end(), to, earlier);
  if (end != link.samples.end()) ++end;
  return std::any_of(begin, end, [&](const Sample& sample) { return apart(*begin, sample); });
}

bool TransformTree::apart(const Sample& one, const Sample& other) {
  const double cosine_of_half =
      std::abs(one.rotation.dot(other.rotation)) / (one.rotation.norm() * other.rotation.norm());
  return (one.translation - other.translation).norm() > standing_distance ||
         cosine_of_half < std::cos(0.5 * standing_angle);
}

/// By a static transform beside others, or by two of one stamp.
bool TransformTree::disputed(const Link& link) {
  const auto differs = [&](const Sample& one) {
    return std::any_of(link.samples.begin(), link.samples.end(),
                       [&](const Sample& other) { return apart(one, other); });
  };
  const auto same_time = [](const Sample& one, const Sample& next) {
    return one.stamp == next.stamp && apart(one, next);
  };
  return std::any_of(link.overridden.begin(), link.overridden.end(), differs) ||
         std::adjacent_find(link.samples.begin(), link.samples.end(), same_time) !=
             link.samples.end();
}

std::string TransformTree::time_text(std::int64_t time) const {
  constexpr double longest_recording = 1e8;
  const double since_start = (static_cast<double>(time) - static_cast<double>(start_)) * 1e-9;
  if (std::abs(since_start) < longest_recording) return decimals(since_start, 3) + " s";
  return decimals(static_cast<double>(time) * 1e-9, 3) + " s since 1970";
}

std::string TransformTree::frame_list() const {
  constexpr std::size_t most = 40;
  const std::vector<std::string> names = frames();
  std::string text = "the frames there are:";
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
    text += (i == 0 ? " " : ", ") + in_quotes(names[i]);
  }
  return text + (names.size() > most ? ", ..." : "");
}

void TransformTree::require_frame(const std::string& frame) const {
  const std::vector<std::string> names = frames();
  if (names.empty()) {
    refuse("found no transforms on /tf and /tf_static, expected those of " + in_quotes(frame));
  }
  if (std::binary_search(names.begin(), names.end(), frame)) return;
  const auto meant = nearest_word(frame, names);
  refuse("found no transform of frame " + in_quotes(frame) +
         (meant ? ", did you mean " + in_quotes(*meant) + "?" : ",") + " " + frame_list());
}

void TransformTree::refuse(const std::string& why) const {
  throw Error(ErrorKind::bad_file, file_ + ": " + why);
}

}  // namespace excavplan
