// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;

// Ours:
constexpr double clear_margin = 0.1;  // to the ground, below and to every side [m]
constexpr double slack = 0.01;        // of the way off and onto the ground [m]
constexpr double under_link = 0.1;    // of a link's body below its line from pin to pin [m]
constexpr double cells_in_reach = 200.0;
constexpr double track_height = 0.5;  // of the undercarriage, over track_front: 0.9 m of a zx120

/// Unknown cells over the reach; where they are as large as those of the ground, they are the same.
HeightMap grid_over(const Machine& machine, const HeightMap& ground) {
  const double reach = machine.swing_reach();
  HeightMap grid;
  grid.cell_size = std::max(ground.cell_size, reach / cells_in_reach);
  const Vector2d corner = Vector2d::Constant(-reach);
  const Vector2d before = ((corner - ground.origin) / grid.cell_size).array().floor();
  grid.origin = ground.origin + grid.cell_size * before;
  const auto cells = static_cast<Index>(std::ceil(2.0 * reach / grid.cell_size)) + 2;
  grid.z = ArrayXXd::Constant(cells, cells, std::nan(""));
  return grid;
}

/// A run of cells along an axis.
struct Run {
  Index first, count;
};

/// Those with their centres in a cell of a map at x, and the one with its centre.
Run covered(double x, double map_cell, double origin, double cell, Index cells) {
  const auto last_before = [&](double edge) {
    return std::ceil((edge - origin) / cell - 0.5) - 1.0;
  };
  const double own = std::floor((x - origin) / cell), end = static_cast<double>(cells - 1);
  const double first = std::max(0.0, std::min(own, last_before(x - 0.5 * map_cell) + 1.0));
  const double last = std::min(end, std::max(own, last_before(x + 0.5 * map_cell)));
  if (!(first <= last)) return {0, 0};
  return {static_cast<Index>(first), static_cast<Index>(last - first) + 1};
}

/// Where a map is known it takes the place of the grid's heights, the highest of each cell; where
/// it is known in a part of a cell, nothing becomes lower.
void enter(const HeightMap& map, HeightMap& grid) {
  ArrayXXd entered = ArrayXXd::Constant(grid.z.rows(), grid.z.cols(), -infinity);
  ArrayXXd at_least = entered;
  const double cell = grid.cell_size;
  std::vector<Run> rows;
  for (Index row = 0; row < map.z.rows(); ++row) {
    rows.push_back(covered(map.y(row), map.cell_size, grid.origin.y(), cell, grid.z.rows()));
  }
  for (Index col = 0; col < map.z.cols(); ++col) {
    const Run cols = covered(map.x(col), map.cell_size, grid.origin.x(), cell, grid.z.cols());
    for (Index row = 0; row < map.z.rows() && cols.count > 0; ++row) {
      const Run& run = rows[static_cast<std::size_t>(row)];
      if (run.count == 0) continue;
      auto place = entered.block(run.first, cols.first, run.count, cols.count);
      if (std::isfinite(map.z(row, col))) {
        place = place.max(map.z(row, col));
      } else {
        at_least.block(run.first, cols.first, run.count, cols.count) =
            grid.z.block(run.first, cols.first, run.count, cols.count);
      }
    }
  }
  const ArrayXXd highest = (at_least > entered).select(at_least, entered);
  grid.z = (entered == -infinity).select(grid.z, highest).eval();
}

ArrayXXd lowest_beside(const ArrayXXd& z) {
  const ArrayXXd low = lowest_within(without_nan(z, infinity), 1);
  return (low == infinity).select(-infinity, low);
}

}  // namespace

Surroundings::Surroundings(const Machine& machine, const Terrain& ground)
    : machine_(machine), seen_(grid_over(machine, ground.bank)) {
  const double front = std::max(0.0, machine.track_front);
  const double half = 0.5 * machine.undercarriage_width();
  undercarriage_ = {-front, -half, front, half};
  own_radius_ = std::hypot(front, half);
  const double cell = seen_.cell_size;
  cells_of_margin_ = std::max(1.0, std::ceil(clear_margin / cell - 1e-9));
  // A place between points is at most spacing (sqrt(1/2) + 1/2) from one: beside it on the machine,
  // and half a step of the motion away.
  near_ = 0.8 * cells_of_margin_ * cell;
  fine_ = 0.7 * cell;  // a square of it holds one of the points of a square grid
  HeightMap standing = seen_;
  if (ground.obstacles.size() > 0) {
    enter({ground.bank.origin, ground.bank.cell_size, ground.obstacles}, standing);
  }
  standing_ = without_nan(standing.z, -infinity);
  for (Index col = 0; col < standing_.cols(); ++col) {
    for (Index row = 0; row < standing_.rows(); ++row) {
      if (undercarriage_.contains(seen_.x(col), seen_.y(row))) standing_(row, col) = -infinity;
    }
  }
  stands_ = highest_within(standing_, static_cast<Index>(cells_of_margin_));
  replace(ground.surface());
  put_beside();
}

void Surroundings::replace(const HeightMap& by) {
  enter(by, seen_);
  put_undercarriage();
  seen_.z = (standing_ > seen_.z || (seen_.z.isNaN() && standing_ > -infinity))
                .select(standing_, seen_.z)
                .eval();
  const auto cells = static_cast<Index>(std::min(cells_of_margin_, 2.0 * cells_in_reach));
  highest_ = highest_within(seen_.z.isNaN().select(0.0, seen_.z), cells);
  lowest_ = lowest_beside(seen_.z);
  top_ = highest_.maxCoeff();
}

/// Of the tracks, which lie along or across what the front looks at.
double Surroundings::track_top() const {
  return track_height * std::max(undercarriage_.x_max, undercarriage_.y_max);
}

void Surroundings::put_undercarriage() {
  const double top = track_top();
  for (Index col = 0; col < seen_.z.cols(); ++col) {
    for (Index row = 0; row < seen_.z.rows(); ++row) {
      const double x = seen_.x(col), y = seen_.y(row);
      if (x >= undercarriage_.x_max || x * x + y * y > own_radius_ * own_radius_) continue;
      seen_.z(row, col) = undercarriage_.contains(x, y) ? top : 0.0;
    }
  }
}

bool Surroundings::stands_at(double x, double y) const {
  const auto cell = cell_at(seen_, x, y);
  return cell && stands_(cell->row, cell->col) > -infinity;
}

void Surroundings::put_beside() {
  const double tail = machine_.tail_swing_radius() + clear_margin + seen_.cell_size;
  const double low = track_top() - clear_margin;
  for (Index col = 0; col < seen_.z.cols(); ++col) {
    for (Index row = 0; row < seen_.z.rows(); ++row) {
      const Eigen::Vector3d top(seen_.x(col), seen_.y(row), seen_.z(row, col));
      const bool hit = top.z() > low && top.head<2>().norm() <= tail;
      if (hit && !on_undercarriage(top.x(), top.y())) beside_.push_back(top);
    }
  }
}

std::optional<Clearance> Surroundings::tail_obstacle(const FrontJoints& from,
                                                     const FrontJoints& to) const {
  const double tail = machine_.tail_swing_radius();
  const double half = std::min(undercarriage_.x_max, undercarriage_.y_max);
  const auto within = [&](const Eigen::Vector3d& top, double swing, double more) {
    const double ahead = top.x() * std::cos(swing) + top.y() * std::sin(swing);
    const double aside = top.y() * std::cos(swing) - top.x() * std::sin(swing);
    return ahead >= -tail - more && ahead <= half + more && std::abs(aside) <= half + more;
  };
  const double steps =
      std::ceil(std::abs(to[3] - from[3]) * (tail + clear_margin) / seen_.cell_size);
  const double near = clear_margin + 0.5 * seen_.cell_size;
  for (const Eigen::Vector3d& top : beside_) {
    if (within(top, from[3], 0.0)) continue;
    for (double i = 1.0; i <= steps; ++i) {
      if (!within(top, from[3] + i / steps * (to[3] - from[3]), near)) continue;
      return Clearance{track_top() - top.z(), top};
    }
  }
  return std::nullopt;
}

/// Points of the machine that are not too high, which a visit may change, over the width of the
/// bucket: visit(place, height of its lower side). Of the boom over the machine, where its foot is,
/// only what something stands at.
template <typename Visit>
void Surroundings::visit(const FrontJoints& joints, double spacing, const double& too_high,
                         Visit visit) const {
  const LinkPositions links = link_positions(machine_, joints.head<3>());
  const Vector2d ahead(std::cos(joints[3]), std::sin(joints[3]));
  const double width = machine_.bucket.width_outside;
  const double strips = std::max(1.0, std::ceil(width / spacing));
  const auto look = [&](const Vector2d& from, const Vector2d& to, double below, bool is_boom) {
    const double steps = std::max(1.0, std::ceil((to - from).norm() / spacing));
    for (double i = 0.0; i <= steps; ++i) {
      const Vector2d at = from + i / steps * (to - from);
      const bool on_machine = is_boom && std::abs(at.x()) <= own_radius_;
      for (double strip = 0.0; strip <= strips; ++strip) {
        if (at.y() - below >= too_high) break;
        const double aside = (strip / strips - 0.5) * width;
        const Vector2d place = at.x() * ahead + aside * Vector2d(-ahead.y(), ahead.x());
        if (on_machine && !stands_at(place.x(), place.y())) continue;
        visit(place, at.y() - below);
      }
    }
  };
  look(machine_.boom_pin, links.arm_pin, under_link, true);
  look(links.arm_pin, links.bucket_pin, under_link, false);
  const std::vector<Vector2d>& profile = machine_.bucket.profile;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    look(bucket_point(links, profile[i]), bucket_point(links, profile[(i + 1) % profile.size()]),
         0.0, false);
  }
}

/// @param most  that is of interest [m]; the clearance is never more
template <typename Height>
Clearance Surroundings::least(const FrontJoints& joints, double spacing, double most,
                              Height height_of) const {
  Clearance found;
  found.height = most;
  double too_high = top_ + most;
  visit(joints, spacing, too_high, [&](const Vector2d& place, double bottom) {
    const auto cell = cell_at(seen_, place.x(), place.y());
    const double ground = cell ? height_of(cell->row, cell->col) : 0.0;
    if (bottom - ground >= found.height) return;
    found = {bottom - ground, {place.x(), place.y(), ground}};
    too_high = top_ + found.height;
  });
  return found;
}

Clearance Surroundings::margin_at(const FrontJoints& joints) const {
  return least(joints, near_, clear_margin,
               [this](Index row, Index col) { return highest_(row, col); });
}

Clearance Surroundings::standing(const FrontJoints& joints) const {
  return least(joints, fine_, infinity, [this](Index row, Index col) { return lowest_(row, col); });
}

/// Into which a straight way is divided, so that no point of the machine goes further in one.
double Surroundings::parts(const FrontJoints& from, const FrontJoints& to, double spacing) const {
  const FrontJoints turn = (to - from).cwiseAbs();
  const double hand = machine_.arm_length + machine_.bucket_length;
  const double most = turn[0] * machine_.full_length() + turn[1] * hand +
                      turn[2] * machine_.bucket_length + turn[3] * machine_.swing_reach();
  return std::max(1.0, std::ceil(most / spacing));
}

std::optional<Clearance> Surroundings::obstacle(const FrontJoints& from,
                                                const FrontJoints& to) const {
  const double count = parts(from, to, near_);
  for (double i = 0.0; i <= count; ++i) {
    const Clearance there = margin_at(from + i / count * (to - from));
    if (there.height < clear_margin) return there;
  }
  return std::nullopt;
}

std::optional<Clearance> Surroundings::obstacle_leaving(const FrontJoints& from,
                                                        const FrontJoints& to) const {
  UnseenGround::Cells stands = UnseenGround::Cells::Constant(seen_.z.rows(), seen_.z.cols(), false);
  visit(from, fine_, infinity, [&](const Vector2d& place, double) {
    const auto cell = cell_at(seen_, place.x(), place.y());
    if (!cell) return;
    const Index row = std::max<Index>(0, cell->row - 1), col = std::max<Index>(0, cell->col - 1);
    stands.block(row, col, std::min<Index>(3, stands.rows() - row),
                 std::min<Index>(3, stands.cols() - col)) = true;
  });
  const auto height_of = [&](Index row, Index col) {
    const double z = seen_.z(row, col);
    return stands(row, col) || std::isnan(z) ? lowest_(row, col) : z;
  };
  const double deepest = std::min(clear_margin, standing(from).height) - slack;
  const double count = parts(from, to, fine_);
  bool clear = false;
  for (double i = 0.0; i <= count; ++i) {
    const FrontJoints at = from + i / count * (to - from);
    const Clearance there = margin_at(at);
    if (there.height >= clear_margin) {
      clear = true;
      continue;
    }
    if (clear) return there;
    const Clearance close = least(at, fine_, clear_margin, height_of);
    if (close.height < deepest) return close;
  }
  return std::nullopt;
}

void Surroundings::pass(const FrontJoints& from, const FrontJoints& to,
                        UnseenGround& unseen) const {
  if (!seen_.z.isNaN().any()) return;
  if (unseen.cells.size() == 0) {
    unseen.cells = UnseenGround::Cells::Constant(seen_.z.rows(), seen_.z.cols(), false);
  }
  const double count = parts(from, to, near_);
  for (double i = 0.0; i <= count; ++i) {
    const FrontJoints at = from + i / count * (to - from);
    visit(at, fine_, infinity, [&](const Vector2d& place, double) {
      const auto cell = cell_at(seen_, place.x(), place.y());
      if (!cell || !std::isnan(seen_.z(cell->row, cell->col))) return;
      bool& passed = unseen.cells(cell->row, cell->col);
      if (passed) return;
      passed = true;
      if (unseen.area == 0.0) unseen.first = place;
      unseen.area += seen_.cell_size * seen_.cell_size;
    });
  }
}

}  // namespace excavplan
