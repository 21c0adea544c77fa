// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/step_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/angles.hpp"
#include "planning/simulated_dig.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

// Numbers of our own choice.
constexpr double room_beyond = 2.0;  // of a view beyond the work, for the bucket and its pile [m]
constexpr double room_beside = 2.0;  // of a view beside the line [m]
constexpr double start_step = 0.4;   // between places where digs may begin [m]
constexpr double least_excess = 0.015;  // of soil that is worth a dig [m]
constexpr double too_deep_price = 4.0;  // of soil taken below the design, over that of the design
constexpr double spill_price = 2.0;     // of soil spilled beside design and dump areas, likewise
constexpr std::size_t most_confirmed = 8;  // digs whose ground is looked at
constexpr double level_from = 0.2;  // before the start of a dig, the ground whose level counts [m]
constexpr double level_to = 1.2;    // likewise [m]
const std::array<double, 6> cut_depths = {0.06, 0.1,  0.15,
                                          0.22, 0.32, 0.45};  // of the layer of a drag [m]
constexpr double heel_clearance = 0.12;                       // over the line of penetration [rad]
constexpr double risky = 0.4;          // what a dig is worth that may stall, over one that will not
constexpr double least_pass = 0.55;    // of a finishing pass, over the length of the work
constexpr double lifted_worth = 0.02;  // of any soil that a finishing pass lifts, likewise
constexpr double cleared_worth = 0.5;  // of soil taken off the floor, over ground brought in shape
const std::array<double, 4> wall_angles = {0.8, 0.95, 1.05, 1.13};  // likewise
const std::array<double, 2> wall_drags = {0.25, 0.6};               // [m]
constexpr double shortest_drag = 0.2;                               // [m]
/// Of the bucket's floor in the penetration [rad], and whether it stays so in the drag or turns
/// with the arm.
struct Attitude {
  double angle;
  bool is_kept;
};
const std::array<Attitude, 6> attitudes = {
    {{0.25, true}, {0.4, true}, {0.6, true}, {0.8, false}, {0.95, false}, {1.1, false}}};
const std::array<double, 3> finish_angles = {0.15, 0.3, 0.5};  // likewise
const std::array<double, 2> fills = {0.9,
                                     1.15};  // soil in the way of the bucket, over its capacity

/// A dig that is laid out.
struct Candidate {
  std::size_t lane = 0;
  DigPath path;
  PlannedDig dig{};
  double worth = 0.0;  ///< by the soil that it lifts
};

/// A lane, and what all digs in it ask of its view.
struct Lane {
  Lane(LaneView seen, double allowance)
      : view(std::move(seen)),
        floor(view.floor(allowance)),
        ground(view.profile()),
        excess(view.excess(allowance)) {}

  LaneView view;
  GroundProfile floor;
  GroundProfile ground;
  Eigen::ArrayXd excess;  ///< of each column [m]
};

class StepSearch {
 public:
  explicit StepSearch(const StepTask& task)
      : task_(task),
        machine_(task.settings.site.machine),
        simulator_(machine_, with_strength(task.settings.site.soil, task.strength_factor),
                   task.density_percent),
        hard_(machine_, with_strength(task.settings.site.soil, task.hard_factor),
              task.density_percent),
        capacity_(heaped_capacity(machine_)) {
    for (const double lane : task.lanes) {
      lanes_.emplace_back(LaneView(task.ground, task.map, dig_line(task.base, 0.0, lane), extent(),
                                   machine_.bucket.width_outside),
                          task.allowance);
    }
  }

  std::optional<StepDig> run() {
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) lay_out(lane);
    for (Candidate& candidate : candidates_) weigh(candidate);
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
    std::optional<StepDig> best;
    std::size_t lane = 0;  // of the best
    std::size_t confirmed = 0;
    for (const Candidate& candidate : candidates_) {
      if (confirmed == most_confirmed || !(candidate.worth > 0.0)) break;
      auto dig = confirm(candidate);
      if (!dig) continue;
      ++confirmed;
      if (best && !(dig->worth > best->worth)) continue;
      best = std::move(dig);
      lane = candidate.lane;
    }
    if (best) add_approach(lane, best->path);
    return best;
  }

 private:
  Rectangle extent() const {
    const double cell = task_.ground.bank.cell_size;
    const auto on_line = [&](double value) { return cell * std::floor(value / cell); };
    const double half = on_line(0.5 * machine_.bucket.width_outside + room_beside);
    return {on_line(std::max(task_.near - room_beyond, machine_.track_front)), -half,
            on_line(task_.far + room_beyond), half};
  }

  void add_approach(std::size_t lane, DigPath& path) const {
    auto down = way_down(machine_, path, boom_plane_profile(lanes_[lane].view.surface()));
    if (auto* poses = std::get_if<std::vector<DigPose>>(&down)) path.approach = std::move(*poses);
  }

  void lay_out(std::size_t lane) {
    const LaneView& view = lanes_[lane].view;
    DigPathOptions rules;
    rules.floor = lanes_[lane].floor;
    rules.penetration_clearance = heel_clearance;
    const GroundProfile& ground = lanes_[lane].ground;
    const double last = task_.finishing ? least_pass * (task_.far - task_.near) : start_step;
    for (double start = task_.far; start > task_.near + last; start -= start_step) {
      if (std::isnan(ground(start) - rules.floor(start)) || !is_worth_a_dig(lanes_[lane], start))
        continue;
      if (task_.finishing) {
        rules.drag_keeps_angle = true;
        for (const double angle : finish_angles) {
          const double down = std::max(0.0, ground(start) - rules.floor(start));
          const double drag = start - down / std::tan(angle) - nearest(angle);
          if (drag > shortest_drag) add(lane, {angle, 1.0, drag}, start, rules);
        }
        if (start == task_.far) cut_end_wall(lane, rules);
        continue;
      }
      const double level = mean_ground(view, start - level_to, start - level_from);
      if (std::isnan(level)) continue;
      for (const double cut : cut_depths) {
        if (cut > task_.deepest_cut) break;
        const double depth = std::max(ground(start) - level, 0.0) + cut;
        for (const Attitude& attitude : attitudes) {
          rules.drag_keeps_angle = attitude.is_kept;
          lay_out_layer(lane, start, {attitude.angle, depth, ground(start) - depth}, rules);
        }
        if (level - cut < rules.floor(start - level_to)) break;  // the next would be the same
      }
    }
  }

  /// Down the end of the work, as steep as the machine can.
  void cut_end_wall(std::size_t lane, DigPathOptions rules) {
    rules.drag_keeps_angle = false;
    for (const double angle : wall_angles) {
      for (const double drag : wall_drags) add(lane, {angle, 2.0, drag}, task_.far, rules);
    }
  }

  /// A penetration and the height of the drag after it.
  struct Layer {
    double angle;
    double depth;   ///< [m]
    double height;  ///< of the drag [m]
  };

  void lay_out_layer(std::size_t lane, double start, const Layer& layer,
                     const DigPathOptions& rules) {
    double last = 0.0;
    const double from = start - layer.depth / std::tan(layer.angle);
    const double longest = from - nearest(layer.angle);
    if (!(longest > shortest_drag)) return;
    for (const double fill : fills) {
      const double drag =
          std::min(drag_that_fills(lanes_[lane], {from, layer.height}, fill), longest);
      if (drag == last) break;
      add(lane, {layer.angle, layer.depth / std::sin(layer.angle), drag}, start, rules);
      last = drag;
    }
  }

  /// Where a drag with this floor angle may end: as the bucket curls, its tip comes nearer to the
  /// tracks.
  double nearest(double angle) const {
    const double attitude = angle + heel_clearance + machine_.beta();
    const double curls = machine_.bucket_length * (1.0 - std::cos(attitude));
    constexpr double rounded = 0.02;  // away from the limit [m]
    return std::max(task_.near,
                    machine_.track_front + DigPathOptions{}.track_margin + curls + rounded);
  }

  /// Of a part of a lane; NaN if none of it is known.
  static double mean_ground(const LaneView& view, double from, double to) {
    double sum = 0.0;
    int known = 0;
    for (Index col = 0; col < view.columns(); ++col) {
      if (view.x(col) < from || view.x(col) > to || std::isnan(view.ground_at(col))) continue;
      sum += view.ground_at(col);
      ++known;
    }
    return known > 0 ? sum / known : std::nan("");
  }

  bool is_worth_a_dig(const Lane& lane, double start) const {
    const LaneView& view = lane.view;
    const double first = view.x(0);
    const auto col = static_cast<Index>((start - start_step - first) / view.surface().cell_size);
    return col > 0 && col < view.columns() && lane.excess(col) > least_excess;
  }

  struct DragStart {
    double x;       ///< [m]
    double height;  ///< [m]
  };

  /// The length of a drag at this height that meets so much soil.
  double drag_that_fills(const Lane& lane, const DragStart& start, double fill) const {
    const LaneView& view = lane.view;
    const auto [from, height] = start;
    const double cell = view.surface().cell_size;
    const double bulking =
        (1.0 + simulator_.loose().void_ratio) / (1.0 + simulator_.bank().void_ratio);
    const double wanted = fill * capacity_ / bulking / machine_.bucket.width_outside;
    double met = 0.0;
    double x = from;
    while (met < wanted && x > task_.near) {
      const auto col = static_cast<Index>((x - view.x(0)) / cell);
      if (col < 0 || col >= view.columns()) break;
      const double above = view.ground_at(col) - height;
      if (above > 0.0) met += cell * std::min(above, lane.excess(col));
      x -= cell;
    }
    return std::max(shortest_drag, from - x);
  }

  void add(std::size_t lane, const DigParameters& parameters, double start,
           const DigPathOptions& rules) {
    auto path = make_dig_path(machine_, parameters, start, lanes_[lane].ground, rules);
    if (auto* made = std::get_if<DigPath>(&path)) candidates_.push_back({lane, std::move(*made)});
  }

  CycleOptions cycle() const {
    CycleOptions options;
    options.swing = task_.dump.swing;
    options.dump_height = task_.dump.height;
    return options;
  }

  double cost(const PlannedDig& dig) const {
    return dig.cycle_energy + task_.settings.time_price * dig.cycle_time;
  }

  void weigh(Candidate& candidate) {
    const Terrain& ground = lanes_[candidate.lane].view.ground().terrain();
    const auto dig = dig_of_path(machine_, simulator_, ground, candidate.path, cycle());
    if (!std::holds_alternative<PlannedDig>(dig)) return;
    candidate.dig = std::get<PlannedDig>(dig);
    candidate.worth = candidate.dig.payload_mass / cost(candidate.dig);
  }

  std::optional<StepDig> confirm(const Candidate& candidate) const {
    const LaneView& view = lanes_[candidate.lane].view;
    const Terrain& ground = view.ground().terrain();
    const auto in_hard = dig_of_path(machine_, hard_, ground, candidate.path, cycle());
    const auto* hard = std::get_if<PlannedDig>(&in_hard);
    auto dug = dig_to_rest(machine_, simulator_, ground, candidate.path, cycle());
    auto* found = std::get_if<SimulatedDig>(&dug);
    if (found == nullptr) return std::nullopt;
    StepDig step;
    step.lane = task_.lanes[candidate.lane];
    step.path = candidate.path;
    step.dig = found->dig;
    step.change = view.change(found->result.patch, task_.slack);
    double shaped = std::max(step.change.shaped, cleared_worth * step.change.cleared);
    if (!(shaped > 0.0)) shaped = lifted_worth * step.dig.payload_volume;
    const double deep_price = task_.finishing ? 1.0 : too_deep_price;
    const double gain = (task_.finishing ? shaped : step.change.gained) -
                        deep_price * step.change.too_deep - spill_price * step.change.spilled;
    if (!(gain > 0.0)) return std::nullopt;
    step.worth = (hard != nullptr ? 1.0 : risky) * gain / cost(step.dig);
    if (hard != nullptr) {
      step.strength_share = std::log(hard->energy / step.dig.energy) /
                            std::log(task_.hard_factor / task_.strength_factor);
    }
    return step;
  }

  const StepTask& task_;
  const Machine& machine_;
  HeightMapSimulator simulator_;
  HeightMapSimulator hard_;
  double capacity_;
  std::vector<Lane> lanes_;
  std::vector<Candidate> candidates_;
};

}  // namespace

SoilKind with_strength(SoilKind soil, double factor) {
  soil.cohesion_loosest *= factor;
  soil.cone_index_reference *= factor;
  return soil;
}

std::optional<StepDig> best_dig(const StepTask& task) { return StepSearch(task).run(); }

}  // namespace excavplan
