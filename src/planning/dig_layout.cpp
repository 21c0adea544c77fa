// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/dig_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double looked_ahead = 0.25;   // of the lip, by the simulator [m]
constexpr double start_grid = 0.2;      // of the first look for a start [m]; ours
constexpr double start_within = 0.002;  // [m]; ours
// Of the joints from their limits, for a machine that does not track exactly [rad]; ours.
constexpr double joint_clearance = 0.035;
constexpr double coarse_step = 0.2;  // tip travel between poses while starts are compared [m]

/// Positive work of the joints against the weight of the links while they dig [J].
double link_work(const Machine& machine, const DigPath& path) {
  double work = 0.0;
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    if (path.poses[i].phase == DigPhase::lift) break;
    const JointAngles& from = path.poses[i - 1].joints;
    const JointAngles& to = path.poses[i].joints;
    const JointAngles torque =
        torque_against_link_weight(machine, link_positions(machine, 0.5 * (from + to)));
    work += (torque.array() * (to - from).array()).max(0.0).sum();
  }
  return work;
}

/// True if the joints keep off their limits while they dig.
bool keeps_off_limits(const Machine& machine, const DigPath& path) {
  return std::all_of(path.poses.begin(), path.poses.end(), [&](const DigPose& pose) {
    return pose.phase == DigPhase::lift ||
           limit_margin(machine, pose.joints).margin >= joint_clearance;
  });
}

/// Remaining share of one phase, 0 .. 1.
double rest_of_phase(const Infeasible& stop, const DigParameters& parameters) {
  const auto rest = [&](double length) {
    return length > 0.0 ? std::clamp(1.0 - stop.distance / length, 0.0, 1.0) : 1.0;
  };
  switch (stop.phase) {
    case DigPhase::penetrate:
      return rest(parameters.penetration_length);
    case DigPhase::drag:
      return rest(parameters.drag_length);
    default:
      return std::clamp(std::abs(stop.value - stop.limit), 0.0, 1.0);
  }
}

double left_to_drive(const Infeasible& stop, const DigParameters& parameters) {
  const double phases = static_cast<double>(DigPhase::lift) - static_cast<double>(stop.phase);
  return 1.0 + phases + rest_of_phase(stop, parameters);
}

}  // namespace

KnownStrip::KnownStrip(const Terrain& terrain, const Machine& machine)
    : origin_(terrain.bank.origin.x()), cell_(terrain.bank.cell_size) {
  const HeightMap& bank = terrain.bank;
  const double half = 0.5 * machine.bucket.width_outside;
  const auto begin = static_cast<Index>(std::floor((-half - bank.origin.y()) / cell_));
  const auto end = static_cast<Index>(std::ceil((half - bank.origin.y()) / cell_));
  const bool on_map = begin >= 0 && end <= bank.z.rows() && begin < end;
  unknown_before_ = {0};
  for (Index col = 0; col < bank.z.cols(); ++col) {
    const bool known = on_map && !bank.z.block(begin, col, end - begin, 1).isNaN().any();
    unknown_before_.push_back(unknown_before_.back() + (known ? 0 : 1));
  }
}

bool KnownStrip::is_known(double x_min, double x_max) const {
  const auto columns = static_cast<double>(unknown_before_.size() - 1);
  const double first = std::floor((x_min - origin_) / cell_);
  const double last = std::ceil((x_max - origin_) / cell_);
  if (!(first >= 0.0 && last <= columns)) return false;
  return unknown_before_[static_cast<std::size_t>(first)] ==
         unknown_before_[static_cast<std::size_t>(last)];
}

DigLayout::DigLayout(const Machine& machine, const Terrain& terrain)
    : machine_(machine), ground_(boom_plane_profile(terrain)), strip_(terrain, machine) {}

std::variant<DigPath, Infeasible> DigLayout::path(const DigParameters& parameters,
                                                  const StartRule& start) const {
  switch (start.kind) {
    case StartRule::Kind::given:
      return path_from(parameters, start.x);
    case StartRule::Kind::searched:
      throw Error(ErrorKind::bad_input, "the start of a single dig cannot be searched");
    case StartRule::Kind::least_work: {
      DigPathOptions coarse;
      coarse.step = coarse_step;
      for (const DigPathOptions& options : {coarse, DigPathOptions{}}) {
        const auto start_x = least_work_start(parameters, options);
        if (!start_x) continue;
        auto path = path_from(parameters, *start_x);
        if (std::holds_alternative<DigPath>(path)) return path;
      }
      break;
    }
    case StartRule::Kind::largest_margin:
      break;
  }
  auto path = make_dig_path_anywhere(machine_, parameters, ground_);
  if (std::holds_alternative<Infeasible>(path)) return path;
  return known(std::get<DigPath>(std::move(path)));
}

std::variant<DigPath, Infeasible> DigLayout::path_from(const DigParameters& parameters,
                                                       double start_x,
                                                       const DigPathOptions& options) const {
  auto path = make_dig_path(machine_, parameters, start_x, ground_, options);
  if (std::holds_alternative<Infeasible>(path)) return path;
  return known(std::get<DigPath>(std::move(path)));
}

/// The path, if every cell the bucket passes and those just ahead of it are known.
std::variant<DigPath, Infeasible> DigLayout::known(DigPath path) const {
  const double x_max = path.start_x + strip_.cell_size();
  const DigPose* phase_start = &path.poses.front();
  for (const DigPose& pose : path.poses) {
    if (pose.phase != phase_start->phase) phase_start = &pose;
    if (strip_.is_known(pose.bucket.x - looked_ahead, x_max)) continue;
    Infeasible stop;
    stop.reason = Infeasible::Reason::unknown_ground;
    stop.phase = pose.phase;
    stop.distance =
        std::hypot(pose.bucket.x - phase_start->bucket.x, pose.bucket.z - phase_start->bucket.z);
    stop.value = path.start_x;
    stop.message = "the path runs over ground that is unknown or off the map";
    return stop;
  }
  return path;
}

std::optional<double> DigLayout::work_from(const DigParameters& parameters, double start_x,
                                           const DigPathOptions& options) const {
  const auto path = path_from(parameters, start_x, options);
  const auto* drivable = std::get_if<DigPath>(&path);
  if (!drivable || !keeps_off_limits(machine_, *drivable)) return std::nullopt;
  return link_work(machine_, *drivable);
}

/// By halving steps around the best point of a grid: the work has one valley where the machine
/// reaches, and its end is sharp where the reach ends.
std::optional<double> DigLayout::least_work_start(const DigParameters& parameters,
                                                  const DigPathOptions& options) const {
  const double reach = machine_.full_length();
  std::optional<double> best;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](double x) {
    const auto work = work_from(parameters, x, options);
    if (!work || !(*work < least)) return;
    least = *work;
    best = x;
  };
  const double nearest = std::max(machine_.track_front, machine_.boom_pin.x() - reach);
  for (double x = nearest; x <= machine_.boom_pin.x() + reach; x += start_grid) look_at(x);
  for (double step = 0.5 * start_grid; best && step >= start_within; step *= 0.5) {
    const double middle = *best;
    look_at(middle - step);
    look_at(middle + step);
  }
  return best;
}

double violation(const DigFailure& failure, const DigParameters& parameters) {
  if (const auto* stop = std::get_if<Infeasible>(&failure)) {
    return left_to_drive(*stop, parameters);
  }
  const double length = parameters.penetration_length + parameters.drag_length;
  return length > 0.0 ? std::clamp(1.0 - std::get<Stall>(failure).travelled / length, 0.01, 1.0)
                      : 1.0;
}

std::variant<PlannedDig, DigFailure> dig_along(const Machine& machine,
                                               const SoilSimulator& simulator,
                                               const Terrain& terrain, const DigPath& path) {
  DigOptions unsettled;  // what slides after the bucket is out changes neither load nor energy
  unsettled.settle = false;
  const DigResult result = simulator.dig(terrain, path, unsettled);
  if (result.stall) return DigFailure(*result.stall);
  return PlannedDig{path.parameters,     path.start_x,
                    result.payload_mass, result.payload_volume,
                    result.energy.total, time_dig_path(machine, path).dig_duration()};
}

}  // namespace excavplan
