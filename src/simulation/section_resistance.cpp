// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/section_resistance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "soil/earthmoving.hpp"

#include "base/angles.hpp"
#include "simulation/resistance.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

/// What a wedge of soil slides up on: the floor, or the front of the soil packed on it.
struct SlidingFace {
  double angle = 0.0;  ///< above the horizontal [rad]
  bool on_soil = false;
};

/// Soil of one kind from a level down, with this stress on it.
struct Layer {
  SoilState soil;
  double depth = 0.0;  ///< of its lower side below its upper [m]
  double above = 0.0;  ///< vertical stress on it [Pa]

  double stress(double at) const { return above + soil.unit_weight * at; }
  double stress_below() const { return stress(depth); }
  /// Of the pressure at rest on a vertical plane to the stress (Jaky 1944).
  double at_rest() const { return 1.0 - std::sin(soil.friction_angle); }
  /// Shear strength on such a plane [Pa].
  double shear(double at) const {
    return soil.cohesion + at_rest() * stress(at) * std::tan(soil.friction_angle);
  }
  /// Friction and adhesion on steel at rest [Pa].
  double on_steel(double at) const {
    return soil.adhesion + at_rest() * stress(at) * std::tan(soil.tool_friction_angle);
  }
};

/// The ground above the tip.
struct Layers {
  Layer loose;
  Layer bank;

  Layers(const Cutting& cut, double to_bank, double to_surface)
      : loose{cut.loose, std::max(0.0, to_surface - std::max(0.0, to_bank)), 0.0},
        bank{cut.bank, std::max(0.0, to_bank), 0.0} {
    bank.above = loose.stress_below();
  }

  double depth() const { return loose.depth + bank.depth; }
  double overburden() const { return bank.stress_below(); }
  const Layer& lowest() const { return bank.depth > 0.0 ? bank : loose; }

  /// Mean over the lowest part of this height.
  template <typename OfSoil>
  double near_tip(double height, const OfSoil& of_soil) const {
    const double share = std::min(1.0, bank.depth / std::min(height, depth()));
    const double of_bank = share > 0.0 ? share * of_soil(bank.soil) : 0.0;
    return share < 1.0 ? of_bank + (1.0 - share) * of_soil(loose.soil) : of_bank;
  }
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

  /// What a wedge ahead of the face meets; depths are across the surface.
  struct Ahead {
    Layers ground;
    double slope = 0.0;
    double pile = 0.0;  ///< height of what was pushed up on it, at the face [m]
  };

  /// How a layer slides up a face.
  struct Slide {
    SoilState soil;
    CuttingWedge wedge;
    EarthmovingFactors n;
    double stuck = 0.0;  ///< cohesion or adhesion on the face [Pa]

    double ahead(double depth) const { return depth / std::tan(n.failure); }
    double over(double depth) const { return depth / std::tan(wedge.rake); }
  };

  /// The floor moves along itself: cone index on lip and teeth, friction on floor and side plates.
  void drive_in(const Cutting& cut, BucketSection& bucket, SectionResistance& result) const {
    const Layers layers(cut, cut.ground.bank - cut.tip.z, cut.ground.surface - cut.tip.z);
    const double depth = layers.depth();
    if (!(depth > 0.0)) return;
    const double sine = std::sin(cut.tip.floor_angle);
    const double cosine = std::cos(cut.tip.floor_angle);
    const double driven = depth / std::max(1e-3, sine - cut.ground.gradient * cosine);
    const double floor = std::min(floor_length_, driven) * bucket_.width_outside;
    const double edge = held(layers, driven);
    const double on_floor = (layers.loose.on_steel(0.5 * layers.loose.depth) * layers.loose.depth +
                             layers.bank.on_steel(0.5 * layers.bank.depth) * layers.bank.depth) /
                            depth;
    const double force =
        edge + 2.0 * on_floor * floor + 2.0 * on_plates(layers, cut.ground.gradient, bucket);
    result.tip = -force * cut.motion;
    result.edge = -edge * cut.motion;
  }

  /// Of lip or teeth in soil that cannot yield [N].
  double held(const Layers& layers, double driven) const {
    const double height = bucket_.teeth ? bucket_.teeth->thickness : bucket_.edge_thickness;
    return layers.near_tip(height, [&](const SoilState& soil) {
      return cone_index(model_.kind, soil, layers.overburden() / soil.unit_weight) *
             penetrating(soil, driven, layers.depth());
    });
  }

  /// Friction on the outside of both side plates, each part in its own layer [N].
  static double on_plates(const Layers& layers, double gradient, BucketSection& bucket) {
    const auto below = [&](double height) {
      return height > 0.0 ? bucket.buried({height, gradient}) : AreaCentre{};
    };
    const AreaCentre all = below(layers.depth());
    const AreaCentre in_bank = below(layers.bank.depth);
    const double in_loose = all.area - in_bank.area;
    double force =
        layers.bank.on_steel(std::max(0.0, layers.bank.depth - in_bank.centre.y())) * in_bank.area;
    if (in_loose > 0.0) {
      const double centre =
          (all.area * all.centre.y() - in_bank.area * in_bank.centre.y()) / in_loose;
      force += layers.loose.on_steel(std::max(0.0, layers.depth() - centre)) * in_loose;
    }
    return 2.0 * force;
  }

  /// A wedge of soil slides up ahead of the face that makes it easier.
  void shear(const Cutting& cut, BucketSection& bucket, SectionResistance& result) const {
    const double alpha = -std::atan(cut.ground.gradient);  // positive uphill
    const Layers upright(cut, cut.ground.bank - cut.tip.z, cut.ground.surface - cut.tip.z);
    const double above = cut.ground.surface - cut.tip.z + cut.pile;
    if (!(above > 0.0)) return;
    const Eigen::Vector2d up = model_.machine.up();
    const double slope = alpha - std::atan2(up.x(), up.y());  // as gravity sees it
    Ahead ahead = {
        Layers(cut, upright.bank.depth * std::cos(alpha), upright.depth() * std::cos(alpha)), slope,
        cut.pile};
    if (!(upright.depth() > 0.0)) {  // in the pile alone
      ahead.ground.loose = {model_.loose, above * std::cos(alpha), 0.0};
      ahead.pile = 0.0;
    }
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
    result.face.y() -= (1.0 - fade) * sheared_off(ahead.ground, face.surcharge);
    if (upright.depth() > 0.0) {
      result.face -= on_plates(upright, cut.ground.gradient, bucket) * cut.motion;
    }
    result.face -= (1.0 - fade) * lift(ahead, bucket.turned(fill.centre).y()) * cut.motion;
    const double descent = std::max(0.0, -cut.motion.y());
    result.edge = -lip(ahead.ground, face.surcharge, descent) * cut.motion;
    result.tip = result.edge;
    const double up_face =
        std::min(ahead.ground.depth() / 3.0, floor_length_ * std::sin(face.rake));
    result.face_at +=
        up_face / std::sin(face.rake) * Vector2d(std::cos(on.angle), std::sin(on.angle));
    result.on_floor = fade * face.on_floor;
    result.wedge_length = fade * face.length;
  }

  Slide slide_of(const SoilState& soil, const SlidingFace& on, double frame, double slope) const {
    const double delta = on.on_soil ? soil.friction_angle : soil.tool_friction_angle;
    const double rake =
        held_rake(std::max(on.angle + frame, bucket_.edge_angle), soil.friction_angle + delta);
    return {soil,
            {rake, soil.friction_angle, delta, slope},
            model_.wedges.at(rake, slope, soil, on.on_soil),
            on.on_soil ? soil.cohesion : soil.adhesion};
  }

  /// A wedge through both layers, each with the passive pressure of its own soil. On the floor it
  /// pushes the soil in the bucket before it; both are one body between the floor and the failure
  /// plane.
  Face pushed(const Ahead& ahead, const SlidingFace& on, double frame, double contents) const {
    const Layers& ground = ahead.ground;
    const double in_bank = ground.bank.depth;
    const double in_loose = ground.loose.depth;
    const Slide bank = slide_of(ground.bank.soil, on, frame, ahead.slope);
    const Slide loose = slide_of(ground.loose.soil, on, frame, ahead.slope);
    Face face;
    face.rake = in_bank > 0.0 ? bank.wedge.rake : loose.wedge.rake;
    face.length = bank.ahead(in_bank) + loose.ahead(in_loose);
    // Level over the ground ahead of the lip; what lies over the face is in the bucket.
    const double top = face.length + bank.over(in_bank) + loose.over(in_loose);
    const double pile = top > 0.0 ? ahead.pile * face.length / top : ahead.pile;
    face.surcharge = model_.loose.unit_weight * pile;
    add_layer(ground.bank, bank, face.surcharge, face);
    add_layer(ground.loose, loose, face.surcharge, face);
    add(face.surcharge * pile * loose.n.gamma * bucket_.width_outside, 0.0, loose, face);
    const double side = side_plane_force(bank.wedge, bank.n, strength(ground.bank), in_bank);
    add(side * share_of_sides(bank), 0.0, bank, face);
    const double over_bank = (bank.ahead(in_bank) + bank.over(in_bank)) * in_loose;
    const double upper = side_plane_force(loose.wedge, loose.n, strength(ground.loose), in_loose) +
                         2.0 * over_bank * ground.loose.shear(0.5 * in_loose);
    add(upper * share_of_sides(loose), 0.0, loose, face);
    if (on.on_soil) return face;
    const double on_face = weight_on_face(ground, bank, loose) / model_.loose.unit_weight;
    const double behind = std::max(0.0, contents - on_face);
    const double share = ground.depth() > 0.0 ? in_bank / ground.depth() : 0.0;
    add_contents(share, behind, contents, bank, face);
    add_contents(1.0 - share, behind, contents, loose, face);
    face.on_floor = on_face + behind;
    return face;
  }

  /// A resultant at the friction angle to the face, and what sticks to the face [N].
  static void add(double force, double sticks, const Slide& slide, Face& face) {
    const double angle = slide.wedge.rake + slide.wedge.tool_friction;
    face.along += force * std::sin(angle) + sticks / std::tan(slide.wedge.rake);
    face.down += force * std::cos(angle) - sticks;
  }

  void add_layer(const Layer& layer, const Slide& slide, double surcharge, Face& face) const {
    const double t = layer.depth;
    const double flat =
        t * (slide.soil.unit_weight * t * slide.n.gamma + slide.soil.cohesion * slide.n.c +
             (layer.above + surcharge) * slide.n.q + slide.stuck * slide.n.ca);
    add(flat * bucket_.width_outside, slide.stuck * t * bucket_.width_outside, slide, face);
  }

  void add_contents(double share, double behind, double contents, const Slide& slide,
                    Face& face) const {
    const double walls = share * wall_friction(contents) * std::sin(slide.wedge.rake);
    add(share * behind * model_.loose.unit_weight * slide.n.Q + walls * slide.n.ca, walls, slide,
        face);
  }

  static double share_of_sides(const Slide& slide) {
    return std::max(0.0, side_plane_share(slide.wedge, slide.n));
  }

  /// What is above presses on the side planes as well.
  static SoilStrength strength(const Layer& layer) {
    return {layer.soil.unit_weight, layer.shear(0.0), layer.soil.adhesion};
  }

  /// Of the wedge's soil over the floor, as far as the floor reaches [N].
  double weight_on_face(const Layers& ground, const Slide& bank, const Slide& loose) const {
    const auto over = [](const Slide& slide, double depth, double longest) {
      return std::clamp(slide.over(depth), 0.0, longest);
    };
    const double first = over(bank, ground.bank.depth, floor_length_);
    const double rest = over(loose, ground.loose.depth, floor_length_ - first);
    return bucket_.width_outside *
           (0.5 * ground.bank.depth * first * ground.bank.soil.unit_weight +
            ground.loose.depth * (first + 0.5 * rest) * ground.loose.soil.unit_weight);
  }

  /// Of the side plates on the soil in the bucket as it slides in, as deep as it would lie on the
  /// floor alone [N].
  double wall_friction(double contents) const {
    const double section = contents / bucket_.width_inside;
    return 2.0 * section * Layer{model_.loose}.on_steel(0.5 * section / floor_length_);
  }

  /// Weight of the soil that is sheared off per travel, times its rise into the bucket [N].
  double lift(const Ahead& ahead, double centre) const {
    const double weight = ahead.ground.overburden() + model_.loose.unit_weight * ahead.pile;
    return weight * std::max(0.0, centre - 0.5 * (ahead.ground.depth() + ahead.pile)) *
           bucket_.width_outside;
  }

  /// Near the rake at which no wedge can slide, a dead wedge forms on the face: clamped as in
  /// CriticalWedges.
  static double held_rake(double rake, double frictions) {
    return std::clamp(rake, 10.0 * degree,
                      std::min(120.0 * degree, pi - frictions - 20.0 * degree));
  }

  /// Shear on a vertical plane ahead of the lip [N].
  double sheared_off(const Layers& ground, double surcharge) const {
    const auto of = [&](Layer layer) {
      layer.above += surcharge;
      return layer.shear(0.5 * layer.depth) * layer.depth;
    };
    return (of(ground.bank) + of(ground.loose)) * bucket_.width_outside;
  }

  /// The flat front of the lip; it pushes aside soil that can yield, and drives into soil that
  /// cannot.
  double lip(const Layers& ground, double surcharge, double descent) const {
    if (!(ground.depth() > 0.0)) return 0.0;
    const double thickness = std::min(bucket_.edge_thickness, ground.depth());
    const double pressure = ground.near_tip(thickness, [&](const SoilState& soil) {
      const double phi = soil.friction_angle;
      const double active = (1.0 - std::sin(phi)) / (1.0 + std::sin(phi));
      return blunt_edge_ratio(0.5 * pi, phi, soil.tool_friction_angle) *
             (0.5 * soil.unit_weight * thickness + soil.cohesion / std::tan(phi) + surcharge +
              ground.overburden() * active);
    });
    const double yielding = pressure * thickness * bucket_.width_outside;
    if (!(descent > 0.0)) return yielding;
    return (1.0 - descent) * yielding +
           descent * held(ground, std::numeric_limits<double>::infinity());
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

  /// Floor and back behind the lip, where they are below what it has left.
  void press_heel(const Cutting& cut, const BucketSection& bucket,
                  SectionResistance& result) const {
    const Vector2d tip(cut.tip.x, cut.tip.z);
    double pressed = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector2d from = tip + bucket.corner(i);
      const Vector2d to = tip + bucket.corner(i + 1);
      if (!(to.x() > from.x())) continue;  // faces upwards
      Vector2d near(tip.x(), std::min(tip.y(), section_.surface_before(tip.x())));
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
    const Layers above = above_point(middle);
    const SoilState& soil = above.lowest().soil;
    const double area = (end - begin) * std::hypot(1.0, slope) * bucket_.width_outside;
    const double force = mean_share(pressed(begin), pressed(end)) * area *
                         bearing_capacity(soil, above.overburden());
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

  /// Of a strip footing as wide as the floor (Prandtl, Reissner; N_gamma of Vesic 1973) with this
  /// stress beside it [Pa].
  double bearing_capacity(const SoilState& soil, double beside) const {
    const double phi = soil.friction_angle;
    const double n_q = std::exp(pi * std::tan(phi)) * (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
    const double n_c = (n_q - 1.0) / std::tan(phi);
    const double n_gamma = 2.0 * (n_q + 1.0) * std::tan(phi);
    return soil.cohesion * n_c + beside * n_q + 0.5 * soil.unit_weight * floor_length_ * n_gamma;
  }

  Layers above_point(const Vector2d& point) const {
    const Column& column = section_.column(section_.column_at(point.x()));
    Cutting here;
    here.bank = section_.bank_of(column.void_ratio);
    here.loose = section_.loose_of(column.loose_void_ratio);
    return {here, section_.bank_before(point.x()) - point.y(),
            section_.surface_before(point.x()) - point.y()};
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
