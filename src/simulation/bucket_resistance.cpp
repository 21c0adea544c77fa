// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/bucket_resistance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angles.hpp"
#include "earth/dig_kernels.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Numbers of our own choice; reasons: docs/methods.md#simulation.
// The surface's slope is taken over this ahead of the lip, or as far as the lip is deep [m].
constexpr double slope_reach = 0.30;
constexpr int heel_samples = 12;  // of the outline behind the lip

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
      wedges(soil, bank, loose) {
  const double mouth = (machine.bucket.profile.back() - machine.bucket.profile.front()).norm();
  slopes.heap = std::tan(soil.angle_of_repose);
  const SoilState dug = dug_state(soil);
  slopes.face = std::tan(stable_slope(dug, mouth, soil.angle_of_repose));
}

// ---- Forces -------------------------------------------------------------------------------------

/// Where the blade is in one stretch, and what it cuts there.
struct BucketResistance::Place {
  explicit Place(const CutSoil& above) : soil(above) {}

  Vector2d tip;
  Vector2d lip;  ///< the ground is cut up to here
  Index col = 0;
  Vector2d motion;
  double floor = 0.0;  ///< angle of the floor [rad]
  double slope = 0.0;  ///< of the surface ahead along the travel, as gravity sees it [rad]
  CutSoil soil;        ///< the layers' states; their depths where they are taken at the tip

  double climb = 0.0;  ///< of the motion [rad]
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
  /// Where the bucket rises it pushes no wedge: the passive force decreases with the cosine of the
  /// climb, and the bucket shears off the soil above it instead.
  double fade = 1.0;
  double along = 0.0;    ///< against the motion
  double across = 0.0;   ///< away from the surface
  double on_face = 0.0;  ///< weight of the part of the wedge that lies over the face
  double borne_weight = 0.0;
  double bank_depth = 0.0;   ///< mean over the width [m]
  double loose_depth = 0.0;  ///< likewise
  double length = 0.0;       ///< of the wedge's top ahead of the lip [m]

  void push(double passive, double adhesion, const FaceTerms& t) {
    along += fade * (passive * t.n.sin_face + adhesion * t.n.cot_rake);
    across += fade * (passive * t.n.cos_face - adhesion);
  }
};

double BucketResistance::floor_length() const {
  const std::vector<Vector2d>& profile = model_.machine.bucket.profile;
  return (profile[1] - profile[0]).norm();
}

const BucketResistance::Column& BucketResistance::column(Index col) {
  const auto i = static_cast<std::size_t>(col - first_col_);  // huge where it is before the first
  if (i >= columns_.size()) return beyond_ = look_at(col);
  if (!columns_[i].seen) columns_[i] = look_at(col);
  return columns_[i];
}

BucketResistance::Column BucketResistance::look_at(Index col) const {
  const Terrain& before = ground_.before();
  return {true, swath_.mean([&](Index row) { return before.bank.z(row, col); }),
          swath_.mean([&](Index row) { return before.bank.z(row, col) + before.loose(row, col); })};
}

Resistance BucketResistance::at(const Stretch& s, const Cavity& cavity, double fill) {
  const Vector2d tip = 0.5 * (s.from + s.to);
  const Index col = swath_.column(tip.x());
  Place place(soil_above(col, tip.y()));
  place.tip = tip;
  place.lip = s.from;
  place.col = col;
  place.motion = s.direction();
  place.climb = std::atan2(place.motion.y(), -place.motion.x());
  place.floor = s.at.phi3 + pi - model_.machine.beta();
  const double depth = surface_at(place.col) - place.tip.y();
  place.slope = surface_slope(place.col, depth) - tilt_;
  // The penetration moves along the floor by definition: no wedge is pushed, the lip is driven in.
  Resistance r =
      s.phase == DigPhase::penetrate ? drive_in(place) : push_wedge(place, fill_in(cavity, fill));
  press_heel(s, cavity, r);
  return r;
}

BucketResistance::Fill BucketResistance::fill_in(const Cavity& cavity, double volume) const {
  const LayerSoil& loose = model_.loose;
  const Cavity::Packed packed = cavity.packed(volume);
  const double section = volume / model_.machine.bucket.width_inside;
  const double depth = section / floor_length();
  return {volume * loose.unit_weight,
          section * loose.rest.pressure * loose.unit_weight * depth * loose.tool_tangent,
          packed.front, packed.centroid.y()};
}

/// Lip and teeth against the cone index, friction on both sides of the floor and of the side
/// plates. What lies on the ground is part of it.
Resistance BucketResistance::drive_in(const Place& place) {
  const double depth = surface_at(place.col) + pile_at(place) - place.tip.y();
  Resistance r;
  if (!(depth > 0.0)) return r;
  CutSoil cut = place.soil;
  cut.loose_depth = depth - cut.bank_depth;
  const double along =
      std::sin(place.floor) + std::tan(surface_slope(place.col, 0.0)) * std::cos(place.floor);
  const double driven = depth / std::max(1e-3, along);
  const double buried = std::min(driven, floor_length());
  const double plates = 2.0 * buried * model_.machine.bucket.width_outside +
                        4.0 * side_plate_area(depth, place.floor);
  r.edge = driving_force(cut, driven);
  r.lip_force = -place.motion * (r.edge + cut.plate_friction() * plates);
  r.face_point = place.tip;
  return r;
}

/// Earthmoving equation per strip of the edge: the wedge slides up the floor, or up the soil packed
/// on it if that is easier.
Resistance BucketResistance::push_wedge(const Place& place, const Fill& fill) {
  const double edge = model_.machine.bucket.edge_angle;
  const auto face_at = [&](double angle, bool packed) {
    return SlidingFace{angle, std::max({angle, angle + place.climb, edge}), packed};
  };
  const StripColumn column = column_at(place);
  strips_.find_piles(column);
  strips_.find(column, ground_.cell_size());
  SlidingFace face = face_at(place.floor, false);
  FaceForce force = slide(face, place, fill);
  if (fill.front > 0.0) {
    const SlidingFace packed = face_at(place.floor + fill.front, true);
    if (const FaceForce other = slide(packed, place, fill); other.along < force.along) {
      face = packed;
      force = other;
    }
  }
  CutSoil cut = place.soil;
  cut.bank_depth = force.bank_depth;
  cut.loose_depth = force.loose_depth;
  const double depth = cut.depth();
  const Vector2d& motion = place.motion;
  const Vector2d up(-motion.y(), motion.x());  // left of the motion, which is towards -x: down
  Resistance r;
  r.edge = edge_force(cut, place.climb);
  r.lip_force = -motion * r.edge;
  const double along = force.along + 2.0 * side_plate_area(depth, std::max(place.floor, edge)) *
                                         cut.plate_friction();
  r.face_force = -motion * along + up * force.across;
  const double lever = std::min(depth / (3.0 * std::sin(face.rake)), floor_length());
  r.face_point = place.tip + lever * Vector2d(std::cos(face.angle), std::sin(face.angle));
  r.borne_weight = force.borne_weight;
  r.wedge_length = force.length;
  return r;
}

FaceTerms BucketResistance::terms_of(const RestingSoil& soil, const SlidingFace& face,
                                     double slope) const {
  return {soil, model_.wedges.at(face.rake, slope, soil, face.packed), face.packed};
}

/// Each layer is pushed by its own soil: the passive pressure in it depends on its strength and on
/// the weight of what lies above.
BucketResistance::FaceForce BucketResistance::slide(const SlidingFace& face, const Place& place,
                                                    const Fill& fill) {
  const LayerTerms mean = {terms_of(place.soil.bank, face, place.slope),
                           terms_of(place.soil.loose, face, place.slope)};
  FaceForce force;
  force.fade = std::cos(std::clamp(place.climb, 0.0, 0.5 * pi));
  push_strips(face, place, mean, fill.rise, force);
  const SideForces sides = side_forces(force, mean);
  force.push(sides.bank, 0.0, mean.bank);
  force.push(sides.loose, 0.0, mean.loose);
  force.length = force.fade * (force.bank_depth * mean.bank.n.cot_failure +
                               force.loose_depth * mean.loose.n.cot_failure);
  if (face.packed) return force;
  // The soil in the bucket slides with the wedge: together they are in equilibrium between the face
  // and the failure plane. What lies over the face is part of it.
  const double pushed = std::max(0.0, fill.weight - force.on_face);
  const double depth = force.bank_depth + force.loose_depth;
  const double in_bank = depth > 0.0 ? force.bank_depth / depth : 0.0;
  const auto push_fill = [&](double share, const FaceTerms& t) {
    const double wall = fill.wall_friction * std::sin(t.n.rake);
    force.push(share * (pushed * t.n.Q + wall * t.n.ca), share * wall, t);
  };
  push_fill(in_bank, mean.bank);
  push_fill(1.0 - in_bank, mean.loose);
  force.borne_weight = force.fade * (force.on_face + pushed);
  return force;
}

/// The wedge row by row, each with the soil of its own cell.
/// @param rise  of the soil in the bucket above the lip [m]
void BucketResistance::push_strips(const SlidingFace& face, const Place& place,
                                   const LayerTerms& mean, double rise, FaceForce& force) {
  const bool even = ground_.bank_is_even() && ground_.loose_is_even();
  const WedgeTerms wedge = {force.fade, rise, ground_.cell_size(),
                            even ? mean.loose : terms_of(model_.loose, face, place.slope)};
  std::vector<LayerTerms> own;  // of the rows, where they differ
  for (std::size_t i = 0; !even && i < strips_.count(); ++i) {
    const Index row = swath_.first_row() + static_cast<Index>(i);
    own.push_back(strips_.is_empty(i) ? mean : terms_in(row, face, place));
  }
  if (even) strips_.begin(0, strips_.count(), mean, wedge.cell);
  for (std::size_t i = 0; i < own.size(); ++i) strips_.begin(i, 1, own[i], wedge.cell);
  add_piles(place);
  StripSums sums;
  if (even) strips_.push(0, strips_.count(), mean, wedge, sums);
  for (std::size_t i = 0; i < own.size(); ++i) strips_.push(i, 1, own[i], wedge, sums);
  force.along = sums.along;
  force.across = sums.across;
  force.on_face = sums.on_face;
  force.bank_depth = sums.bank_depth / model_.machine.bucket.width_outside;
  force.loose_depth = sums.loose_depth / model_.machine.bucket.width_outside;
}

LayerTerms BucketResistance::terms_in(Index row, const SlidingFace& face,
                                      const Place& place) const {
  return {terms_of(RestingSoil(ground_.bank_state(row, place.col)), face, place.slope),
          terms_of(RestingSoil(ground_.lying_state(row, place.col)), face, place.slope)};
}

/// On the side planes of the mean wedge; that of the loose layer is also over that of the bank.
BucketResistance::SideForces BucketResistance::side_forces(const FaceForce& mean,
                                                           const LayerTerms& layers) {
  const auto wedge_of = [&](const FaceTerms& t) {
    return CuttingWedge{t.n.rake, t.soil.friction_angle, t.friction, 0.0};
  };
  const auto force = [&](const FaceTerms& t, double depth, double above) {
    const double stuck = t.soil.cohesion + above * t.shear_at_rest;
    const SoilStrength strength = {t.soil.unit_weight, stuck, t.soil.adhesion};
    return side_plane_force(t.n, strength, t.soil.rest, depth);
  };
  SideForces sides;
  const double above = layers.loose.soil.unit_weight * mean.loose_depth;
  if (mean.bank_depth > 0.0) {
    sides.bank = force(layers.bank, mean.bank_depth, above) *
                 side_plane_share(wedge_of(layers.bank), layers.bank.n);
  }
  if (mean.loose_depth > 0.0) {
    const FaceTerms& t = layers.loose;
    const double over_bank =
        mean.loose_depth * mean.bank_depth * (layers.bank.n.cot_rake + layers.bank.n.cot_failure);
    const double stress = t.soil.cohesion + 0.5 * above * t.shear_at_rest;
    sides.loose = (force(t, mean.loose_depth, 0.0) + 2.0 * over_bank * stress) *
                  side_plane_share(wedge_of(t), t.n);
  }
  return sides;
}

/// Adds what lies on the other cells of all wedges.
void BucketResistance::add_piles(const Place& place) {
  const Index row = swath_.first_row();
  const Index columns = std::min(static_cast<Index>(std::ceil(strips_.longest() - 1.0)),
                                 place.col - ground_.cells().col_begin);
  if (columns <= 0) return;
  const Eigen::ArrayXXd& lay = ground_.before().loose;
  const std::size_t next = ground_.at(row, place.col) - ground_.column_step();
  strips_.add({strips_.count(), ground_.looses(next, strips_.count()), &lay(row, place.col - 1),
               -static_cast<std::ptrdiff_t>(ground_.column_step()), -lay.rows()},
              static_cast<std::size_t>(columns));
}

/// Where the outline behind the lip reaches below what the tip has cut, the ground bears it like a
/// footing: pressure across the outline, friction against the motion.
void BucketResistance::press_heel(const Stretch& s, const Cavity& cavity, Resistance& r) {
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
    if (!(point.x() > s.to.x())) continue;
    const double swept = swept_to(point.x(), behind);
    if (!(swept > point.y() + least_sunk)) continue;
    const double level = std::min(swept, surface_between(point.x()));
    const double sunk = level - point.y();
    if (!(sunk > least_sunk)) continue;
    const Index col = swath_.column(point.x());
    const CutSoil ground = soil_above(col, point.y());
    const LayerSoil& soil = ground.bank_depth > 0.0 ? ground.bank : ground.loose;
    const double pressure =
        std::min(1.0, sunk / footing) * bearing_capacity(soil, ground.overburden(), floor_length());
    const double area = side.norm() * segments / heel_samples * model_.machine.bucket.width_outside;
    const Vector2d inward = Vector2d(-side.y(), side.x()).normalized();
    const double force = pressure * area;
    r.heel_force += force * (inward - soil.tool_tangent * motion);
    r.heel_point += force * point;
    if (!(ground.bank_depth > 0.0) && !ground_.loose_is_even()) {
      r.pressed.push_back({col, pressure});
    }
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

/// surface_at() between the centres of cells, so that slopes have no steps; -infinity where
/// unknown.
double BucketResistance::surface_between(double x) {
  const HeightMap& map = ground_.before().bank;
  const auto last = static_cast<double>(map.z.cols() - 1);
  const double at = std::clamp((x - map.origin.x()) / map.cell_size - 0.5, 0.0, last);
  const auto col = static_cast<Index>(at);
  const double t = at - static_cast<double>(col);
  const double surface =
      (1.0 - t) * surface_at(col) + t * surface_at(std::min(col + 1, map.z.cols() - 1));
  return std::isnan(surface) ? -std::numeric_limits<double>::infinity() : surface;
}

// ---- Parts of them ------------------------------------------------------------------------------

StripColumn BucketResistance::column_at(const Place& place) const {
  const HeightMap& map = ground_.before().bank;
  const Index row = swath_.first_row();
  const double right = map.origin.x() + map.cell_size * static_cast<double>(place.col + 1);
  const double length = std::clamp(right - place.lip.x(), 0.0, map.cell_size);
  return {place.tip.y(),
          length / map.cell_size,
          place.lip.y() + 0.5 * length * place.motion.y() / place.motion.x(),
          &map.z(row, place.col),
          &ground_.before().loose(row, place.col),
          ground_.looses(ground_.at(row, place.col), strips_.count()),
          swath_.covers()};
}

double BucketResistance::pile_at(const Place& place) {
  const double* piles = strips_.find_piles(column_at(place));
  return swath_.mean([&](Index row) { return piles[row - swath_.first_row()]; });
}

CutSoil BucketResistance::soil_above(Index col, double z) {
  CutSoil cut{ground_.bank_is_even() ? model_.bank : mean_bank(col),
              ground_.loose_is_even() ? model_.loose : mean_loose(col)};
  cut.bank_depth = std::max(0.0, bank_at(col) - z);
  cut.loose_depth = std::max(0.0, surface_at(col) - z - cut.bank_depth);
  return cut;
}

LayerSoil BucketResistance::mean_bank(Index col) const {
  const double e = swath_.mean([&](Index row) { return ground_.bank_void_ratio(row, col); });
  return LayerSoil(checked_bank_state(
      model_.soil, std::clamp(e, model_.soil.void_ratio_min, model_.soil.void_ratio_max)));
}

/// Of all its loose soil, or, where none lies, of soil just dug.
LayerSoil BucketResistance::mean_loose(Index col) const {
  const Terrain& before = ground_.before();
  const double thickness = swath_.mean([&](Index row) { return before.loose(row, col); });
  if (!(thickness > 0.0)) return model_.loose;
  const double sum = swath_.mean(
      [&](Index row) { return before.loose(row, col) * before.loose_void_ratio(row, col); });
  return LayerSoil(checked_loose_state(model_.soil, sum / thickness));
}

/// Slope of the surface ahead of the lip along the travel, positive uphill.
/// Of the surface over the wedge that a lip at this depth pushes: over less, the flank of a pile
/// that the wedge reaches beyond would pass for its whole top.
double BucketResistance::surface_slope(Index col, double depth) {
  const double length = depth > slope_reach ? depth : slope_reach;
  const auto reach = std::max<Index>(1, std::lround(length / ground_.cell_size()));
  const Index ahead = std::max<Index>(0, col - reach);
  if (ahead == col) return 0.0;
  const double rise = surface_at(ahead) - surface_at(col);
  return std::isnan(rise)
             ? 0.0
             : std::atan2(rise, ground_.cell_size() * static_cast<double>(col - ahead));
}

/// Area of lip or teeth that meets soil which cannot yield, `driven` along the floor. The lip
/// between teeth follows in soil that they have broken. The cone index holds the friction on its
/// cone; teeth are other wedges.
double BucketResistance::penetrating_area(double driven, double depth,
                                          const LayerSoil& soil) const {
  const Bucket& bucket = model_.machine.bucket;
  if (!bucket.teeth) return std::min(bucket.edge_thickness, depth) * bucket.width_outside;
  const Teeth& teeth = *bucket.teeth;
  const double friction = soil.tool_tangent;
  const double wedge =
      (1.0 + friction / std::tan(0.5 * teeth.angle)) / (1.0 + friction / std::tan(cone_half_angle));
  return std::min(1.0, driven / teeth.length) * wedge * teeth.count * teeth.width *
         std::min(teeth.thickness, depth);
}

/// Of lip or teeth, `driven` along the floor into soil that cannot yield [N].
double BucketResistance::driving_force(const CutSoil& cut, double driven) const {
  const Bucket& bucket = model_.machine.bucket;
  const double height = bucket.teeth ? bucket.teeth->thickness : bucket.edge_thickness;
  return cut.mean_at_point(height, [&](const LayerSoil& soil) {
    return cone_index(model_.soil, soil, cut.overburden() / soil.unit_weight) *
           penetrating_area(driven, cut.depth(), soil);
  });
}

/// Blunt lip in soil that yields towards the surface (Balovnev 1983, thin edge); the part of a
/// motion that goes down meets soil that cannot yield, and the cone index.
double BucketResistance::edge_force(const CutSoil& cut, double climb) const {
  if (!(cut.depth() > 0.0)) return 0.0;
  const Bucket& bucket = model_.machine.bucket;
  const double thickness = std::min(bucket.edge_thickness, cut.depth());
  const double pressure = cut.mean_at_point(thickness, [&](const LayerSoil& soil) {
    return (0.5 * thickness * soil.unit_weight + soil.cohesion / soil.rest.tangent +
            cut.overburden() * soil.active) *
           soil.blunt_edge;
  });
  const double yielding = pressure * thickness * bucket.width_outside;
  const double plunge = std::max(0.0, -std::sin(climb));
  const double driving = plunge > 0.0 ? driving_force(cut, floor_length()) : 0.0;
  return (1.0 - plunge) * yielding + plunge * driving;
}

/// Side plate below the surface: the triangle between floor and surface.
double BucketResistance::side_plate_area(double depth, double floor) const {
  return std::min(0.5 * depth * depth / std::tan(floor), depth * floor_length());
}

}  // namespace excavplan
