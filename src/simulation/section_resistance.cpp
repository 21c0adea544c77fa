// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/section_resistance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "simulation/earthmoving.hpp"

#include "base/angles.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double degree = pi / 180.0;

constexpr double cone_half_angle = 15.0 * degree;  // of the standard cone (ASAE S313)
constexpr double bearing_settlement = 0.1;  // of its width, at which a footing bears all; ours

/// What a wedge of soil slides up on: the floor, or the front of the soil packed on it.
struct SlidingFace {
  double angle = 0.0;  ///< above the horizontal [rad]
  bool on_soil = false;
};

/// The forces of one attitude.
class SoilResistance {
 public:
  SoilResistance(const SectionModel& model, const SoilSection& section)
      : model_(model), bucket_(model.machine.bucket), section_(section) {
    floor_length_ = (bucket_.profile[1] - bucket_.profile[0]).norm();
  }

  /// `bucket` is turned to its attitude.
  SectionResistance at(const Cutting& cut, BucketSection& bucket, DigPhase phase) const {
    SectionResistance result;
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
    double length = 0.0;     ///< of the wedge's top ahead of the lip [m]
    double on_floor = 0.0;   ///< [m^3]
  };

  /// What a wedge ahead of the face meets.
  struct Ahead {
    SoilState soil;
    double depth = 0.0;  ///< across the surface [m]
    double slope = 0.0;
    double loose = 0.0;  ///< height of the loose soil on it at the face [m]
  };

  /// The floor moves along itself: cone index on lip and teeth, friction on floor and side plates.
  void drive_in(const Cutting& cut, BucketSection& bucket, SectionResistance& result) const {
    const Below ground = {cut.ground.surface - cut.tip.z, cut.ground.gradient};
    const double depth = ground.height;
    if (!(depth > 0.0)) return;
    const SoilState soil = cut.ground.bank > cut.tip.z ? cut.bank : in_loose(cut.bank);
    const double sine = std::sin(cut.tip.floor_angle);
    const double cosine = std::cos(cut.tip.floor_angle);
    const double driven = depth / std::max(1e-3, sine - ground.slope * cosine);
    const double floor = std::min(floor_length_, driven) * bucket_.width_outside;
    const AreaCentre plate = bucket.buried(ground);
    const double edge = cone_index(model_.kind, soil, depth) * penetrating(soil, driven, depth);
    const double force = edge + 2.0 * friction(soil, 0.5 * depth) * floor +
                         4.0 * friction(soil, depth - plate.centre.y()) * plate.area;
    result.tip = -force * cut.motion;
    result.edge = -edge * cut.motion;
  }

  /// A wedge of soil slides up ahead of the face that makes it easier.
  void shear(const Cutting& cut, BucketSection& bucket, SectionResistance& result) const {
    const double alpha = -std::atan(cut.ground.gradient);  // positive uphill
    const double bank_depth = (cut.ground.bank - cut.tip.z) * std::cos(alpha);
    const double loose_above = cut.ground.surface - cut.ground.bank + cut.pile;
    const double all_depth = bank_depth + loose_above * std::cos(alpha);
    if (!(all_depth > 0.0)) return;
    const Eigen::Vector2d up = model_.machine.up();
    const double slope = alpha - std::atan2(up.x(), up.y());  // as gravity sees it
    const Ahead ahead = bank_depth > 0.0 ? Ahead{cut.bank, bank_depth, slope, loose_above}
                                         : Ahead{in_loose(cut.bank), all_depth, slope, 0.0};
    const double climb = std::asin(std::clamp(cut.motion.y(), -1.0, 1.0));
    const double frame = std::max(alpha, climb);
    SlidingFace on = {cut.tip.floor_angle, false};
    Face face = pushed(ahead, on, frame, cut.contents);
    const PackedFront::Fill fill = model_.packed.of(cut.contents);
    const double front = cut.tip.floor_angle + fill.front;
    if (const Face other = pushed(ahead, {front, true}, frame, cut.contents);
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
    result.face -= (1.0 - fade) * lift(ahead, bucket.turned(fill.centre).y()) * cut.motion;
    const double descent = std::max(0.0, -cut.motion.y());
    result.edge = -lip(ahead.soil, ahead.depth, face.surcharge, descent) * cut.motion;
    result.tip = result.edge;
    const double up_face = std::min(ahead.depth / 3.0, floor_length_ * std::sin(face.rake));
    result.face_at +=
        up_face / std::sin(face.rake) * Vector2d(std::cos(on.angle), std::sin(on.angle));
    result.on_floor = fade * face.on_floor;
    result.wedge_length = fade * face.length;
  }

  /// Loose soil that is compacted against the face: it has the friction of the bank.
  SoilState in_loose(const SoilState& bank) const {
    SoilState soil = model_.loose;
    soil.friction_angle = bank.friction_angle;
    soil.tool_friction_angle = bank.tool_friction_angle;
    return soil;
  }

  /// A wedge on the floor pushes the soil in the bucket before it; both are one body between the
  /// floor and the failure plane.
  Face pushed(const Ahead& ahead, const SlidingFace& on, double frame, double contents) const {
    const SoilState& soil = ahead.soil;
    const double width = bucket_.width_outside;
    const double delta = on.on_soil ? soil.friction_angle : soil.tool_friction_angle;
    const double stuck = on.on_soil ? soil.cohesion : soil.adhesion;
    const double rake =
        held_rake(std::max(on.angle + frame, bucket_.edge_angle), soil.friction_angle + delta);
    const EarthmovingFactors n = model_.wedges.at(rake, ahead.slope, soil, on.on_soil);
    const CuttingWedge wedge = {rake, soil.friction_angle, delta, ahead.slope};
    Face face;
    face.rake = rake;
    const double t = ahead.depth;
    face.length = t / std::tan(n.failure);
    // Level over the ground ahead of the lip; what lies over the face is in the bucket.
    const double pile = ahead.loose * face.length / (face.length + t / std::tan(rake));
    face.surcharge = model_.loose.unit_weight * pile;
    const double flat = soil.unit_weight * t * t * n.gamma + soil.cohesion * t * n.c +
                        face.surcharge * (t * n.q + pile * n.gamma) + stuck * t * n.ca;
    const SoilStrength strength = {soil.unit_weight, soil.cohesion, soil.adhesion};
    double force = flat * width + side_plane_force(wedge, n, strength, t) *
                                      std::max(0.0, side_plane_share(wedge, n));
    double adhesion = stuck * t * width;
    const double cot_rake = 1.0 / std::tan(rake);
    if (!on.on_soil) {
      const double on_face = 0.5 * t * std::min(t * cot_rake, floor_length_) * width *
                             soil.unit_weight / model_.loose.unit_weight;
      const double behind = std::max(0.0, contents - std::max(0.0, on_face));
      const double walls = wall_friction(contents) * std::sin(rake);
      force += behind * model_.loose.unit_weight * n.Q + walls * n.ca;
      adhesion += walls;
      face.on_floor = std::max(0.0, on_face) + behind;
    }
    face.along = force * std::sin(rake + delta) + adhesion * cot_rake;
    face.down = force * std::cos(rake + delta) - adhesion;
    return face;
  }

  /// Of the side plates on the soil in the bucket as it slides in, as deep as it would lie on the
  /// floor alone [N].
  double wall_friction(double contents) const {
    const double section = contents / bucket_.width_inside;
    return 2.0 * section * friction(model_.loose, 0.5 * section / floor_length_);
  }

  /// Weight of the soil that is sheared off per travel, times its rise into the bucket [N].
  double lift(const Ahead& ahead, double centre) const {
    const double weight =
        ahead.soil.unit_weight * ahead.depth + model_.loose.unit_weight * ahead.loose;
    return weight * std::max(0.0, centre - 0.5 * (ahead.depth + ahead.loose)) *
           bucket_.width_outside;
  }

  /// Near the rake at which no wedge can slide, a dead wedge forms on the face: clamped as in
  /// CriticalWedges.
  static double held_rake(double rake, double frictions) {
    return std::clamp(rake, 10.0 * degree,
                      std::min(120.0 * degree, pi - frictions - 20.0 * degree));
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
    const double thickness = std::min(bucket_.edge_thickness, depth);
    const double pressure = 0.5 * soil.unit_weight * thickness + soil.cohesion / std::tan(phi) +
                            surcharge + soil.unit_weight * depth * active;
    const double yielding = blunt_edge_ratio(0.5 * pi, phi, soil.tool_friction_angle) * pressure *
                            thickness * bucket_.width_outside;
    if (!(descent > 0.0)) return yielding;
    const double held = cone_index(model_.kind, soil, depth) *
                        penetrating(soil, std::numeric_limits<double>::infinity(), depth);
    return (1.0 - descent) * yielding + descent * held;
  }

  /// Area that the cone index acts on, so far into the ground [m^2]. The teeth are wedges as wide
  /// at the root as at the point; the lip behind follows in soil that they have broken. The
  /// resistance of a cone is mostly friction on its flanks; it is larger on the flatter flanks of a
  /// tooth.
  double penetrating(const SoilState& soil, double driven, double depth) const {
    if (!bucket_.teeth) return bucket_.width_outside * std::min(bucket_.edge_thickness, depth);
    const Teeth& teeth = *bucket_.teeth;
    const auto flanks = [&](double half_angle) {
      return 1.0 + std::tan(soil.tool_friction_angle) / std::tan(half_angle);
    };
    const double wedged =
        teeth.width * std::min(teeth.thickness, depth) * std::min(1.0, driven / teeth.length);
    return teeth.count * wedged * flanks(0.5 * teeth.angle) / flanks(cone_half_angle);
  }

  /// Friction on steel under the pressure at rest at this depth [Pa].
  static double friction(const SoilState& soil, double depth) {
    const double rest = 1.0 - std::sin(soil.friction_angle);
    return soil.adhesion +
           rest * soil.unit_weight * std::max(0.0, depth) * std::tan(soil.tool_friction_angle);
  }

  /// Floor and back behind the lip, where they are below what it has left.
  void press_heel(const Cutting& cut, const BucketSection& bucket,
                  SectionResistance& result) const {
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
  /// the floor, proportional to its depth. Adds the force and the point times the force; returns
  /// the force [N].
  double bear(const Line& side, const Line& ground, const Vector2d& motion,
              SectionResistance& result) const {
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

}  // namespace

SectionModel::SectionModel(Machine machine_, SoilKind kind_, double density_percent_)
    : machine(std::move(machine_)),
      kind(std::move(kind_)),
      density_percent(density_percent_),
      bank(bank_state(kind, density_percent)),
      loose(loose_state(kind)),
      wedges(kind, bank, loose),
      packed(machine.bucket) {
  // Dug soil has the cohesion of moist soil in that state.
  const SoilState dug =
      bank_state_of_void_ratio(kind, std::min(kind.void_ratio_loose, kind.void_ratio_max));
  const double mouth = (machine.bucket.profile.back() - machine.bucket.profile.front()).norm();
  slopes.heap = std::tan(kind.angle_of_repose);
  slopes.face = std::tan(stable_slope(dug, mouth, kind.angle_of_repose));
}

SectionResistance section_resistance(const SectionModel& model, const SoilSection& section,
                                     const Cutting& cut, BucketSection& bucket, DigPhase phase) {
  return SoilResistance(model, section).at(cut, bucket, phase);
}

}  // namespace excavplan
