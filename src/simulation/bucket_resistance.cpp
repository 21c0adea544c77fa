// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/bucket_resistance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angles.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Numbers of our own choice; reasons: docs/methods.md#simulation.
constexpr double slope_reach = 0.30;  // the surface's slope is taken over this ahead of the lip [m]
constexpr int heel_samples = 12;      // of the outline behind the lip
constexpr double bearing_settlement =
    0.1;  // of its width, at which a footing has its full capacity

constexpr double cone_half_angle = 15.0 * pi / 180.0;  // of the standard cone (ASAE S313)

/// Mean pressure at rest on a vertical face down to this depth (Jaky 1944: K_0 = 1 - sin phi).
double at_rest_pressure(const SoilState& soil, double depth) {
  return 0.5 * (1.0 - std::sin(soil.friction_angle)) * soil.unit_weight * depth;
}

/// Friction and adhesion on steel under that pressure.
double plate_friction(const SoilState& soil, double depth) {
  return soil.adhesion + at_rest_pressure(soil, depth) * std::tan(soil.tool_friction_angle);
}

/// Bearing capacity of a strip footing (Prandtl, Reissner; N_gamma of Vesic 1973) [Pa].
double bearing_capacity(const SoilState& soil, double depth, double width) {
  const double tangent = std::tan(soil.friction_angle);
  const double root = std::tan(0.25 * pi + 0.5 * soil.friction_angle);
  const double n_q = std::exp(pi * tangent) * root * root;
  return soil.cohesion * (n_q - 1.0) / tangent + soil.unit_weight * depth * n_q +
         soil.unit_weight * width * (n_q + 1.0) * tangent;
}

/// Soil in the bucket is in its loosest state, with the cohesion that moist soil has there.
SoilState dug_state(const SoilKind& soil) {
  const double density =
      (soil.void_ratio_max - soil.void_ratio_loose) / (soil.void_ratio_max - soil.void_ratio_min);
  return bank_state(soil, 100.0 * std::clamp(density, 0.0, 1.0));
}

}  // namespace

HeightMapModel::HeightMapModel(Machine machine_, SoilKind soil_, double density_percent_)
    : machine(std::move(machine_)),
      soil(std::move(soil_)),
      density_percent(density_percent_),
      bank(bank_state(soil, density_percent)),
      loose(loose_state(soil)),
      wedges(soil, bank) {
  const double mouth = (machine.bucket.profile.back() - machine.bucket.profile.front()).norm();
  slopes.heap = std::tan(soil.angle_of_repose);
  const SoilState dug = dug_state(soil);
  slopes.face = std::tan(stable_slope(dug, mouth, soil.angle_of_repose));
}

// ---- Forces -------------------------------------------------------------------------------------

struct BucketResistance::Attitude {
  double floor;  ///< angle of the floor [rad]
  double climb;  ///< angle of the motion above the horizontal [rad]
};

/// The soil in the bucket.
struct BucketResistance::Fill {
  double weight = 0.0;         ///< [N]
  double wall_friction = 0.0;  ///< of both side plates, if it slides along them [N]
  double front = 0.0;  ///< angle from the floor to its front, packed into floor and back [rad]
  double rise = 0.0;   ///< of its centre above the lip [m]
};

/// The plane on which the wedge ahead slides up: the bucket's floor, on which it pushes what is in
/// the bucket before it, or the front of that soil, packed and at rest (secondary separation plate;
/// Blouin, Hemami and Lipsett 2001).
struct BucketResistance::SlidingFace {
  double angle = 0.0;  ///< in the boom plane [rad]
  double rake = 0.0;   ///< against the motion [rad]
  bool packed = false;
};

/// In the frame of the motion [N].
struct BucketResistance::FaceForce {
  double along = 0.0;   ///< against the motion
  double across = 0.0;  ///< away from the surface
  double borne_weight = 0.0;
  double depth = 0.0;   ///< mean over the width [m]
  double length = 0.0;  ///< of the wedge's top ahead of the lip [m]
};

/// Soil above the tip in one row: depth of the uncut bank, thickness of the loose soil on it.
struct BucketResistance::Strip {
  double bank = 0.0;
  double loose = 0.0;
};

double BucketResistance::floor_length() const {
  const std::vector<Vector2d>& profile = model_.machine.bucket.profile;
  return (profile[1] - profile[0]).norm();
}

double BucketResistance::uncut_at(Index col) const {
  return swath_.mean([&](Index row) { return ground_.before().bank.z(row, col); });
}

double BucketResistance::surface_at(Index col) const {
  return uncut_at(col) + swath_.mean([&](Index row) { return ground_.loose(row, col); });
}

Resistance BucketResistance::at(const Stretch& s, const Cavity& cavity, double fill) const {
  const Vector2d motion = s.direction();
  const double floor = s.at.phi3 + pi - model_.machine.beta();
  const Vector2d tip = 0.5 * (s.from + s.to);
  const Index col = swath_.column(tip.x());
  // The penetration moves along the floor by definition: no wedge is pushed, the lip is driven in.
  Resistance r;
  if (s.phase == DigPhase::penetrate) {
    r = drive_in(tip, col, floor, motion);
  } else {
    const double climb = std::atan2(motion.y(), -motion.x());
    r = push_wedge(tip, col, {floor, climb}, fill_in(cavity, fill), motion);
  }
  press_heel(s, cavity, r);
  return r;
}

BucketResistance::Fill BucketResistance::fill_in(const Cavity& cavity, double volume) const {
  const SoilState& loose = model_.loose;
  const Cavity::Packed packed = cavity.packed(volume);
  const double section = volume / model_.machine.bucket.width_inside;
  const double depth = section / floor_length();
  return {volume * loose.unit_weight,
          2.0 * section * at_rest_pressure(loose, depth) * std::tan(loose.tool_friction_angle),
          packed.front, packed.centroid.y()};
}

/// Lip and teeth against the cone index, friction on both sides of the floor and of the side
/// plates.
Resistance BucketResistance::drive_in(const Vector2d& tip, Index col, double floor,
                                      const Vector2d& motion) const {
  const double depth = surface_at(col) - tip.y();
  Resistance r;
  if (!(depth > 0.0)) return r;
  const SoilState soil = mean_soil_at(col);
  const double along = std::sin(floor) + std::tan(surface_slope(col)) * std::cos(floor);
  const double driven = depth / std::max(1e-3, along);
  const double buried = std::min(driven, floor_length());
  const double plates =
      2.0 * buried * model_.machine.bucket.width_outside + 4.0 * side_plate_area(depth, floor);
  r.edge = cone_index(model_.soil, soil, depth) * penetrating_area(driven, depth, soil);
  r.lip_force = -motion * (r.edge + plate_friction(soil, depth) * plates);
  r.face_point = tip;
  return r;
}

/// Earthmoving equation per strip of the edge: the wedge slides up the floor, or up the soil packed
/// on it if that is easier.
Resistance BucketResistance::push_wedge(const Vector2d& tip, Index col, const Attitude& attitude,
                                        const Fill& fill, const Vector2d& motion) const {
  const double edge = model_.machine.bucket.edge_angle;
  const double turn = std::clamp(attitude.climb, 0.0, 0.5 * pi);
  const auto face_at = [&](double angle, bool packed) {
    return SlidingFace{angle, std::max({angle, angle + attitude.climb, edge}), packed};
  };
  SlidingFace face = face_at(attitude.floor, false);
  FaceForce force = slide(face, tip, col, turn, fill);
  if (fill.front > 0.0) {
    const SlidingFace packed = face_at(attitude.floor + fill.front, true);
    if (const FaceForce other = slide(packed, tip, col, turn, fill); other.along < force.along) {
      face = packed;
      force = other;
    }
  }
  const SoilState soil = mean_soil_at(col);
  const double depth = force.depth;
  const Vector2d up(-motion.y(), motion.x());  // left of the motion, which is towards -x: down
  Resistance r;
  r.edge = edge_force(depth, attitude.climb, soil);
  r.lip_force = -motion * r.edge;
  const double along = force.along + 2.0 * side_plate_area(depth, std::max(attitude.floor, edge)) *
                                         plate_friction(soil, depth);
  r.face_force = -motion * along + up * force.across;
  const double lever = std::min(depth / (3.0 * std::sin(face.rake)), floor_length());
  r.face_point = tip + lever * Vector2d(std::cos(face.angle), std::sin(face.angle));
  r.borne_weight = force.borne_weight;
  r.wedge_length = force.length;
  return r;
}

/// Terms of the wedge's force that do not depend on the depth of the strip.
struct BucketResistance::FaceTerms {
  FaceTerms(const SoilState& state, const EarthmovingFactors& factors, bool packed)
      : soil(state),
        n(factors),
        adhesion(packed ? state.cohesion : state.adhesion),
        sin_face(std::sin(n.rake + friction(packed))),
        cos_face(std::cos(n.rake + friction(packed))),
        cot_rake(1.0 / std::tan(n.rake)),
        cot_failure(1.0 / std::tan(n.failure)),
        tan_friction(std::tan(state.friction_angle)) {}

  double friction(bool packed) const {
    return packed ? soil.friction_angle : soil.tool_friction_angle;
  }

  SoilState soil;
  EarthmovingFactors n;
  double adhesion;
  double sin_face, cos_face, cot_rake, cot_failure, tan_friction;
};

BucketResistance::FaceForce BucketResistance::slide(const SlidingFace& face, const Vector2d& tip,
                                                    Index col, double turn,
                                                    const Fill& fill) const {
  const Vector2d up = model_.machine.up();
  const double slope = surface_slope(col) - std::atan2(up.x(), up.y());  // as gravity sees it
  // Where the bucket rises it pushes no wedge: the passive force decreases with the cosine of the
  // climb, and the bucket shears off the soil above it instead.
  const double fade = std::cos(turn);
  FaceForce force;
  double on_face = 0.0;  // weight of the part of the wedge that lies over the face
  const auto push = [&](double passive, double adhesion, const FaceTerms& t) {
    force.along += fade * (passive * t.sin_face + adhesion * t.cot_rake);
    force.across += fade * (passive * t.cos_face - adhesion);
  };
  const auto terms_of = [&](const SoilState& soil) {
    return FaceTerms(soil, model_.wedges.at(face.rake, slope, soil, face.packed), face.packed);
  };
  const FaceTerms mean = terms_of(mean_soil_at(col));
  const bool even = ground_.bank_is_even();
  for (Index i = 0; i < swath_.rows(); ++i) {
    const Index row = swath_.first_row() + i;
    const double width = swath_.cover(i) * ground_.cell_size();
    const Strip strip = strip_at(row, col, tip.y());
    if (strip.bank + strip.loose <= 0.0) continue;
    const FaceTerms t = even ? mean : terms_of(ground_.bank_state(row, col));
    const double loose = loose_on_wedge(row, col, strip, t);
    push(width * passive_force(strip, loose, t), width * t.adhesion * strip.bank, t);
    force.along += width * (1.0 - fade) * shearing_force(strip, fill.rise, t);
    on_face += width * 0.5 * t.soil.unit_weight * strip.bank * strip.bank * t.cot_rake;
    force.depth += width * strip.bank;
  }
  force.depth /= model_.machine.bucket.width_outside;
  force.length = fade * force.depth * mean.cot_failure;
  if (force.depth > 0.0) {
    const SoilState& soil = mean.soil;
    const CuttingWedge wedge{mean.n.rake, soil.friction_angle, mean.friction(face.packed), 0.0};
    const SoilStrength strength = {soil.unit_weight, soil.cohesion, soil.adhesion};
    const double sides = side_plane_force(wedge, mean.n, strength, force.depth);
    push(sides * side_plane_share(wedge, mean.n), 0.0, mean);
  }
  if (face.packed) return force;
  // The soil in the bucket slides with the wedge: together they are in equilibrium between the face
  // and the failure plane. What lies over the face is part of it.
  const double pushed = std::max(0.0, fill.weight - on_face);
  const double wall = fill.wall_friction * std::sin(mean.n.rake);
  push(pushed * mean.n.Q + wall * mean.n.ca, wall, mean);
  force.borne_weight = fade * (on_face + pushed);
  return force;
}

/// Of the wedge in one row on the face, per metre of width [N/m].
/// @param loose  thickness of the loose soil on it [m]
double BucketResistance::passive_force(const Strip& strip, double loose, const FaceTerms& t) const {
  const double surcharge = model_.loose.unit_weight * loose;
  return strip.bank * (t.soil.unit_weight * strip.bank * t.n.gamma + t.soil.cohesion * t.n.c +
                       surcharge * t.n.q + t.adhesion * t.n.ca) +
         surcharge * loose * t.n.gamma;
}

/// What is not pushed up is sheared off and lifted to where it lies in the bucket, `rise` above the
/// lip: against the motion, per metre of width [N/m].
double BucketResistance::shearing_force(const Strip& strip, double rise, const FaceTerms& t) const {
  const double shear = t.soil.cohesion + at_rest_pressure(t.soil, strip.bank) * t.tan_friction;
  const double lifted = t.soil.unit_weight * strip.bank + model_.loose.unit_weight * strip.loose;
  const double lift = std::max(0.0, rise - 0.5 * (strip.bank + strip.loose));
  return strip.bank * shear + lifted * lift;
}

/// Loose soil over the top of the wedge, as an even layer on all of it; what lies over the face is
/// in the bucket, and payload. In loose soil alone, all of it [m].
double BucketResistance::loose_on_wedge(Index row, Index col, const Strip& strip,
                                        const FaceTerms& terms) const {
  if (!(strip.bank > 0.0)) return strip.loose;
  const double ahead = strip.bank * terms.cot_failure;
  const double cells = ahead / ground_.cell_size();
  double sum = 0.0;
  for (Index i = 0; static_cast<double>(i) < cells && col - i >= ground_.cells().col_begin; ++i) {
    sum += std::min(1.0, cells - static_cast<double>(i)) * ground_.loose(row, col - i);
  }
  return sum * ground_.cell_size() / (ahead + strip.bank * terms.cot_rake);
}

/// Where the outline behind the lip reaches below what the tip has cut, the ground bears it like a
/// footing: pressure across the outline, friction against the motion.
void BucketResistance::press_heel(const Stretch& s, const Cavity& cavity, Resistance& r) const {
  const double footing = bearing_settlement * floor_length();
  const double segments = std::min<double>(2.0, static_cast<double>(cavity.corners() - 1));
  constexpr double least_sunk = 1e-6;  // rounding of a floor that runs along itself [m]
  double pressed = 0.0;
  std::size_t behind = s.pose;
  const Vector2d motion = s.direction();
  for (int i = 0; i < heel_samples; ++i) {
    const double along = segments * (i + 0.5) / heel_samples;
    const auto k = static_cast<std::size_t>(along);
    const Vector2d side = cavity.corner(k + 1) - cavity.corner(k);
    const Vector2d point = s.at.tip + cavity.corner(k) + (along - std::floor(along)) * side;
    if (!(point.x() > s.to.x() && swept_to(point.x(), behind) > point.y() + least_sunk)) continue;
    const double level = std::min(swept_to(point.x(), behind), uncut_between(point.x()));
    const double sunk = level - point.y();
    if (!(sunk > least_sunk)) continue;
    const Index col = swath_.column(point.x());
    const SoilState soil = mean_soil_at(col);
    const double depth = std::max(0.0, uncut_at(col) - point.y());
    const double pressure =
        std::min(1.0, sunk / footing) * bearing_capacity(soil, depth, floor_length());
    const double area = side.norm() * segments / heel_samples * model_.machine.bucket.width_outside;
    const Vector2d inward = Vector2d(-side.y(), side.x()).normalized();
    const double force = pressure * area;
    r.heel_force += force * (inward - std::tan(soil.tool_friction_angle) * motion);
    r.heel_point += force * point;
    pressed += force;
  }
  if (pressed > 0.0) r.heel_point /= pressed;
}

/// Level that the tip has left at x behind the lip; infinite where it has not been. `pose` is where
/// the search starts and, afterwards, where x was found.
double BucketResistance::swept_to(double x, std::size_t& pose) const {
  const std::vector<DigPose>& poses = path_.poses;
  while (pose > 0 && poses[pose].bucket.x < x) --pose;
  const BucketPose& behind = poses[pose].bucket;
  if (behind.x < x) return std::numeric_limits<double>::infinity();
  const BucketPose& ahead = poses[pose + 1].bucket;
  const double share = std::min(1.0, (x - ahead.x) / (behind.x - ahead.x));
  return ahead.z + share * (behind.z - ahead.z);
}

/// uncut_at() between the centres of cells, so that slopes have no steps; -infinity where unknown.
double BucketResistance::uncut_between(double x) const {
  const HeightMap& map = ground_.before().bank;
  const auto last = static_cast<double>(map.z.cols() - 1);
  const double at = std::clamp((x - map.origin.x()) / map.cell_size - 0.5, 0.0, last);
  const auto col = static_cast<Index>(at);
  const double t = at - static_cast<double>(col);
  const double uncut =
      (1.0 - t) * uncut_at(col) + t * uncut_at(std::min(col + 1, map.z.cols() - 1));
  return std::isnan(uncut) ? -std::numeric_limits<double>::infinity() : uncut;
}

// ---- Parts of them ------------------------------------------------------------------------------

BucketResistance::Strip BucketResistance::strip_at(Index row, Index col, double tip_z) const {
  const double bank = ground_.before().bank.z(row, col) - tip_z;
  const double loose = ground_.loose(row, col);
  if (!(bank + loose > 0.0)) return {};
  return {std::max(0.0, bank), std::min(loose, bank + loose)};
}

SoilState BucketResistance::mean_soil_at(Index col) const {
  if (ground_.bank_is_even()) return model_.bank;
  const double e = swath_.mean([&](Index row) { return ground_.bank_void_ratio(row, col); });
  return checked_bank_state(model_.soil,
                            std::clamp(e, model_.soil.void_ratio_min, model_.soil.void_ratio_max));
}

/// Slope of the surface ahead of the lip along the travel, positive uphill.
double BucketResistance::surface_slope(Index col) const {
  const auto reach = std::max<Index>(1, std::lround(slope_reach / ground_.cell_size()));
  const Index ahead = std::max<Index>(0, col - reach);
  if (ahead == col) return 0.0;
  const double rise = uncut_at(ahead) - uncut_at(col);
  return std::isnan(rise)
             ? 0.0
             : std::atan2(rise, ground_.cell_size() * static_cast<double>(col - ahead));
}

/// Area of lip or teeth that meets soil which cannot yield, `driven` along the floor. The lip
/// between teeth follows in soil that they have broken. The cone index holds the friction on its
/// cone; teeth are other wedges.
double BucketResistance::penetrating_area(double driven, double depth,
                                          const SoilState& soil) const {
  const Bucket& bucket = model_.machine.bucket;
  if (!bucket.teeth) return std::min(bucket.edge_thickness, depth) * bucket.width_outside;
  const Teeth& teeth = *bucket.teeth;
  const double friction = std::tan(soil.tool_friction_angle);
  const double wedge =
      (1.0 + friction / std::tan(0.5 * teeth.angle)) / (1.0 + friction / std::tan(cone_half_angle));
  return std::min(1.0, driven / teeth.length) * wedge * teeth.count * teeth.width *
         std::min(teeth.thickness, depth);
}

/// Blunt lip in soil that yields towards the surface (Balovnev 1983, thin edge); the part of a
/// motion that goes down meets soil that cannot yield, and the cone index.
double BucketResistance::edge_force(double depth, double climb, const SoilState& soil) const {
  if (!(depth > 0.0)) return 0.0;
  const Bucket& bucket = model_.machine.bucket;
  const double phi = soil.friction_angle;
  const double active = (1.0 - std::sin(phi)) / (1.0 + std::sin(phi));
  const double thickness = std::min(bucket.edge_thickness, depth);
  const double pressure = 0.5 * thickness * soil.unit_weight + soil.cohesion / std::tan(phi) +
                          depth * soil.unit_weight * active;
  const double yielding = pressure * blunt_edge_ratio(0.5 * pi, phi, soil.tool_friction_angle) *
                          thickness * bucket.width_outside;
  const double plunge = std::max(0.0, -std::sin(climb));
  const double driving = plunge > 0.0 ? cone_index(model_.soil, soil, depth) *
                                            penetrating_area(floor_length(), depth, soil)
                                      : 0.0;
  return (1.0 - plunge) * yielding + plunge * driving;
}

/// Side plate below the surface: the triangle between floor and surface.
double BucketResistance::side_plate_area(double depth, double floor) const {
  return std::min(0.5 * depth * depth / std::tan(floor), depth * floor_length());
}

}  // namespace excavplan
