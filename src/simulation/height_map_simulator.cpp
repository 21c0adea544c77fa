// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/height_map_simulator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"
#include "earth/dig_kernels.hpp"
#include "earth/slump.hpp"
#include "simulation/bucket_cavity.hpp"
#include "simulation/bucket_resistance.hpp"
#include "simulation/dig_account.hpp"
#include "simulation/pile_ahead.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Numbers of our own choice; reasons: docs/methods.md#simulation.
constexpr int sweeps_at_the_end = 2000;       // until all is at rest; a dig needs some tens
constexpr double first_room = 0.5;            // of the window around the path at first [m]
constexpr double rounding_of_ground = 1e-15;  // of a volume [m^3]
constexpr double spill_error = 1e-8;          // of the soil that has no room in the bucket [m^3]

/// How much of the column that it is in the lip has passed, and how high.
class PassedPart {
 public:
  /// Of the way of the lip within one column.
  struct Piece {
    double length;   ///< along x [m]
    double z_end;    ///< level where it ends, nearer to the machine [m]
    double z_begin;  ///< where it begins [m]
  };

  /// Mean level of the lip over the last `behind` metres of a column, up to where the next piece
  /// begins; where the lip has not been, of the piece's line. (That line alone tells nothing of the
  /// pieces before: at the end of a scoop the lip rises nearly upright.)
  double level(Index col, double behind, const Piece& next) {
    if (col != col_) *this = PassedPart(col);
    const double passed = std::min(length_, behind);
    const double rest = behind - passed;
    const double slope = (next.z_begin - next.z_end) / next.length;
    const double of_passed = length_ > 0.0 ? passed * area_ / length_ : 0.0;
    const double of_rest = rest * (next.z_begin + slope * (passed + 0.5 * rest));
    length_ += next.length;
    area_ += 0.5 * next.length * (next.z_end + next.z_begin);
    return behind > 0.0 ? (of_passed + of_rest) / behind : next.z_begin;
  }

  PassedPart() = default;

 private:
  explicit PassedPart(Index col) : col_(col) {}

  Index col_ = -1;
  double length_ = 0.0;  ///< [m]
  double area_ = 0.0;    ///< between the way of the lip and z = 0 [m^2]
};

/// One dig from its first pose to its end.
class Dig {
 public:
  Dig(const HeightMapModel& model, const Terrain& terrain, const DigPath& path,
      const DigOptions& options)
      : model_(model),
        path_(path),
        options_(options),
        swath_(terrain.bank, model.machine.bucket.width_outside),
        ground_(terrain, {model.soil, model.bank, model.loose}, cells_around(terrain, path),
                comes_to_rest()),
        cavity_(model.machine.bucket),
        resistance_(model, ground_, swath_, path),
        pile_(ground_, swath_, model.machine.bucket.width_outside, model.slopes.heap),
        account_(model.machine, path, options),
        cut_bank_(static_cast<std::size_t>(swath_.rows())),
        cut_loose_(cut_bank_.size()) {}

  DigResult run() {
    const std::vector<DigPose>& poses = path_.poses;
    DigResult& result = account_.result;
    const double energy_worth = energy_worth_spending(poses.back(), options_.give_up_below);
    std::size_t reached = 0;
    while (reached + 1 < poses.size() && !result.stall && !result.given_up) {
      advance(stretch(reached));
      if (!result.stall) ++reached;
      result.given_up = result.energy.total > energy_worth;
    }
    come_clear(poses[reached].bucket, poses.back());
    if (comes_to_rest()) slump(ground_, moving_, {model_.slopes.heap, false}, sweeps_at_the_end);
    if (!options_.worth_alone) sum_loose_soil(account_.result.soil);
    account_.close(ground_, fill_, model_.slopes.heap);
    return std::move(result);
  }

 private:
  /// The cells of the path while it digs, and room around them.
  CellBlock cells_around(const Terrain& terrain, const DigPath& path) const {
    const Rectangle strip = swept_strip(model_.machine, path);
    const CellBlock cells = {swath_.first_row(), swath_.end_row(), swath_.column(strip.x_min),
                             swath_.column(strip.x_max) + 1};
    const auto room = static_cast<Index>(std::ceil(first_room / terrain.bank.cell_size));
    return cells.widened(room, terrain.loose.rows(), terrain.loose.cols());
  }

  Stretch stretch(std::size_t i) const {
    const DigPose& a = path_.poses[i];
    const DigPose& b = path_.poses[i + 1];
    Stretch s;
    s.phase = b.phase;
    s.pose = i;
    s.from = {a.bucket.x, a.bucket.z};
    s.to = {b.bucket.x, b.bucket.z};
    s.joints = 0.5 * (a.joints + b.joints);
    s.turn = b.joints - a.joints;
    s.at = link_positions(model_.machine, s.joints);
    s.length = (s.to - s.from).norm();
    return s;
  }

  void advance(const Stretch& s) {
    cavity_.turn_to(s.at.phi3);
    const bool digs = s.phase != DigPhase::lift;
    const Resistance resistance =
        digs && s.length > 0.0 ? resistance_.at(s, cavity_, fill_) : Resistance{};
    account(s, resistance);
    if (account_.result.stall) return;
    account_.travel(s.length);
    if (!digs) return;
    for (const Resistance::Pressed& heel : resistance.pressed) press(heel);
    const double before = fill_;
    cut(s);
    pile_.move_to(s.to.x(), resistance.wedge_length);
    const double ahead = level_ahead(s.to);
    spill(ahead,
          [&](double level) { return room_in_bucket(std::max(ahead, level) - s.to.y(), before); });
  }

  /// The heel may stand far behind where the path begins.
  void press(const Resistance::Pressed& heel) {
    ground_.cover({swath_.first_row(), swath_.end_row(), heel.col, heel.col + 1});
    for (Index row = swath_.first_row(); row < swath_.end_row(); ++row) {
      ground_.compact(ground_.at(row, heel.col), heel.pressure);
    }
  }

  /// Level of the surface just ahead of the lip, where it is known; else that of the lip.
  double level_ahead(const Vector2d& lip) const {
    const Index col = swath_.nearest_column(lip.x() - ground_.cell_size());
    double sum = 0.0;
    double known = 0.0;
    for (Index i = 0; i < swath_.rows(); ++i) {
      const Index row = swath_.first_row() + i;
      const double surface = ground_.before().bank.z(row, col) + ground_.loose(row, col);
      if (std::isnan(surface)) continue;
      sum += swath_.cover(i) * surface;
      known += swath_.cover(i);
    }
    return known > 0.0 ? sum / known : lip.y();
  }

  /// How much soil the bucket may hold while it is pushed in, with the soil ahead `support` above
  /// the lip. It gets in up to that level; what is in, `held`, stays as long as the bucket can hold
  /// it.
  double room_in_bucket(double support, double held) const {
    const Cavity::Room room = cavity_.room(std::max(0.0, support), model_.slopes);
    return std::min(std::max(held, room.pushed_in), room.capacity);
  }

  // ---- soil ------------------------------------------------------------------------------------

  /// Takes out of every cell what lies above the line the tip draws through it.
  void cut(const Stretch& s) {
    if (!(s.to.x() < s.from.x())) return;
    const HeightMap& map = ground_.before().bank;
    const double slope = (s.from.y() - s.to.y()) / (s.from.x() - s.to.x());
    const Index last = swath_.column(s.to.x());
    for (Index col = swath_.column(s.from.x()); col >= last; --col) {
      const double left = map.origin.x() + map.cell_size * static_cast<double>(col);
      const double x0 = std::max(s.to.x(), left);
      const double x1 = std::min(s.from.x(), left + map.cell_size);
      if (!(x1 > x0)) continue;
      const double z0 = s.to.y() + slope * (x0 - s.to.x());
      cut_column(col, x0, x1, z0, z0 + slope * (x1 - x0));
    }
  }

  void cut_column(Index col, double x0, double x1, double z0, double z1) {
    const HeightMap& map = ground_.before().bank;
    const double left = map.origin.x() + map.cell_size * static_cast<double>(col);
    const double share = (x1 - x0) / map.cell_size;
    const double ahead =
        (x1 - left) / map.cell_size;  // share of the cell the lip has not passed yet
    const double behind = passed_.level(col, left + map.cell_size - x1, {x1 - x0, z0, z1});
    require_known(col, x0);
    const std::size_t cell = ground_.at(swath_.first_row(), col);
    const auto count = static_cast<std::size_t>(swath_.rows());
    cut_cells(
        {z0, z1, share, ahead, behind},
        {count, &map.z(swath_.first_row(), col), ground_.looses(cell, count), swath_.covers()},
        cut_bank_.data(), cut_loose_.data());
    take_in(col, cell);
    ground_.lower(cell, count, cut_bank_.data(), cut_loose_.data());
    moving_.include({swath_.first_row(), swath_.end_row(), col, col + 1});
  }

  void require_known(Index col, double x) const {
    const HeightMap& map = ground_.before().bank;
    for (Index row = swath_.first_row(); row < swath_.end_row(); ++row) {
      if (!std::isnan(map.z(row, col))) continue;
      throw Error(ErrorKind::bad_input,
                  "dig: the path crosses unknown ground at x = " + number_text(x) +
                      " m, y = " + number_text(map.y(row)) + " m");
    }
  }

  /// What was cut in a column, of which `cell` is the first, swells into the bucket.
  void take_in(Index col, std::size_t cell) {
    const double area = ground_.cell_size() * ground_.cell_size();
    SoilLedger& soil = account_.result.soil;
    for (std::size_t i = 0; i < cut_bank_.size(); ++i) {
      const double bank = cut_bank_[i];
      const double loose = cut_loose_[i];
      const Index row = swath_.first_row() + static_cast<Index>(i);
      fill_ +=
          area * (ground_.swollen_bank(row, col, bank) + ground_.swollen_loose(cell + i, loose));
      soil.bank_cut += bank * area;
      soil.loose_cut += loose * area;
    }
  }

  /// What has no room in the bucket comes to lie in the pile ahead. That rises from `level`, or is
  /// already higher, to the level at which the rest has room, `room(level)`.
  template <typename Room>
  void spill(double level, const Room& room) {
    double held = room(level);
    if (!(fill_ > held + spill_error)) return;
    double held_at = level;
    double low = -std::numeric_limits<double>::infinity();
    double high = -low;
    level = std::max(level, top_of_pile_);
    double top = level;
    double last_left = 0.0;
    double pile = 0.0;              // volume
    for (int i = 0; i < 60; ++i) {  // secants within the bounds found
      const double last_top = std::exchange(top, level);
      if (pile_.look(top)) low = -std::numeric_limits<double>::infinity();
      pile = pile_.volume(top);
      if (top != held_at) held = room(held_at = top);
      const double left = fill_ - held - pile;
      if (std::abs(left) < spill_error) break;
      (left > 0.0 ? low : high) = top;
      if (i > 0) gain_ = (last_left - left) / (top - last_top);
      if (!(gain_ > 0.0)) gain_ = pile_.area(top);
      last_left = left;
      level = top + left / gain_;
      if (gain_ > 0.0 && level > low && level < high) continue;
      level = std::isinf(high) ? low + 0.1 : std::isinf(low) ? high - 0.1 : 0.5 * (low + high);
    }
    const double spilled = std::min(fill_, pile);
    if (!(spilled > 0.0)) return;
    top_of_pile_ = top;
    fill_ = fill_ - spilled > rounding_of_ground ? fill_ - spilled : 0.0;
    moving_.include(pile_.lay(top, spilled / pile));
  }

  // ---- energy ----------------------------------------------------------------------------------

  void account(const Stretch& s, const Resistance& resistance) {
    const double payload_weight =
        std::max(0.0, fill_ * model_.loose.unit_weight - resistance.borne_weight);
    const Machine& machine = model_.machine;
    DigStep step;
    step.phase = s.phase;
    step.length = s.length;
    step.joints = s.joints;
    step.turn = s.turn;
    step.by_soil =
        torque_against_force(machine, s.at, resistance.face_point, resistance.face_force) +
        torque_against_force(machine, s.at, s.at.tip, resistance.lip_force) +
        torque_against_force(machine, s.at, resistance.heel_point, resistance.heel_force);
    step.by_edge = torque_against_force(
        machine, s.at, s.at.tip,
        s.length > 0.0 ? Vector2d(-resistance.edge * s.direction()) : Vector2d::Zero());
    step.by_payload = torque_against_force(machine, s.at, s.at.tip + cavity_.packed(fill_).centroid,
                                           -payload_weight * machine.up());
    step.by_links = torque_against_link_weight(machine, s.at);
    step.force = resistance.total() - payload_weight * machine.up();
    if (s.phase != DigPhase::lift) account_.note_force(step, resistance.total(), fill_);
    account_.stalls(step);
    account_.book(step);
  }

  // ---- end -------------------------------------------------------------------------------------

  /// Turns the cavity as it leaves the ground and returns how soil stands in it there.
  HoldingSlopes turn_clear(const DigPose& last) {
    cavity_.turn_to(last.bucket.floor_angle - pi + model_.machine.beta());
    return {model_.slopes.heap, model_.slopes.heap};
  }

  /// The most energy with which the dig can still be this efficient [J].
  double energy_worth_spending(const DigPose& last, double efficiency) {
    if (!(efficiency > 0.0)) return std::numeric_limits<double>::infinity();
    const HoldingSlopes slopes = turn_clear(last);
    return cavity_.capacity(0.0, slopes) * model_.loose.bulk_density / efficiency;
  }

  /// The bucket leaves the ground where it has come to, in the attitude of its last pose: what no
  /// soil ahead supports any more falls off, no wall is held any more.
  void come_clear(const BucketPose& at, const DigPose& last) {
    const Index ahead = swath_.nearest_column(at.x - ground_.cell_size());
    ground_.cover({swath_.first_row(), swath_.end_row(), ahead, ahead + 1});
    const HoldingSlopes slopes = turn_clear(last);
    pile_.move_to(at.x, 0.0);
    spill(level_ahead({at.x, at.z}), [&](double) { return cavity_.capacity(0.0, slopes); });
  }

  bool comes_to_rest() const { return options_.settle && !options_.worth_alone; }

  /// Loose soil that was gained where the ground was cut, and elsewhere.
  void sum_loose_soil(SoilLedger& ledger) const {
    const Terrain& before = ground_.before();
    const CellBlock& cells = ground_.cells();
    const double area = ground_.cell_size() * ground_.cell_size();
    for (Index col = cells.col_begin; col < cells.col_end; ++col) {
      for (Index row = cells.row_begin; row < cells.row_end; ++row) {
        const double gained = ground_.loose(row, col) - before.loose(row, col);
        const double lowered = before.bank.z(row, col) - ground_.bank(row, col);
        if (std::isnan(lowered)) continue;
        const double in_pit = std::clamp(gained, 0.0, std::max(0.0, lowered));
        ledger.fallen_back += in_pit * area;
        ledger.spilled += std::max(0.0, gained - in_pit) * area;
      }
    }
  }

  const HeightMapModel& model_;
  const DigPath& path_;
  const DigOptions& options_;
  Swath swath_;
  GroundWindow ground_;
  Cavity cavity_;
  BucketResistance resistance_;
  PileAhead pile_;
  DigAccount account_;
  std::vector<double> cut_bank_;   ///< of the rows of the column that was cut last [m]
  std::vector<double> cut_loose_;  ///< likewise

  double top_of_pile_ = -std::numeric_limits<double>::infinity();  ///< lately [m]
  double gain_ = 0.0;  ///< of soil in and ahead of the bucket per rise of that, lately [m^2]
  double fill_ = 0.0;  ///< loose soil in the bucket [m^3]
  PassedPart passed_;  ///< of the column that the lip is in
  /// Cells that may not be at rest: those that the lip has passed, whose walls the bucket holds
  /// until it is out, and those of the pile.
  CellBlock moving_;
};

std::shared_ptr<const HeightMapModel> map_model_of(const Machine& machine, const SoilKind& soil,
                                                   double density_percent) {
  require_machine(machine);
  return std::make_shared<const HeightMapModel>(machine, soil, density_percent);
}

}  // namespace

HeightMapSimulator::HeightMapSimulator(const Machine& machine, const SoilKind& soil,
                                       double density_percent)
    : model_(map_model_of(machine, soil, density_percent)) {}

std::string HeightMapSimulator::name() {
  return "height-map " + std::to_string(height_map_simulator_version);
}

std::string HeightMapSimulator::identity() const {
  return simulator_identity(name(), model_->machine, model_->soil, model_->density_percent);
}

const SoilState& HeightMapSimulator::bank() const { return model_->bank; }
const SoilState& HeightMapSimulator::loose() const { return model_->loose; }

DigResult HeightMapSimulator::dig(const Terrain& terrain, const DigPath& path,
                                  const DigOptions& options) const {
  check_dig(terrain, path);
  return Dig(*model_, terrain, path, options).run();
}

}  // namespace excavplan
