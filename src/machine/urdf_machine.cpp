// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/urdf_machine.hpp"

#include <cmath>
#include <filesystem>
#include <set>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/warning.hpp>

#include "base/angles.hpp"
#include "base/files.hpp"
#include "base/text.hpp"
#include "machine/machine_reading.hpp"
#include "machine/urdf_front.hpp"

namespace excavplan {
namespace {

using nlohmann::json;
using std::string;

constexpr double most_apart = 4.0;  // of a number and that of a usual machine of the size; ours

/// By which power of its length a number of a machine grows: ours, from data sheets of 1.7 to 20 t
/// (docs/machines.md#what-a-urdf-does-not-hold).
double power_of(const string& key) {
  const auto ends = [&](const string& end) {
    return key.size() >= end.size() && key.compare(key.size() - end.size(), end.size(), end) == 0;
  };
  if (ends("inertia_kg_m2")) return 4.3;
  if (ends("torque_n_m")) return 3.0;
  if (ends("mass_kg")) return 2.3;
  if (ends("power_w")) return 2.0;
  return ends("_m") ? 1.0 : 0.0;
}

void scale(json& value, double size, const string& key = {}) {
  if (value.is_object()) {
    value.erase("sources");
    for (auto& [name, part] : value.items()) scale(part, size, name);
  } else if (value.is_array()) {
    for (json& part : value) scale(part, size, key);
  } else if (value.is_number_float() || (value.is_number() && power_of(key) != 0.0)) {
    value = value.get<double>() * std::pow(size, power_of(key));
  }
}

/// The keys of all numbers, "joints.boom.lower_rad"; a list is one.
void add_keys(const json& value, const string& where, std::set<string>& keys) {
  if (!value.is_object()) {
    keys.insert(where);
    return;
  }
  for (const auto& [name, part] : value.items()) {
    if (name == "sources") continue;
    add_keys(part, where.empty() ? name : where + '.' + name, keys);
  }
}

std::set<string> keys_of(const json& value) {
  std::set<string> keys;
  add_keys(value, "", keys);
  return keys;
}

json& at(json& value, const string& key) {
  return value[json::json_pointer("/" + [&] {
    string path = key;
    for (char& c : path) {
      if (c == '.') c = '/';
    }
    return path;
  }())];
}

/// The zx120 in another size. Its cylinders are left out: pins do not scale with a joint's range.
json usual_machine(const UrdfFront& front) {
  const string file = find_data_file("machines/zx120.json");
  const string text = read_file(file);
  read_machine(JsonObject::of_text(file, text, "excavplan-machine"));  // it holds all of these
  json machine = parse_json(file, text);
  for (const char* key :
       {"format", "version", "name", "description", "cylinders", "data_sheet", "robot_joints"}) {
    machine.erase(key);
  }
  json bucket = machine["bucket"];
  const json& usual = machine["geometry"];
  const double size = (front.parts[0].length + front.parts[1].length) /
                      (usual["boom_length_m"].get<double>() + usual["arm_length_m"].get<double>());
  scale(bucket["profile"], front.parts[2].length / usual["bucket_length_m"].get<double>());
  scale(machine, size);
  machine["bucket"]["profile"] = bucket["profile"];
  machine["bucket"]["profile"][0] = {{"along_m", front.parts[2].length}, {"across_m", 0.0}};
  return machine;
}

/// What a URDF says, and of what it is not believed.
struct Said {
  json numbers;
  string placeholders;
};

class FromUrdf {
 public:
  FromUrdf(const UrdfFront& front, json usual) : front_(front), usual_(std::move(usual)) {}

  Said said(double ground) {
    json& geometry = said_.numbers["geometry"];
    geometry = {{"boom_pin_m", {front_.boom_pin.x(), front_.boom_pin.y()}},
                {"boom_length_m", front_.parts[0].length},
                {"arm_length_m", front_.parts[1].length},
                {"bucket_length_m", front_.parts[2].length}};
    for (std::size_t i = 0; i < 3; ++i) add_part(front_.parts[i], front_words[i]);
    add("swing.speed_rad_per_s", front_.swing.velocity);
    add("swing.torque_n_m", front_.swing.effort);
    if (front_.swing.lower) {
      said_.numbers["swing"]["lower_rad"] = *front_.swing.lower;
      said_.numbers["swing"]["upper_rad"] = *front_.swing.upper;
    }
    add_root(ground);
    said_.numbers["robot_joints"] = robot_joints_json(RobotJoints{
        front_.parts[0].angle, front_.parts[1].angle, front_.parts[2].angle, front_.swing_angle});
    return std::move(said_);
  }

 private:
  /// Of the root in the site frame: the inverse of that of the boom's plane at zero of the swing.
  void add_root(double ground) {
    const double c = std::cos(front_.ahead), s = std::sin(front_.ahead);
    const double x = front_.swing_x, y = front_.swing_y;
    const double yaw = std::abs(front_.ahead) > pi - 1e-9 ? pi : 0.0 - front_.ahead;
    said_.numbers["robot_root"] = {
        {"position_m", {0.0 - c * x - s * y, 0.0 + s * x - c * y, 0.0 - ground}}, {"yaw_rad", yaw}};
  }

  void add_part(const UrdfPart& part, const string& word) {
    const string joint = "joints." + word + '.';
    const string link = "links." + word + '.';
    if (part.limits.lower) at(said_.numbers, joint + "lower_rad") = *part.limits.lower;
    if (part.limits.upper) at(said_.numbers, joint + "upper_rad") = *part.limits.upper;
    add(joint + "speed_rad_per_s", part.limits.velocity);
    add(joint + "torque_n_m", part.limits.effort);
    if (!(part.mass.mass > 0.0) || !add(link + "mass_kg", part.mass.mass)) return;
    at(said_.numbers, link + "center_along_m") = part.mass.along;
    at(said_.numbers, link + "center_across_m") = part.mass.across;
  }

  /// Unless it is a placeholder.
  bool add(const string& key, std::optional<double> value) {
    if (!value) return false;
    const double ratio = *value / at(usual_, key).get<double>();
    if (ratio > 1.0 / most_apart && ratio < most_apart) {
      at(said_.numbers, key) = *value;
      return true;
    }
    said_.placeholders +=
        (said_.placeholders.empty() ? "" : ", ") + key + " " + number_text(*value);
    return false;
  }

  const UrdfFront& front_;
  json usual_;
  Said said_;
};

// ---- the JSON beside it -------------------------------------------------------------------------

struct Side {
  string file;  ///< empty: there is none
  json numbers = json::object();
  UrdfNames names;
};

Eigen::Vector3d read_direction(JsonObject& file) {
  const string text = file.text("forward");
  const std::array<std::pair<const char*, Eigen::Vector3d>, 4> directions = {
      {{"x", Eigen::Vector3d::UnitX()},
       {"-x", -Eigen::Vector3d::UnitX()},
       {"y", Eigen::Vector3d::UnitY()},
       {"-y", -Eigen::Vector3d::UnitY()}}};
  for (const auto& [name, direction] : directions) {
    if (text == name) return direction;
  }
  file.fail("forward", "is " + in_quotes(text) + ", expected 'x', '-x', 'y' or '-y'");
}

void read_names(JsonObject file, UrdfNames& names) {
  names.swing_stated = file.has("swing");
  if (names.swing_stated) {
    const bool none = !file.states("swing");
    if (none) names.swing = std::nullopt;
    if (!none) names.swing = file.text("swing");
    file.ignore("swing");
  }
  for (std::size_t i = 0; i < 3; ++i)
    names.joints[i] = file.text_or(front_words[i], names.joints[i]);
  if (file.has("tip_m")) {
    if (file.has("tip")) file.fail("tip_m", "found it beside 'tip', expected one of the two");
    const std::vector<double> at = file.numbers("tip_m", 3);
    names.tip_at = {at[0], at[1], at[2]};
  }
  names.tip = file.text_or("tip", names.tip);
  names.ground = file.number_or("ground_z_m", 0.0, -100.0, 100.0);
  if (file.has("forward")) names.forward = read_direction(file);
  file.done();
}

/// What the JSON says of the ranges; of wrong kinds read_machine() complains.
void read_ranges(const json& numbers, UrdfNames& names) {
  const auto stated = [&](const string& key) -> std::optional<double> {
    const json::json_pointer at("/joints/" + key);
    if (!numbers.contains(at) || !numbers.at(at).is_number()) return std::nullopt;
    return numbers.at(at).get<double>();
  };
  for (std::size_t i = 0; i < 3; ++i) {
    names.ranges[i].lower = stated(string(front_words[i]) + "/lower_rad");
    names.ranges[i].upper = stated(string(front_words[i]) + "/upper_rad");
  }
}

Side side_of(const string& urdf) {
  Side side;
  const std::filesystem::path path = std::filesystem::path(urdf).replace_extension(".json");
  side.names.beside = path.string();
  std::error_code none;
  if (path == urdf || !std::filesystem::exists(path, none)) return side;
  side.file = path.string();
  JsonObject file = JsonObject::open(side.file, "excavplan-machine");
  if (file.has("urdf")) read_names(file.object("urdf"), side.names);
  side.numbers = parse_json(side.file, read_file(side.file));
  for (const char* key : {"format", "version", "urdf"}) side.numbers.erase(key);
  read_ranges(side.numbers, side.names);
  return side;
}

/// The URDF gives the lengths; a file that gives others is of another machine.
void refuse_doubles(const json& urdf, const Side& side) {
  const std::set<string> stated = keys_of(side.numbers);
  for (const string& key : keys_of(urdf)) {
    if (key.rfind("geometry.", 0) != 0 || stated.count(key) == 0) continue;
    throw Error(ErrorKind::bad_file,
                side.file + ": " + key +
                    ": found it here and in the URDF, expected it in the URDF, as this file "
                    "beside it is read for what it lacks");
  }
}

// ---- all ----------------------------------------------------------------------------------------

string listed(const std::set<string>& keys) {
  string text;
  for (const string& key : keys) text += (text.empty() ? "" : ", ") + key;
  return safe_text(text, 700);
}

/// Into the sections that may hold sources.
void add_sources(const std::set<string>& keys, const string& source, json& machine) {
  for (const string& key : keys) {
    const std::size_t dot = key.find('.');
    if (dot == string::npos || key.rfind("data_sheet.", 0) == 0) continue;
    machine[key.substr(0, dot)]["sources"][key.substr(dot + 1)] = source;
  }
}

std::set<string> without(std::set<string> keys, const std::set<string>& others) {
  for (const string& key : others) keys.erase(key);
  return keys;
}

/// Without the parts that the JSON beside it says the machine does not have.
std::set<string> without_absent(std::set<string> keys, const std::set<string>& of_side) {
  for (const string& key :
       {string("body"), string("engine"), string("swing"), string("bucket.teeth")}) {
    if (of_side.count(key) == 0) continue;  // null: the machine has none
    for (auto each = keys.begin(); each != keys.end();) {
      each = each->rfind(key + '.', 0) == 0 ? keys.erase(each) : std::next(each);
    }
  }
  return keys;
}

void warn_of_numbers(const string& path, const std::set<string>& scaled, const string& placeholders,
                     std::vector<Warning>& warnings) {
  if (!scaled.empty()) {
    warnings.emplace_back(WarningCode::urdf_scaled,
                          "these numbers are in neither " + path +
                              " nor a JSON beside it; those of the zx120, scaled to "
                              "this size, are taken: " +
                              listed(scaled));
  }
  if (!placeholders.empty()) {
    warnings.emplace_back(WarningCode::urdf_placeholder,
                          "these numbers of " + path +
                              " are taken for placeholders, as a usual machine of this size "
                              "differs by more than a factor of " +
                              number_text(most_apart) + ": " + safe_text(placeholders, 400));
  }
}

void warn_of_angles(const UrdfFront& front, std::vector<Warning>& warnings) {
  string text;
  const auto add = [&](const string& word, const RobotJoint& angle) {
    if (angle.sign > 0.0 && std::abs(angle.zero) < 1e-9) return;
    text += (text.empty() ? "" : ", ") + word + " = " + (angle.sign < 0.0 ? "-" : "") + angle.name;
    if (angle.zero == 0.0) return;
    text += (angle.zero < 0.0 ? " - " : " + ") + readable(std::abs(angle.zero), 6);
  };
  for (std::size_t i = 0; i < 3; ++i) add(front_words[i], front.parts[i].angle);
  add("swing", front.swing_angle);
  if (text.empty()) return;
  warnings.emplace_back(
      WarningCode::urdf_angles,
      "the angles of excavplan are not those of the URDF: " + text +
          " rad; of trajectories .yaml and .com3 are in the latter, all else in the former");
}

void warn_of_root(const json& machine, std::vector<Warning>& warnings) {
  const json& root = machine["robot_root"];
  const auto at = root["position_m"].get<std::vector<double>>();
  const double yaw = root.value("yaw_rad", 0.0);
  if (std::abs(at[0]) + std::abs(at[1]) + std::abs(at[2]) + std::abs(yaw) < 1e-6) return;
  warnings.emplace_back(
      WarningCode::urdf_frame,
      "the root frame of the URDF is not the site frame, which has its origin on the "
      "swing axis at the ground and x along the boom: in the site frame the root is "
      "at (" +
          readable(at[0], 6) + ", " + readable(at[1], 6) + ", " + readable(at[2], 6) +
          ") m, turned about z by " + readable(yaw, 6) +
          " rad; scans in the root frame need this transform");
}

}  // namespace

UrdfDraft draft_of_urdf(const string& path, const string& content) {
  const UrdfTree tree = parse_urdf(path, content);
  const Side side = side_of(path);
  const UrdfFront front = front_of(tree, side.names);
  json machine = usual_machine(front);
  const Said said = FromUrdf(front, machine).said(side.names.ground);
  refuse_doubles(said.numbers, side);

  const std::set<string> of_side = keys_of(side.numbers);
  const std::set<string> of_urdf = without(keys_of(said.numbers), of_side);
  const std::set<string> scaled =
      without_absent(without(without(keys_of(machine), of_urdf), of_side), of_side);

  UrdfDraft draft;
  machine.merge_patch(said.numbers);
  add_sources(of_urdf, "URDF " + in_quotes(tree.name), machine);
  add_sources(scaled, "ours: the zx120, scaled to the length of boom and arm", machine);
  machine.merge_patch(side.numbers);
  if (!machine.contains("name")) machine["name"] = tree.name;
  machine["format"] = "excavplan-machine";
  machine["version"] = 1;
  warn_of_numbers(path, scaled, said.placeholders, draft.warnings);
  warn_of_angles(front, draft.warnings);
  warn_of_root(machine, draft.warnings);
  draft.json = std::move(machine);
  draft.beside = side.file;
  return draft;
}

}  // namespace excavplan
