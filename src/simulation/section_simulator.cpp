// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/section_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/simulation/dig_ground.hpp>

#include "simulation/dig_account.hpp"
#include "simulation/section_bucket.hpp"
#include "simulation/section_resistance.hpp"
#include "simulation/soil_section.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Soil ahead of the lip: level over a wedge of length `level`, from there it falls at `fall` per
/// metre towards the ground ahead.
struct Pile {
  double area = 0.0;
  double level = 0.0;

  double height(double fall) const {
    return fall * (std::sqrt(level * level + 2.0 * area / fall) - level);
  }

  /// Takes the part of the pile over the next `advance` of ground that is higher than `lip` above
  /// it.
  double take(double advance, double lip, double fall) {
    const double high = height(fall) - std::max(0.0, lip);
    if (high <= 0.0 || advance <= 0.0) return 0.0;
    const double flat = std::min(advance, level);
    const double sloping = std::min(advance - flat, high / fall);
    const double taken = std::min(area, flat * high + sloping * (high - 0.5 * fall * sloping));
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
  static TipReach reach(const Machine& machine, const DigPath& path) {
    const std::vector<Vector2d>& profile = machine.bucket.profile;
    const Rectangle strip = swept_strip(machine, path);
    return {strip.x_min, strip.x_max, (profile[2] - profile[0]).norm()};
  }

  double width() const { return machine_.bucket.width_outside; }

  /// How fast the pile's surface falls towards the ground ahead, per metre.
  double fall(const GroundAhead& ground) const {
    return std::max(0.25 * repose_, repose_ - ground.gradient);
  }

  /// False if the machine stalls.
  bool dig_step(const DigPose& from, const DigPose& to) {
    const JointAngles joints = 0.5 * (from.joints + to.joints);
    const LinkPositions at = link_positions(machine_, joints);
    bucket_.turn_to(at.phi3);
    const Vector2d p(from.bucket.x, from.bucket.z);
    const Vector2d q(to.bucket.x, to.bucket.z);
    const SectionResistance soil = resist(
        0.5 * (p + q), q - p, 0.5 * (from.bucket.floor_angle + to.bucket.floor_angle), to.phase);
    DigStep step;
    step.phase = to.phase;
    step.length = (q - p).norm();
    step.joints = joints;
    step.turn = to.joints - from.joints;
    step.by_soil = torque_against_force(machine_, at, soil.face_at, soil.face) +
                   torque_against_force(machine_, at, soil.tip_at, soil.tip) +
                   torque_against_force(machine_, at, soil.heel_at, soil.heel);
    step.by_edge = torque_against_force(machine_, at, soil.tip_at, soil.edge);
    const double carried = std::max(0.0, contents_ - soil.on_floor);
    step.by_payload = carry(at, carried);
    step.force = soil.total() - carried * model_.loose.unit_weight * machine_.up();
    step.by_links = torque_against_link_weight(machine_, at);
    account_.note_force(step, soil.total(), contents_);
    if (account_.stalls(step)) return false;
    account_.book(step);
    account_.travel(step.length);
    cut(p, q, soil.wedge_length);
    return true;
  }

  SectionResistance resist(const Vector2d& tip, const Vector2d& step, double floor_angle,
                           DigPhase phase) {
    const double length = step.norm();
    if (!(length > 0.0)) return {};
    Cutting cutting;
    cutting.tip = {tip.x(), tip.y(), floor_angle};
    cutting.motion = step / length;
    cutting.ground = section_.ahead(tip.x());
    cutting.bank = section_.bank_of(cutting.ground.void_ratio);
    cutting.loose = section_.loose_of(cutting.ground.loose_void_ratio);
    cutting.pile = pile_.height(fall(cutting.ground));
    cutting.contents = contents_;
    return section_resistance(model_, section_, cutting, bucket_, phase);
  }

  /// A part of the soil in the bucket, all of which lies packed into its corner.
  JointAngles carry(const LinkPositions& at, double volume) {
    const Vector2d centre = at.tip + bucket_.turned(model_.packed.of(contents_).centre);
    return torque_against_force(machine_, at, centre,
                                -volume * model_.loose.unit_weight * machine_.up());
  }

  void cut(const Vector2d& p, const Vector2d& q, double wedge_length) {
    const CutArea area = section_.cut(p, q);
    const GroundAhead ground = section_.ahead(q.x());
    const double falls = fall(ground);
    const double lip = q.y() - ground.surface;
    const double from_pile = pile_.take(p.x() - q.x(), lip, falls);
    account_.result.soil.bank_cut += area.bank * width();
    account_.result.soil.loose_cut += (area.loose + from_pile) * width();
    const double before = contents_;
    contents_ += (area.swollen + from_pile) * width();
    pile_.level = wedge_length;
    spill(ground, lip, before);
    pile_at_ = q.x();
    const double shed = section_.shed(pile_at_, {pile_.level, pile_.height(falls), falls}, repose_);
    pile_.area = std::max(0.0, pile_.area - shed);
  }

  /// Leaves as much soil ahead as lets the rest find room in the bucket.
  /// @param before  what the bucket held before the cut [m^3]
  void spill(const GroundAhead& ground, double lip, double before) {
    const double falls = fall(ground);
    const auto left_over = [&](double spilled) {
      const double height = Pile{pile_.area + spilled / width(), pile_.level}.height(falls);
      const double support = std::max(0.0, height - lip);
      const double room = std::max(before, bucket_.pushed_in(support));
      return contents_ - spilled - std::min(room, bucket_.held(support, model_.slopes));
    };
    if (!(left_over(0.0) > 0.0)) return;
    double low = 0.0;
    double high = contents_;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (left_over(middle) > 0.0 ? low : high) = middle;
    }
    pile_.area += high / width();
    contents_ -= high;
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
        support > 0.0 ? bucket_.held(support, model_.slopes) : bucket_.held(0.0, clear);
    if (contents_ <= holds) return;
    const double lost = (contents_ - holds) / width();
    dropped_ += lost;
    dropped_at_ += lost * to.bucket.x;
    contents_ = holds;
  }

  /// The back of the pile slides into the cut; soil that the bucket lost lies under it.
  void settle() {
    using Side = SoilSection::Side;
    if (pile_.area > 0.0) {
      pile_.level = 0.0;
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
  DigAccount account_;
  double repose_;
  Pile pile_;
  double pile_at_ = 0.0;
  double contents_ = 0.0;    ///< loose, in the bucket [m^3]
  double dropped_ = 0.0;     ///< by the rising bucket [m^2]
  double dropped_at_ = 0.0;  ///< sum of area times x
};

std::shared_ptr<const SectionModel> model_of(const Machine& machine, const SoilKind& soil,
                                             double density_percent) {
  require_machine(machine);
  return std::make_shared<const SectionModel>(machine, soil, density_percent);
}

}  // namespace

SectionSimulator::SectionSimulator(const Machine& machine, const SoilKind& soil,
                                   double density_percent)
    : model_(model_of(machine, soil, density_percent)) {}

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
