// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/plain_planners.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/dig_along.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/plan_geometry.hpp"
#include "ground/grid_cells.hpp"
#include "trial/dump_places.hpp"
#include "trial/seen_ground.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double penetration = 0.25 * pi;       // of a layer [rad]
constexpr double finishing_penetration = 0.35;  // of a pass along the floor [rad]
constexpr double least_layer = 0.04;            // [m]
constexpr double beside = 0.04;                 // of the bucket, for the cells of a wall [m]
constexpr double scratch = 0.02;                // beside the design [m]
constexpr int evaluations = 200;                // of the one search of "greedy"
constexpr double sample = 0.05;                 // along a lane and over it [m]

/// A lane at a station.
struct Lane {
  double left = 0.0;   ///< of the axis [m]
  double layer = 0.0;  ///< that is tried next [m]
  int digs = 0;
  int stalls = 0;
  bool done = false;
};

class PlainPlanner : public JobPlanner {
 public:
  PlainPlanner(const PlainPolicy& policy, const SiteBrief& site, const HeightMap& first_scan,
               const Machine& machine)
      : policy_(policy),
        site_(site),
        machine_(machine),
        axis_(site.job.words->from, site.job.words->heading),
        ground_(first_scan),
        design_(first_scan),
        dumps_(site.job, machine),
        base_(*site.job.start) {
    find_design(first_scan);
    base_.z = ground_.at(base_.x, base_.y);
    if (policy.digs == PlainPolicy::Digs::searched) search();
    if (policy.digs == PlainPolicy::Digs::fixed) place_fixed();
    arrive();
  }

  JobStep next() override {
    if (!step_) step_ = decide();
    return *step_;
  }

  void done(long long id, const StepReport& report) override {
    if (!step_ || step_->id != id) return;
    if (report.scan) ground_.take(*report.scan);
    if (report.base) base_ = *report.base;
    const JobAction what = step_->what;
    step_.reset();
    if (what == JobAction::move) arrive();
    if (digs(what)) {
      dumps_.loaded(report.payload_mass.value_or(0.0));
      must_scan_ = true;
    }
    if (what == JobAction::scan) must_scan_ = false;
    if (what == JobAction::dig) {
      Lane& lane = lanes_[at_];
      ++lane.digs;
      if (report.stalled) {
        ++lane.stalls;
        lane.layer = std::max(least_layer, policy_.after_stall * lane.layer);
      }
    }
    if (digs(what)) ++at_;
  }

 private:
  enum class Phase { bulk, finish, leave };

  // ---- the design --------------------------------------------------------------------------

  /// The design where it lies below the first scan, and how far it goes along and beside the axis.
  void find_design(const HeightMap& first_scan) {
    const DesignCover cover = cover_of(site_.design, first_scan);
    constexpr double least_share = 0.25;  // ours: of a cell at an upright wall
    design_.z = cover.height;
    for_each_cell(design_.z, [&](Cell at) {
      double& z = design_.z(at.row, at.col);
      const double ground = ground_.at(design_.x(at.col), design_.y(at.row));
      if (!(cover.share(at.row, at.col) > least_share && z < ground)) {
        z = nan;
        return;
      }
      const Vector2d place = axis_.of({design_.x(at.col), design_.y(at.row)});
      const double along = place.x(), left = place.y();
      least_height_ = std::min(least_height_, z);
      least_along_ = std::min(least_along_, along);
      most_along_ = std::max(most_along_, along);
      least_left_ = std::min(least_left_, left);
      most_left_ = std::max(most_left_, left);
    });
    require(most_along_ > least_along_, "plain planner: the design lies nowhere below the ground");
  }

  /// The highest of the design under the bucket; beside the design little less than the ground.
  double floor_at(double along, double left) const {
    double highest = nan;
    const double half = 0.5 * machine_.bucket.width_outside - beside;
    for (double off = -half; off <= half + 1e-9; off += half / 4.0) {
      const Vector2d at = axis_.place(along, left + off);
      const auto cell = cell_at(design_, at.x(), at.y());
      double z = cell ? design_.z(cell->row, cell->col) : nan;
      if (std::isnan(z)) z = ground_at(along, left) - scratch;
      if (std::isnan(highest) || z > highest) highest = z;
    }
    return highest;
  }
  /// Mean of the ground under the bucket.
  double ground_at(double along, double left) const {
    double sum = 0.0;
    int count = 0;
    const double half = 0.5 * machine_.bucket.width_outside - beside;
    for (double off = -half; off <= half + 1e-9; off += half / 4.0) {
      const Vector2d at = axis_.place(along, left + off);
      const double z = ground_.at(at.x(), at.y());
      if (std::isnan(z)) continue;
      sum += z;
      ++count;
    }
    return count > 0 ? sum / count : nan;
  }

  // ---- stations and lanes ------------------------------------------------------------------

  double first_station() const { return most_along_ - policy_.farthest; }
  double base_along() const { return axis_.of({base_.x, base_.y}).x(); }
  double base_left() const { return axis_.of({base_.x, base_.y}).y(); }
  /// Ahead of the swing axis, between which a station digs [m].
  double far_end() const { return policy_.farthest; }
  double near_end() const { return policy_.farthest - policy_.station; }
  double drag_start() const { return std::min(far_end(), most_along_ - base_along()); }
  double drag_end() const { return std::max(near_end(), least_along_ - base_along()); }

  void arrive() {
    lanes_.clear();
    at_ = 0;
    phase_ = Phase::bulk;
    const double width = machine_.bucket.width_outside;
    const double room = std::max(0.0, most_left_ - least_left_ - width);
    const int gaps = static_cast<int>(std::ceil(room / (policy_.lane_share * width) - 1e-9));
    const double middle = 0.5 * (least_left_ + most_left_);
    for (int i = 0; i <= gaps; ++i) {
      const double share = gaps > 0 ? static_cast<double>(i) / gaps - 0.5 : 0.0;
      lanes_.push_back({middle + share * room, policy_.layer});
    }
  }

  double mean_over_floor(const Lane& lane) const {
    double sum = 0.0;
    int count = 0;
    for (double x = near_end(); x <= far_end(); x += sample) {
      const double along = base_along() + x;
      if (along < least_along_ || along > most_along_) continue;
      const double over = ground_at(along, lane.left) - floor_at(along, lane.left);
      if (std::isnan(over)) continue;
      sum += std::max(0.0, over);
      ++count;
    }
    return count > 0 ? sum / count : 0.0;
  }

  /// Mean height of a lane over the station, where it is over the floor.
  double level_of(const Lane& lane) const {
    double sum = 0.0;
    int count = 0;
    for (double x = near_end(); x <= far_end(); x += sample) {
      const double along = base_along() + x;
      const double z = ground_at(along, lane.left);
      if (along > most_along_ || !(z > floor_at(along, lane.left))) continue;
      sum += z;
      ++count;
    }
    return count > 0 ? sum / count : base_.z;
  }

  // ---- steps -------------------------------------------------------------------------------

  JobStep decide() {
    if (!is_placed_) {
      is_placed_ = true;
      const double off = std::hypot(base_along() - first_station(), base_left());
      if (off > 0.3) return move_to(first_station());
    }
    dump_ = dumps_.from(base_, site_.job.words->heading, ground_);
    if (!dump_.in_reach) phase_ = Phase::leave;
    while (phase_ != Phase::leave) {
      if (at_ >= lanes_.size()) {
        if (must_scan_) return scan();
        end_of_round();
        continue;
      }
      if (auto step = phase_ == Phase::bulk ? dig() : finish()) return *step;
      ++at_;
    }
    const double to = base_along() - policy_.station;
    if (to + far_end() > least_along_ + 0.2) return move_to(to);
    JobStep stop = step_of(JobAction::stop);
    stop.reason = finished_reason;
    return stop;
  }

  void end_of_round() {
    at_ = 0;
    if (phase_ == Phase::finish) {
      phase_ = Phase::leave;
      return;
    }
    bool all = true;
    for (Lane& lane : lanes_) {
      lane.done = lane.done || mean_over_floor(lane) <= policy_.left ||
                  lane.digs >= policy_.most_digs || lane.stalls >= policy_.most_stalls;
      all = all && lane.done;
    }
    if (!all) return;
    phase_ = policy_.digs == PlainPolicy::Digs::layers ? Phase::finish : Phase::leave;
  }

  JobStep step_of(JobAction what) {
    JobStep step;
    step.id = ++last_id_;
    step.what = what;
    step.base = base_;
    return step;
  }
  JobStep scan() {
    JobStep step = step_of(JobAction::scan);
    step.reason = "the ground has changed";
    return step;
  }
  JobStep move_to(double along) {
    JobStep step = step_of(JobAction::move);
    const Vector2d to = axis_.place(along, 0.5 * (least_left_ + most_left_));
    step.base = {to.x(), to.y(), ground_.at(to.x(), to.y()), site_.job.words->heading};
    return step;
  }

  std::optional<JobStep> dig() {
    Lane& lane = lanes_[at_];
    if (lane.done) return std::nullopt;
    DigPathOptions rules;
    DigParameters numbers = numbers_;
    double start = drag_start();
    if (policy_.digs == PlainPolicy::Digs::layers) {
      const double level = level_of(lane) - lane.layer;
      start = start_over(level, lane);
      const double depth =
          std::max(least_layer, ground_at(base_along() + start, lane.left) - level);
      numbers.penetration_angle = penetration;
      numbers.penetration_length = depth / std::sin(penetration);
      numbers.drag_length = std::max(0.0, start - drag_end() - depth / std::tan(penetration));
      set_floor(rules, lane);
    }
    const auto path = path_of(numbers, start, lane, rules);
    if (!path) lane.done = true;
    return path ? std::optional<JobStep>(with(*path, lane, JobAction::dig)) : std::nullopt;
  }

  std::optional<JobStep> finish() {
    const Lane& lane = lanes_[at_];
    DigPathOptions rules;
    set_floor(rules, lane);
    rules.drag_keeps_angle = true;
    const double start = start_over(least_height_, lane);
    const double along = base_along() + start;
    const double over =
        std::clamp(ground_at(along, lane.left) - floor_at(along, lane.left), 0.0, policy_.layer);
    DigParameters numbers;
    numbers.penetration_angle = finishing_penetration;
    numbers.penetration_length = (over + 0.02) / std::sin(finishing_penetration);
    numbers.drag_length = std::max(0.0, start - drag_end());
    const auto path = path_of(numbers, start, lane, rules);
    return path ? std::optional<JobStep>(with(*path, lane, JobAction::finish)) : std::nullopt;
  }

  void set_floor(DigPathOptions& rules, const Lane& lane) const {
    rules.floor = [this, lane](double x) {
      return floor_at(base_along() + x, lane.left) - base_.z;
    };
    rules.drag_grade = std::atan(site_.job.words->grade);
  }

  /// The farthest place from which a penetration comes down to a level before it meets the floor,
  /// or where that lies deepest.
  double start_over(double level, const Lane& lane) const {
    constexpr double near = 0.05, fine = 0.01;  // ours [m]
    level = std::max(level, least_height_);
    double deepest = drag_start(), most = -1.0;
    for (double x = drag_start(); x > drag_end(); x -= 0.5 * sample) {
      const double ground = ground_at(base_along() + x, lane.left);
      if (!(ground > level + least_layer)) continue;  // dug already
      double z = ground;
      double at = x;
      while (z > level && z >= floor_at(base_along() + at, lane.left)) {
        z -= fine;
        at -= fine / std::tan(penetration);
      }
      if (z <= level + near) return x;
      if (ground - z <= most + near) continue;
      most = ground - z;
      deepest = x;
    }
    return deepest;
  }

  /// From the far end of the station, or as near to it as the machine can.
  std::optional<DigPath> path_of(const DigParameters& numbers, double start, const Lane& lane,
                                 const DigPathOptions& rules) const {
    const auto ground = [&](double x) { return ground_at(base_along() + x, lane.left) - base_.z; };
    for (double x = start; x > start - 1.2; x -= 0.1) {
      DigParameters tried = numbers;
      tried.drag_length = std::max(0.0, numbers.drag_length - (start - x));
      auto path = make_dig_path(machine_, tried, x, ground, rules);
      if (auto* found = std::get_if<DigPath>(&path)) return std::move(*found);
    }
    return std::nullopt;
  }

  JobStep with(const DigPath& path, const Lane& lane, JobAction what) {
    JobStep step = step_of(what);
    step.swung = wrapped(site_.job.words->heading - base_.heading);
    step.lane = lane.left - base_left();
    step.path = path;
    step.dump = dump_.pin;
    step.truck = dump_.truck;
    return step;
  }

  /// From where the joints have most room.
  void place_fixed() {
    const auto path = make_dig_path_anywhere(machine_, numbers_, [](double) { return 0.0; });
    if (const auto* found = std::get_if<DigPath>(&path)) policy_.farthest = found->start_x;
  }

  void search() {
    PlanOptions options;
    options.method = PlanMethod::search;
    options.search.stop.evaluations = evaluations;
    const DigPlan plan = plan_dig(machine_, site_.soil, site_.density.percent, options);
    if (!plan.dig) return;
    numbers_ = plan.dig->parameters;
    policy_.farthest = plan.dig->start_x;
  }

  PlainPolicy policy_;
  SiteBrief site_;
  Machine machine_;
  PlanFrame axis_;  ///< of the design
  LastSeenGround ground_;
  HeightMap design_;  ///< NaN where nothing is to be dug
  DumpPlaces dumps_;
  PlainDump dump_;  ///< of the present step
  BasePose base_;
  DigParameters numbers_ = paper_fixed_path();
  double least_height_ = 1e9;  ///< of the design [m]
  double least_along_ = 1e9, most_along_ = -1e9, least_left_ = 1e9, most_left_ = -1e9;
  std::vector<Lane> lanes_;
  std::size_t at_ = 0;  ///< of the lanes
  Phase phase_ = Phase::bulk;
  bool is_placed_ = false;
  bool must_scan_ = false;
  long long last_id_ = 0;
  std::optional<JobStep> step_;
};

}  // namespace

const std::vector<PlainPolicy>& plain_policies() {
  static const std::vector<PlainPolicy> all = [] {
    PlainPolicy layers, greedy, fixed;
    layers.word = "operator";
    greedy.word = "greedy";
    greedy.digs = PlainPolicy::Digs::searched;
    fixed.word = "fixed";
    fixed.digs = PlainPolicy::Digs::fixed;
    return std::vector<PlainPolicy>{layers, greedy, fixed};
  }();
  return all;
}

std::unique_ptr<JobPlanner> plain_planner(const PlainPolicy& policy, const SiteBrief& site,
                                          const HeightMap& first_scan, const Machine& machine) {
  require(site.job.words.has_value(),
          "planner " + policy.word + ": the design of the site must be in words too");
  return std::make_unique<PlainPlanner>(policy, site, first_scan, machine);
}

}  // namespace excavplan
