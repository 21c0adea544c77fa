// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/section_simulator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/error.hpp>

#include "soil_section.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double pi = 3.14159265358979323846;

double square(double value) { return value * value; }

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
    clip(polygon_, rear, scratch_);
    AreaCentre result = area_centre(polygon_);
    result.area *= bucket_.width_inside;
    if (top.x() > 0.0) result.area += heaped(top, face, rear, slopes.heap);
    return result;
  }

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

// ---- Resistance ---------------------------------------------------------------------------------

/// The soil's force on the bucket, (x, z), and where it acts.
struct Resistance {
  Vector2d force = Vector2d::Zero();
  Vector2d point = Vector2d::Zero();
  double on_floor = 0.0;  ///< volume of payload whose weight is in the force already [m^3]
};

struct Cutting {
  BucketPose tip;
  Vector2d motion = Vector2d::Zero();  ///< unit vector
  GroundAhead ground;
  double pile = 0.0;  ///< height of the pile at the lip [m]
};

class SoilResistance {
 public:
  SoilResistance(const Machine& machine, const SoilKind& kind, const SoilState& bank,
                 const SoilState& loose, const CriticalWedges& wedges)
      : bucket_(machine.bucket), kind_(kind), bank_(bank), loose_(loose), wedges_(wedges) {
    floor_length_ = (bucket_.profile[1] - bucket_.profile[0]).norm();
  }

  /// The floor runs along itself: cone index on the lip, friction on floor and side plates.
  Resistance driving_in(const Cutting& cut, BucketSection& section) const {
    const double depth = cut.ground.surface - cut.tip.z;
    Resistance result;
    result.point = {cut.tip.x, cut.tip.z};
    if (!(depth > 0.0)) return result;
    const double sine = std::max(1e-3, std::sin(cut.tip.floor_angle));
    const double floor = std::min(floor_length_, depth / sine) * bucket_.width_outside;
    const Below ground = {depth, -std::tan(cut.ground.slope)};
    const AreaCentre plate = section.buried(ground);
    const double sides = friction(depth - plate.centre.y()) * plate.area;
    const double force = cone_index(kind_, bank_, depth) * lip_area() +
                         2.0 * friction(0.5 * depth) * floor + 4.0 * sides;
    result.force = -force * cut.motion;
    return result;
  }

  /// A wedge of soil slides up ahead of the face.
  Resistance shearing(const Cutting& cut) const {
    Resistance result;
    result.point = {cut.tip.x, cut.tip.z};
    const double alpha = cut.ground.slope;
    const double bank_depth = (cut.ground.bank - cut.tip.z) * std::cos(alpha);
    const double loose_above = cut.ground.surface - cut.ground.bank + cut.pile;
    const double all_depth = bank_depth + loose_above * std::cos(alpha);
    if (!(all_depth > 0.0)) return result;
    const bool in_bank = bank_depth > 0.0;
    const SoilState& soil = in_bank ? bank_ : loose_;
    const double depth = in_bank ? bank_depth : all_depth;
    const double climb = std::asin(std::clamp(cut.motion.y(), -1.0, 1.0));
    const double frame = std::max(alpha, climb);
    const double rake = std::max(cut.tip.floor_angle + frame, bucket_.edge_angle);
    const Face face = pushed(soil, depth, rake, alpha, in_bank ? loose_above : 0.0);
    const double fade = climb > 0.0 ? std::cos(climb) : 1.0;
    const Vector2d along(std::cos(frame), -std::sin(frame));
    const Vector2d normal(std::sin(frame), std::cos(frame));
    result.force = fade * (face.along * along - face.down * normal);
    result.force.y() -= (1.0 - fade) * sheared_off(soil, depth, face.surcharge);
    const double descent = std::max(0.0, -cut.motion.y());
    result.force -= lip(soil, depth, face.surcharge, descent) * cut.motion;
    const double up_face = std::min(depth / 3.0, floor_length_ * std::sin(face.rake));
    result.point += up_face / std::sin(face.rake) *
                    Vector2d(std::cos(cut.tip.floor_angle), std::sin(cut.tip.floor_angle));
    result.on_floor = fade * face.on_floor;
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

  Face pushed(const SoilState& soil, double depth, double rake, double slope,
              double loose_above) const {
    const double width = bucket_.width_outside;
    const double delta = bank_.tool_friction_angle;
    const EarthmovingFactors n = wedges_.at(rake, slope);
    // As the table holds them.
    const CuttingWedge wedge = {std::clamp(rake, 10.0 * pi / 180.0, 2.0), bank_.friction_angle,
                                delta, slope};
    Face face;
    face.rake = wedge.rake;
    face.surcharge = loose_.unit_weight * mean_over(loose_above, depth, wedge, n);
    const double t = depth;
    const double flat = soil.unit_weight * t * t * n.gamma + soil.cohesion * t * n.c +
                        face.surcharge * t * n.q + soil.adhesion * t * n.ca;
    const SoilStrength strength = {soil.unit_weight, soil.cohesion, soil.adhesion};
    const double force = flat * width + side_plane_force(wedge, n, strength, t) *
                                            std::max(0.0, side_plane_share(wedge, n));
    const double adhesion = soil.adhesion * t * width;
    const double cot_rake = 1.0 / std::tan(wedge.rake);
    face.along = force * std::sin(wedge.rake + delta) + adhesion * cot_rake;
    face.down = force * std::cos(wedge.rake + delta) - adhesion;
    const double on_face = 0.5 * t * std::min(t * cot_rake, floor_length_);
    face.on_floor = std::max(0.0, on_face) * width * soil.unit_weight / loose_.unit_weight;
    return face;
  }

  /// Mean height of a pile over the top of the wedge.
  double mean_over(double height, double depth, const CuttingWedge& wedge,
                   const EarthmovingFactors& n) const {
    const double top = depth * (1.0 / std::tan(wedge.rake) + 1.0 / std::tan(n.failure));
    const double base = height / std::tan(kind_.angle_of_repose);
    return base < top ? 0.5 * height * base / top : height * (1.0 - 0.5 * top / base);
  }

  /// Shear on a vertical plane ahead of the lip [N].
  double sheared_off(const SoilState& soil, double depth, double surcharge) const {
    const double rest = 1.0 - std::sin(bank_.friction_angle);
    const double pressure = rest * (0.5 * soil.unit_weight * depth + surcharge);
    return (soil.cohesion + pressure * std::tan(bank_.friction_angle)) * depth *
           bucket_.width_outside;
  }

  /// The flat front of the lip; it pushes aside soil that can yield, and drives into soil that
  /// cannot.
  double lip(const SoilState& soil, double depth, double surcharge, double descent) const {
    const double phi = bank_.friction_angle;
    const double active = (1.0 - std::sin(phi)) / (1.0 + std::sin(phi));
    const double pressure = 0.5 * soil.unit_weight * bucket_.edge_thickness +
                            soil.cohesion / std::tan(phi) + surcharge +
                            soil.unit_weight * depth * active;
    const double yielding = blunt_edge_ratio(0.5 * pi, phi, bank_.tool_friction_angle) * pressure;
    const double held = descent > 0.0 ? cone_index(kind_, soil, depth) : 0.0;
    return ((1.0 - descent) * yielding + descent * held) * lip_area();
  }

  double lip_area() const { return bucket_.width_outside * bucket_.edge_thickness; }

  /// Friction on steel under the pressure at rest at this depth [Pa].
  double friction(double depth) const {
    const double rest = 1.0 - std::sin(bank_.friction_angle);
    return bank_.adhesion +
           rest * bank_.unit_weight * std::max(0.0, depth) * std::tan(bank_.tool_friction_angle);
  }

  const Bucket& bucket_;
  const SoilKind& kind_;
  const SoilState& bank_;
  const SoilState& loose_;
  const CriticalWedges& wedges_;
  double floor_length_ = 0.0;
};

/// Dry mass above a level; unknown cells weigh nothing [kg].
double solids(const Terrain& terrain, double above, const SoilState& bank, const SoilState& loose) {
  const auto& z = terrain.bank.z;
  const auto known = z == z;
  const double area = square(terrain.bank.cell);
  return area * (bank.dry_density * known.select((z - above).max(0.0), 0.0).sum() +
                 loose.dry_density * known.select(terrain.loose, 0.0).sum());
}

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

struct Soil {
  const SoilKind& kind;
  const SoilState& bank;
  const SoilState& loose;
  const CriticalWedges& wedges;
  const HoldingSlopes& slopes;
};

class SectionDig {
 public:
  SectionDig(const Machine& machine, const Soil& soil, const Terrain& terrain, const DigPath& path,
             const DigOptions& options)
      : machine_(machine),
        soil_(soil),
        path_(path),
        options_(options),
        bucket_(machine.bucket),
        resistance_(machine, soil.kind, soil.bank, soil.loose, soil.wedges),
        section_(terrain, machine.bucket.width_outside, tip_range(path).first,
                 tip_range(path).second),
        swell_((1.0 + soil.loose.void_ratio) / (1.0 + soil.bank.void_ratio)),
        repose_(std::tan(soil.kind.angle_of_repose)) {
    result_.terrain = terrain;
  }

  DigResult run() {
    const double deepest =
        std::min_element(path_.poses.begin(), path_.poses.end(), [](auto& a, auto& b) {
          return a.bucket.z < b.bucket.z;
        })->bucket.z;
    result_.soil.solids_before = solids(result_.terrain, deepest, soil_.bank, soil_.loose);
    std::size_t i = 1;
    for (; i < path_.poses.size() && path_.poses[i].phase != DigPhase::lift; ++i) {
      if (!dig_step(path_.poses[i - 1], path_.poses[i])) break;
    }
    if (!result_.stall) {
      for (; i < path_.poses.size(); ++i) lift_step(path_.poses[i - 1], path_.poses[i]);
    }
    settle();
    finish(deepest);
    return std::move(result_);
  }

 private:
  static std::pair<double, double> tip_range(const DigPath& path) {
    if (path.poses.size() < 2) {
      throw Error(ErrorKind::bad_input, "dig: a path has at least 2 poses, this one has " +
                                            std::to_string(path.poses.size()));
    }
    double low = path.poses.front().bucket.x;
    double high = low;
    for (const DigPose& pose : path.poses) {
      if (pose.phase == DigPhase::lift) break;
      if (!std::isfinite(pose.bucket.x) || !std::isfinite(pose.bucket.z)) {
        throw Error(ErrorKind::bad_input, "dig: every pose of the path must be finite");
      }
      low = std::min(low, pose.bucket.x);
      high = std::max(high, pose.bucket.x);
    }
    return {low, high};
  }

  double width() const { return machine_.bucket.width_outside; }

  /// How fast the pile's surface falls towards the ground ahead, per metre.
  double fall(const GroundAhead& ground) const {
    return std::max(0.25 * repose_, repose_ + std::tan(ground.slope));
  }

  /// False if a joint stalls.
  bool dig_step(const DigPose& from, const DigPose& to) {
    const JointAngles turn = to.joints - from.joints;
    const LinkPositions at = link_positions(machine_, 0.5 * (from.joints + to.joints));
    bucket_.turn_to(at.phi3);
    const Vector2d p(from.bucket.x, from.bucket.z);
    const Vector2d q(to.bucket.x, to.bucket.z);
    const Resistance soil = resist(
        0.5 * (p + q), q - p, 0.5 * (from.bucket.floor_angle + to.bucket.floor_angle), to.phase);
    const JointAngles by_soil = torque_against_force(machine_, at, soil.point, soil.force);
    const JointAngles by_payload = carry(at, std::max(0.0, contents_ - soil.on_floor));
    const JointAngles by_links = torque_against_link_weight(machine_, at);
    const JointAngles torque = by_soil + by_payload + by_links;
    if (stalls(torque, to.phase)) return false;
    for (Index j = 0; j < 3; ++j) {
      if (!(torque(j) * turn(j) > 0.0)) continue;
      EnergyLedger& energy = result_.energy;
      const double work = torque(j) * turn(j);
      energy.total += work;
      energy.by_joint[static_cast<std::size_t>(j)] += work;
      energy.by_phase[phase_index(to.phase)] += work;
      energy.soil += by_soil(j) * turn(j);
      energy.payload += by_payload(j) * turn(j);
      energy.links += by_links(j) * turn(j);
    }
    travelled_ += (q - p).norm();
    cut(p, q);
    result_.peak_force = std::max(result_.peak_force, soil.force.norm());
    if (options_.history) {
      result_.history.push_back({to.phase, travelled_, soil.force, torque, contents_});
    }
    return true;
  }

  static std::size_t phase_index(DigPhase phase) {
    return phase == DigPhase::scoop ? 2 : phase == DigPhase::drag ? 1 : 0;
  }

  Resistance resist(const Vector2d& tip, const Vector2d& step, double floor_angle, DigPhase phase) {
    Cutting cutting;
    cutting.tip = {tip.x(), tip.y(), floor_angle};
    const double length = step.norm();
    if (length > 0.0) cutting.motion = step / length;
    cutting.ground = section_.ahead(tip.x());
    cutting.pile = pile_.height(fall(cutting.ground));
    return phase == DigPhase::drag || phase == DigPhase::scoop
               ? resistance_.shearing(cutting)
               : resistance_.driving_in(cutting, bucket_);
  }

  JointAngles carry(const LinkPositions& at, double volume) {
    const Vector2d centre = at.tip + bucket_.held(0.0, soil_.slopes).centre;
    return torque_against_force(machine_, at, centre, {0.0, -volume * soil_.loose.unit_weight});
  }

  bool stalls(const JointAngles& torque, DigPhase phase) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double asked = torque(static_cast<Index>(j));
      if (std::abs(asked) <= machine_.limits[j].torque) continue;
      result_.stall = Stall{phase, static_cast<Joint>(j), travelled_, asked};
      return true;
    }
    return false;
  }

  void cut(const Vector2d& p, const Vector2d& q) {
    const CutArea area = section_.cut(p, q);
    const GroundAhead ground = section_.ahead(q.x());
    const double falls = fall(ground);
    const double lip = q.y() - ground.surface;
    const double from_pile = pile_.take(p.x() - q.x(), lip, falls);
    result_.soil.bank_cut += area.bank * width();
    result_.soil.loose_cut += (area.loose + from_pile) * width();
    contents_ += (area.bank * swell_ + area.loose + from_pile) * width();
    const double support = std::max(0.0, pile_.height(falls) - lip);
    const double holds = bucket_.held(support, soil_.slopes).area;
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
    const JointAngles torque = carry(at, contents_) + torque_against_link_weight(machine_, at);
    const JointAngles turn = to.joints - from.joints;
    for (Index j = 0; j < 3; ++j) result_.energy.lift += std::max(0.0, torque(j) * turn(j));
    bucket_.turn_to(link_positions(machine_, to.joints).phi3);
    const GroundAhead ground = section_.ahead(to.bucket.x);
    const double support = ground.surface - to.bucket.z;
    const HoldingSlopes clear = {soil_.slopes.heap, soil_.slopes.heap};
    const double holds =
        support > 0.0 ? bucket_.held(support, soil_.slopes).area : bucket_.held(0.0, clear).area;
    if (contents_ <= holds) return;
    const double lost = (contents_ - holds) / width();
    dropped_ += lost;
    dropped_at_ += lost * to.bucket.x;
    contents_ = holds;
  }

  /// The pile's back, no longer held, slides into the cut; what the bucket lost lies under it.
  void settle() {
    const std::size_t last = section_.columns().size() - 1;
    if (pile_.area > 0.0) {
      const double falls = fall(section_.ahead(pile_at_));
      const double stays = pile_.area * repose_ / (repose_ + falls);
      const std::size_t edge = section_.column_at(pile_at_);
      section_.settle(pile_at_ - pile_.height(falls) / (repose_ + falls), stays, repose_, 0,
                      edge > 0 ? edge - 1 : 0);
      section_.settle(pile_at_, pile_.area - stays, repose_, edge, last);
    }
    if (dropped_ > 0.0) section_.settle(dropped_at_ / dropped_, dropped_, repose_, 0, last);
  }

  void finish(double deepest) {
    const SlopeLimits limits = {repose_, std::tan(soil_.bank.friction_angle),
                                critical_height(soil_.bank), swell_};
    SoilLedger& ledger = result_.soil;
    const LooseSoil rest = write_back(section_, limits, result_.terrain);
    ledger.spilled = rest.elsewhere;
    ledger.fallen_back = rest.in_cut;
    ledger.payload = result_.payload_volume = contents_;
    ledger.fallback_fraction = ledger.bank_cut > 0.0 ? ledger.fallen_back / ledger.bank_cut : 0.0;
    result_.payload_mass = contents_ * soil_.loose.bulk_density;
    const double carried = options_.dump_at ? 0.0 : contents_ * soil_.loose.dry_density;
    if (options_.dump_at) pour(result_.terrain, *options_.dump_at, contents_, repose_);
    ledger.solids_after = solids(result_.terrain, deepest, soil_.bank, soil_.loose) + carried;
  }

  const Machine& machine_;
  Soil soil_;
  const DigPath& path_;
  const DigOptions& options_;
  BucketSection bucket_;
  SoilResistance resistance_;
  SoilSection section_;
  double swell_;
  double repose_;
  Pile pile_;
  double pile_at_ = 0.0;
  double contents_ = 0.0;    ///< loose, in the bucket [m^3]
  double dropped_ = 0.0;     ///< by the rising bucket [m^2]
  double dropped_at_ = 0.0;  ///< sum of area times x
  double travelled_ = 0.0;
  DigResult result_;
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
    : machine_(machine),
      soil_(soil),
      bank_(bank_state(soil, density_percent)),
      loose_(loose_state(soil)),
      wedges_(bank_.friction_angle, bank_.tool_friction_angle) {
  const double mouth = (machine.bucket.profile.back() - machine.bucket.profile.front()).norm();
  slopes_.heap = std::tan(soil.angle_of_repose);
  slopes_.face = std::tan(stable_slope(bank_state(soil, 0.0), mouth, soil.angle_of_repose));
}

DigResult SectionSimulator::dig(const Terrain& terrain, const DigPath& path,
                                const DigOptions& options) const {
  return SectionDig(machine_, {soil_, bank_, loose_, wedges_, slopes_}, terrain, path, options)
      .run();
}

}  // namespace excavplan
