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

/// The highest known ground of a column within the width of the links.
double height_under_links(const HeightMap& surface, Index col) {
  const double within = half_width + 0.5 * surface.cell_size;
  double highest = nothing;
  for (Index row = 0; row < surface.z.rows(); ++row) {
    const double z = surface.z(row, col);
    if (std::abs(surface.y(row)) < within && z > highest) highest = z;
  }
  return highest;
}

}  // namespace

std::string describe(const FrontContact& contact) {
  return std::string("the ") + contact.link +
         " would pass through the ground at x = " + readable(contact.x, 2) + " m: it would be " +
         readable(contact.lowest, 2) + " m high, the ground is " + readable(contact.z, 2) +
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
    heights_.push_back(ahead ? height_under_links(surface, col) : nothing);
    highest_ = std::max(highest_, heights_.back());
  }
}

std::optional<FrontContact> FrontRoom::contact(const LinkPositions& at) const {
  if (const auto boom = contact("boom", machine_.boom_pin, at.arm_pin)) return boom;
  return contact("arm", at.arm_pin, at.bucket_pin);
}

std::optional<FrontContact> FrontRoom::contact(const char* link, const Eigen::Vector2d& from,
                                               const Eigen::Vector2d& to) const {
  if (std::min(from.y(), to.y()) - margin > highest_) return std::nullopt;
  const auto columns = static_cast<double>(heights_.size());
  const double first = std::floor((std::min(from.x(), to.x()) - origin_) / cell_size_);
  const double last = std::floor((std::max(from.x(), to.x()) - origin_) / cell_size_);
  for (double col = std::max(0.0, first); col <= std::min(last, columns - 1.0); ++col) {
    const double left = origin_ + col * cell_size_;
    const double lowest =
        std::min(height_at_x(from, to, left), height_at_x(from, to, left + cell_size_));
    const double ground = heights_[static_cast<std::size_t>(col)];
    if (ground > lowest - margin) {
      return FrontContact{link, left + 0.5 * cell_size_, ground, lowest};
    }
  }
  return std::nullopt;
}

}  // namespace excavplan
