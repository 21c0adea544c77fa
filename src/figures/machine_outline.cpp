// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/machine_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angles.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// A point so far along a line of this direction and so far to its left.
Vector2d beside(const Vector2d& from, double angle, double along, double across) {
  return from + along * direction(angle) + across * Vector2d(-std::sin(angle), std::cos(angle));
}

Vector2d pin_at(const Vector2d& joint, double angle, const PolarPin& pin) {
  return joint + pin.distance * direction(angle + pin.angle);
}

/// Bent upwards where its centre of mass lies, thickest there.
Points boom_outline(const Machine& machine, const LinkPositions& at) {
  const double length = machine.boom_length;
  const LinkMass& mass = machine.links[0];
  const double along = std::clamp(mass.along, 0.3 * length, 0.6 * length);
  const double bend = std::clamp(1.7 * mass.across, 0.0, 0.25 * length);
  const auto point = [&](double x, double z) { return beside(machine.boom_pin, at.phi1, x, z); };
  const double thin = 0.035 * length;
  const double thick = 0.055 * length;
  return {point(-thin, 0.0),
          point(0.0, thin),
          point(along - 0.11 * length, bend + 0.5 * thick),
          point(along + 0.11 * length, bend + 0.7 * thick),
          point(length, thin),
          point(length + thin, 0.0),
          point(length, -thin),
          point(along + 0.07 * length, bend - 1.2 * thick),
          point(along - 0.07 * length, bend - 1.4 * thick),
          point(0.0, -thin)};
}

/// Of an edge whose x grows, between its corners.
double height_on(const Points& edge, double x) {
  std::size_t next = 1;
  while (next + 1 < edge.size() && edge[next].x() < x) ++next;
  const Vector2d& a = edge[next - 1];
  const Vector2d& b = edge[next];
  return a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x());
}

/// The edge with a lug that holds a pin above it; half as wide at its top as at its foot.
Points with_lug(const Points& edge, const Vector2d& pin, double half) {
  const double left = std::max(pin.x() - half, edge.front().x());
  const double right = std::min(pin.x() + half, edge.back().x());
  if (left >= right || pin.y() < height_on(edge, pin.x())) return edge;
  Points found;
  for (const Vector2d& corner : edge) {
    if (corner.x() <= left) found.push_back(corner);
  }
  found.emplace_back(left, height_on(edge, left));
  found.emplace_back(pin.x() - 0.5 * half, pin.y() + 0.4 * half);
  found.emplace_back(pin.x() + 0.5 * half, pin.y() + 0.4 * half);
  found.emplace_back(right, height_on(edge, right));
  for (const Vector2d& corner : edge) {
    if (corner.x() >= right) found.push_back(corner);
  }
  return found;
}

/// With a tail that its cylinder pushes, and a lug for the cylinder of the bucket.
Points arm_outline(const Machine& machine, const LinkPositions& at) {
  const double length = machine.arm_length;
  const auto point = [&](double x, double z) { return beside(at.arm_pin, at.phi2, x, z); };
  double tail = 0.2 * length;
  double lift = 0.1 * length;
  if (machine.cylinders) {
    if (const auto* rod = std::get_if<PolarPin>(&(*machine.cylinders)[1].geometry().rod)) {
      tail = -rod->distance * std::cos(rod->angle);
      lift = rod->distance * std::sin(rod->angle);
    }
  }
  const double thin = 0.04 * length;
  Points edge = {{-tail, lift + thin}, {0.15 * length, 0.16 * length}, {length, thin}};
  if (machine.cylinders) {
    const PolarPin& foot = (*machine.cylinders)[2].geometry().foot;
    edge = with_lug(edge, Vector2d(length, 0.0) + pin_at({0.0, 0.0}, 0.0, foot), 1.5 * thin);
  }
  Points outline = {point(-tail - thin, lift)};
  for (const Vector2d& corner : edge) outline.push_back(point(corner.x(), corner.y()));
  for (const Vector2d& corner : Points{{length + thin, 0.0},
                                       {length, -thin},
                                       {0.1 * length, -0.05 * length},
                                       {-0.3 * thin, -1.2 * thin},
                                       {-tail, lift - thin}}) {
    outline.push_back(point(corner.x(), corner.y()));
  }
  return outline;
}

/// Where two bars that turn about a and b meet, on the left of the way from a to b or the right.
std::optional<Vector2d> meeting(const Vector2d& a, double from_a, const Vector2d& b, double from_b,
                                double side) {
  const Vector2d way = b - a;
  const double distance = way.norm();
  const double along = (distance * distance + from_a * from_a - from_b * from_b) / (2.0 * distance);
  const double across = from_a * from_a - along * along;
  if (!(distance > 0.0) || across < 0.0) return std::nullopt;
  const Vector2d unit = way / distance;
  return Vector2d(a + along * unit + side * std::sqrt(across) * Vector2d(-unit.y(), unit.x()));
}

/// Rod, rocker and link of a four-bar; the rod's end is where rocker and link meet too.
/// @param length  of the rod, from its `foot` @param rocker, link  their pins
std::vector<Points> four_bar(const FourBar& bars, const Vector2d& foot, double length,
                             const Vector2d& rocker, const Vector2d& link) {
  std::optional<Vector2d> best;
  double least = 0.0;
  for (const double side : {-1.0, 1.0}) {
    const auto end = meeting(rocker, bars.rocker.length, link, bars.link.length, side);
    if (!end) continue;
    const double error = std::abs((*end - foot).norm() - length);
    if (best && error >= least) continue;
    best = end;
    least = error;
  }
  if (!best) return {};
  return {{foot, *best}, {rocker, *best}, {*best, link}};
}

std::vector<Points> cylinder_lines(const Machine& machine, const LinkPositions& at,
                                   const JointAngles& joints) {
  if (!machine.cylinders) return {};
  const std::array<Vector2d, 3> joint = {machine.boom_pin, at.arm_pin, at.bucket_pin};
  const std::array<double, 4> directions = {0.0, at.phi1, at.phi2, at.phi3};
  std::vector<Points> lines;
  for (std::size_t i = 0; i < 3; ++i) {
    const Cylinder& cylinder = (*machine.cylinders)[i];
    const Vector2d foot = pin_at(joint[i], directions[i], cylinder.geometry().foot);
    if (const auto* rod = std::get_if<PolarPin>(&cylinder.geometry().rod)) {
      lines.push_back({foot, pin_at(joint[i], directions[i + 1], *rod)});
      continue;
    }
    const double length = cylinder.at(joints[static_cast<int>(i)]).length;
    const auto& bars = std::get<FourBar>(cylinder.geometry().rod);
    const Vector2d rocker = pin_at(joint[i], directions[i], bars.rocker.pin);
    const Vector2d link = pin_at(joint[i], directions[i + 1], bars.link.pin);
    for (Points& line : four_bar(bars, foot, length, rocker, link))
      lines.push_back(std::move(line));
  }
  return lines;
}

/// From the bucket's pin over that of its link to the wall that is nearest to this, and along the
/// wall to its top edge.
Points bracket_outline(const Machine& machine, const LinkPositions& at, const Points& wall) {
  if (!machine.cylinders || wall.empty()) return {};
  const auto* bars = std::get_if<FourBar>(&(*machine.cylinders)[2].geometry().rod);
  if (bars == nullptr) return {};
  const Vector2d link = pin_at(at.bucket_pin, at.phi3, bars->link.pin);
  Points bracket = {at.bucket_pin, link};
  const auto nearest =
      std::min_element(wall.begin(), wall.end(), [&](const auto& a, const auto& b) {
        return (a - link).squaredNorm() < (b - link).squaredNorm();
      });
  bracket.insert(bracket.end(), nearest, wall.end());
  return bracket;
}

/// Tracks on the ground, house and cab above them, by the height of the boom pin.
void add_body(const Machine& machine, MachineOutline& outline) {
  const double front = machine.track_front;
  const double pin = std::max(machine.boom_pin.y(), 0.3 * front);
  const double rear = machine.body ? std::min(machine.body->rear_edge - 0.2, -0.8 * front) : -front;
  const double top = 0.52 * pin;
  const double bend = 0.5 * top;
  constexpr int steps = 8;
  const auto end = [&](double x, double sense) {
    for (int i = 0; i <= steps; ++i) {
      const double angle = pi * (i / static_cast<double>(steps) - 0.5);
      outline.tracks.emplace_back(x + sense * bend * std::cos(angle),
                                  bend + sense * bend * std::sin(angle));
    }
  };
  end(front - bend, 1.0);
  end(rear + bend, -1.0);
  const double tail = -1.25 * front;
  const double nose = machine.boom_pin.x() + 0.25 * pin;
  const double floor = 0.62 * pin;
  const double deck = 1.28 * pin;
  outline.house = {{tail, floor + 0.1 * pin}, {tail + 0.1 * pin, floor}, {nose, floor},
                   {nose, 0.95 * pin},        {nose - 0.5 * pin, deck},  {tail + 0.15 * pin, deck},
                   {tail, deck - 0.15 * pin}};
  outline.turntable = {
      {-0.5 * pin, 0.9 * top}, {0.5 * pin, 0.9 * top}, {0.4 * pin, floor}, {-0.4 * pin, floor}};
  const double cab_front = nose + 0.45 * pin;
  outline.cab = {{nose - 0.75 * pin, floor + 0.05 * pin},
                 {cab_front, floor + 0.05 * pin},
                 {cab_front, 1.1 * pin},
                 {cab_front - 0.3 * pin, 1.95 * pin},
                 {nose - 0.65 * pin, 1.95 * pin},
                 {nose - 0.75 * pin, 1.85 * pin}};
}

// ---- Soil in the bucket, in its frame ---------------------------------------------------------

double area_of(const Points& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (p.x() * q.y() - q.x() * p.y());
  }
  return std::abs(sum);
}

/// The mouth of a bucket: from the top edge to the tip.
struct Mouth {
  Vector2d first, last, normal;  ///< tip, top edge, inwards
  explicit Mouth(const Points& profile) : first(profile.front()), last(profile.back()) {
    const Vector2d along = (last - first).normalized();
    normal = {-along.y(), along.x()};
    const auto inside = [&](const Vector2d& p) { return (p - first).dot(normal) > 1e-6; };
    if (std::none_of(profile.begin(), profile.end(), inside)) normal = -normal;
  }
  double depth(const Vector2d& p) const { return (p - first).dot(normal); }
};

/// The part of a profile at least so deep below its mouth.
Points below(const Points& profile, const Mouth& mouth, double level) {
  Points cut;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vector2d& p = profile[i];
    const Vector2d& q = profile[(i + 1) % profile.size()];
    const double a = mouth.depth(p) - level;
    const double b = mouth.depth(q) - level;
    if (a >= 0.0) cut.push_back(p);
    if (a * b < 0.0) cut.emplace_back(p + (q - p) * (a / (a - b)));
  }
  return cut;
}

Points heaped(Points profile, const Mouth& mouth, double excess) {
  const double length = (mouth.last - mouth.first).norm();
  const double height = std::min(2.0 * excess / length, 0.5 * length);
  for (const double share : {0.35, 0.65}) {
    profile.emplace_back(mouth.last + share * (mouth.first - mouth.last) -
                         0.75 * height * mouth.normal);
  }
  return profile;
}

Points filled(const Points& profile, double area) {
  const Mouth mouth(profile);
  const double struck = area_of(profile);
  if (area >= struck) return heaped(profile, mouth, area - struck);
  double low = 0.0;
  double high = 0.0;
  for (const Vector2d& p : profile) high = std::max(high, mouth.depth(p));
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (area_of(below(profile, mouth, middle)) > area ? low : high) = middle;
  }
  return below(profile, mouth, low);
}

Points placed(const Machine& machine, const JointAngles& joints, const Points& in_bucket) {
  const LinkPositions links = link_positions(machine, joints);
  Points points;
  for (const Vector2d& corner : in_bucket) points.push_back(bucket_point(links, corner));
  return points;
}

}  // namespace

MachineOutline machine_outline(const Machine& machine, const JointAngles& joints) {
  const LinkPositions at = link_positions(machine, joints);
  MachineOutline outline;
  add_body(machine, outline);
  outline.boom = boom_outline(machine, at);
  outline.arm = arm_outline(machine, at);
  outline.cylinders = cylinder_lines(machine, at, joints);
  outline.bucket = bucket_outline(machine, joints);
  outline.bracket = bracket_outline(machine, at, outline.bucket);
  outline.pins = {machine.boom_pin, at.arm_pin, at.bucket_pin};
  if (!outline.bracket.empty()) outline.pins.push_back(outline.bracket[1]);
  if (outline.cylinders.size() > 2) {
    outline.pins.insert(outline.pins.end(), outline.cylinders[2].begin(),
                        outline.cylinders[2].end());
  }
  return outline;
}

Points bucket_outline(const Machine& machine, const JointAngles& joints) {
  return placed(machine, joints, machine.bucket.profile);
}

Points soil_in_bucket(const Machine& machine, const JointAngles& joints, double volume) {
  constexpr double least = 1e-4;  // [m^2]
  const double area = volume / machine.bucket.width_inside;
  if (!(area > least) || machine.bucket.profile.size() < 3) return {};
  return placed(machine, joints, filled(machine.bucket.profile, area));
}

}  // namespace excavplan
