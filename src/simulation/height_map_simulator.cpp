// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/height_map_simulator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <excavplan/error.hpp>

#include "soil_layers.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;

constexpr double pi = 3.14159265358979323846;

// Numbers of our own choice; docs/methods.md#simulation says why.
constexpr double sweeps_per_step = 10.0;  // of slumping while the bucket moves, on 5 cm cells; as
                                          // many more as a slide takes on smaller ones
constexpr int sweeps_at_the_end = 2000;   // until all is at rest; a dig needs some tens
constexpr double spread_ahead = 0.15;     // overflow lands within this ahead of the lip [m]
constexpr double steepest_face =
    80.0 * pi / 180.0;                // of soil in the bucket, however cohesive [rad]
constexpr double slope_reach = 0.30;  // the surface's slope is taken over this ahead of the lip [m]

/// Turns a point of the bucket frame, relative to the tip, into the boom plane.
Vector2d turned(const Vector2d& v, double phi3) {
  return {v.x() * std::cos(phi3) - v.y() * std::sin(phi3),
          v.x() * std::sin(phi3) + v.y() * std::cos(phi3)};
}

Vector2d centroid(const std::vector<Vector2d>& polygon) {
  Vector2d sum = Vector2d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double cross = a.x() * b.y() - b.x() * a.y();
    area += cross;
    sum += cross * (a + b);
  }
  return sum / (3.0 * area);
}

/// Soil in the bucket is as loose as it gets, but moist soil keeps the cohesion of that state.
SoilState dug_state(const SoilKind& soil) {
  const double density =
      (soil.void_ratio_max - soil.void_ratio_loose) / (soil.void_ratio_max - soil.void_ratio_min);
  return bank_state(soil, 100.0 * std::clamp(density, 0.0, 1.0));
}

/// One stretch of the path: the tip goes from `from` to `to` while the joints turn by `turn`.
struct Stretch {
  DigPhase phase = DigPhase::penetrate;
  Vector2d from;
  Vector2d to;
  JointAngles joints;  ///< half-way
  JointAngles turn;
  LinkPositions at;  ///< half-way
  double length = 0.0;

  Vector2d direction() const { return (to - from) / length; }
};

/// What the soil does to the bucket: a force in the face, one at the lip.
struct Resistance {
  Vector2d face_force = Vector2d::Zero();
  Vector2d face_point = Vector2d::Zero();
  Vector2d lip_force = Vector2d::Zero();
  double borne_weight = 0.0;  ///< of the soil on the face, which the payload must not count again

  Vector2d total() const { return face_force + lip_force; }
};

/// One dig from its first pose to its end.
class Dig {
 public:
  Dig(const Machine& machine, const SoilKind& soil, const SoilState& bank, const SoilState& loose,
      const CriticalWedges& wedges, const HoldingSlopes& slopes, const Terrain& terrain)
      : machine_(machine),
        soil_(soil),
        bank_(bank),
        loose_(loose),
        wedges_(wedges),
        slopes_(slopes),
        terrain_(terrain),
        swell_((1.0 + loose.void_ratio) / (1.0 + bank.void_ratio)),
        limits_{std::tan(soil.angle_of_repose), std::tan(bank.friction_angle),
                critical_height(bank), swell_} {
    result_.terrain = terrain;
    sweeps_ = static_cast<int>(
        std::ceil(sweeps_per_step * std::max(1.0, std::pow(0.05 / terrain.bank.cell, 2))));
    find_rows();
  }

  DigResult run(const DigPath& path, const DigOptions& options) {
    deepest_ = std::numeric_limits<double>::infinity();
    for (const DigPose& pose : path.poses) deepest_ = std::min(deepest_, pose.bucket.z);
    result_.soil.solids_before = solids();
    for (std::size_t i = 0; i + 1 < path.poses.size() && !result_.stall; ++i) {
      advance(stretch(path.poses[i], path.poses[i + 1]), options.history);
    }
    come_clear(path.poses.back());
    settle_accounts();
    if (options.dump_at) {
      pour(result_.terrain, *options.dump_at, fill_, limits_.loose_slope);
      result_.soil.solids_after = solids();
    }
    return std::move(result_);
  }

 private:
  /// Rows that the bucket covers, and how much of each.
  void find_rows() {
    const HeightMap& map = terrain_.bank;
    const double half = 0.5 * machine_.bucket.width_outside;
    const double first = (-half - map.origin.y()) / map.cell;
    const double last = (half - map.origin.y()) / map.cell;
    if (!(first >= 0.0 && last <= static_cast<double>(map.z.rows()))) {
      throw Error(ErrorKind::bad_input,
                  "dig: the map must hold the bucket's width, y = " + std::to_string(-half) +
                      " .. " + std::to_string(half) + " m");
    }
    first_row_ = static_cast<Index>(std::floor(first));
    const auto end = std::min(map.z.rows(), static_cast<Index>(std::ceil(last)));
    cover_.resize(end - first_row_);
    for (Index i = 0; i < cover_.size(); ++i) {
      const auto row = static_cast<double>(first_row_ + i);
      cover_(i) = std::min(last, row + 1.0) - std::max(first, row);
    }
  }

  Index column(double x) const {
    const HeightMap& map = terrain_.bank;
    const double col = std::floor((x - map.origin.x()) / map.cell);
    if (!(col >= 0.0 && col < static_cast<double>(map.z.cols()))) {
      throw Error(ErrorKind::bad_input, "dig: the path leaves the map at x = " + std::to_string(x) +
                                            " m; the map reaches from " +
                                            std::to_string(map.extent().x_min) + " to " +
                                            std::to_string(map.extent().x_max) + " m");
    }
    return static_cast<Index>(col);
  }

  /// Mean over the bucket's width of a column of a layer.
  double mean_of(const ArrayXXd& layer, Index col) const {
    return (layer(Eigen::seqN(first_row_, cover_.size()), col) * cover_).sum() / cover_.sum();
  }
  double uncut_at(Index col) const { return mean_of(terrain_.bank.z, col); }
  double surface_at(Index col) const { return uncut_at(col) + mean_of(result_.terrain.loose, col); }

  Stretch stretch(const DigPose& a, const DigPose& b) const {
    Stretch s;
    s.phase = b.phase;
    s.from = {a.bucket.x, a.bucket.z};
    s.to = {b.bucket.x, b.bucket.z};
    s.joints = 0.5 * (a.joints + b.joints);
    s.turn = b.joints - a.joints;
    s.at = link_positions(machine_, s.joints);
    s.length = (s.to - s.from).norm();
    return s;
  }

  void advance(const Stretch& s, bool history) {
    const Resistance resistance =
        s.length > 0.0 && s.phase != DigPhase::lift ? resist(s) : Resistance{};
    account(s, resistance, history);
    if (result_.stall) return;
    travelled_ += s.length;
    if (s.phase != DigPhase::lift) {
      cut(s);
      const Index ahead = column(s.to.x() - terrain_.bank.cell);
      const double support = std::max(0.0, surface_at(ahead) - s.to.y());
      overflow(s.to.x(), s.at.phi3, support, slopes_);
      moving_ = slump(result_.terrain, moving_, loose_only(), sweeps_, under_bucket(s.to));
    }
  }

  /// Cells that the bucket stands on behind its lip, if it is in the ground: no soil gets there.
  CellBlock under_bucket(const Vector2d& tip) const {
    const Index lip = column(tip.x());
    if (!(surface_at(lip) > tip.y())) return {};
    const auto length = static_cast<Index>(std::ceil(floor_length() / terrain_.bank.cell));
    return {first_row_, first_row_ + cover_.size(), lip + 1,
            std::min(lip + 1 + length, terrain_.bank.z.cols())};
  }

  /// While the bucket stands in the cut it holds the walls.
  SlopeLimits loose_only() const {
    SlopeLimits limits = limits_;
    limits.critical_height = std::numeric_limits<double>::infinity();
    return limits;
  }

  // ---- soil ------------------------------------------------------------------------------------

  /// Takes out of every cell what lies above the line the tip draws through it.
  void cut(const Stretch& s) {
    if (!(s.to.x() < s.from.x())) return;
    const HeightMap& map = terrain_.bank;
    const double slope = (s.from.y() - s.to.y()) / (s.from.x() - s.to.x());
    const Index last = column(s.to.x());
    for (Index col = column(s.from.x()); col >= last; --col) {
      const double left = map.origin.x() + map.cell * static_cast<double>(col);
      const double x0 = std::max(s.to.x(), left);
      const double x1 = std::min(s.from.x(), left + map.cell);
      if (!(x1 > x0)) continue;
      const double z0 = s.to.y() + slope * (x0 - s.to.x());
      cut_column(col, x0, x1, z0, z0 + slope * (x1 - x0));
    }
  }

  /// Mean over an interval of max(0, height - z), z running linearly from z0 to z1.
  static double mean_above(double height, double z0, double z1) {
    const double a = height - z0;
    const double b = height - z1;
    if (a >= 0.0 && b >= 0.0) return 0.5 * (a + b);
    if (a <= 0.0 && b <= 0.0) return 0.0;
    const double positive = std::max(a, b);
    return 0.5 * positive * positive / std::abs(a - b);
  }

  void cut_column(Index col, double x0, double x1, double z0, double z1) {
    const double cell = terrain_.bank.cell;
    const double left = terrain_.bank.origin.x() + cell * static_cast<double>(col);
    const double share = (x1 - x0) / cell;
    const double ahead = (x1 - left) / cell;  // share of the cell that the lip has not passed yet
    double bank_volume = 0.0;
    double loose_volume = 0.0;
    for (Index i = 0; i < cover_.size(); ++i) {
      const Index row = first_row_ + i;
      const double top = terrain_.bank.z(row, col);  // of what is still uncut
      if (std::isnan(top)) {
        throw Error(ErrorKind::bad_input,
                    "dig: the path runs over unknown ground at x = " + std::to_string(x0) +
                        " m, y = " + std::to_string(terrain_.bank.y(row)) + " m");
      }
      const double removed = share * cover_(i) * mean_above(top, z0, z1);
      result_.terrain.bank.z(row, col) -= removed;
      bank_volume += removed;
      // All loose soil of the cell lies ahead of the lip: nothing can lie under the bucket's floor.
      double& loose = result_.terrain.loose(row, col);
      const double thickness = loose / ahead;
      const double taken =
          share * cover_(i) * (mean_above(top + thickness, z0, z1) - mean_above(top, z0, z1));
      const double loose_removed = std::min(loose, taken);
      loose -= loose_removed;
      loose_volume += loose_removed;
    }
    const double area = cell * cell;
    result_.soil.bank_cut += bank_volume * area;
    result_.soil.loose_cut += loose_volume * area;
    fill_ += (bank_volume * swell_ + loose_volume) * area;
    for (CellBlock* block : {&moving_, &passed_}) {
      block->include(first_row_, col);
      block->include(first_row_ + cover_.size() - 1, col);
    }
  }

  /// What the bucket cannot hold falls off the lip.
  void overflow(double lip_x, double phi3, double support, const HoldingSlopes& slopes) {
    const double capacity = bucket_capacity(machine_, phi3, support, slopes);
    const double excess = fill_ - capacity;
    if (!(excess > 0.0)) return;
    const double cell = terrain_.bank.cell;
    const Index last = column(lip_x - 1e-9);
    const Index first = column(lip_x - spread_ahead);
    double share = 0.0;
    for (Index col = first; col <= last; ++col) share += ahead_of(lip_x, col) * cover_.sum();
    for (Index col = first; col <= last; ++col) {
      for (Index i = 0; i < cover_.size(); ++i) {
        result_.terrain.loose(first_row_ + i, col) +=
            excess / (cell * cell) * ahead_of(lip_x, col) * cover_(i) / share;
      }
      moving_.include(first_row_, col);
      moving_.include(first_row_ + cover_.size() - 1, col);
    }
    fill_ -= excess;
  }

  /// Share of a column that lies ahead of the lip.
  double ahead_of(double lip_x, Index col) const {
    const HeightMap& map = terrain_.bank;
    const double left = map.origin.x() + map.cell * static_cast<double>(col);
    return std::clamp((lip_x - left) / map.cell, 0.0, 1.0);
  }

  // ---- forces ----------------------------------------------------------------------------------

  Resistance resist(const Stretch& s) const {
    const Vector2d motion = s.direction();
    const double floor = s.at.phi3 + pi - machine_.beta();
    const double climb = std::atan2(motion.y(), -motion.x());  // of the motion above the horizontal
    const Vector2d tip = 0.5 * (s.from + s.to);
    const Index col = column(tip.x());
    // The penetration moves along the floor by definition: no wedge is pushed, the lip is driven
    // in.
    return s.phase == DigPhase::penetrate ? drive_in(tip, col, floor, motion)
                                          : push_wedge(tip, col, {floor, climb}, motion);
  }

  /// Lip against the cone index, and friction on both sides of the floor and of the side plates.
  Resistance drive_in(const Vector2d& tip, Index col, double floor, const Vector2d& motion) const {
    const double depth = surface_at(col) - tip.y();
    Resistance r;
    if (!(depth > 0.0)) return r;
    const Bucket& bucket = machine_.bucket;
    const double buried = std::min(depth / std::sin(floor), floor_length());
    const double friction =
        bank_.adhesion + at_rest_pressure(depth) * std::tan(bank_.tool_friction_angle);
    const double plates = 2.0 * buried * bucket.width_outside + 2.0 * side_plate_area(depth, floor);
    const double lip = cone_index(soil_, bank_, depth) * lip_area();
    r.lip_force = -motion * (lip + friction * plates);
    r.face_point = tip;
    return r;
  }

  struct Attitude {
    double floor;  ///< angle of the floor [rad]
    double climb;  ///< angle of the motion above the horizontal [rad]
  };

  /// Earthmoving equation per strip of the edge, in the frame of the motion.
  Resistance push_wedge(const Vector2d& tip, Index col, const Attitude& attitude,
                        const Vector2d& motion) const {
    const double rake =
        std::max({attitude.floor, attitude.floor + attitude.climb, machine_.bucket.edge_angle});
    const EarthmovingFactors n = wedges_.at(rake, surface_slope(col));
    const double face = rake + bank_.tool_friction_angle;
    const double turn = std::clamp(attitude.climb, 0.0, 0.5 * pi);
    Resistance r;
    double along = 0.0;
    double across = 0.0;
    double depth_sum = 0.0;
    for (Index i = 0; i < cover_.size(); ++i) {
      const double width = cover_(i) * terrain_.bank.cell;
      const Strip strip = strip_at(first_row_ + i, col, tip.y());
      if (strip.bank + strip.loose <= 0.0) continue;
      const double passive = wedge_force(strip, n);
      const double adhesion = bank_.adhesion * strip.bank;
      const double shear = bank_.cohesion * strip.bank + at_rest_pressure(strip.bank) * strip.bank *
                                                             std::tan(bank_.friction_angle);
      // Level motion pushes a wedge up; a lip that rises shears the soil above it off instead.
      along += width * (std::cos(turn) * (passive * std::sin(face) + adhesion / std::tan(rake)) +
                        (1.0 - std::cos(turn)) * shear);
      across += width * std::cos(turn) * (passive * std::cos(face) - adhesion);
      depth_sum += width * strip.bank;
      r.borne_weight += width * 0.5 * bank_.unit_weight * strip.bank * strip.bank / std::tan(rake);
    }
    const double depth = depth_sum / machine_.bucket.width_outside;
    along += std::cos(turn) * confinement(rake, n, depth) + edge_force(depth, attitude.climb) +
             2.0 * side_plate_area(depth, std::max(attitude.floor, machine_.bucket.edge_angle)) *
                 (bank_.adhesion + at_rest_pressure(depth) * std::tan(bank_.tool_friction_angle));
    const Vector2d up(-motion.y(),
                      motion.x());  // left of the motion; turned below for travel in -x
    r.face_force = -motion * along + up * across;
    const double lever = std::min(depth / (3.0 * std::sin(rake)), floor_length());
    r.face_point = tip + lever * Vector2d(std::cos(attitude.floor), std::sin(attitude.floor));
    return r;
  }

  /// Soil above the tip in one row: depth of the uncut bank and thickness of the loose soil on it.
  struct Strip {
    double bank = 0.0;
    double loose = 0.0;
  };
  Strip strip_at(Index row, Index col, double tip_z) const {
    const double bank = terrain_.bank.z(row, col) - tip_z;
    const double loose = result_.terrain.loose(row, col);
    if (!(bank + loose > 0.0)) return {};
    return {std::max(0.0, bank), std::min(loose, bank + loose)};
  }

  /// Resultant on the face per width: the wedge of bank with the loose soil as its surcharge.
  double wedge_force(const Strip& strip, const EarthmovingFactors& n) const {
    const double surcharge = loose_.unit_weight * strip.loose;
    return strip.bank * (bank_.unit_weight * strip.bank * n.gamma + bank_.cohesion * n.c +
                         surcharge * n.q + bank_.adhesion * n.ca) +
           surcharge * strip.loose * n.gamma;
  }

  /// Side planes of the wedge, as a force along the motion.
  double confinement(double rake, const EarthmovingFactors& n, double depth) const {
    if (!(depth > 0.0)) return 0.0;
    const CuttingWedge wedge{rake, bank_.friction_angle, bank_.tool_friction_angle, 0.0};
    return side_plane_force(wedge, n, {bank_.unit_weight, bank_.cohesion, bank_.adhesion}, depth) *
           side_plane_share(wedge, n) * std::sin(rake + bank_.tool_friction_angle);
  }

  double lip_area() const { return machine_.bucket.edge_thickness * machine_.bucket.width_outside; }

  /// Blunt lip in soil that yields towards the surface (Balovnev 1983, thin edge); the part of a
  /// motion that goes down meets soil that cannot yield, and the cone index.
  double edge_force(double depth, double climb) const {
    if (!(depth > 0.0)) return 0.0;
    const double phi = bank_.friction_angle;
    const double active = (1.0 - std::sin(phi)) / (1.0 + std::sin(phi));
    const double pressure = 0.5 * machine_.bucket.edge_thickness * bank_.unit_weight +
                            bank_.cohesion / std::tan(phi) + depth * bank_.unit_weight * active;
    const double yielding = pressure * blunt_edge_ratio(0.5 * pi, phi, bank_.tool_friction_angle);
    const double plunge = std::max(0.0, -std::sin(climb));
    return lip_area() * ((1.0 - plunge) * yielding + plunge * cone_index(soil_, bank_, depth));
  }

  /// Mean pressure at rest on a vertical face down to this depth (Jaky 1944: K_0 = 1 - sin phi).
  double at_rest_pressure(double depth) const {
    return 0.5 * (1.0 - std::sin(bank_.friction_angle)) * bank_.unit_weight * depth;
  }

  double floor_length() const {
    return (machine_.bucket.profile[1] - machine_.bucket.profile[0]).norm();
  }

  /// Side plate below the surface: the triangle between floor and surface.
  double side_plate_area(double depth, double floor) const {
    return std::min(0.5 * depth * depth / std::tan(floor), depth * floor_length());
  }

  /// Slope of the surface ahead of the lip along the travel, positive uphill.
  double surface_slope(Index col) const {
    const auto reach = std::max<Index>(1, std::lround(slope_reach / terrain_.bank.cell));
    const Index ahead = std::max<Index>(0, col - reach);
    if (ahead == col) return 0.0;
    const double rise = uncut_at(ahead) - uncut_at(col);
    return std::isnan(rise)
               ? 0.0
               : std::atan2(rise, terrain_.bank.cell * static_cast<double>(col - ahead));
  }

  // ---- energy ----------------------------------------------------------------------------------

  void account(const Stretch& s, const Resistance& resistance, bool history) {
    const double payload_weight =
        std::max(0.0, fill_ * loose_.unit_weight - resistance.borne_weight);
    const Vector2d payload_at = bucket_point(s.at, centroid(machine_.bucket.profile));
    const JointAngles soil =
        torque_against_force(machine_, s.at, resistance.face_point, resistance.face_force) +
        torque_against_force(machine_, s.at, s.at.tip, resistance.lip_force);
    const JointAngles payload =
        torque_against_force(machine_, s.at, payload_at, {0.0, -payload_weight});
    const JointAngles links = torque_against_link_weight(machine_, s.at);
    const JointAngles torque = soil + payload + links;
    note_force(s, resistance, torque, history);
    for (int j = 0; j < 3; ++j) {
      const double work = torque(j) * s.turn(j);
      if (work <= 0.0) continue;
      const auto joint = static_cast<Joint>(j);
      if (std::abs(torque(j)) > machine_.limits[static_cast<std::size_t>(j)].torque) {
        result_.stall = Stall{s.phase, joint, travelled_, torque(j)};
        return;
      }
      spend(s, j, work, {soil(j) * s.turn(j), payload(j) * s.turn(j), links(j) * s.turn(j)});
    }
  }

  void spend(const Stretch& s, int joint, double work, const std::array<double, 3>& causes) {
    EnergyLedger& energy = result_.energy;
    if (s.phase == DigPhase::lift) {
      energy.lift += work;
      return;
    }
    energy.total += work;
    energy.by_joint[static_cast<std::size_t>(joint)] += work;
    const int phase = static_cast<int>(s.phase) - static_cast<int>(DigPhase::penetrate);
    energy.by_phase[static_cast<std::size_t>(phase)] += work;
    energy.soil += causes[0];
    energy.payload += causes[1];
    energy.links += causes[2];
  }

  void note_force(const Stretch& s, const Resistance& resistance, const JointAngles& torque,
                  bool history) {
    if (s.phase == DigPhase::lift) return;
    const Vector2d force = resistance.total();
    result_.peak_force = std::max(result_.peak_force, force.norm());
    if (history) result_.history.push_back({s.phase, travelled_, force, torque, fill_});
  }

  // ---- end -------------------------------------------------------------------------------------

  /// The bucket leaves the ground: what no soil ahead supports any more falls off, all comes to
  /// rest.
  void come_clear(const DigPose& last) {
    const double phi3 = last.bucket.floor_angle - pi + machine_.beta();
    overflow(last.bucket.x, phi3, 0.0, {slopes_.heap, slopes_.heap});
    if (!passed_.empty()) {
      moving_.include(passed_.row_begin, passed_.col_begin);
      moving_.include(passed_.row_end - 1, passed_.col_end - 1);
    }
    slump(result_.terrain, moving_, limits_, sweeps_at_the_end);
    result_.payload_volume = fill_;
    result_.payload_mass = fill_ * loose_.bulk_density;
    result_.soil.payload = fill_;
  }

  void settle_accounts() {
    const double area = terrain_.bank.cell * terrain_.bank.cell;
    SoilLedger& ledger = result_.soil;
    for (Index col = 0; col < terrain_.loose.cols(); ++col) {
      for (Index row = 0; row < terrain_.loose.rows(); ++row) {
        const double gained = result_.terrain.loose(row, col) - terrain_.loose(row, col);
        const double lowered = terrain_.bank.z(row, col) - result_.terrain.bank.z(row, col);
        if (std::isnan(lowered)) continue;
        const double in_pit = std::clamp(gained, 0.0, std::max(0.0, lowered));
        ledger.fallen_back += in_pit * area;
        ledger.spilled += (gained - in_pit) * area;
      }
    }
    if (ledger.bank_cut > 0.0) ledger.fallback_fraction = ledger.fallen_back / ledger.bank_cut;
    ledger.solids_after = solids() + fill_ * loose_.dry_density;
  }

  /// Dry mass of the map above the deepest point of the path.
  double solids() const {
    const Terrain& terrain = result_.terrain;
    double mass = 0.0;
    for (Index col = 0; col < terrain.loose.cols(); ++col) {
      double sum = 0.0;
      for (Index row = 0; row < terrain.loose.rows(); ++row) {
        const double bank = terrain.bank.z(row, col) - deepest_;
        if (std::isnan(bank)) continue;
        sum += bank * bank_.dry_density + terrain.loose(row, col) * loose_.dry_density;
      }
      mass += sum;
    }
    return mass * terrain.bank.cell * terrain.bank.cell;
  }

  const Machine& machine_;
  const SoilKind& soil_;
  const SoilState& bank_;
  const SoilState& loose_;
  const CriticalWedges& wedges_;
  const HoldingSlopes& slopes_;
  const Terrain& terrain_;  ///< before the dig: its bank is what the lip has still ahead
  double swell_;
  SlopeLimits limits_;

  int sweeps_ = 0;  ///< of slumping per step
  Index first_row_ = 0;
  ArrayXd cover_;  ///< share of each row that the bucket covers
  DigResult result_;
  double fill_ = 0.0;  ///< loose soil in the bucket [m^3]
  double travelled_ = 0.0;
  double deepest_ = 0.0;
  CellBlock moving_;  ///< cells that may not be at rest
  CellBlock passed_;  ///< cells the lip has passed, whose walls the bucket holds until it is out
};

/// Side view of the bucket's cavity in the boom plane, relative to the tip.
class Cavity {
 public:
  /// Extent of the cavity above one x. Its mouth may be the upper or the lower bound.
  struct Slice {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    bool open_below = false;
    bool open_above = false;
  };

  Cavity(const std::vector<Vector2d>& profile, double phi3) {
    for (const Vector2d& corner : profile)
      corners_.push_back(turned(corner - profile.front(), phi3));
    for (const Vector2d& corner : corners_) {
      x_min_ = std::min(x_min_, corner.x());
      x_max_ = std::max(x_max_, corner.x());
    }
  }

  double x_min() const { return x_min_; }
  double x_max() const { return x_max_; }
  const Vector2d& top() const { return corners_.back(); }

  Slice at(double x) const {
    Slice slice;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const bool mouth = k + 1 == corners_.size();
      const Vector2d& a = corners_[k];
      const Vector2d& b = corners_[mouth ? 0 : k + 1];
      if ((a.x() <= x) == (b.x() <= x)) continue;
      const double z = a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x());
      if (z < slice.low) {
        slice.low = z;
        slice.open_below = mouth;
      }
      if (z > slice.high) {
        slice.high = z;
        slice.open_above = mouth;
      }
    }
    return slice;
  }

 private:
  std::vector<Vector2d> corners_;
  double x_min_ = 0.0;
  double x_max_ = 0.0;
};

void check(const Terrain& terrain, const DigPath& path) {
  if (terrain.bank.z.size() == 0) throw Error(ErrorKind::bad_input, "dig: the map is empty");
  if (terrain.loose.rows() != terrain.bank.z.rows() ||
      terrain.loose.cols() != terrain.bank.z.cols()) {
    throw Error(ErrorKind::bad_input, "dig: bank and loose layer must have the same size");
  }
  if (!(terrain.bank.cell > 0.0)) {
    throw Error(ErrorKind::bad_input,
                "dig: cell must be > 0 m, got " + std::to_string(terrain.bank.cell));
  }
  if (!(terrain.loose >= 0.0).all()) {
    throw Error(ErrorKind::bad_input, "dig: the loose layer must be >= 0 everywhere");
  }
  if (path.poses.size() < 2) throw Error(ErrorKind::bad_input, "dig: the path has no poses");
}

}  // namespace

double bucket_capacity(const Machine& machine, double phi3, double support,
                       const HoldingSlopes& slopes) {
  const Cavity cavity(machine.bucket.profile, phi3);
  const double width = machine.bucket.width_inside;
  const double flank = 0.5 * slopes.heap * width;  // height at which the slopes of both sides meet
  constexpr int slices = 64;
  double area = 0.0;
  for (int i = 0; i < slices; ++i) {
    const double x = cavity.x_min() + (i + 0.5) / slices * (cavity.x_max() - cavity.x_min());
    const Cavity::Slice slice = cavity.at(x);
    if (!(slice.high > slice.low) || slice.open_below) continue;
    double surface = std::max(0.0, support) + slopes.face * std::max(0.0, x);
    if (!slice.open_above) {
      area += std::clamp(surface - slice.low, 0.0, slice.high - slice.low);
      continue;
    }
    // The trench holds the soil beside the plates as high as the ground stands.
    const double side = support > 0.0 ? std::max(slice.high, support) : slice.high;
    const double rim = support > 0.0 ? std::max(cavity.top().y(), support) : cavity.top().y();
    surface = std::min(surface, rim + slopes.heap * std::max(0.0, cavity.top().x() - x));
    const double heap = std::max(0.0, surface - side);
    const double mean_heap = heap < flank ? heap - 0.5 * heap * heap / flank : 0.5 * flank;
    area += std::max(0.0, std::min(surface, side) - slice.low) + mean_heap;
  }
  return area * (cavity.x_max() - cavity.x_min()) / slices * width;
}

double stable_slope(const SoilState& soil, double height, double least) {
  const double phi = soil.friction_angle;
  const auto stands = [&](double angle) {
    return 4.0 * soil.cohesion * std::sin(angle) * std::cos(phi) >=
           soil.unit_weight * height * (1.0 - std::cos(angle - phi));
  };
  double low = least;
  double high = steepest_face;
  if (high <= low || stands(high)) return std::max(low, high);
  if (!stands(low)) return low;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stands(middle) ? low : high) = middle;
  }
  return low;
}

HeightMapSimulator::HeightMapSimulator(const Machine& machine, const SoilKind& soil,
                                       double density_percent)
    : machine_(machine),
      soil_(soil),
      bank_(bank_state(soil, density_percent)),
      loose_(loose_state(soil)),
      wedges_(bank_.friction_angle, bank_.tool_friction_angle) {
  const std::vector<Vector2d>& profile = machine.bucket.profile;
  const double mouth = (profile.back() - profile.front()).norm();
  slopes_.heap = std::tan(soil.angle_of_repose);
  slopes_.face = std::tan(stable_slope(dug_state(soil), mouth, soil.angle_of_repose));
}

DigResult HeightMapSimulator::dig(const Terrain& terrain, const DigPath& path,
                                  const DigOptions& options) const {
  check(terrain, path);
  return Dig(machine_, soil_, bank_, loose_, wedges_, slopes_, terrain).run(path, options);
}

}  // namespace excavplan
