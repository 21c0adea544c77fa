// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/experiments/study_condition.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr int few = 30;    // runs of a condition; ours
constexpr int many = 300;  // where the share of intervals that hold is the question; ours

using Conditions = std::vector<StudyCondition>;

template <typename Change>
void add(Conditions& all, const std::string& factor, const std::string& level, Change change,
         int runs = few) {
  StudyCondition condition{factor, level, {}, runs};
  change(condition.setting);
  all.push_back(condition);
}

void add_densities(Conditions& all) {
  for (const double density : {5.0, 20.0, 35.0, 50.0, 65.0, 80.0, 95.0}) {
    add(all, "density", readable(density) + " %",
        [=](StudySetting& s) { s.density_percent = density; });
  }
}

/// The fixed path would lift the machine in most hard soil.
void add_held_down(Conditions& all) {
  for (const double density : {65.0, 80.0, 95.0}) {
    add(all, "machine held down", readable(density) + " %", [=](StudySetting& s) {
      s.density_percent = density;
      s.held_down = true;
    });
  }
}

void add_ground(Conditions& all) {
  for (const double degrees : {-10.0, -5.0, 5.0, 10.0}) {
    add(all, "slope", (degrees > 0.0 ? "+" : "") + readable(degrees) + " deg",
        [=](StudySetting& s) { s.slope = degrees * pi / 180.0; });
  }
  for (const double rms : {0.02, 0.05}) {
    add(all, "rough ground", readable(100.0 * rms) + " cm rms",
        [=](StudySetting& s) { s.roughness = rms; });
  }
  add(all, "second dig", "on the ground that the first left",
      [](StudySetting& s) { s.second = SecondGround::left; });
  add(all, "digs in a row", "10", [](StudySetting& s) { s.row = 10; });
}

void add_soils(Conditions& all) {
  for (const char* soil : {"sand", "clay", "gravel"}) {
    add(all, "soil", soil, [=](StudySetting& s) { s.soil = soil; });
  }
  add(all, "soil", "loam, that of the library", [](StudySetting& s) { s.drawn_soil = false; });
}

void add_sensors(Conditions& all) {
  add(
      all, "sensor", "none", [](StudySetting&) {}, many);
  all.back().compared = 0;  // they are those of the reference
  add(all, "sensor", "lidar", [](StudySetting& s) { s.sensor = StudySensor::lidar; });
  add(
      all, "sensor", "D435i at 3 m", [](StudySetting& s) { s.sensor = StudySensor::d435i; }, many);
  add(all, "sensor", "poor", [](StudySetting& s) { s.sensor = StudySensor::poor; });
}

void add_laws(Conditions& all) {
  const auto law = [&](const char* level, StudyLaw which) {
    add(all, "law", level, [=](StudySetting& s) { s.law = which; });
  };
  law("of the engine that digs", StudyLaw::own_engine);
  law("line of the engine that digs", StudyLaw::own_line);
  law("the paper's line", StudyLaw::paper);
  law("of another path", StudyLaw::other_path);
  law("of sand", StudyLaw::other_soil);
  add(all, "law", "of the engine that digs, soil of the law", [](StudySetting& s) {
    s.law = StudyLaw::own_engine;
    s.drawn_soil = false;
  });
}

void add_plans(Conditions& all, const Machine& machine) {
  add(all, "plan", "for 50 %, whatever the soil",
      [](StudySetting& s) { s.plan = StudyPlan::not_adapted; });
  add(all, "plan", "searched on the true ground",
      [](StudySetting& s) { s.plan = StudyPlan::search; });
  add(all, "plan", "searched on ground seen by D435i", [](StudySetting& s) {
    s.plan = StudyPlan::search;
    s.sensor = StudySensor::d435i;
  });
  add(all, "engine that digs", "section", [](StudySetting& s) { s.digs = "section"; });
  add(all, "baseline", "the paper's field path",
      [](StudySetting& s) { s.fixed_path = paper_field_path(); });
  const SoilKind loam = load_soil(shipped_or_file("soils", "loam"));
  add(all, "baseline", "sized to the bucket",
      [&](StudySetting& s) { s.fixed_path = path_sized_to_bucket(machine, loam); });
}

}  // namespace

std::vector<StudyCondition> default_study(const Machine& machine) {
  Conditions all;
  add(all, "reference", "loam, 5-95 %, level, no sensor error", [](StudySetting&) {});
  add_densities(all);
  add_held_down(all);
  add_ground(all);
  add_soils(all);
  add_sensors(all);
  add_laws(all);
  add_plans(all, machine);
  return all;
}

}  // namespace excavplan
