// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/dig_layout.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <excavplan/machine/kinematics.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "ground/terrain.hpp"
#include "simulation/swath.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

// How far ahead of the lip the simulator reads the ground [m].
constexpr double looked_ahead = 0.25;

const Machine& required(const Machine& machine) {
  require_machine(machine);
  return machine;
}

}  // namespace

KnownStrip::KnownStrip(const Terrain& terrain, const Machine& machine)
    : origin_(terrain.bank.origin.x()), cell_size_(terrain.bank.cell_size) {
  const HeightMap& bank = terrain.bank;
  std::optional<Swath> swath;
  if (const double width = machine.bucket.width_outside; Swath::fits(bank, width)) {
    swath.emplace(bank, width);
  }
  unknown_before_ = {0};
  for (Index col = 0; col < bank.z.cols(); ++col) {
    const bool known = swath && swath->is_known(col);
    unknown_before_.push_back(unknown_before_.back() + (known ? 0 : 1));
  }
}

bool KnownStrip::is_known(double x_min, double x_max) const {
  const auto columns = static_cast<double>(unknown_before_.size() - 1);
  const double first = std::floor((x_min - origin_) / cell_size_);
  const double last = std::ceil((x_max - origin_) / cell_size_);
  if (!(first >= 0.0 && last <= columns)) return false;
  return unknown_before_[static_cast<std::size_t>(first)] ==
         unknown_before_[static_cast<std::size_t>(last)];
}

DigLayout::DigLayout(const Machine& machine, const Terrain& terrain, DigPathOptions rules)
    : machine_(required(machine)),
      rules_(std::move(rules)),
      ground_(start_profile(terrain, machine)),
      strip_(terrain, machine),
      room_(terrain, machine) {}

std::variant<DigPath, Infeasible> DigLayout::path_from(const DigParameters& parameters,
                                                       double start_x,
                                                       const DigPathOptions& rules) const {
  return checked(make_dig_path(machine_, parameters, start_x, ground_, rules));
}

bool DigLayout::can_be_driven(const DigTrials& trials, double start_x,
                              const DigTrials::Judge& judge) const {
  const auto path = trials.from(start_x, judge);
  if (!path) return false;
  const double x_max = path->start_x + strip_.cell_size();
  return std::none_of(path->poses.begin(), path->poses.end(),
                      [&](const DigPose& pose) { return obstacle(pose, x_max).has_value(); });
}

std::variant<DigPath, Infeasible> DigLayout::path_from(const DigParameters& parameters,
                                                       double start_x) const {
  return path_from(parameters, start_x, rules_);
}

std::variant<DigPath, Infeasible> DigLayout::path_near(const DigParameters& parameters,
                                                       double start_x) const {
  auto path = path_from(parameters, start_x);
  return std::holds_alternative<DigPath>(path) ? path : path_of_largest_margin(parameters);
}

std::variant<DigPath, Infeasible> DigLayout::path_of_largest_margin(
    const DigParameters& parameters) const {
  return checked(make_dig_path_anywhere(machine_, parameters, ground_, rules_));
}

/// What a profile of the ground does not tell: a cell that the bucket passes, or one just ahead of
/// it, is unknown, or the ground is in the way of the links.
std::optional<Infeasible> DigLayout::obstacle(const DigPose& pose, double x_max) const {
  if (!strip_.is_known(pose.bucket.x - looked_ahead, x_max)) {
    Infeasible stop;
    stop.phase = pose.phase;
    stop.reason = Infeasible::Reason::unknown_ground;
    stop.value = x_max - strip_.cell_size();
    stop.message = "the path runs over ground that is unknown or off the map";
    return stop;
  }
  return front_contact(pose);
}

std::optional<Infeasible> DigLayout::front_contact(const DigPose& pose) const {
  const auto contact = room_.contact(link_positions(machine_, pose.joints));
  if (!contact) return std::nullopt;
  Infeasible stop;
  stop.phase = pose.phase;
  stop.reason = Infeasible::Reason::front_contact;
  stop.value = contact->lowest;
  stop.limit = contact->z;
  stop.message = describe(*contact);
  return stop;
}

std::variant<std::vector<DigPose>, Infeasible> DigLayout::approach(const DigPath& path) const {
  auto found = way_down(machine_, path, ground_);
  if (const auto* way = std::get_if<std::vector<DigPose>>(&found)) {
    for (const DigPose& pose : *way) {
      if (auto stop = front_contact(pose)) return *std::move(stop);
    }
  }
  return found;
}

/// The path, if nothing of that stops it.
std::variant<DigPath, Infeasible> DigLayout::checked(
    std::variant<DigPath, Infeasible> found) const {
  const auto* path = std::get_if<DigPath>(&found);
  if (!path) return found;
  const double x_max = path->start_x + strip_.cell_size();
  const DigPose* phase_start = &path->poses.front();
  for (const DigPose& pose : path->poses) {
    if (pose.phase != phase_start->phase) phase_start = &pose;
    auto stop = obstacle(pose, x_max);
    if (!stop) continue;
    stop->distance =
        std::hypot(pose.bucket.x - phase_start->bucket.x, pose.bucket.z - phase_start->bucket.z);
    return *std::move(stop);
  }
  return found;
}

std::vector<double> starts_along_reach(const Machine& machine) {
  constexpr double step = 0.25;
  std::vector<double> starts;
  const double reach = machine.boom_pin.x() + machine.full_length();
  for (double x = machine.track_front; x < reach; x += step) starts.push_back(x);
  return starts;
}

}  // namespace excavplan
