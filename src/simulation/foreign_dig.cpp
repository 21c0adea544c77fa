// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/foreign_dig.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "ground/map_check.hpp"
#include "simulation/dig_account.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double room_around = 2.0;       // of the window around what the bucket sweeps [m]; ours
constexpr double most_fill = 2.0;         // of the heaped capacity; ours
constexpr double height_rounding = 1e-9;  // by which an answer may raise undisturbed soil [m]

/// The cells that a dig can change.
CellBlock window_of(const Machine& machine, const Terrain& terrain, const DigPath& path) {
  const HeightMap& map = terrain.bank;
  const Rectangle strip = swept_strip(machine, path);
  const Rectangle extent = map.extent();
  if (strip.x_min < extent.x_min || strip.x_max > extent.x_max || strip.y_min < extent.y_min ||
      strip.y_max > extent.y_max) {
    refuse("dig: the path leaves the map, which reaches from x = " + number_text(extent.x_min) +
           " to " + number_text(extent.x_max) + " m and from y = " + number_text(extent.y_min) +
           " to " + number_text(extent.y_max) + " m");
  }
  const auto cell = [&](double at, double origin) {
    return static_cast<Index>(std::floor((at - origin) / map.cell_size));
  };
  const CellBlock swept = {cell(strip.y_min, map.origin.y()), cell(strip.y_max, map.origin.y()) + 1,
                           cell(strip.x_min, map.origin.x()),
                           cell(strip.x_max, map.origin.x()) + 1};
  for (Index col = swept.col_begin; col < std::min(swept.col_end, map.z.cols()); ++col) {
    for (Index row = swept.row_begin; row < std::min(swept.row_end, map.z.rows()); ++row) {
      if (std::isnan(map.z(row, col))) {
        refuse("dig: the path crosses unknown ground at x = " + number_text(map.x(col)) +
               " m, y = " + number_text(map.y(row)) + " m");
      }
    }
  }
  const auto room = static_cast<Index>(std::ceil(room_around / map.cell_size));
  return swept.widened(room, map.z.rows(), map.z.cols());
}

DigStep step_of(const Machine& machine, const DigPose& from, const DigPose& to,
                const ForeignLoad& load) {
  DigStep step;
  step.phase = to.phase;
  step.length = std::hypot(to.bucket.x - from.bucket.x, to.bucket.z - from.bucket.z);
  step.joints = 0.5 * (from.joints + to.joints);
  step.turn = to.joints - from.joints;
  const LinkPositions at = link_positions(machine, step.joints);
  // Joint angles turn clockwise: a moment from +x to +z works against them.
  step.by_soil =
      torque_against_force(machine, at, at.tip, load.force) + JointAngles::Constant(load.moment);
  step.by_links = torque_against_link_weight(machine, at);
  step.force = load.force;
  return step;
}

void book(const std::vector<ForeignLoad>& loads, const Machine& machine, const DigPath& path,
          double loose_density, DigAccount& account) {
  for (std::size_t i = 0; i < loads.size() && !account.result.stall; ++i) {
    const DigStep step = step_of(machine, path.poses[i], path.poses[i + 1], loads[i]);
    if (step.phase != DigPhase::lift) {
      account.note_force(step, loads[i].force, loads[i].carried / loose_density);
    }
    account.stalls(step);
    account.book(step);
    if (!account.result.stall) account.travel(step.length);
  }
}

}  // namespace

ForeignModel::ForeignModel(Machine of_machine, SoilKind of_soil, double percent)
    : machine(std::move(of_machine)),
      soil(std::move(of_soil)),
      density_percent(percent),
      bank(bank_state(soil, percent)),
      loose(loose_state(soil)) {
  require_machine(machine);
}

std::optional<std::string> fault_of_name(const std::string& name) {
  constexpr std::size_t longest_name = 100;
  if (name.empty()) return "empty";
  if (name.find(',') != name.npos) return in_quotes(name) + ", must have no comma";
  return fault_of_line(name, longest_name);
}

ForeignDig::ForeignDig(const ForeignModel& model, const Terrain& terrain, const DigPath& path,
                       const DigOptions& options)
    : model_(model), terrain_(terrain), path_(path), options_(options) {
  check_dig(terrain, path);
  if (terrain.bank_void_ratio.size() > 0 || terrain.loose_void_ratio.size() > 0) {
    refuse("dig: a simulator of a library or program takes no ground with void ratios of its own");
  }
  cells_ = window_of(model.machine, terrain, path);
  bank_.cell_size = terrain.bank.cell_size;
  bank_.origin = terrain.bank.origin +
                 bank_.cell_size * Eigen::Vector2d(static_cast<double>(cells_.col_begin),
                                                   static_cast<double>(cells_.row_begin));
  const auto block = [this](const Eigen::ArrayXXd& layer) {
    return layer.block(cells_.row_begin, cells_.col_begin, cells_.rows(), cells_.cols());
  };
  bank_.z = block(terrain.bank.z);
  loose_ = block(terrain.loose);
}

void ForeignDig::check_numbers(const ForeignAnswer& answer) const {
  require(answer.payload >= 0.0 && std::isfinite(answer.payload), "its payload [kg]",
          answer.payload, "finite and not negative");
  const double full = heaped_capacity(model_.machine) * model_.loose.bulk_density;
  require(answer.payload <= most_fill * full, "its payload [kg]", answer.payload,
          "at most " + number_text(most_fill) + " times the " + readable(full) +
              " kg of a heaped bucket");
  if (answer.loads.empty() && !answer.energy) refuse("it gives neither loads nor an energy");
  if (!answer.loads.empty() && answer.loads.size() != steps()) {
    refuse("it gives " + std::to_string(answer.loads.size()) + " loads for " +
           std::to_string(steps()) + " steps of the path");
  }
  for (std::size_t i = 0; i < answer.loads.size(); ++i) {
    const ForeignLoad& load = answer.loads[i];
    const std::string of = " of step " + std::to_string(i + 1);
    for (const double number : {load.force.x(), load.force.y(), load.moment}) {
      require(std::isfinite(number), "its load" + of, number, "finite");
    }
    require(load.carried >= 0.0 && std::isfinite(load.carried), "its soil carried [kg]" + of,
            load.carried, "finite and not negative");
  }
  if (answer.bank.rows() != bank_.z.rows() || answer.bank.cols() != bank_.z.cols() ||
      answer.loose.rows() != bank_.z.rows() || answer.loose.cols() != bank_.z.cols()) {
    refuse("its ground is not of the size of the window");
  }
  for (Index col = 0; col < bank_.z.cols(); ++col) {
    for (Index row = 0; row < bank_.z.rows(); ++row) {
      const double before = bank_.z(row, col);
      const double bank = answer.bank(row, col);
      const double loose = answer.loose(row, col);
      const bool sound = bank >= -farthest_height && bank <= before + height_rounding &&
                         loose >= 0.0 && loose <= farthest_height;
      if (sound || std::isnan(before)) continue;
      refuse("its ground has a bank of " + number_text(bank) + " m, which was at " +
             number_text(before) + " m, and a loose layer of " + number_text(loose) + " m in row " +
             std::to_string(row) + ", column " + std::to_string(col) +
             "; a bank must not rise, a loose layer not be negative");
    }
  }
}

void ForeignDig::check_mass(const ForeignAnswer& answer, double tolerance) const {
  double left = 0.0;
  double moved = 0.0;
  for (Index col = 0; col < bank_.z.cols(); ++col) {
    for (Index row = 0; row < bank_.z.rows(); ++row) {
      if (std::isnan(bank_.z(row, col))) continue;
      const double lost = (bank_.z(row, col) - answer.bank(row, col)) * model_.bank.dry_density +
                          (loose_(row, col) - answer.loose(row, col)) * model_.loose.dry_density;
      left += lost;
      moved += std::max(0.0, lost);
    }
  }
  const double area = bank_.cell_size * bank_.cell_size;
  const double lifted = answer.payload / (1.0 + model_.soil.water_content);
  const double most = std::max(area * moved, lifted);
  constexpr double rounding = 1e-9;  // of what is moved, and of a kilogram
  if (std::abs(area * left - lifted) <= std::max(tolerance, rounding) * most + rounding) return;
  refuse("its balance of dry mass is off: " + readable(area * left) + " kg left the ground and " +
         readable(lifted) + " kg are in the bucket, must agree within " + number_text(tolerance) +
         " of the " + readable(most) + " kg moved");
}

SoilLedger ForeignDig::change(const ForeignAnswer& answer, GroundWindow& ground) const {
  SoilLedger ledger;
  const double area = bank_.cell_size * bank_.cell_size;
  for (Index col = 0; col < bank_.z.cols(); ++col) {
    for (Index row = 0; row < bank_.z.rows(); ++row) {
      if (std::isnan(bank_.z(row, col))) continue;
      const double lowered = bank_.z(row, col) - answer.bank(row, col);
      const double gained = answer.loose(row, col) - loose_(row, col);
      const double in_pit = std::clamp(gained, 0.0, std::max(0.0, lowered));
      const std::size_t cell = ground.at(cells_.row_begin + row, cells_.col_begin + col);
      if (lowered > 0.0) ground.lower_bank(cell, lowered);
      ground.lower_loose(cell, -gained);
      ledger.bank_cut += std::max(0.0, lowered) * area;
      ledger.loose_cut += std::max(0.0, -gained) * area;
      ledger.fallen_back += in_pit * area;
      ledger.spilled += std::max(0.0, gained - in_pit) * area;
    }
  }
  return ledger;
}

DigResult ForeignDig::result(const ForeignAnswer& answer, double mass_tolerance) const {
  check_numbers(answer);
  if (!answer.given_up) check_mass(answer, mass_tolerance);
  GroundWindow ground(terrain_, {model_.soil, model_.bank, model_.loose}, cells_);
  DigAccount account(model_.machine, path_, options_);
  book(answer.loads, model_.machine, path_, model_.loose.bulk_density, account);
  account.result.soil = change(answer, ground);
  account.result.given_up = answer.given_up;
  if (answer.energy) account.result.energy = *answer.energy;
  account.close(ground, answer.payload / model_.loose.bulk_density,
                std::tan(model_.soil.angle_of_repose));
  account.result.payload_mass = answer.payload;
  return std::move(account.result);
}

}  // namespace excavplan
