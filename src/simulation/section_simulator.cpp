// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/section_simulator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/earthmoving.hpp>

#include "base/angles.hpp"
#include "simulation/dig_account.hpp"
#include "simulation/soil_section.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double degree = pi / 180.0;

constexpr double cone_half_angle = 15.0 * degree;  // of the standard cone (ASAE S313)
constexpr double bearing_settlement = 0.1;  // of its width, at which a footing bears all; ours

// ---- What the bucket holds ----------------------------------------------------------------------

using Polygon = std::vector<Vector2d>;

void clip(Polygon& polygon, const Below& side, Polygon& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = side.at(p.x()) - p.y();
    const double at_q = side.at(q.x()) - q.y();
    if (at_p >= 0.0) scratch.push_back(p);
    if ((at_p < 0.0) != (at_q < 0.0)) scratch.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  polygon.swap(scratch);
}

struct AreaCentre {
  double area = 0.0;
  Vector2d centre = Vector2d::Zero();
};

AreaCentre area_centre(const Polygon& polygon) {
  AreaCentre result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double cross = p.x() * q.y() - p.y() * q.x();
    result.area += 0.5 * cross;
    result.centre += cross / 6.0 * (p + q);
  }
  if (result.area > 0.0) result.centre /= result.area;
  return result;
}

/// Volume over a stretch of mouth on which the soil's face stands `from` .. `to` above it,
/// linearly, between side plates from which it may only rise at `slope`.
double heap_over_mouth(double length, double from, double to, double width, double slope) {
  const double full = 0.5 * width * slope;  // the slopes of both plates meet here
  const auto integral = [&](double height) {
    const double low = std::clamp(height, 0.0, full);
    const double high = std::max(0.0, height - full);
    return low * low * (0.5 * width - low / (3.0 * slope)) + high * 0.5 * width * full;
  };
  if (std::abs(to - from) < 1e-12) return 0.0;
  return length * (integral(to) - integral(from)) / (to - from);
}

/// The bucket in one attitude, relative to the tip.
class BucketSection {
 public:
  explicit BucketSection(const Bucket& bucket) : bucket_(bucket) {}

  void turn_to(double phi3) {
    const double c = std::cos(phi3);
    const double s = std::sin(phi3);
    corners_.clear();
    for (const Vector2d& corner : bucket_.profile) {
      const Vector2d p = corner - bucket_.profile.front();
      corners_.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    }
  }

  /// Volume held, and the centre of the part between the side plates.
  AreaCentre held(double support, const HoldingSlopes& slopes) {
    const Vector2d top = corners_.back();
    const Below face = {support, slopes.face};
    const Below rear = {top.y() + slopes.heap * top.x(), -slopes.heap};
    polygon_ = corners_;
    clip(polygon_, face, scratch_);
    // Soil runs over the top edge only where that is lower than the lip by more than the slope.
    if (top.x() > 0.0 && rear.height < 0.0) clip(polygon_, rear, scratch_);
    AreaCentre result = area_centre(polygon_);
    result.area *= bucket_.width_inside;
    if (top.x() > 0.0) result.area += heaped(top, face, rear, slopes.heap);
    return result;
  }

  const Vector2d& corner(std::size_t i) const { return corners_[i]; }

  /// The part of the side plates below a line of this height and slope.
  AreaCentre buried(const Below& ground) {
    polygon_ = corners_;
    clip(polygon_, ground, scratch_);
    return area_centre(polygon_);
  }

 private:
  double heaped(const Vector2d& top, const Below& face, const Below& rear, double slope) const {
    const Below mouth = {0.0, top.y() / top.x()};
    const auto above = [&](double x) {
      return std::min(face.height + face.slope * x, rear.height + rear.slope * x) - mouth.slope * x;
    };
    const double crossing = (rear.height - face.height) / (face.slope - rear.slope);
    const double peak = std::clamp(crossing, 0.0, top.x());
    const double width = bucket_.width_inside;
    return heap_over_mouth(peak, above(0.0), above(peak), width, slope) +
           heap_over_mouth(top.x() - peak, above(peak), above(top.x()), width, slope);
  }

  const Bucket& bucket_;
  Polygon corners_;
  Polygon polygon_;
  Polygon scratch_;
};

/// Where the front of the soil stands that has packed into the corner of floor and back: the angle
/// at the lip from the floor to it, by the volume behind it.
class PackedFront {
 public:
  explicit PackedFront(const Bucket& bucket) {
    const auto direction = [&](std::size_t i) {
      const Vector2d side = bucket.profile[i] - bucket.profile[0];
      return std::atan2(side.y(), side.x());
    };
    const double floor = direction(1);
    mouth_ = std::remainder(direction(bucket.profile.size() - 1) - floor, 2.0 * pi);
    BucketSection section(bucket);
    for (int i = 0; i <= steps; ++i) {
      section.turn_to(-floor - mouth_ * i / steps);  // the front is level
      volume_.push_back(section.buried({}).area * bucket.width_inside);
    }
  }

  double angle(double volume) const {
    const auto above = std::upper_bound(volume_.begin(), volume_.end(), volume);
    if (above == volume_.begin()) return 0.0;
    if (above == volume_.end()) return mouth_;
    const double below = *(above - 1);
    const auto whole = static_cast<double>(above - 1 - volume_.begin());
    return mouth_ * (whole + (volume - below) / (*above - below)) / steps;
  }

 private:
  static constexpr int steps = 64;
  double mouth_ = 0.0;
  std::vector<double> volume_;
};

// ---- Resistance ---------------------------------------------------------------------------------

}  // namespace

/// What is known before any ground is seen.
struct SectionModel {
  SectionModel(const Machine& machine_, const SoilKind& kind_, double density_percent_)
      : machine(machine_),
        kind(kind_),
        density_percent(density_percent_),
        bank(bank_state(kind, density_percent)),
        loose(loose_state(kind)),
        packed(machine.bucket),
        on_steel_(bank.friction_angle, bank.tool_friction_angle),
        on_soil_(bank.friction_angle, bank.friction_angle) {
    // Dug soil keeps the cohesion that moist soil has when it is as loose.
    const SoilState dug =
        bank_state_of_void_ratio(kind, std::min(kind.void_ratio_loose, kind.void_ratio_max));
    const double mouth = (machine.bucket.profile.back() - machine.bucket.profile.front()).norm();
    slopes.heap = std::tan(kind.angle_of_repose);
    slopes.face = std::tan(stable_slope(dug, mouth, kind.angle_of_repose));
  }

  /// Factors of a wedge that slides on steel, or on soil as strong as itself.
  EarthmovingFactors factors(double rake, double slope, const SoilState& soil, bool on_soil) const {
    if (soil.friction_angle == bank.friction_angle) {
      return (on_soil ? on_soil_ : on_steel_).at(rake, slope);
    }
    std::call_once(uneven_made_, [&] {
      const double densest = kind.friction_loosest + kind.friction_gain;
      const auto [low, high] = std::minmax(kind.friction_loosest, densest);
      uneven_on_steel_.emplace(low, high, kind.tool_friction_ratio);
      uneven_on_soil_.emplace(low, high, 1.0);
    });
    return (on_soil ? *uneven_on_soil_ : *uneven_on_steel_).at(rake, slope, soil.friction_angle);
  }

  Machine machine;
  SoilKind kind;
  double density_percent;
  SoilState bank;
  SoilState loose;
  HoldingSlopes slopes;
  PackedFront packed;

 private:
  CriticalWedges on_steel_;
  CriticalWedges on_soil_;
  mutable std::once_flag uneven_made_;  ///< tables for ground that is not equally dense everywhere
  mutable std::optional<FrictionWedges> uneven_on_steel_;
  mutable std::optional<FrictionWedges> uneven_on_soil_;
};

namespace {

/// The soil's forces on the bucket, (x, z): in the face, at the tip and under the heel [N].
struct Resistance {
  Vector2d face = Vector2d::Zero();
  Vector2d face_at = Vector2d::Zero();
  Vector2d tip = Vector2d::Zero();
  Vector2d tip_at = Vector2d::Zero();
  Vector2d heel = Vector2d::Zero();
  Vector2d heel_at = Vector2d::Zero();
  double on_floor = 0.0;  ///< volume of payload whose weight is in the force already [m^3]

  Vector2d total() const { return face + tip + heel; }
};

/// One attitude of the bucket in the ground, half-way of a step.
struct Cutting {
  BucketPose tip;
  Vector2d motion = Vector2d::Zero();  ///< unit vector
  GroundAhead ground;
  SoilState bank;
  double pile = 0.0;      ///< height of the pile at the lip [m]
  double contents = 0.0;  ///< of the bucket, loose [m^3]
};

/// What a wedge of soil slides up on: the floor, or the front of the soil packed on it.
struct SlidingFace {
  double angle = 0.0;  ///< above the horizontal [rad]
  bool on_soil = false;
};

class SoilResistance {
 public:
  SoilResistance(const SectionModel& model, const SoilSection& section)
      : model_(model), bucket_(model.machine.bucket), section_(section) {
    floor_length_ = (bucket_.profile[1] - bucket_.profile[0]).norm();
  }

  /// `bucket` is turned as it stands.
  Resistance at(const Cutting& cut, BucketSection& bucket, DigPhase phase) const {
    Resistance result;
    result.face_at = result.tip_at = {cut.tip.x, cut.tip.z};
    if (phase == DigPhase::penetrate) {
      drive_in(cut, bucket, result);
    } else {
      shear(cut, bucket, result);
    }
    press_heel(cut, bucket, result);
    return result;
  }

 private:
  struct Face {
    double along = 0.0;  ///< force against the travel, along the frame [N]
    double down = 0.0;   ///< into the ground [N]
    double rake = 0.0;
    double surcharge = 0.0;  ///< [Pa]
    double on_floor = 0.0;   ///< [m^3]
  };

  /// What a wedge ahead of the face meets.
  struct Ahead {
    SoilState soil;
    double depth = 0.0;  ///< across the surface [m]
    double slope = 0.0;
    double loose = 0.0;  ///< height of the loose soil on it at the face [m]
  };

  /// The floor runs along itself: cone index on lip and teeth, friction on floor and side plates.
  void drive_in(const Cutting& cut, BucketSection& bucket, Resistance& result) const {
    const Below ground = {cut.ground.surface - cut.tip.z, cut.ground.gradient};
    const double depth = ground.height;
    if (!(depth > 0.0)) return;
    const SoilState soil = cut.ground.bank > cut.tip.z ? cut.bank : in_loose(cut.bank);
    const double sine = std::sin(cut.tip.floor_angle);
    const double cosine = std::cos(cut.tip.floor_angle);
    const double driven = depth / std::max(1e-3, sine - ground.slope * cosine);
    const double floor = std::min(floor_length_, driven) * bucket_.width_outside;
    const AreaCentre plate = bucket.buried(ground);
    const double force = cone_index(model_.kind, soil, depth) * penetrating(soil, driven) +
                         2.0 * friction(soil, 0.5 * depth) * floor +
                         4.0 * friction(soil, depth - plate.centre.y()) * plate.area;
    result.tip = -force * cut.motion;
  }

  /// A wedge of soil slides up ahead of the face that makes it easier.
  void shear(const Cutting& cut, BucketSection& bucket, Resistance& result) const {
    const double alpha = -std::atan(cut.ground.gradient);  // positive uphill
    const double bank_depth = (cut.ground.bank - cut.tip.z) * std::cos(alpha);
    const double loose_above = cut.ground.surface - cut.ground.bank + cut.pile;
    const double all_depth = bank_depth + loose_above * std::cos(alpha);
    if (!(all_depth > 0.0)) return;
    const Ahead ahead = bank_depth > 0.0 ? Ahead{cut.bank, bank_depth, alpha, loose_above}
                                         : Ahead{in_loose(cut.bank), all_depth, alpha, 0.0};
    const double climb = std::asin(std::clamp(cut.motion.y(), -1.0, 1.0));
    const double frame = std::max(alpha, climb);
    SlidingFace on = {cut.tip.floor_angle, false};
    Face face = pushed(ahead, on, frame);
    const double front = cut.tip.floor_angle + model_.packed.angle(cut.contents);
    if (const Face other = pushed(ahead, {front, true}, frame);
        cut.contents > 0.0 && other.along < face.along) {
      on = {front, true};
      face = other;
    }
    const double fade = climb > 0.0 ? std::cos(climb) : 1.0;
    const Vector2d along(std::cos(frame), -std::sin(frame));
    const Vector2d normal(std::sin(frame), std::cos(frame));
    result.face = fade * (face.along * along - face.down * normal);
    result.face.y() -= (1.0 - fade) * sheared_off(ahead.soil, ahead.depth, face.surcharge);
    result.face -= side_friction(cut, bucket) * cut.motion;
    const double descent = std::max(0.0, -cut.motion.y());
    result.tip = -lip(ahead.soil, ahead.depth, face.surcharge, descent) * cut.motion;
    const double up_face = std::min(ahead.depth / 3.0, floor_length_ * std::sin(face.rake));
    result.face_at +=
        up_face / std::sin(face.rake) * Vector2d(std::cos(on.angle), std::sin(on.angle));
    result.on_floor = fade * face.on_floor;
  }

  /// Loose soil ahead, as strong as it gets against the face: it has the bank's friction.
  SoilState in_loose(const SoilState& bank) const {
    SoilState soil = model_.loose;
    soil.friction_angle = bank.friction_angle;
    soil.tool_friction_angle = bank.tool_friction_angle;
    return soil;
  }

  Face pushed(const Ahead& ahead, const SlidingFace& on, double frame) const {
    const SoilState& soil = ahead.soil;
    const double width = bucket_.width_outside;
    const double delta = on.on_soil ? soil.friction_angle : soil.tool_friction_angle;
    const double stuck = on.on_soil ? soil.cohesion : soil.adhesion;
    const double rake =
        held_rake(std::max(on.angle + frame, bucket_.edge_angle), soil.friction_angle + delta);
    const EarthmovingFactors n = model_.factors(rake, ahead.slope, soil, on.on_soil);
    const CuttingWedge wedge = {rake, soil.friction_angle, delta, ahead.slope};
    Face face;
    face.rake = rake;
    const double t = ahead.depth;
    const double pile = mean_over(ahead.loose, t, wedge, n);
    face.surcharge = model_.loose.unit_weight * pile;
    const double flat = soil.unit_weight * t * t * n.gamma + soil.cohesion * t * n.c +
                        face.surcharge * (t * n.q + pile * n.gamma) + stuck * t * n.ca;
    const SoilStrength strength = {soil.unit_weight, soil.cohesion, soil.adhesion};
    const double force = flat * width + side_plane_force(wedge, n, strength, t) *
                                            std::max(0.0, side_plane_share(wedge, n));
    const double adhesion = stuck * t * width;
    const double cot_rake = 1.0 / std::tan(rake);
    face.along = force * std::sin(rake + delta) + adhesion * cot_rake;
    face.down = force * std::cos(rake + delta) - adhesion;
    const double on_face = 0.5 * t * std::min(t * cot_rake, floor_length_);
    face.on_floor = std::max(0.0, on_face) * width * soil.unit_weight / model_.loose.unit_weight;
    return face;
  }

  /// A steeper face, near to where no wedge can slide, is given up for a dead wedge on it: as
  /// CriticalWedges holds it.
  static double held_rake(double rake, double frictions) {
    return std::clamp(rake, 10.0 * degree,
                      std::min(120.0 * degree, pi - frictions - 20.0 * degree));
  }

  /// Mean height of a pile over the top of the wedge.
  double mean_over(double height, double depth, const CuttingWedge& wedge,
                   const EarthmovingFactors& n) const {
    const double top = depth * (1.0 / std::tan(wedge.rake) + 1.0 / std::tan(n.failure));
    const double base = height / model_.slopes.heap;
    return base < top ? 0.5 * height * base / top : height * (1.0 - 0.5 * top / base);
  }

  /// Shear on a vertical plane ahead of the lip [N].
  double sheared_off(const SoilState& soil, double depth, double surcharge) const {
    const double rest = 1.0 - std::sin(soil.friction_angle);
    const double pressure = rest * (0.5 * soil.unit_weight * depth + surcharge);
    return (soil.cohesion + pressure * std::tan(soil.friction_angle)) * depth *
           bucket_.width_outside;
  }

  /// On the outside of both side plates, which runs along the walls of the cut.
  double side_friction(const Cutting& cut, BucketSection& bucket) const {
    const double depth = cut.ground.bank - cut.tip.z;
    if (!(depth > 0.0)) return 0.0;
    const AreaCentre plate = bucket.buried({depth, cut.ground.gradient});
    return 2.0 * friction(cut.bank, depth - plate.centre.y()) * plate.area;
  }

  /// The flat front of the lip; it pushes aside soil that can yield, and drives into soil that
  /// cannot.
  double lip(const SoilState& soil, double depth, double surcharge, double descent) const {
    const double phi = soil.friction_angle;
    const double active = (1.0 - std::sin(phi)) / (1.0 + std::sin(phi));
    const double pressure = 0.5 * soil.unit_weight * bucket_.edge_thickness +
                            soil.cohesion / std::tan(phi) + surcharge +
                            soil.unit_weight * depth * active;
    const double yielding = blunt_edge_ratio(0.5 * pi, phi, soil.tool_friction_angle) * pressure *
                            bucket_.edge_thickness * bucket_.width_outside;
    if (!(descent > 0.0)) return yielding;
    const double held = cone_index(model_.kind, soil, depth) *
                        penetrating(soil, std::numeric_limits<double>::infinity());
    return (1.0 - descent) * yielding + descent * held;
  }

  /// Area that the cone index acts on, so far into the ground [m^2]. The teeth are wedges as wide
  /// at the root as at the point; the lip behind follows in soil that they have broken. What a cone
  /// meets is mostly friction on its flanks; on the flatter flanks of a tooth that is more.
  double penetrating(const SoilState& soil, double driven) const {
    if (!bucket_.teeth) return bucket_.width_outside * bucket_.edge_thickness;
    const Teeth& teeth = *bucket_.teeth;
    const auto flanks = [&](double half_angle) {
      return 1.0 + std::tan(soil.tool_friction_angle) / std::tan(half_angle);
    };
    const double wedged = teeth.width * teeth.thickness * std::min(1.0, driven / teeth.length);
    return teeth.count * wedged * flanks(0.5 * teeth.angle) / flanks(cone_half_angle);
  }

  /// Friction on steel under the pressure at rest at this depth [Pa].
  static double friction(const SoilState& soil, double depth) {
    const double rest = 1.0 - std::sin(soil.friction_angle);
    return soil.adhesion +
           rest * soil.unit_weight * std::max(0.0, depth) * std::tan(soil.tool_friction_angle);
  }

  /// Floor and back behind the lip, where they are below what it has left.
  void press_heel(const Cutting& cut, const BucketSection& bucket, Resistance& result) const {
    const Vector2d tip(cut.tip.x, cut.tip.z);
    double pressed = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector2d from = tip + bucket.corner(i);
      const Vector2d to = tip + bucket.corner(i + 1);
      if (!(to.x() > from.x())) continue;  // faces upwards
      Vector2d near(tip.x(), std::min(tip.y(), section_.uncut(tip.x())));
      const std::vector<Vector2d>& ground = section_.left_behind();
      for (auto far = ground.rbegin(); far != ground.rend() && near.x() < to.x(); near = *far++) {
        pressed += bear({from, to}, {near, *far}, cut.motion, result);
      }
    }
    if (pressed > 0.0) result.heel_at /= pressed;
  }

  struct Line {
    Vector2d from;
    Vector2d to;
  };

  /// Where a side of the outline lies below the ground, it bears like a strip footing as wide as
  /// the floor, the more the deeper it is pressed in. Adds the force, and the point times the
  /// force's size, which it returns [N].
  double bear(const Line& side, const Line& ground, const Vector2d& motion,
              Resistance& result) const {
    const Vector2d along = side.to - side.from;
    const double slope = along.y() / along.x();
    const auto sunk = [&](const Vector2d& p) {
      return p.y() - side.from.y() - slope * (p.x() - side.from.x());
    };
    const double from = sunk(ground.from);
    const double to = sunk(ground.to);
    const double begin = std::max(side.from.x(), ground.from.x());
    const double end = std::min(side.to.x(), ground.to.x());
    if (!(std::max(from, to) > 1e-6 && end > begin)) return 0.0;
    const double steeper = (to - from) / (ground.to.x() - ground.from.x());
    const auto pressed = [&](double x) {
      return (from + steeper * (x - ground.from.x())) / (bearing_settlement * floor_length_);
    };
    const double x = 0.5 * (begin + end);
    const Vector2d middle(x, side.from.y() + slope * (x - side.from.x()));
    const SoilState soil = bank_at(x);
    const double area = (end - begin) * std::hypot(1.0, slope) * bucket_.width_outside;
    const double force = mean_share(pressed(begin), pressed(end)) * area *
                         bearing_capacity(soil, std::max(0.0, section_.uncut(x) - middle.y()));
    const Vector2d inward = Vector2d(-slope, 1.0).normalized();
    result.heel += force * (inward - std::tan(soil.tool_friction_angle) * motion);
    result.heel_at += force * middle;
    return force;
  }

  /// Mean of max(0, min(1, u)) from one u to another.
  static double mean_share(double from, double to) {
    const auto integral = [](double u) { return u <= 0.0 ? 0.0 : u < 1.0 ? 0.5 * u * u : u - 0.5; };
    if (std::abs(to - from) < 1e-9) return std::clamp(from, 0.0, 1.0);
    return (integral(to) - integral(from)) / (to - from);
  }

  /// Of a strip footing as wide as the floor (Prandtl, Reissner; N_gamma of Vesic 1973) [Pa].
  double bearing_capacity(const SoilState& soil, double depth) const {
    const double phi = soil.friction_angle;
    const double n_q = std::exp(pi * std::tan(phi)) * (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
    const double n_c = (n_q - 1.0) / std::tan(phi);
    const double n_gamma = 2.0 * (n_q + 1.0) * std::tan(phi);
    return soil.cohesion * n_c + soil.unit_weight * (depth * n_q + 0.5 * floor_length_ * n_gamma);
  }

  SoilState bank_at(double x) const {
    return section_.bank_of(section_.column(section_.column_at(x)).void_ratio);
  }

  const SectionModel& model_;
  const Bucket& bucket_;
  const SoilSection& section_;
  double floor_length_ = 0.0;
};

/// Soil that leans against the lip as a wedge at the angle of repose.
struct Pile {
  double area = 0.0;

  /// At the lip, where its surface falls by `fall` per metre towards the ground ahead.
  double height(double fall) const { return std::sqrt(2.0 * area * fall); }

  /// Takes what lies over the next `advance` of ground higher than `lip` above it.
  double take(double advance, double lip, double fall) {
    const double high = height(fall);
    const double from = std::max(0.0, lip);
    if (high <= from || advance <= 0.0) return 0.0;
    const double length = std::min(advance, (high - from) / fall);
    const double taken = std::min(area, length * (high - from - 0.5 * fall * length));
    area -= taken;
    return taken;
  }
};

// ---- One dig ------------------------------------------------------------------------------------

class SectionDig {
 public:
  SectionDig(const SectionModel& model, const Terrain& terrain, const DigPath& path,
             const DigOptions& options)
      : model_(model),
        machine_(model.machine),
        path_(path),
        bucket_(machine_.bucket),
        section_(terrain, {model.kind, model.bank, model.loose}, machine_.bucket.width_outside,
                 reach(machine_, path)),
        resistance_(model, section_),
        account_(machine_, path, options),
        repose_(model.slopes.heap) {}

  DigResult run() {
    const BucketPose& start = path_.poses.front().bucket;
    section_.pass({start.x, start.z});
    std::size_t i = 1;
    for (; i < path_.poses.size() && path_.poses[i].phase != DigPhase::lift; ++i) {
      if (!dig_step(path_.poses[i - 1], path_.poses[i])) break;
    }
    if (!account_.result.stall) {
      for (; i < path_.poses.size(); ++i) lift_step(path_.poses[i - 1], path_.poses[i]);
    }
    settle();
    const LooseSoil rest = write_back(section_, repose_);
    account_.result.soil.spilled = rest.elsewhere;
    account_.result.soil.fallen_back = rest.in_cut;
    account_.close(section_.ground(), contents_, repose_);
    return std::move(account_.result);
  }

 private:
  static Reach reach(const Machine& machine, const DigPath& path) {
    const std::vector<Vector2d>& profile = machine.bucket.profile;
    const Rectangle strip = swept_strip(machine, path);
    return {strip.x_min, strip.x_max, (profile[2] - profile[0]).norm()};
  }

  double width() const { return machine_.bucket.width_outside; }

  /// How fast the pile's surface falls towards the ground ahead, per metre.
  double fall(const GroundAhead& ground) const {
    return std::max(0.25 * repose_, repose_ - ground.gradient);
  }

  /// False if a joint stalls.
  bool dig_step(const DigPose& from, const DigPose& to) {
    const JointAngles joints = 0.5 * (from.joints + to.joints);
    const LinkPositions at = link_positions(machine_, joints);
    bucket_.turn_to(at.phi3);
    const Vector2d p(from.bucket.x, from.bucket.z);
    const Vector2d q(to.bucket.x, to.bucket.z);
    const Resistance soil = resist(
        0.5 * (p + q), q - p, 0.5 * (from.bucket.floor_angle + to.bucket.floor_angle), to.phase);
    DigStep step;
    step.phase = to.phase;
    step.length = (q - p).norm();
    step.joints = joints;
    step.turn = to.joints - from.joints;
    step.by_soil = torque_against_force(machine_, at, soil.face_at, soil.face) +
                   torque_against_force(machine_, at, soil.tip_at, soil.tip) +
                   torque_against_force(machine_, at, soil.heel_at, soil.heel);
    step.by_payload = carry(at, std::max(0.0, contents_ - soil.on_floor));
    step.by_links = torque_against_link_weight(machine_, at);
    account_.note_force(step, soil.total(), contents_);
    if (account_.stalls(step)) return false;
    account_.book(step);
    account_.travel(step.length);
    cut(p, q);
    return true;
  }

  Resistance resist(const Vector2d& tip, const Vector2d& step, double floor_angle, DigPhase phase) {
    const double length = step.norm();
    if (!(length > 0.0)) return {};
    Cutting cutting;
    cutting.tip = {tip.x(), tip.y(), floor_angle};
    cutting.motion = step / length;
    cutting.ground = section_.ahead(tip.x());
    cutting.bank = section_.bank_of(cutting.ground.void_ratio);
    cutting.pile = pile_.height(fall(cutting.ground));
    cutting.contents = contents_;
    return resistance_.at(cutting, bucket_, phase);
  }

  JointAngles carry(const LinkPositions& at, double volume) {
    const Vector2d centre = at.tip + bucket_.held(0.0, model_.slopes).centre;
    return torque_against_force(machine_, at, centre, {0.0, -volume * model_.loose.unit_weight});
  }

  void cut(const Vector2d& p, const Vector2d& q) {
    const CutArea area = section_.cut(p, q);
    const GroundAhead ground = section_.ahead(q.x());
    const double falls = fall(ground);
    const double lip = q.y() - ground.surface;
    const double from_pile = pile_.take(p.x() - q.x(), lip, falls);
    account_.result.soil.bank_cut += area.bank * width();
    account_.result.soil.loose_cut += (area.loose + from_pile) * width();
    contents_ += (area.swollen + from_pile) * width();
    const double support = std::max(0.0, pile_.height(falls) - lip);
    const double holds = bucket_.held(support, model_.slopes).area;
    if (contents_ > holds) {
      pile_.area += (contents_ - holds) / width();
      contents_ = holds;
    }
    pile_at_ = q.x();
    const double shed = section_.shed(pile_at_, pile_.height(falls), falls, repose_);
    pile_.area = std::max(0.0, pile_.area - shed);
  }

  void lift_step(const DigPose& from, const DigPose& to) {
    const LinkPositions at = link_positions(machine_, 0.5 * (from.joints + to.joints));
    bucket_.turn_to(at.phi3);
    DigStep step;
    step.phase = DigPhase::lift;
    step.turn = to.joints - from.joints;
    step.by_payload = carry(at, contents_);
    step.by_links = torque_against_link_weight(machine_, at);
    account_.book(step);
    bucket_.turn_to(link_positions(machine_, to.joints).phi3);
    const GroundAhead ground = section_.ahead(to.bucket.x);
    const double support = ground.surface - to.bucket.z;
    const HoldingSlopes clear = {model_.slopes.heap, model_.slopes.heap};
    const double holds =
        support > 0.0 ? bucket_.held(support, model_.slopes).area : bucket_.held(0.0, clear).area;
    if (contents_ <= holds) return;
    const double lost = (contents_ - holds) / width();
    dropped_ += lost;
    dropped_at_ += lost * to.bucket.x;
    contents_ = holds;
  }

  /// The pile's back, no longer held, slides into the cut; what the bucket lost lies under it.
  void settle() {
    using Side = SoilSection::Side;
    if (pile_.area > 0.0) {
      const double falls = fall(section_.ahead(pile_at_));
      const double stays = pile_.area * repose_ / (repose_ + falls);
      const double crest = pile_at_ - pile_.height(falls) / (repose_ + falls);
      section_.settle(pile_at_, {Side::ahead, crest, repose_}, stays);
      section_.settle(pile_at_, {Side::behind, pile_at_, repose_}, pile_.area - stays);
    }
    if (dropped_ > 0.0) {
      section_.settle(pile_at_, {Side::both, dropped_at_ / dropped_, repose_}, dropped_);
    }
  }

  const SectionModel& model_;
  const Machine& machine_;
  const DigPath& path_;
  BucketSection bucket_;
  SoilSection section_;
  SoilResistance resistance_;
  DigAccount account_;
  double repose_;
  Pile pile_;
  double pile_at_ = 0.0;
  double contents_ = 0.0;    ///< loose, in the bucket [m^3]
  double dropped_ = 0.0;     ///< by the rising bucket [m^2]
  double dropped_at_ = 0.0;  ///< sum of area times x
};

}  // namespace

double clipped_capacity(const Machine& machine, double phi3, double support,
                        const HoldingSlopes& slopes) {
  BucketSection section(machine.bucket);
  section.turn_to(phi3);
  return section.held(support, slopes).area;
}

SectionSimulator::SectionSimulator(const Machine& machine, const SoilKind& soil,
                                   double density_percent)
    : model_(std::make_shared<const SectionModel>(machine, soil, density_percent)) {}

DigResult SectionSimulator::dig(const Terrain& terrain, const DigPath& path,
                                const DigOptions& options) const {
  check_dig(terrain, path);
  return SectionDig(*model_, terrain, path, options).run();
}

std::string SectionSimulator::name() {
  return "section " + std::to_string(section_simulator_version);
}

std::string SectionSimulator::identity() const {
  return simulator_identity(name(), model_->machine, model_->kind, model_->density_percent);
}

}  // namespace excavplan
