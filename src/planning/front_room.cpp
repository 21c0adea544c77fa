// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/front_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double half_width = 0.25;  // of boom and arm [m]; ours
constexpr double margin = 0.1;       // between them and the ground [m]; ours
constexpr double nothing = -std::numeric_limits<double>::infinity();

/// Height of the lower side at x, the ends counting beyond themselves.
double height_at_x(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double x) {
  if (from.x() == to.x()) return std::min(from.y(), to.y());
  const double share = std::clamp((x - from.x()) / (to.x() - from.x()), 0.0, 1.0);
  return from.y() + share * (to.y() - from.y());
}

/// The highest of a column within this of the boom plane.
double height_within(const HeightMap& map, Index col, double half) {
  const double within = half + 0.5 * map.cell_size;
  double highest = nothing;
  for (Index row = 0; row < map.z.rows(); ++row) {
    const double z = map.z(row, col);
    if (std::abs(map.y(row)) < within && z > highest) highest = z;
  }
  return highest;
}

/// Each column as high as those beside it within the margin.
std::vector<double> widened(const std::vector<double>& heights, double cell_size) {
  const auto cells = static_cast<std::size_t>(std::ceil(margin / cell_size));
  std::vector<double> wide = heights;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::size_t last = std::min(heights.size() - 1, i + cells);
    for (std::size_t k = i > cells ? i - cells : 0; k <= last; ++k) {
      wide[i] = std::max(wide[i], heights[k]);
    }
  }
  return wide;
}

}  // namespace

std::string describe(const FrontContact& contact) {
  return std::string("the ") + contact.link +
         " would pass through the ground at x = " + readable(contact.x, 2) + " m: it would be " +
         readable(contact.lowest, 2) +
         " m high, the ground, or what is counted to stand there, is " + readable(contact.z, 2) +
         " m high";
}

FrontRoom::FrontRoom(const Terrain& terrain, const Machine& machine)
    : machine_(machine),
      origin_(terrain.bank.origin.x()),
      cell_size_(terrain.bank.cell_size),
      highest_(nothing) {
  const HeightMap surface = terrain.surface();
  for (Index col = 0; col < surface.z.cols(); ++col) {
    const bool ahead = surface.x(col) > machine.track_front;
    heights_.push_back(ahead ? height_within(surface, col, half_width) : nothing);
    highest_ = std::max(highest_, heights_.back());
  }
  if (terrain.obstacles.size() == 0) return;
  const double half = 0.5 * machine.bucket.width_outside + margin;
  const HeightMap standing = {surface.origin, surface.cell_size, terrain.obstacles};
  for (Index col = 0; col < standing.z.cols(); ++col) {
    const bool ahead = standing.x(col) > machine.track_front;  // else it is the machine itself
    standing_.push_back(ahead ? height_within(standing, col, half) : nothing);
  }
  standing_ = widened(standing_, cell_size_);
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    heights_[i] = std::max(heights_[i], standing_[i]);
    highest_ = std::max(highest_, heights_[i]);
  }
}

std::optional<FrontContact> FrontRoom::contact(const LinkPositions& at) const {
  if (const auto boom = contact("boom", machine_.boom_pin, at.arm_pin, heights_)) return boom;
  if (const auto arm = contact("arm", at.arm_pin, at.bucket_pin, heights_)) return arm;
  if (standing_.empty()) return std::nullopt;
  const std::vector<Eigen::Vector2d>& profile = machine_.bucket.profile;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d& next = profile[(i + 1) % profile.size()];
    const auto bucket =
        contact("bucket", bucket_point(at, profile[i]), bucket_point(at, next), standing_);
    if (bucket) return bucket;
  }
  return std::nullopt;
}

std::optional<FrontContact> FrontRoom::contact(const char* link, const Eigen::Vector2d& from,
                                               const Eigen::Vector2d& to,
                                               const std::vector<double>& heights) const {
  if (std::min(from.y(), to.y()) - margin > highest_) return std::nullopt;
  const auto columns = static_cast<double>(heights.size());
  const double first = std::floor((std::min(from.x(), to.x()) - origin_) / cell_size_);
  const double last = std::floor((std::max(from.x(), to.x()) - origin_) / cell_size_);
  for (double col = std::max(0.0, first); col <= std::min(last, columns - 1.0); ++col) {
    const double left = origin_ + col * cell_size_;
    const double lowest =
        std::min(height_at_x(from, to, left), height_at_x(from, to, left + cell_size_));
    const double ground = heights[static_cast<std::size_t>(col)];
    if (ground > lowest - margin) {
      return FrontContact{link, left + 0.5 * cell_size_, ground, lowest};
    }
  }
  return std::nullopt;
}

}  // namespace excavplan
