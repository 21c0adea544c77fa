// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/obstacle_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "base/angles.hpp"
#include "base/random.hpp"

namespace excavplan::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector3d turned(const Vector3d& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
}

/// First positive root of a t² + 2 b t + c.
double root(double a, double b, double c) {
  const double under = b * b - a * c;
  if (under < 0.0 || a == 0.0) return infinity;
  const double t = (-b - std::sqrt(under)) / a;
  return t > 0.0 ? t : infinity;
}

double box_hit(const Shape& box, const Vector3d& from, const Vector3d& direction) {
  const Vector3d o = turned(from - box.at, -box.turn) - Vector3d(0.0, 0.0, 0.5 * box.size.z());
  const Vector3d d = turned(direction, -box.turn);
  double first = 0.0, last = infinity;
  for (int i = 0; i < 3; ++i) {
    const double half = 0.5 * box.size[i];
    const double a = (-half - o[i]) / d[i], b = (half - o[i]) / d[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last && first > 0.0 ? first : infinity;
}

double post_hit(const Shape& post, const Vector3d& from, const Vector3d& direction) {
  const Vector3d o = from - post.at;
  const double r = post.size.x(), top = post.size.z();
  const double a = direction.head<2>().squaredNorm(), b = o.head<2>().dot(direction.head<2>());
  double best = infinity;
  const double t = root(a, b, o.head<2>().squaredNorm() - r * r);
  const double z = o.z() + t * direction.z();
  if (std::isfinite(t) && z >= 0.0 && z <= top) best = t;
  const double lid = (top - o.z()) / direction.z();
  if (lid > 0.0 && (o + lid * direction).head<2>().norm() <= r) best = std::min(best, lid);
  return best;
}

double cone_hit(const Shape& cone, const Vector3d& from, const Vector3d& direction) {
  const Vector3d o = from - cone.at;
  const double k = cone.size.x() / cone.size.z(), top = cone.size.z();  // radius = k (top - z)
  const double w = top - o.z(),
               a = direction.head<2>().squaredNorm() - k * k * direction.z() * direction.z();
  const double b = o.head<2>().dot(direction.head<2>()) + k * k * w * direction.z();
  const double c = o.head<2>().squaredNorm() - k * k * w * w;
  const double under = b * b - a * c;
  if (under < 0.0) return infinity;
  double best = infinity;
  for (const double sign : {-1.0, 1.0}) {
    const double t = (-b + sign * std::sqrt(under)) / a;
    const double z = o.z() + t * direction.z();
    if (t > 0.0 && z >= 0.0 && z <= top) best = std::min(best, t);
  }
  return best;
}

double wire_hit(const Shape& wire, const Vector3d& from, const Vector3d& direction) {
  const Vector3d along = (wire.to - wire.at).normalized();
  const Vector3d o = from - wire.at;
  const Vector3d d = direction - direction.dot(along) * along, p = o - o.dot(along) * along;
  const double t = root(d.squaredNorm(), p.dot(d), p.squaredNorm() - std::pow(wire.size.x(), 2));
  if (!std::isfinite(t)) return infinity;
  const double s = (o + t * direction).dot(along);
  return s >= 0.0 && s <= (wire.to - wire.at).norm() ? t : infinity;
}

Shape shape(Shape::Kind kind, std::string name, const Vector3d& at, const Vector3d& size,
            double turn = 0.0) {
  return {kind, std::move(name), at, size, turn, Vector3d::Zero()};
}

Shape wire(Random& random, const Vector3d& middle, double turn) {
  Shape wire = shape(Shape::Kind::wire, "wire", middle, {0.01, 0.0, 0.0});
  const double length = random.uniform(4.0, 20.0);
  const Vector3d half = 0.5 * length * Vector3d(std::cos(turn), std::sin(turn), 0.0);
  const double height = random.uniform(1.5, 6.0), slope = random.uniform(-0.05, 0.05);
  wire.at = middle - half + Vector3d(0.0, 0.0, height - slope * length);
  wire.to = middle + half + Vector3d(0.0, 0.0, height + slope * length);
  return wire;
}

std::vector<Shape> truck(Random& random, const Vector3d& at, double turn) {
  const double height = random.uniform(1.6, 2.8);
  const Vector3d size(random.uniform(4.0, 7.0), 2.5, height);
  const Vector3d cab = turned({0.5 * size.x() + 1.0, 0.0, 0.0}, turn);
  return {shape(Shape::Kind::box, "truck", at, size, turn),
          shape(Shape::Kind::box, "cab", at + cab, {1.9, 2.4, 3.0}, turn)};
}

std::vector<Shape> tree(Random& random, const Vector3d& at) {
  const double trunk = random.uniform(2.0, 3.5), crown = random.uniform(0.7, 1.4);
  const Vector3d up(0.0, 0.0, trunk + 0.6 * crown);
  return {shape(Shape::Kind::post, "trunk", at, {random.uniform(0.08, 0.2), 0.0, trunk}),
          shape(Shape::Kind::ball, "crown", at + up, {crown, 0.0, 0.0})};
}

std::vector<Shape> any_shapes(Random& random) {
  using Kind = Shape::Kind;
  const double angle = random.uniform(-pi, pi), away = random.uniform(2.4, 9.5);
  const Vector3d at(away * std::cos(angle), away * std::sin(angle), 0.0);
  const double turn = random.uniform(-pi, pi);
  const auto between = [&](double low, double high) { return random.uniform(low, high); };
  switch (random.index(9)) {
    case 0: {
      const Vector3d size{between(1.5, 8.0), between(0.1, 0.4), between(0.8, 3.8)};
      return {shape(Kind::box, "wall", at, size, turn)};
    }
    case 1:
      return {shape(Kind::post, "mast", at, {between(0.04, 0.2), 0.0, between(2.5, 8.0)})};
    case 2:
      return {wire(random, at, turn)};
    case 3:
      return truck(random, at, turn);
    case 4:
    case 5:
      return {shape(Kind::post, "person", at, {between(0.18, 0.27), 0.0, between(1.55, 1.95)})};
    case 6: {
      const double radius = between(0.7, 2.0);
      return {shape(Kind::cone, "heap", at, {radius, 0.0, radius * between(0.5, 0.75)})};
    }
    case 7:
      return tree(random, at);
    default: {
      const Vector3d size{between(0.3, 2.0), between(0.3, 2.0), between(0.6, 2.0)};
      return {shape(Kind::box, "box", at, size, turn)};
    }
  }
}

/// Of the machine that stands and faces the dig: tracks, upper structure, front and the strip of
/// the dig, which planned digs keep out of.
bool touches_machine(const Shape& shape) {
  for (double x = -2.4; x <= 8.0; x += 0.1) {
    const double half = x < 2.2 ? 1.5 : 0.6;
    for (double y = -half; y <= half; y += 0.1) {
      for (double z = 0.0; z <= 5.5; z += 0.25) {
        if (shape.distance({x, y, z}) < 0.2) return true;
      }
    }
  }
  return false;
}

/// A link as a box: from one pin to the next, so far below and above the line of the pins.
void add_link(const Vector3d& from, const Vector3d& to, double below, double above, double half,
              const Vector3d& aside, std::vector<Vector3d>& points) {
  constexpr double apart = 0.12;
  const Vector3d along = (to - from).normalized(), up = aside.cross(along) * -1.0;
  const double steps = std::ceil((to - from).norm() / apart);
  for (double i = 0.0; i <= steps; ++i) {
    const Vector3d on = from + i / steps * (to - from);
    for (const double y : {-half, 0.0, half}) {
      for (const double z : {-below, above}) points.push_back(on + y * aside + z * up);
    }
  }
}

}  // namespace

double Shape::distance(const Vector3d& place) const {
  const Vector3d p = place - at;
  switch (kind) {
    case Kind::box: {
      const Vector3d q = turned(p, -turn) - Vector3d(0.0, 0.0, 0.5 * size.z());
      const Vector3d off = q.cwiseAbs() - 0.5 * size;
      return off.cwiseMax(0.0).norm() + std::min(0.0, off.maxCoeff());
    }
    case Kind::post: {
      const Vector2d off(p.head<2>().norm() - size.x(),
                         std::abs(p.z() - 0.5 * size.z()) - 0.5 * size.z());
      return off.cwiseMax(0.0).norm() + std::min(0.0, off.maxCoeff());
    }
    case Kind::ball:
      return p.norm() - size.x();
    case Kind::cone: {
      const double slant = std::hypot(size.x(), size.z());
      const double above = p.z() - size.z() * (1.0 - p.head<2>().norm() / size.x());
      return std::max(above * size.x() / slant, -p.z());
    }
    case Kind::wire: {
      const Vector3d along = to - at;
      const double s = std::clamp(p.dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (p - s * along).norm() - size.x();
    }
  }
  return infinity;
}

double Shape::hit(const Vector3d& from, const Vector3d& direction) const {
  switch (kind) {
    case Kind::box:
      return box_hit(*this, from, direction);
    case Kind::post:
      return post_hit(*this, from, direction);
    case Kind::ball:
      return root(1.0, (from - at).dot(direction), (from - at).squaredNorm() - size.x() * size.x());
    case Kind::cone:
      return cone_hit(*this, from, direction);
    case Kind::wire:
      return wire_hit(*this, from, direction);
  }
  return infinity;
}

ObstacleScene any_scene(std::uint64_t number) {
  Random random(31, number);
  ObstacleScene scene;
  const std::uint64_t count = random.index(5);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::vector<Shape> more;
    do {
      more = any_shapes(random);
    } while (std::any_of(more.begin(), more.end(), touches_machine));
    scene.shapes.insert(scene.shapes.end(), more.begin(), more.end());
  }
  if (random.uniform() < 0.15) {
    scene.edge = random.uniform(3.0, 8.0);
    scene.drop = random.uniform(0.5, 2.5);
  }
  return scene;
}

std::vector<RaySensor> any_sensors(std::uint64_t number) {
  Random random(32, number);
  const std::uint64_t count = 1 + random.index(3);
  std::vector<RaySensor> sensors;
  for (std::uint64_t i = 0; i < count; ++i) {
    RaySensor sensor;
    sensor.step = random.uniform(0.003, 0.008);
    sensor.row = random.uniform(0.004, 0.014);
    const double angle = random.uniform(-pi, pi), away = random.uniform(6.0, 13.0);
    sensor.at = {away * std::cos(angle), away * std::sin(angle), random.uniform(2.5, 8.0)};
    if (i == 0) sensor.at = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 3.2};
    sensors.push_back(sensor);
  }
  return sensors;
}

Scan RayScan::scan() const {
  Scan scan;
  scan.clouds = {cloud};
  scan.z_is_up = true;
  return scan;
}

RayScan ray_scan(const ObstacleScene& scene, const std::vector<RaySensor>& sensors,
                 std::uint64_t number) {
  constexpr double furthest = 25.0, noise = 0.01, lowest = -1.3, highest = 0.6;
  Random random(33, number);
  RayScan seen;
  seen.hits.assign(scene.shapes.size(), 0);
  for (const RaySensor& sensor : sensors) {
    for (double up = lowest; up < highest; up += sensor.row) {
      for (double around = -pi; around < pi; around += sensor.step) {
        const Vector3d direction(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around),
                                 std::sin(up));
        double nearest = infinity;
        int shape = -1;
        for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
          const double t = scene.shapes[i].hit(sensor.at, direction);
          if (t < nearest) nearest = t, shape = static_cast<int>(i);
        }
        for (const double z : {0.0, -scene.drop}) {  // the face of the edge is left out
          const double t = (z - sensor.at.z()) / direction.z();
          const Vector3d at = sensor.at + t * direction;
          const bool is_ground = t > 0.0 && t < nearest && scene.ground(at.x(), at.y()) == z;
          if (is_ground) nearest = t, shape = -1;
        }
        if (!(nearest < furthest)) continue;
        if (shape >= 0) ++seen.hits[static_cast<std::size_t>(shape)];
        seen.cloud->points.push_back(sensor.at + (nearest + noise * random.normal()) * direction);
      }
    }
  }
  seen.cloud->width = seen.cloud->points.size();
  return seen;
}

std::vector<Vector3d> machine_points(const Machine& machine, const TrajectoryPoint& at) {
  const double swing = at.swing.angle;
  const Vector3d ahead(std::cos(swing), std::sin(swing), 0.0), up = Vector3d::UnitZ();
  const Vector3d aside(-std::sin(swing), std::cos(swing), 0.0);
  double angle = 0.0;
  Vector3d pin = machine.boom_pin.x() * ahead + machine.boom_pin.y() * up;
  std::vector<Vector3d> points;
  const auto go = [&](double turn, double length) {
    angle -= turn;
    return Vector3d(pin + length * (std::cos(angle) * ahead + std::sin(angle) * up));
  };
  const Vector3d arm = go(at.joints[0], machine.boom_length);
  add_link(pin, arm, 0.0, 0.4, 0.25, aside, points);
  pin = arm;
  const Vector3d hand = go(at.joints[1], machine.arm_length);
  add_link(pin, hand, 0.0, 0.3, 0.2, aside, points);
  pin = hand;
  const Vector3d tip = go(at.joints[2], 1.0);
  const Vector3d along = tip - pin, across = -aside.cross(along);
  const auto& profile = machine.bucket.profile;
  const auto corner = [&](std::size_t i) {
    const Vector2d& p = profile[i % profile.size()];
    return Vector3d(pin + p.x() * along + p.y() * across);
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    for (double share = 0.0; share < 1.0; share += 0.2) {
      const Vector3d on = corner(i) + share * (corner(i + 1) - corner(i));
      for (const double y : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
        points.push_back(on + y * machine.bucket.width_outside * aside);
      }
    }
  }
  constexpr double tail = 2.13, half = 1.25, front = 1.2;  // upper structure of the zx120 [m]
  for (double y = -half; y <= half + 1e-9; y += 0.125) {
    const double rear = std::sqrt(tail * tail - y * y);
    for (const double x : {-rear, -0.5 * rear, 0.0, front}) {
      for (const double z : {1.0, 1.7, 2.4}) points.push_back(x * ahead + y * aside + z * up);
    }
  }
  return points;
}

std::vector<double> nearest(const Machine& machine, const Trajectory& motion,
                            const ObstacleScene& scene, bool as_columns) {
  std::vector<double> least(scene.shapes.size(), infinity);
  for (std::size_t i = 0; i < motion.points.size(); i += 5) {
    for (const Vector3d& p : machine_points(machine, motion.points[i])) {
      for (std::size_t k = 0; k < scene.shapes.size(); ++k) {
        const Shape& shape = scene.shapes[k];
        double away = shape.distance(p);
        if (as_columns && shape.hangs()) {
          Shape flat = shape;
          flat.at.z() = flat.to.z() = p.z();
          const double highest =
              shape.kind == Shape::Kind::ball ? shape.at.z() : std::max(shape.at.z(), shape.to.z());
          if (p.z() < highest) away = flat.distance(p);
        }
        least[k] = std::min(least[k], away);
      }
    }
  }
  return least;
}

double seen_share(const Machine& machine, const Trajectory& motion, const Cloud& cloud) {
  constexpr double cell = 0.1;
  const auto key = [](double x, double y) {
    return std::pair(std::lround(x / cell), std::lround(y / cell));
  };
  std::set<std::pair<long, long>> seen, passed;
  for (const Vector3d& p : cloud.points) {
    if (p.head<2>().norm() > 12.0) continue;
    for (int i = -2; i <= 2; ++i) {
      for (int k = -2; k <= 2; ++k) seen.insert(key(p.x() + cell * i, p.y() + cell * k));
    }
  }
  for (std::size_t i = 0; i < motion.points.size(); i += 10) {
    for (const Vector3d& p : machine_points(machine, motion.points[i])) {
      if (p.head<2>().norm() > 2.3) passed.insert(key(p.x(), p.y()));
    }
  }
  const auto known = std::count_if(passed.begin(), passed.end(),
                                   [&](const auto& each) { return seen.count(each) > 0; });
  return static_cast<double>(known) / static_cast<double>(passed.size());
}

}  // namespace excavplan::test
