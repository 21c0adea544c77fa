// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/step_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <excavplan/planning/screened_search.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "base/parallel.hpp"
#include "planning/simulated_dig.hpp"
#include "simulation/across_tracks.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

// Numbers of our own choice.
constexpr double room_beyond = 2.0;  // of a view beyond the work, for the bucket and its pile [m]
constexpr double room_beside = 2.0;  // of a view beside the line [m]
constexpr double start_step = 0.4;   // between places where digs may begin [m]
constexpr double least_excess = 0.015;   // of soil that is worth a dig [m]
constexpr double least_ridge = 0.004;    // likewise of a finishing pass: it may lie at a wall alone
constexpr double too_deep_price = 4.0;   // of soil taken below the design, over that of the design
constexpr double spill_price = 2.0;      // of soil spilled beside design and dump areas, likewise
constexpr double most_touched = 0.0005;  // by a dig, of what no soil may touch [m^3]
constexpr std::size_t most_lanes = 7;    // that are searched at once
constexpr std::size_t most_confirmed = 8;  // digs whose ground is looked at
constexpr std::size_t most_ranked = 24;    // on the ground itself; of more, the best on coarser
constexpr int coarse_cells = 2;            // of the ground along x and y in one of that
constexpr double level_from = 0.2;  // before the start of a dig, the ground whose level counts [m]
constexpr double level_to = 1.2;    // likewise [m]
const std::array<double, 6> cut_depths = {0.06, 0.1,  0.15,
                                          0.22, 0.32, 0.45};  // of the layer of a drag [m]
constexpr double lowest = -100.0;                             // of a drag along the floor [m]
constexpr double heel_clearance = 0.12;                       // over the line of penetration [rad]
constexpr double height_doubt = 0.01;  // of the edge over the ground, at which no dig may stall [m]
constexpr double risky = 0.2;          // what a dig is worth that may stall, over one that will not
constexpr double behind_sure = 1e-6;   // likewise, to be looked at after all of those
constexpr double least_pass = 0.55;    // of a finishing pass, over the length of the work
constexpr double shortest_pass = 0.6;  // [m]
constexpr double above_ground = 0.015;  // where a pass begins: an edge in it would not move [m]
constexpr double in_shape_over = 0.5;   // so far the ground is in shape after it [m]
constexpr double cleared_worth = 0.5;   // of soil taken off the floor, over ground brought in shape
constexpr double pushed_price = 0.5;    // of soil that a pass pushes beside it, likewise
constexpr double same_lane = 0.05;      // of a dig that lifted little [m]
constexpr double same_start = 0.25;     // likewise [m]
constexpr double same_turn = 0.03;      // likewise [rad]
constexpr double leaning = 0.1;         // of the design under a bucket that runs along a face [m]
constexpr double same_floor = 0.02;     // of lanes of which none is above the other [m]
constexpr double most_below = 2.0;      // of what a lane shapes, in tolerances below its floor
constexpr double least_gain = 0.2;      // of a dig for volume, over the bucket's capacity
constexpr double least_in_hard = 0.07;  // likewise in soil that lets no bucket fill
constexpr double least_on_bench = 0.3;  // likewise where more is below that can come with it
constexpr double most_from_beside = 1.5;  // of soil that a dig lifts, over what lies in its lane
constexpr double least_at_wall = 0.06;    // likewise, counting what lies there twice
constexpr double least_lifted = 0.012;    // by a finishing pass [m^3]
constexpr double standing = 0.05;        // of a bank in a lane over the mean ground of the lane [m]
constexpr double least_finished = 0.06;  // that a pass brings within the tolerance [m^2]
constexpr double least_of_many = 0.15;   // likewise of a design that has faces and many places
constexpr double least_cleared = 0.015;  // or clears, for later ones [m^3]
constexpr double wall_from = 0.5;        // before the end, soil that later digs would leave [m]
constexpr double wall_to = 0.12;         // likewise [m]
constexpr double least_of_flatter = 0.5;     // of what a flatter cut there is worth
constexpr double high_wall = 0.04;           // where it is highest, to be cut first [m]
constexpr double most_doubt_at_wall = 1.42;  // of the soil's strength
constexpr double wall_worth = 1.0;           // of that soil, beyond that of other soil
constexpr double shortest_drag = 0.2;        // [m]
constexpr double holding = 0.9;  // of the angle of repose: a bucket's floor on which soil stays
/// Of the bucket's floor in the penetration [rad], and whether it stays so in the drag or turns
/// with the arm.
struct Attitude {
  double angle;
  bool is_kept;
};
const std::array<Attitude, 4> attitudes = {{{0.25, true}, {0.4, true}, {0.6, true}, {0.8, false}}};
const std::array<Attitude, 5> wall_attitudes = {
    {{1.3, false}, {1.2, false}, {1.1, false}, {1.0, false}, {0.8, false}}};
// Where a flat cut would stall or lift the front, the bucket bites: a short steep penetration, and
// then its cylinder, the strongest, curls it through the soil.
const std::array<double, 4> bite_angles = {1.0, 1.2, 1.3, 1.4};  // [rad]
const std::array<double, 2> bite_depths = {0.04, 0.08};          // of its penetration [m]
const std::array<double, 3> bite_drags = {0.0, 0.4, 0.8};        // [m]
constexpr double least_bitten = 0.06;                            // of soil over the floor there [m]
constexpr double least_strength = 0.2;   // of soil, over that of its kind, that is looked at
constexpr double most_strength = 20.0;   // likewise
constexpr int strength_halvings = 6;     // of these bounds, by their logarithm
constexpr double poor_fill = 0.5;        // of a dig, so that a bite may do better
constexpr double thinnest_layer = 0.04;  // of a drag in hard soil [m]
const std::array<double, 4> shavings = {thinnest_layer, 0.07, 0.11, 0.16};  // off a bank [m]
constexpr double over_open = 0.05;   // of one over the ground before the bank, at least [m]
constexpr double bank_from = 0.2;    // before the start of one, the bank whose level counts [m]
constexpr double bank_to = 0.6;      // likewise [m]
constexpr double least_slope = 0.1;  // of ground, to be dug along it [rad]
const std::array<double, 5> slope_cuts = {0.05, 0.08, 0.12, 0.18, 0.26};  // below it [m]
const std::array<double, 2> steeper_than_slope = {0.15, 0.3};  // of a dig than the ground [rad]
constexpr Attitude steep_attitude = {1.1, false};              // along the walls of a pit
const std::array<double, 4> finish_angles = {0.05, 0.1, 0.2, 0.35};  // likewise
const std::array<double, 2> face_angles = {0.2, 0.35};               // likewise along a face
constexpr double face_step = 0.1;                                    // likewise between starts [m]
constexpr double steepest_drag = 1.0;                                // down a face [rad]
constexpr double steepest_floor = 0.15;                              // else it is a face [rad]
constexpr double on_face = 0.2;                                      // where its slope is told [m]
const std::array<double, 2> steeper_rakes = {0.1, 0.3};              // of a dig than its face [rad]
const std::array<double, 2> sweep_rakes = {0.42, 0.5};               // of a bucket along its floor
const std::array<double, 4> sweep_layers = {0.1, 0.18, 0.3, 1.0};    // that one takes off [m]
const std::array<double, 3> sweep_ends = {0.07, 0.3, 0.6};           // before the near end [m]
constexpr double shortest_sweep = 0.6;                               // [m]
constexpr double sweep_fall_over = 0.25;                 // where its floor's fall is told [m]
const std::array<double, 2> sweep_angles = {0.15, 1.4};  // of its penetration [rad]
const std::array<double, 2> fills = {0.9,
                                     1.15};  // soil in the way of the bucket, over its capacity

/// A dig that is laid out.
struct Candidate {
  std::size_t lane = 0;
  DigPath path;
  double worth = 0.0;  ///< by the soil that it lifts
};

/// The path in steps twice as long.
DigPath every_second(const DigPath& path) {
  DigPath coarse = path;
  coarse.poses.clear();
  const std::size_t count = path.poses.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool ends_phase = i + 1 == count || path.poses[i + 1].phase != path.poses[i].phase;
    if (i % 2 == 0 || ends_phase) coarse.poses.push_back(path.poses[i]);
  }
  return coarse;
}

/// A lane, and what all digs in it ask of its view.
struct Lane {
  Lane(const WorkLine& where, LaneView seen, const StepTask& task)
      : line(where),
        view(std::move(seen)),
        floor(view.floor(task.allowance)),
        ground(view.top()),
        mean(view.mean()),
        excess(view.excess(task.allowance)),
        leans(task.has_steps &&
              mean_over(line.near, line.far, [&](Index col) { return view.fall(col); }) > leaning) {
  }

  /// Soil that stands over the rest of the lane there: a bucket cannot begin within it.
  bool has_bank_at(double x) const { return !leans && ground(x) - mean(x) > standing; }
  /// Of a value of each column, over a part of the lane; NaN if none of it is known.
  template <typename Value>
  double mean_over(double from, double to, Value value) const {
    double sum = 0.0;
    int known = 0;
    for (Index col = 0; col < view.columns(); ++col) {
      if (view.x(col) < from || view.x(col) > to || std::isnan(value(col))) continue;
      sum += value(col);
      ++known;
    }
    return known > 0 ? sum / known : std::nan("");
  }

  WorkLine line;
  LaneView view;
  GroundProfile floor;
  GroundProfile ground;   ///< that the bucket meets first
  GroundProfile mean;     ///< under all of the bucket
  Eigen::ArrayXd excess;  ///< of each column [m]
  bool leans;             ///< it runs along a face, on which one side of the bucket cuts
};

class StepSearch {
 public:
  explicit StepSearch(const StepTask& task)
      : task_(task),
        machine_(looking(task.settings.site.machine, -task.tracks)),
        simulator_(machine_, with_strength(task.settings.site.soil, task.strength_factor),
                   task.density_percent),
        hard_(machine_, with_strength(task.settings.site.soil, task.hard_factor),
              task.density_percent),
        firm_(machine_, with_strength(task.settings.site.soil, wall_factor()),
              task.density_percent),
        capacity_(heaped_capacity(machine_) - task.carried) {
    for (const WorkLine& line : task.lines) {
      LaneView view(task.ground, task.map, dig_line(task.base, line.turned, line.lane),
                    extent(line), machine_.bucket.width_outside);
      if (task.bench) view.keep_above(*task.bench - task.base.z);
      lanes_.emplace_back(line, std::move(view), task);
    }
  }

  std::optional<StepDig> run() {
    if (!task_.bench) {
      if (auto dig = best_at_wall()) return dig;
    }
    if (task_.finishing && task_.has_steps) return best_from_top();
    const std::vector<std::size_t> lanes = fullest_first();
    for (std::size_t done = 0; done < lanes.size(); done += most_lanes) {
      const std::vector<std::size_t> some(
          lanes.begin() + static_cast<std::ptrdiff_t>(done),
          lanes.begin() + static_cast<std::ptrdiff_t>(std::min(done + most_lanes, lanes.size())));
      if (auto dig = best_in(some)) return dig;
    }
    return std::nullopt;
  }

 private:
  /// What a dig is for: the wall at the end of the work, volume, any volume where the soil is hard,
  /// or the shape of the floor.
  enum class Aim { wall, volume, hard, shape };

  std::optional<StepDig> best_in(const std::vector<std::size_t>& lanes) {
    candidates_.clear();
    for (const std::size_t lane : lanes) lay_out(lane);
    if (task_.finishing) return best(Aim::shape);
    auto dig = best(Aim::volume);
    if (!task_.may_bite || (dig && !dig->may_stall && dig->dig.fill > poor_fill)) return dig;
    candidates_.clear();
    for (const std::size_t lane : lanes) lay_out_in_hard(lane);
    auto bite = best(Aim::hard);
    return bite && (!dig || bite->worth > dig->worth) ? bite : dig;
  }

  /// In the highest lane in which a pass is worth its cycle: what it cuts falls on those below.
  std::optional<StepDig> best_from_top() {
    std::vector<double> floor;
    for (const Lane& lane : lanes_) {
      const double mean = lane.mean_over(lane.line.near, lane.line.far,
                                         [&](Index col) { return lane.floor(lane.view.x(col)); });
      floor.push_back(std::isnan(mean) ? -std::numeric_limits<double>::infinity() : mean);
    }
    std::vector<std::size_t> order;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (lanes_[lane].leans || !task_.leaves_floor) order.push_back(lane);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return floor[a] > floor[b]; });
    for (std::size_t first = 0; first < order.size();) {
      std::size_t end = first;
      while (end < order.size() && !(floor[order[end]] < floor[order[first]] - same_floor)) ++end;
      if (auto dig = best_in({order.begin() + static_cast<std::ptrdiff_t>(first),
                              order.begin() + static_cast<std::ptrdiff_t>(end)}))
        return dig;
      first = end;
    }
    return std::nullopt;
  }

  /// The lanes by what is above the design in them, if there are too many to look at all at once.
  std::vector<std::size_t> fullest_first() const {
    std::vector<std::size_t> order(lanes_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (order.size() <= most_lanes) return order;
    std::vector<double> above;
    for (const Lane& lane : lanes_) above.push_back(lane.excess.sum());
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return above[a] > above[b]; });
    return order;
  }

  /// As steeply as the machine surely can without a loss of its work; else, if it may risk a
  /// stall, what is worth most.
  std::optional<StepDig> best_at_wall() {
    std::vector<std::size_t> lanes;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (lanes_[lane].line.ends_at_wall && has_end_wall(lanes_[lane])) lanes.push_back(lane);
    }
    if (lanes.empty()) return std::nullopt;
    std::vector<StepDig> sure;
    std::optional<StepDig> risky_one;
    for (const Attitude& attitude : wall_attitudes) {
      for (const std::size_t lane : lanes) cut_end_wall(lane, attitude);
      auto dig = best(Aim::wall);
      candidates_.clear();
      if (!dig) continue;
      if (!dig->may_stall) {
        sure.push_back(*std::move(dig));
        if (sure.back().dig.fill > poor_fill) break;
      } else if (task_.may_risk && (!risky_one || dig->worth > risky_one->worth)) {
        risky_one = std::move(dig);
      }
    }
    if (sure.empty()) return risky_one;
    const auto most =
        std::max_element(sure.begin(), sure.end(),
                         [](const StepDig& a, const StepDig& b) { return a.worth < b.worth; });
    const double least = least_of_flatter * most->worth;
    return *std::find_if(sure.begin(), sure.end(),
                         [&](const StepDig& each) { return each.worth >= least; });
  }

  std::optional<StepDig> best(Aim aim) {
    rank(aim);
    std::optional<StepDig> best;
    std::size_t lane = 0;  // of the best
    std::size_t confirmed = 0;
    for (std::size_t next = 0; next < candidates_.size() && confirmed < most_confirmed;) {
      const std::size_t count = std::min(most_confirmed - confirmed, candidates_.size() - next);
      std::vector<std::optional<StepDig>> digs(count);
      parallel_for(count, 0, [&](std::size_t i) { digs[i] = confirm(candidates_[next + i], aim); });
      for (std::size_t i = 0; i < count; ++i) {
        if (!digs[i]) continue;
        ++confirmed;
        if (best && !(digs[i]->worth > best->worth)) continue;
        best = std::move(digs[i]);
        lane = candidates_[next + i].lane;
      }
      next += count;
    }
    if (!best) return best;
    best->signs.stalls_at = stalls_at(lane, best->path);
    best->signs.strength = task_.strength_factor;
    best->signs.layer = layer_under(best->path);
    add_approach(lane, best->path);
    return best;
  }

  /// Loose soil per thickness below the way of a bucket through the ground [kg/m].
  double layer_under(const DigPath& path) const {
    const auto lifted = std::find_if(path.poses.begin(), path.poses.end(), [](const DigPose& pose) {
      return pose.phase == DigPhase::lift;
    });
    const double length = path.poses.front().bucket.x - std::prev(lifted)->bucket.x;
    return loose_mass(task_.settings.site.soil,
                      machine_.bucket.width_outside * std::max(0.0, length));
  }

  /// The least factor on the soil's strength at which a dig stalls, within the bounds.
  double stalls_at(std::size_t lane, const DigPath& path) const {
    const Terrain& ground = lanes_[lane].view.ground().terrain();
    double low = std::log(least_strength);
    double high = std::log(most_strength);
    for (int i = 0; i < strength_halvings; ++i) {
      const double middle = 0.5 * (low + high);
      const HeightMapSimulator simulator(machine_,
                                         with_strength(task_.settings.site.soil, std::exp(middle)),
                                         task_.density_percent);
      const auto dig = dig_of_path(machine_, simulator, ground, path, {});
      (std::holds_alternative<PlannedDig>(dig) ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
  }

  Rectangle extent(const WorkLine& line) const {
    const double cell = task_.ground.bank.cell_size;
    const auto on_line = [&](double value) { return cell * std::floor(value / cell); };
    const double half = on_line(0.5 * machine_.bucket.width_outside + room_beside);
    // A bite ends so far before the work, and then the bucket curls.
    const double first = line.near - bite_drags.back() - 2.0 * machine_.bucket_length;
    return {on_line(std::max(first, machine_.track_front)), -half, on_line(line.far + room_beyond),
            half};
  }

  void add_approach(std::size_t lane, DigPath& path) const {
    auto down = way_down(machine_, path, boom_plane_profile(lanes_[lane].view.surface()));
    if (auto* poses = std::get_if<std::vector<DigPose>>(&down)) path.approach = std::move(*poses);
  }

  DigPathOptions rules_in(std::size_t lane) const {
    DigPathOptions rules;
    rules.floor = lanes_[lane].floor;
    rules.penetration_clearance = heel_clearance;
    return rules;
  }

  void lay_out(std::size_t lane) {
    if (task_.finishing) return lay_out_passes(lane);
    const WorkLine& line = lanes_[lane].line;
    if (!may_yield(lanes_[lane], least_of_volume())) return;
    if (task_.tracks != 0.0) lay_out_sweeps(lane);
    for (double start = line.far; start > line.near + start_step; start -= start_step) {
      if (!is_worth_a_dig(lanes_[lane], start)) continue;
      lay_out_layers(lane, start, attitudes, rules_in(lane));
      if (task_.has_others_beside || task_.bench)
        lay_out_layers(lane, start, std::array{steep_attitude}, rules_in(lane));
      lay_out_face(lane, start);
      lay_out_along_slope(lane, start);
    }
  }

  double least_of_volume() const { return (task_.bench ? least_on_bench : least_gain) * capacity_; }

  /// Whether so much can still come out of a lane.
  bool may_yield(const Lane& lane, double least) const {
    const WorkLine& line = lane.line;
    const double mean =
        lane.mean_over(line.near, line.far, [&](Index c) { return lane.excess(c); });
    const double lies = mean * (line.far - line.near) * machine_.bucket.width_outside;
    return most_from_beside * lies > least;
  }

  /// Bites, and the thinnest layers.
  void lay_out_in_hard(std::size_t lane) {
    const Lane& at = lanes_[lane];
    const WorkLine& line = at.line;
    if (!may_yield(at, least_in_hard * capacity_)) return;
    DigPathOptions rules = rules_in(lane);
    for (double start = line.far; start > line.near; start -= start_step) {
      const double ground = at.ground(start);
      if (!(ground - at.floor(start) > least_bitten)) continue;
      for (const double angle : bite_angles) {
        for (const double depth : bite_depths) {
          for (const double drag : bite_drags)
            add(lane, {angle, depth / std::sin(angle), drag}, start, rules);
        }
      }
      for (const Attitude& attitude : attitudes) {
        rules.drag_keeps_angle = attitude.is_kept;
        lay_out_layer(lane, start, {attitude.angle, ground - thinnest_layer}, rules);
      }
      rules.drag_keeps_angle = false;
      lay_out_along_slope(lane, start);
    }
    for (double start = line.far; start > line.near + start_step; start -= start_step)
      lay_out_shavings(lane, start);
  }

  /// Level layers off the top of a bank, from the open ground beyond it: the edge need not
  /// penetrate.
  void lay_out_shavings(std::size_t lane, double start) {
    const Lane& at = lanes_[lane];
    if (!is_worth_a_dig(at, start)) return;
    const double top = at.mean_over(start - bank_to, start - bank_from,
                                    [&](Index col) { return at.view.ground_at(col); });
    DigPathOptions rules = rules_in(lane);
    rules.drag_keeps_angle = true;
    for (const double cut : shavings) {
      const double height = top - cut;
      if (!(height > at.ground(start) + over_open)) return;
      for (const Attitude& attitude : attitudes) {
        if (!attitude.is_kept) continue;
        add_drags(
            lane, {attitude.angle, 0.0, 0.0}, {start, start, height},
            [&](double) { return height; }, rules);
      }
    }
  }

  /// Layers of even depth below ground that falls towards the machine: level ones meet all of its
  /// height at once, or none of it.
  void lay_out_along_slope(std::size_t lane, double start) {
    const Lane& at = lanes_[lane];
    const double slope = (at.mean(start) - at.mean(start - level_to)) / level_to;
    const double grade = std::atan(slope);
    if (!(grade > least_slope) || grade + steeper_than_slope.back() > steepest_drag) return;
    DigPathOptions rules = rules_in(lane);
    rules.drag_keeps_angle = true;
    for (const double cut : slope_cuts) {
      rules.floor = [&at, cut](double x) { return std::fmax(at.floor(x), at.mean(x) - cut); };
      for (const double more : steeper_than_slope) {
        const double angle = grade + more;
        rules.drag_grade = grade + 0.5 * more;
        const double down = drop_to(at, start, at.mean(start) - cut);
        const double from = start - down / (std::tan(angle) - slope);
        add_drags(lane, {angle, 1.0, 0.0}, {start, from}, rules.floor, rules);
      }
    }
  }

  /// Along the floor; where a bank stands in the lane by layers from its top, since the bucket
  /// cannot begin within it.
  void lay_out_passes(std::size_t lane) {
    if (task_.tracks != 0.0) return lay_out_sweeps(lane);
    if (lanes_[lane].leans) return lay_out_along_face(lane);
    DigPathOptions rules = rules_in(lane);
    rules.drag_keeps_angle = true;
    const WorkLine& line = lanes_[lane].line;
    const double last = line.near + least_pass * (line.far - line.near);
    for (double start = line.far; start > last; start -= start_step) {
      if (!is_worth_a_dig(lanes_[lane], start)) continue;
      lay_out_face(lane, start);
      if (task_.has_faces) lay_out_along_slope(lane, start);  // where all of a face would stall
      if (lanes_[lane].has_bank_at(start)) {
        lay_out_layers(lane, start, attitudes, rules_in(lane));
        continue;
      }
      for (const double angle : finish_angles) {
        const double drag = longest_drag(lanes_[lane], start, angle);
        if (drag > shortest_drag) add(lane, {angle, 1.0, drag}, start, rules);
        const double shorter = drag - (in_shape_before(lanes_[lane], start) - line.near);
        if (shorter > shortest_drag && shorter < drag)
          add(lane, {angle, 1.0, shorter}, start, rules);
      }
    }
  }

  /// All along it at once, from as far as the front reaches with a flat bucket.
  void lay_out_along_face(std::size_t lane) {
    const Lane& at = lanes_[lane];
    DigPathOptions rules = rules_in(lane);
    rules.drag_keeps_angle = true;
    const double last = at.line.near + least_pass * (at.line.far - at.line.near);
    bool is_laid_out = false;
    for (double start = at.line.far; start > last && !is_laid_out; start -= face_step) {
      if (!is_worth_a_dig(at, start)) continue;
      lay_out_face(lane, start);
      const std::size_t steep = candidates_.size();
      for (const double angle : face_angles) {
        const double drag = longest_drag(at, start, angle);
        if (drag > shortest_drag) add(lane, {angle, 1.0, drag}, start, rules);
      }
      is_laid_out = candidates_.size() > steep;
    }
  }

  /// The ground on which a dig begins: a thin cut on the mean, else where the bucket meets it.
  const GroundProfile& ground_of(const Lane& lane, double start) const {
    const bool is_even = task_.finishing && !lane.leans && !lane.has_bank_at(start);
    return is_even ? lane.mean : lane.ground;
  }

  /// So far over it a dig begins.
  double above_start() const { return task_.finishing ? above_ground : 0.0; }

  /// From where a dig begins to a height below it.
  double drop_to(const Lane& lane, double start, double height) const {
    return std::max(0.0, ground_of(lane, start)(start) - height) + above_start();
  }

  /// Along the floor, from the end of a penetration at that angle to as near as the bucket comes.
  double longest_drag(const Lane& lane, double start, double angle) const {
    const double down = drop_to(lane, start, lane.floor(start));
    return start - down / std::tan(angle) - nearest(lane.line, angle);
  }

  /// Down the far face, along the floor and up the near face, in layers for volume.
  void lay_out_sweeps(std::size_t lane) {
    const Lane& at = lanes_[lane];
    for (double start = at.line.far; start > at.line.near + shortest_sweep; start -= start_step) {
      if (!is_worth_a_dig(at, start)) continue;
      for (const double layer : sweep_layers) {
        if (task_.finishing && layer < sweep_layers.back()) continue;
        const auto floor = [&at, layer](double x) {
          const double ground = (at.mean(x - on_face) + at.mean(x) + at.mean(x + on_face)) / 3.0;
          return std::isnan(ground) ? at.floor(x) : std::max(at.floor(x), ground - layer);
        };
        for (const double rake : sweep_rakes) {
          if (sweep(lane, start, rake, floor) && task_.finishing) break;
        }
      }
    }
  }

  /// From a start to some ends: for volume to where the bucket is full, else as far as can be.
  /// @return whether the front can
  bool sweep(std::size_t lane, double start, double rake, const GroundProfile& floor) {
    const Lane& at = lanes_[lane];
    DigPathOptions rules = rules_in(lane);
    rules.floor = floor;
    rules.drag_follows_floor = true;
    rules.penetration_clearance = 0.0;
    const double rise = floor(start + sweep_fall_over) - floor(start - sweep_fall_over);
    const double fall = rise / (2.0 * sweep_fall_over);
    const double angle = std::atan(fall) + rake;
    if (!(angle > sweep_angles.front() && angle < sweep_angles.back())) return false;
    const double from = start - drop_to(at, start, floor(start)) / (std::tan(angle) - fall);
    const std::size_t before_all = candidates_.size();
    double last = 0.0;
    for (const double before : sweep_ends) {
      const double longest = from - at.line.near - before;
      const double drag =
          task_.finishing ? longest : std::min(longest, sweep_that_fills(at, from, floor));
      if (drag == last || !(drag > shortest_sweep)) continue;
      add(lane, {angle, 1.0, drag}, start, rules);
      if (task_.finishing && candidates_.size() > before_all) break;
      last = drag;
    }
    return candidates_.size() > before_all;
  }

  /// Where the ground before a start comes into shape for a while: to cut on would only roughen
  /// it.
  double in_shape_before(const Lane& lane, double start) const {
    for (double x = start - shortest_pass; x > lane.line.near; x -= lane.view.surface().cell_size) {
      const double left =
          lane.mean_over(x - in_shape_over, x, [&](Index col) { return lane.excess(col); });
      if (left < task_.slack) return x;
    }
    return lane.line.near;
  }

  /// Down a face that falls towards the machine, and on along what lies before it.
  void lay_out_face(std::size_t lane, double start) {
    if (!task_.has_faces) return;
    DigPathOptions rules = rules_in(lane);
    rules.drag_keeps_angle = true;
    const double face = std::atan((rules.floor(start) - rules.floor(start - on_face)) / on_face);
    if (!(face > steepest_floor)) return;
    for (const double more : steeper_rakes) {
      const double angle = face + more;
      rules.drag_grade = face + 0.5 * more;
      if (rules.drag_grade > steepest_drag) break;
      if (!task_.finishing) {
        const double down = drop_to(lanes_[lane], start, rules.floor(start));
        const double from = start - down / std::tan(angle);
        add_drags(
            lane, {angle, 1.0, 0.0}, {start, from}, [](double) { return lowest; }, rules);
        continue;
      }
      const double longest = longest_drag(lanes_[lane], start, angle);
      if (longest > shortest_drag) add(lane, {angle, 1.0, longest}, start, rules);
    }
  }

  /// Layers of all depths from there.
  template <typename Attitudes>
  void lay_out_layers(std::size_t lane, double start, const Attitudes& with, DigPathOptions rules) {
    const double ground = ground_of(lanes_[lane], start)(start);
    const LaneView& view = lanes_[lane].view;
    const double level = lanes_[lane].mean_over(start - level_to, start - level_from,
                                                [&](Index col) { return view.ground_at(col); });
    if (std::isnan(level)) return;
    for (const double cut : cut_depths) {
      if (cut > task_.deepest_cut) break;
      const double height = std::min(ground, level) - cut;
      for (const Attitude& attitude : with) {
        rules.drag_keeps_angle = attitude.is_kept;
        lay_out_layer(lane, start, {attitude.angle, height}, rules);
      }
      if (level - cut < rules.floor(start - level_to)) break;  // the next would be the same
    }
  }

  /// Whether soil stands before the end of the work.
  bool has_end_wall(const Lane& lane) const {
    return lane.mean_over(lane.line.far - wall_from, lane.line.far - wall_to, [&](Index col) {
      return lane.ground(lane.view.x(col)) - lane.floor(lane.view.x(col));
    }) > high_wall;
  }

  /// Steep layers from the end of the work: a flat cut would leave a ramp there, which is
  /// costly to take off by itself.
  void cut_end_wall(std::size_t lane, const Attitude& attitude) {
    DigPathOptions rules = rules_in(lane);
    const double far = lanes_[lane].line.far;
    lay_out_layers(lane, far, std::array{attitude}, rules);
    // From its top, where what lies before it is deeper already.
    const double top = ground_of(lanes_[lane], far)(far);
    for (const double cut : cut_depths) {
      if (cut > task_.deepest_cut) break;
      lay_out_layer(lane, far, {attitude.angle, top - cut}, rules);
    }
  }

  /// A penetration and the height of the drag after it.
  struct Layer {
    double angle;
    double height;  ///< of the drag [m]
  };

  void lay_out_layer(std::size_t lane, double start, const Layer& layer,
                     const DigPathOptions& rules) {
    const double down = drop_to(lanes_[lane], start, layer.height);
    const double from = start - down / std::tan(layer.angle);
    add_drags(
        lane, {layer.angle, down / std::sin(layer.angle), 0.0}, {start, from},
        [&](double) { return layer.height; }, rules);
  }

  /// Where a dig begins, and its drag [m].
  struct Begin {
    double start;
    double drag;
    double height = -infinity;  ///< over the ground, if that is lower there
  };

  /// With drags that fill the bucket, by the soil above a height of each x, or as long as can be.
  template <typename Height>
  void add_drags(std::size_t lane, DigParameters dig, const Begin& at, Height height,
                 const DigPathOptions& rules) {
    const double longest = at.drag - nearest(lanes_[lane].line, dig.penetration_angle);
    if (!(longest > shortest_drag)) return;
    double last = 0.0;
    for (const double fill : fills) {
      dig.drag_length = std::min(drag_that_fills(lanes_[lane], at.drag, height, fill), longest);
      if (dig.drag_length == last) break;
      add(lane, dig, at, rules);
      last = dig.drag_length;
    }
  }

  /// Where a drag with this floor angle may end: as the bucket curls, its tip comes nearer to
  /// the tracks.
  double nearest(const WorkLine& line, double angle) const {
    const double attitude = angle + heel_clearance + machine_.beta();
    const double curls = machine_.bucket_length * (1.0 - std::cos(attitude));
    constexpr double rounded = 0.02;  // away from the limit [m]
    return std::max(line.near,
                    machine_.track_front + DigPathOptions{}.track_margin + curls + rounded);
  }

  bool is_worth_a_dig(const Lane& lane, double start) const {
    const LaneView& view = lane.view;
    if (std::isnan(lane.ground(start) - lane.floor(start))) return false;
    const double first = view.x(0);
    const auto col = static_cast<Index>((start - start_step - first) / view.surface().cell_size);
    return col > 0 && col < view.columns() &&
           lane.excess(col) > (task_.finishing ? least_ridge : least_excess);
  }

  /// The length of a drag above a height of each x that meets so much soil.
  template <typename Height>
  double drag_that_fills(const Lane& lane, double from, Height height, double fill) const {
    const LaneView& view = lane.view;
    const double cell = view.surface().cell_size;
    const double wanted = fill * capacity_ / bulking() / machine_.bucket.width_outside;
    double met = 0.0;
    double x = from;
    while (met < wanted && x > lane.line.near) {
      const auto col = static_cast<Index>((x - view.x(0)) / cell);
      if (col < 0 || col >= view.columns()) break;
      const double above = view.ground_at(col) - height(x);
      if (above > 0.0) met += cell * std::min(above, lane.excess(col));
      x -= cell;
    }
    return std::max(shortest_drag, from - x);
  }

  /// The length of a sweep that meets a bucket of soil.
  double sweep_that_fills(const Lane& lane, double from, const GroundProfile& floor) const {
    const double cell = lane.view.surface().cell_size;
    const double wanted = fills.back() * capacity_ / bulking() / machine_.bucket.width_outside;
    double met = 0.0;
    double x = from;
    for (; met < wanted && x > lane.line.near; x -= cell)
      met += cell * std::max(0.0, lane.mean(x) - floor(x));
    return from - x;
  }

  void add(std::size_t lane, const DigParameters& parameters, double start,
           const DigPathOptions& rules) {
    add(lane, parameters, {start, start}, rules);
  }

  void add(std::size_t lane, const DigParameters& parameters, const Begin& begin,
           const DigPathOptions& rules) {
    const Lane& at = lanes_[lane];
    const double start = begin.start;
    if (is_barren(at, start)) return;
    const GroundProfile& ground = ground_of(at, start);
    auto path = make_dig_path(
        machine_, parameters, start,
        [&](double x) {
          const double on = ground(x) + above_start();
          return x < start ? on : std::max(on, begin.height);
        },
        rules);
    auto* made = std::get_if<DigPath>(&path);
    if (made == nullptr || (task_.carried > 0.0 && !can_hold(*made))) return;
    const auto [nearest, farthest] = std::minmax_element(
        made->poses.begin(), made->poses.end(),
        [](const DigPose& a, const DigPose& b) { return a.bucket.x < b.bucket.x; });
    if (!at.view.is_known(nearest->bucket.x, farthest->bucket.x)) return;
    candidates_.push_back({lane, std::move(*made)});
  }

  bool is_barren(const Lane& lane, double start) const {
    const WorkLine& line = lane.line;
    return std::any_of(task_.barren.begin(), task_.barren.end(), [&](const DigStart& each) {
      const bool is_done = task_.finishing && lane.leans && each.is_pass;  // all along it
      return std::abs(each.lane - line.lane) < same_lane &&
             std::abs(each.turned - line.turned) < same_turn &&
             (is_done || std::abs(each.along - start) < same_start);
    });
  }

  bool can_hold(const DigPath& path) const { return can_hold_load(task_.settings.site.soil, path); }

  CycleOptions cycle_of(const Candidate& dig) const {
    const double carried = loose_mass(task_.settings.site.soil, task_.carried);
    return cycle_after(seen_from(task_.dump, lanes_[dig.lane].line.turned),
                       task_.keeps_load && can_hold(dig.path), carried);
  }

  double cost(const PlannedDig& dig) const {
    return dig.cycle_energy + task_.settings.time_price * dig.cycle_time;
  }

  /// Leaves those that are worth something, the best first; for volume after a stall those that
  /// will not before others. Of many digs for volume the best on coarser ground and in coarser
  /// steps, where a dig costs a quarter. What a pass does to the shape of the ground is finer than
  /// that.
  void rank(Aim aim) {
    const bool is_coarse = !task_.finishing && candidates_.size() > most_ranked;
    const bool is_sure_first = !task_.may_risk && (aim == Aim::volume || aim == Aim::hard);
    std::vector<std::optional<Terrain>> coarse(lanes_.size());
    for (const Candidate& each : candidates_) {
      if (is_coarse && !coarse[each.lane])
        coarse[each.lane] = coarser(lanes_[each.lane].view.ground().terrain(), coarse_cells);
    }
    parallel_for(candidates_.size(), 0, [&](std::size_t i) {
      Candidate& each = candidates_[i];
      const auto worth = [&](const HeightMapSimulator& simulator) {
        if (is_coarse)
          return worth_of(each, simulator, *coarse[each.lane], every_second(each.path));
        return worth_of(each, simulator, lanes_[each.lane].view.ground().terrain(), each.path);
      };
      each.worth = is_sure_first ? worth(hard_) : 0.0;
      if (!(each.worth > 0.0)) each.worth = behind_sure * worth(simulator_);
    });
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                     [](const Candidate& each) { return !(each.worth > 0.0); }),
                      candidates_.end());
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
    if (is_coarse && candidates_.size() > most_ranked)
      candidates_.erase(candidates_.begin() + most_ranked, candidates_.end());
  }

  /// By the soil that it lifts; 0 if it stalls.
  double worth_of(const Candidate& candidate, const HeightMapSimulator& simulator,
                  const Terrain& ground, const DigPath& path) const {
    const auto dig = dig_of_path(machine_, simulator, ground, path, cycle_of(candidate));
    const auto* planned = std::get_if<PlannedDig>(&dig);
    return planned == nullptr ? 0.0 : planned->payload_mass / cost(*planned);
  }

  std::optional<StepDig> confirm(const Candidate& candidate, Aim aim) const {
    const LaneView& view = lanes_[candidate.lane].view;
    const Terrain& ground = view.ground().terrain();
    auto dug = dig_to_rest(machine_, simulator_, ground, candidate.path, cycle_of(candidate));
    auto* found = std::get_if<SimulatedDig>(&dug);
    if (found == nullptr) return std::nullopt;
    StepDig step;
    const WorkLine& line = lanes_[candidate.lane].line;
    step.turned = line.turned;
    step.lane = line.lane;
    step.path = candidate.path;
    step.dig = found->dig;
    if (task_.carried > 0.0 && step.dig.payload_volume > capacity_) return std::nullopt;
    step.change = view.change(found->result.patch,
                              {task_.slack, task_.settings.design.tolerance, line.far - wall_from,
                               task_.has_steps ? most_below * task_.settings.design.tolerance
                                               : std::numeric_limits<double>::infinity()});
    const double gain = gain_of(step, aim);
    if (step.change.touched > most_touched) return std::nullopt;
    if (!(gain > 0.0) || !is_enough(step, aim)) return std::nullopt;
    const auto in_hard = dig_of_path(machine_, aim == Aim::wall ? firm_ : hard_, ground,
                                     candidate.path, cycle_of(candidate));
    const auto* hard = std::get_if<PlannedDig>(&in_hard);
    step.may_stall = hard == nullptr || (aim != Aim::wall && stalls_higher(candidate));
    step.worth = (step.may_stall ? risky : 1.0) * gain / cost(step.dig);
    if (hard != nullptr) {
      step.signs.energy_share =
          std::log(hard->energy / step.dig.energy) /
          std::log((aim == Aim::wall ? wall_factor() : task_.hard_factor) / task_.strength_factor);
    }
    return step;
  }

  /// Whether it stalls where the edge runs lower than planned, or the ground is higher than seen.
  bool stalls_higher(const Candidate& candidate) const {
    Terrain higher = lanes_[candidate.lane].view.ground().terrain();
    higher.bank.z += height_doubt;
    const auto dig = dig_of_path(machine_, simulator_, higher, candidate.path, {});
    return !std::holds_alternative<PlannedDig>(dig);
  }

  /// On the strength, at which no dig at a wall may stall: a flat one would leave a ramp, and a
  /// stall costs less.
  double wall_factor() const {
    return std::min(task_.hard_factor, most_doubt_at_wall * task_.strength_factor);
  }

  /// In a wide design of what the bucket lifts: what it pushes aside is lifted from another
  /// lane.
  double gained_by(const StepDig& step) const {
    return task_.has_others_beside ? step.dig.payload_volume / bulking() : step.change.gained;
  }

  /// Of the bank, as it is dug.
  double bulking() const {
    return (1.0 + simulator_.loose().void_ratio) / (1.0 + simulator_.bank().void_ratio);
  }

  /// Volume of the design that a dig gains, less what it spoils.
  double gain_of(const StepDig& step, Aim aim) const {
    const ShapeChange& change = step.change;
    const double deep_price = aim == Aim::shape ? 1.0 : too_deep_price;
    const double spoiled = deep_price * change.too_deep + spill_price * change.spilled;
    if (aim == Aim::wall) return change.gained + wall_worth * change.at_end - spoiled;
    if (aim != Aim::shape) return gained_by(step) - spoiled;
    const double left = pushed_price * std::max(0.0, change.pushed);  // for the next pass
    return std::max(change.shaped, cleared_worth * change.cleared) - left - spoiled;
  }

  /// Less is not worth a cycle.
  bool is_enough(const StepDig& step, Aim aim) const {
    const ShapeChange& change = step.change;
    if (aim == Aim::shape) {
      const bool has_many = task_.has_faces && task_.has_others_beside;
      return change.finished > (has_many ? least_of_many : least_finished) ||
             change.cleared > least_cleared;
    }
    if (aim == Aim::volume) return gained_by(step) > least_of_volume();
    if (aim == Aim::hard) return change.gained > least_in_hard * capacity_;
    if (task_.finishing) return change.at_end > least_lifted;
    return change.gained + change.at_end > least_at_wall * capacity_;
  }

  const StepTask& task_;
  const Machine machine_;  ///< as it looks along the lines
  HeightMapSimulator simulator_;
  HeightMapSimulator hard_;
  HeightMapSimulator firm_;
  double capacity_;
  std::vector<Lane> lanes_;
  std::vector<Candidate> candidates_;
};

}  // namespace

bool can_hold_load(const SoilKind& soil, const DigPath& path) {
  return path.poses.front().bucket.floor_angle <= holding * soil.angle_of_repose;
}

DumpPlace seen_from(DumpPlace dump, double turned) {
  dump.swing = wrapped(dump.swing - turned);
  return dump;
}

CycleOptions cycle_after(const DumpPlace& dump, bool keeps_load, double carried) {
  CycleOptions options;
  options.swing = dump.swing;
  options.dump_height = dump.height;
  options.keeps_load = keeps_load;
  options.carried = carried;
  return options;
}

std::optional<StepDig> best_dig(const StepTask& task) { return StepSearch(task).run(); }

}  // namespace excavplan
