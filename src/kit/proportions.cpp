// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "kit/proportions.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <excavplan/kit/kit_files.hpp>
#include <excavplan/kit/workspace.hpp>

#include "base/json.hpp"
#include "machine/data_sheet_keys.hpp"
#include "machine/machine_mass.hpp"

namespace excavplan {
namespace {

using nlohmann::json;
using std::string;

// Pumps deliver so much of the engine's net power: ours, as data/machines/zx120.json.
constexpr double to_cylinders = 0.9;
// Machines that differ by this factor of mass, exp(0.3), count half as much; ours.
constexpr double near_mass = 0.3;

/// How the numbers whose places end so grow.
struct Growth {
  const char* end;
  std::optional<double> DataSheet::*figure;  ///< if the sheet states it
  const char* with;                          ///< that figure
  double (*otherwise)(const DataSheet& sheet, double length);
  const char* otherwise_with;
};

double one(const DataSheet&, double) { return 1.0; }
double by_length(const DataSheet&, double length) { return length; }
double by_mass(const DataSheet& sheet, double) { return *sheet.operating_mass; }
double by_moment(const DataSheet& sheet, double length) { return *sheet.operating_mass * length; }
double by_inertia(const DataSheet& sheet, double length) {
  return *sheet.operating_mass * length * length;
}
double by_capacity(const DataSheet& sheet, double) { return std::cbrt(*sheet.bucket_capacity); }

constexpr const char* mass = "operating_mass_kg";
constexpr const char* reach = "ground_reach_m";

/// The first that fits holds.
const std::vector<Growth>& growths() {
  static const std::vector<Growth> table = {
      {"/power_w", &DataSheet::engine_power, "engine_power_w", by_mass, mass},
      {"/idle_power_w", &DataSheet::engine_power, "engine_power_w", by_mass, mass},
      {"swing/speed_rad_per_s", &DataSheet::swing_rate, "swing_rate_rad_per_s", one, ""},
      {"/width_outside_m", &DataSheet::bucket_width, "bucket_width_m", by_capacity,
       "the cube root of bucket_capacity_m3"},
      {"/width_inside_m", &DataSheet::bucket_width, "bucket_width_m", by_capacity,
       "the cube root of bucket_capacity_m3"},
      {"/track_front_m", &DataSheet::track_length, "track_length_m", by_length, reach},
      {"/rear_edge_m", &DataSheet::track_length, "track_length_m", by_length, reach},
      {"/front_edge_m", &DataSheet::track_length, "track_length_m", by_length, reach},
      {"/inertia_kg_m2", nullptr, "", by_inertia, "operating_mass_kg times squared ground_reach_m"},
      {"/torque_n_m", nullptr, "", by_moment, "operating_mass_kg times ground_reach_m"},
      {"/mass_kg", nullptr, "", by_mass, mass},
      {"_m", nullptr, "", by_length, reach},
      {"", nullptr, "", one, ""}};
  return table;
}

/// Without the index in a list of two.
string without_index(const string& place) {
  const std::size_t last = place.rfind('/');
  const bool is_index = std::isdigit(static_cast<unsigned char>(place[last + 1])) != 0;
  return is_index ? place.substr(0, last) : place;
}

const Growth& growth_of(const string& place) {
  const string name = without_index(place);
  return *std::find_if(growths().begin(), growths().end(), [&](const Growth& each) {
    const string end = each.end;
    return name.size() >= end.size() &&
           name.compare(name.size() - end.size(), end.size(), end) == 0;
  });
}

double measure(const string& place, const DataSheet& sheet, double length) {
  const Growth& growth = growth_of(place);
  if (growth.figure != nullptr && sheet.*growth.figure) return *(sheet.*growth.figure);
  return growth.otherwise(sheet, length);
}

DataSheet sheet_of(const MachineFile& file) {
  const Machine& machine = file.machine;
  const Reach reaches = reach_of(machine);
  DataSheet sheet = file.data_sheet;
  const auto fill = [&](std::optional<double> DataSheet::*figure, double value) {
    if (!(sheet.*figure)) sheet.*figure = value;
  };
  fill(&DataSheet::operating_mass, total_mass(machine));
  fill(&DataSheet::bucket_capacity, heaped_capacity(machine));
  fill(&DataSheet::bucket_force, bucket_force(machine));
  fill(&DataSheet::arm_force, arm_force(machine));
  fill(&DataSheet::ground_reach, reaches.ground);
  fill(&DataSheet::depth, reaches.depth);
  fill(&DataSheet::height, reaches.height);
  fill(&DataSheet::dump_height, dump_height(machine));
  fill(&DataSheet::bucket_width, machine.bucket.width_outside);
  fill(&DataSheet::track_length, 2.0 * machine.track_front);
  if (machine.engine) fill(&DataSheet::engine_power, machine.engine->power / to_cylinders);
  if (machine.swing) fill(&DataSheet::swing_rate, machine.swing->speed);
  return sheet;
}

void drop_sources(json& value) {
  if (!value.is_structured()) return;
  if (value.is_object()) value.erase("sources");
  for (json& part : value) drop_sources(part);
}

MachineNumbers numbers_of(const MachineFile& file) {
  json machine = parse_json(file.machine.name, file.text);
  for (const char* key : {"format", "version", "name", "description", "cylinders", "data_sheet",
                          "robot_joints", "robot_root"}) {
    machine.erase(key);
  }
  drop_sources(machine);
  MachineNumbers numbers;
  const json flat = machine.flatten();
  for (const auto& [place, value] : flat.items()) {
    if (value.is_number()) numbers[place] = value.get<double>();
  }
  return numbers;
}

}  // namespace

Proportioned proportioned(const string& word) {
  Proportioned known;
  known.file = load_machine_file(machine_path(word));
  known.sheet = sheet_of(known.file);
  known.numbers = numbers_of(known.file);
  return known;
}

DataSheet as_far_as(const DataSheet& sheet, const DataSheet& other) {
  DataSheet both;
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (other.*each.figure) both.*each.figure = sheet.*each.figure;
  }
  return both;
}

MachineNumbers in_proportion(const std::vector<const Proportioned*>& known, const DataSheet& sheet,
                             double length) {
  MachineNumbers numbers = known.front()->numbers;
  for (auto each = numbers.begin(); each != numbers.end();) {
    double sum = 0.0, weights = 0.0;
    bool all = true;
    for (const Proportioned* machine : known) {
      const auto found = machine->numbers.find(each->first);
      all = all && found != machine->numbers.end();
      if (!all) break;
      const DataSheet theirs = as_far_as(machine->sheet, sheet);
      const double apart = std::log(*sheet.operating_mass / *theirs.operating_mass) / near_mass;
      const double weight = 1.0 / (1.0 + apart * apart);
      sum += weight * found->second / measure(each->first, theirs, *theirs.ground_reach);
      weights += weight;
    }
    each->second = sum / weights * measure(each->first, sheet, length);
    each = all ? std::next(each) : numbers.erase(each);
  }
  return numbers;
}

string grows_with(const string& place, const DataSheet& sheet) {
  const Growth& growth = growth_of(place);
  const bool states = growth.figure != nullptr && sheet.*growth.figure;
  return states ? growth.with : growth.otherwise_with;
}

string key_of(const string& place) {
  string key;
  for (std::size_t begin = 1; begin <= place.size();) {
    const std::size_t end = std::min(place.find('/', begin), place.size());
    const string part = place.substr(begin, end - begin);
    const bool is_index = std::isdigit(static_cast<unsigned char>(part[0])) != 0;
    key += is_index ? "[" + part + "]" : (key.empty() ? "" : ".") + part;
    begin = end + 1;
  }
  return key;
}

}  // namespace excavplan
