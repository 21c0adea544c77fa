// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <excavplan/experiments/sensitivity.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using Assumptions = std::vector<Assumption>;
using Change = std::function<void(DigModel&)>;

std::string from_to(double lower, double upper, const char* unit) {
  return decimals(lower, 1) + " .. " + decimals(upper, 1) + unit;
}
std::string times(double factor) { return "x " + decimals(factor, 2); }

/// Turns the floor of the bucket about the tip; its length stays.
void turn_floor(Bucket& bucket, double angle) {
  const Eigen::Vector2d tip = bucket.profile[0];
  Eigen::Vector2d& heel = bucket.profile[1];
  const double length = (heel - tip).norm();
  heel = tip + length * Eigen::Vector2d(-std::cos(angle), std::sin(angle));
}

void add_path_rules(Assumptions& all) {
  for (const double angle : {0.0, 1.0, 4.0}) {
    all.push_back({"floor above the cut in the drag", decimals(angle, 0) + " deg",
                   [=](DigModel& m) { m.search.rules.min_heel_clearance = angle * pi / 180.0; }});
  }
  const std::pair<const char*, StartRule::Kind> starts[] = {
      {"least work of the links", StartRule::Kind::least_work},
      {"largest margin", StartRule::Kind::largest_margin}};
  for (const auto& [level, kind] : starts) {
    all.push_back({"start", level, [kind = kind](DigModel& m) { m.search.start_rule = kind; }});
  }
}

/// The paper's Table 3 is not published as text; both fixed paths of the paper lie in each of
/// these.
void add_ranges(Assumptions& all) {
  const std::pair<DigParameters, DigParameters> ranges[] = {{{0.2, 0.1, 0.3}, {1.4, 0.9, 3.0}},
                                                            {{0.7, 0.3, 1.4}, {1.1, 0.6, 2.6}}};
  for (const auto& [lower, upper] : ranges) {
    const std::string level = from_to(lower.penetration_angle, upper.penetration_angle, " rad, ") +
                              from_to(lower.penetration_length, upper.penetration_length, " m, ") +
                              from_to(lower.drag_length, upper.drag_length, " m");
    all.push_back({"search ranges", level, [lower = lower, upper = upper](DigModel& m) {
                     m.search.bounds.lower = lower;
                     m.search.bounds.upper = upper;
                   }});
  }
}

void add_bucket(Assumptions& all) {
  for (const double angle : {45.0, 55.0}) {
    all.push_back({"floor of the bucket to the line of tip and pin", decimals(angle, 0) + " deg",
                   [=](DigModel& m) { turn_floor(m.machine.bucket, angle * pi / 180.0); }});
  }
  all.push_back({"teeth", "none", [](DigModel& m) { m.machine.bucket.teeth.reset(); }});
  for (const double factor : {0.67, 1.33}) {
    all.push_back({"width and thickness of the teeth", times(factor), [=](DigModel& m) {
                     if (!m.machine.bucket.teeth) return;
                     m.machine.bucket.teeth->width *= factor;
                     m.machine.bucket.teeth->thickness *= factor;
                   }});
  }
  for (const double factor : {0.67, 1.5}) {
    all.push_back({"thickness of the lip", times(factor),
                   [=](DigModel& m) { m.machine.bucket.edge_thickness *= factor; }});
  }
}

void add_machine(Assumptions& all) {
  for (const double by : {-0.2, 0.2}) {
    all.push_back({"centre of mass of the body", (by > 0.0 ? "+" : "") + decimals(by, 1) + " m",
                   [=](DigModel& m) {
                     if (m.machine.body) m.machine.body->centre.x() += by;
                   }});
  }
  all.push_back({"machine", "held down", [](DigModel& m) { m.machine.body.reset(); }});
}

void add_soil(Assumptions& all) {
  const auto scale = [&](const char* factor, double SoilKind::*number, double low, double high) {
    for (const double by : {low, high}) {
      all.push_back({factor, times(by), [=](DigModel& m) { m.soil.*number *= by; }});
    }
  };
  scale("cone index", &SoilKind::cone_index_reference, 0.7, 1.4);
  scale("cohesion", &SoilKind::cohesion_loosest, 0.67, 1.5);
  scale("adhesion over cohesion", &SoilKind::adhesion_ratio, 0.0, 2.0);
  scale("soil-steel over internal friction", &SoilKind::tool_friction_ratio, 0.75, 1.25);
  scale("angle of repose", &SoilKind::angle_of_repose, 0.9, 1.1);
  all.push_back(
      {"simulator", "section", [](DigModel& m) { m.simulator = simulator_of_word("section"); }});
}

}  // namespace

std::vector<Assumption> our_assumptions() {
  Assumptions all;
  add_path_rules(all);
  add_ranges(all);
  add_bucket(all);
  add_machine(all);
  add_soil(all);
  return all;
}

}  // namespace excavplan
