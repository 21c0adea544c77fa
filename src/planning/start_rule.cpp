// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/start_rule.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double start_grid = 0.2;      // of the starts compared first [m]; ours
constexpr double start_within = 0.002;  // [m]; ours
// Of the joints from their limits, for a machine that does not track exactly [rad]; ours.
constexpr double joint_clearance = 0.035;
constexpr double coarse_step = 0.2;  // tip travel between poses while starts are compared [m]

/// Positive work of the joints against the weight of the links while they dig, or more than `most`
/// once it is [J].
double link_work(const Machine& machine, const DigPath& path, double most) {
  double work = 0.0;
  for (std::size_t i = 1; i < path.poses.size() && work <= most; ++i) {
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
    return limit_margin(machine, pose.joints).margin >= joint_clearance;
  });
}

/// By halving steps around the best point of a grid: the work has one valley where the machine
/// reaches, and its end is sharp where the reach ends.
std::optional<double> least_work_start(const DigLayout& layout, const DigParameters& parameters,
                                       const DigPathOptions& options) {
  const Machine& machine = layout.machine();
  std::optional<double> best;
  double least = std::numeric_limits<double>::infinity();
  const DigTrials trials(machine, parameters, layout.ground(), options);
  double work = 0.0;
  const auto judge = [&](const DigPath& path) {
    if (!keeps_off_limits(machine, path)) return false;
    work = link_work(machine, path, least);
    return work < least;
  };
  const auto compare = [&](double x) {
    if (!layout.can_be_driven(trials, x, judge)) return;
    least = work;
    best = x;
  };
  const double reach = machine.full_length();
  const double nearest = std::max(machine.track_front, machine.boom_pin.x() - reach);
  for (double x = nearest; x <= machine.boom_pin.x() + reach; x += start_grid) compare(x);
  for (double step = 0.5 * start_grid; best && step >= start_within; step *= 0.5) {
    const double middle = *best;
    compare(middle - step);
    compare(middle + step);
  }
  return best;
}

/// @return nothing where no start keeps the joints off their limits
std::optional<DigPath> path_of_least_work(const DigLayout& layout,
                                          const DigParameters& parameters) {
  DigPathOptions coarse = layout.rules();
  coarse.step = coarse_step;
  for (const DigPathOptions& options : {coarse, layout.rules()}) {
    const auto start_x = least_work_start(layout, parameters, options);
    if (!start_x) continue;
    auto path = layout.path_from(parameters, *start_x);
    if (auto* drivable = std::get_if<DigPath>(&path)) return std::move(*drivable);
  }
  return std::nullopt;
}

}  // namespace

std::variant<DigPath, Infeasible> path_by(const DigLayout& layout, const DigParameters& parameters,
                                          const StartRule& start) {
  switch (start.kind) {
    case StartRule::Kind::given:
      return layout.path_from(parameters, start.x);
    case StartRule::Kind::searched:
      throw Error(ErrorKind::bad_input, "the start of a single dig cannot be searched");
    case StartRule::Kind::least_work:
      if (auto path = path_of_least_work(layout, parameters)) return std::move(*path);
      break;
    case StartRule::Kind::largest_margin:
      break;
  }
  return layout.path_of_largest_margin(parameters);
}

const std::vector<StartRuleInfo>& start_rules() {
  using Kind = StartRule::Kind;
  static const std::vector<StartRuleInfo> rules = {
      {Kind::least_work, "work", "least work of the links' own weight"},
      {Kind::largest_margin, "margin", "largest margin to joint limits and heel contact"},
      {Kind::searched, "search", "searched with the path"},
  };
  return rules;
}

std::optional<StartRule> start_rule_of_word(const std::string& word) {
  for (const StartRuleInfo& rule : start_rules()) {
    if (rule.word == word) return StartRule(rule.kind);
  }
  return std::nullopt;
}

std::string describe(const StartRule& rule) {
  for (const StartRuleInfo& info : start_rules()) {
    if (info.kind == rule.kind) return info.description;
  }
  return "given, x = " + number_text(rule.x) + " m";
}

}  // namespace excavplan
