// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/data_sheet_machine.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/kit/workspace.hpp>

#include "base/check.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "kit/fitted_cylinders.hpp"
#include "kit/proportions.hpp"
#include "machine/data_sheet_keys.hpp"
#include "machine/machine_reading.hpp"

namespace excavplan {
namespace {

using nlohmann::json;
using std::string;
using Known = std::vector<const Proportioned*>;

// Ranges of the end of a boom's travel, up and down [rad], and of the depth of a bucket over its
// length; ours: those of the shipped machines and as much again.
constexpr double highest_boom = -1.45, lowest_raised = -0.5;
constexpr double least_lowered = 0.35, most_lowered = 1.25;
constexpr double shallowest = 0.25, deepest = 0.85;
// Over both tracks, by the gauge: 2.80 over 2.20 m, Komatsu PC200-8 with shoes of 0.6 m.
constexpr double width_by_gauge = 1.27;

constexpr const char* boom_lower = "/joints/boom/lower_rad";
constexpr const char* boom_upper = "/joints/boom/upper_rad";

json file_of(const MachineNumbers& numbers, const string& name) {
  json flat = json::object();
  for (const auto& [place, value] : numbers) flat[place] = value;
  json machine = flat.unflatten();
  machine["format"] = "excavplan-machine";
  machine["version"] = 1;
  machine["name"] = name;
  return machine;
}

Machine machine_of(const MachineNumbers& numbers, const string& name) {
  return read_machine(JsonObject::of_text("the fitted machine " + in_quotes(name),
                                          file_of(numbers, name).dump(), "excavplan-machine"));
}

/// Where a function that rises reaches a value, or the nearer end.
template <typename Function>
double solved(double low, double high, double wanted, const Function& function) {
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The numbers of a machine, and how those came about that do not only grow with a figure.
class Fit {
 public:
  Fit(const Known& known, const NamedDataSheet& stated) : name_(stated.name), sheet_(stated.sheet) {
    const double reach = *sheet_.ground_reach;
    grow(known, reach);
    const double reached = reach_of(machine_of(numbers_, name_)).ground;
    require(reached > 0.0, "data sheet: no machine of these proportions reaches the ground");
    grow(known, reach * reach / reached);
    set_torques();
    set_masses();
    set_profile();
    set_boom();
    if (sheet_.track_gauge) {
      set("/geometry/track_width_m", width_by_gauge * *sheet_.track_gauge,
          readable(width_by_gauge) + " times track_gauge_m");
    }
  }

  const MachineNumbers& numbers() const { return numbers_; }

  string how(const string& place) const {
    const auto found = how_.find(place);
    if (found != how_.end()) return found->second;
    const string with = grows_with(place, sheet_);
    return with.empty() ? "as the shipped machines" : "in proportion to " + with;
  }

 private:
  double& at(const string& place) { return numbers_.at(place); }

  void set(const string& place, double value, const string& how) {
    numbers_[place] = value;
    how_[place] = how;
  }

  void grow(const Known& known, double length) {
    numbers_ = in_proportion(known, sheet_, length);
    set_teeth();
  }

  void set_torques() {
    const double bucket = at("/geometry/bucket_length_m");
    if (sheet_.bucket_force) {
      set("/joints/bucket/torque_n_m", *sheet_.bucket_force * bucket,
          "bucket_force_n times the length of the bucket");
    }
    if (sheet_.arm_force) {
      set("/joints/arm/torque_n_m", *sheet_.arm_force * (at("/geometry/arm_length_m") + bucket),
          "arm_force_n times the length of arm and bucket");
    }
  }

  void set_masses() {
    double links = 0.0;
    for (const char* link : {"boom", "arm", "bucket"})
      links += at(string("/links/") + link + "/mass_kg");
    if (numbers_.count("/body/mass_kg") == 0) return;
    set("/body/mass_kg", *sheet_.operating_mass - links,
        "operating_mass_kg less boom, arm and bucket");
  }

  void set_teeth() {
    if (numbers_.count("/bucket/teeth/count") == 0) return;
    const double most = std::floor(at("/bucket/width_outside_m") / at("/bucket/teeth/width_m"));
    double& count = at("/bucket/teeth/count");
    count = std::max(1.0, std::min(most, std::round(count)));
  }

  /// As deep as its capacity asks.
  void set_profile() {
    Machine machine = machine_of(numbers_, name_);
    const auto usual = machine.bucket.profile;
    double depth = 0.0;
    for (const auto& corner : usual) depth = std::max(depth, corner.y());
    const double length = machine.bucket_length / depth;
    const double times =
        solved(shallowest * length, deepest * length, *sheet_.bucket_capacity, [&](double factor) {
          for (std::size_t i = 0; i < usual.size(); ++i) {
            machine.bucket.profile[i].y() = factor * usual[i].y();
          }
          return heaped_capacity(machine);
        });
    for (std::size_t i = 0; i < usual.size(); ++i) {
      const string place = "/bucket/profile/" + std::to_string(i);
      set(place + "/across_m", times * usual[i].y(), "such that bucket_capacity_m3 is held");
    }
    at("/bucket/profile/0/along_m") = machine.bucket_length;
  }

  /// Turns as far as depth and height ask.
  void set_boom() {
    Machine machine = machine_of(numbers_, name_);
    JointLimits& boom = machine.limits[0];
    boom.upper = solved(least_lowered, most_lowered, *sheet_.depth, [&](double angle) {
      boom.upper = angle;
      return reach_of(machine).depth;
    });
    set(boom_upper, boom.upper, "such that depth_m is reached");
    const auto raise = [&](double wanted, const string& figure, const auto& height) {
      boom.lower = -solved(-lowest_raised, -highest_boom, wanted, [&](double angle) {
        boom.lower = -angle;
        return height();
      });
      set(boom_lower, boom.lower, "such that " + figure + " is reached");
    };
    if (sheet_.height) {
      raise(*sheet_.height, "height_m", [&] { return reach_of(machine).height; });
    } else if (sheet_.dump_height) {
      raise(*sheet_.dump_height, "dump_height_m", [&] { return dump_height(machine); });
    }
  }

  string name_;
  DataSheet sheet_;
  MachineNumbers numbers_;
  std::map<string, string> how_;
};

bool is_angle(const string& place) {
  constexpr std::size_t end = 4;
  return place.size() > end && place.compare(place.size() - end, end, "_rad") == 0;
}

/// Of each number, what the fit is off for the known machines, each left out of it.
std::map<string, std::vector<double>> errors_left_out(const std::vector<Proportioned>& known,
                                                      const DataSheet& sheet) {
  std::map<string, std::vector<double>> errors;
  for (const Proportioned& left_out : known) {
    Known others;
    for (const Proportioned& each : known) {
      if (&each != &left_out) others.push_back(&each);
    }
    const Fit fit(others, {left_out.file.machine.name, as_far_as(left_out.sheet, sheet)});
    for (const auto& [place, value] : fit.numbers()) {
      const auto truth = left_out.numbers.find(place);
      if (truth == left_out.numbers.end()) continue;
      if (is_angle(place)) errors[place].push_back(value - truth->second);
      if (!is_angle(place) && truth->second != 0.0) {
        errors[place].push_back(value / truth->second - 1.0);
      }
    }
  }
  return errors;
}

std::optional<double> rms(const std::vector<double>& errors) {
  if (errors.size() < 2) return std::nullopt;
  double sum = 0.0;
  for (const double error : errors) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

string spread_text(const FittedNumber& number) {
  if (!number.spread) return "spread unknown";
  const string angle = readable(*number.spread, 2) + " rad";
  return "spread " + (is_angle(number.key) ? angle : readable(100.0 * *number.spread, 2) + " %");
}

std::vector<FittedNumber> described(const Fit& fit, const std::vector<Proportioned>& known,
                                    const DataSheet& sheet) {
  const auto errors = errors_left_out(known, sheet);
  std::vector<FittedNumber> list;
  for (const auto& [place, value] : fit.numbers()) {
    const auto found = errors.find(place);
    list.push_back({key_of(place), value, fit.how(place),
                    found == errors.end() ? std::nullopt : rms(found->second)});
  }
  return list;
}

/// One for all numbers of a list, with the widest spread.
void add_sources(const std::vector<FittedNumber>& numbers, json& machine) {
  std::map<string, FittedNumber> widest;
  for (const FittedNumber& number : numbers) {
    const string key = number.key.substr(0, number.key.find('['));
    const auto [place, is_new] = widest.emplace(key, number);
    if (!is_new && place->second.spread.value_or(0.0) <= number.spread.value_or(0.0)) {
      place->second = number;
    }
  }
  for (const auto& [key, number] : widest) {
    const std::size_t dot = key.find('.');
    machine[key.substr(0, dot)]["sources"][key.substr(dot + 1)] =
        "fitted to the data sheet: " + number.how + "; " + spread_text(number);
  }
}

Warning fitted_warning(const std::vector<FittedNumber>& numbers) {
  std::vector<FittedNumber> worst;
  for (const FittedNumber& number : numbers) {
    if (number.spread && !is_angle(number.key)) worst.push_back(number);
  }
  std::stable_sort(worst.begin(), worst.end(),
                   [](const auto& a, const auto& b) { return *a.spread > *b.spread; });
  if (worst.size() > 4) worst.resize(4);
  string list;
  for (const FittedNumber& number : worst) {
    list += (list.empty() ? "" : ", ") + number.key + " (" + spread_text(number) + ")";
  }
  return {WarningCode::data_sheet_fitted,
          "all that the data sheet does not state is fitted from the shipped machines, with the "
          "spread that its sources tell; least certain: " +
              list};
}

}  // namespace

const std::vector<string>& proportion_machines() {
  static const std::vector<string> names = {"generic-mini", "zx120", "zx200", "generic-20t"};
  return names;
}

FittedMachine machine_from_data_sheet(const NamedDataSheet& sheet,
                                      const std::vector<string>& from) {
  for (const DataSheetKey& each : data_sheet_keys()) {
    require(!each.required || sheet.sheet.*each.figure,
            string("data sheet: ") + each.key + " is missing");
  }
  require(from.size() >= 2, "data sheet: machines to take proportions from",
          static_cast<double>(from.size()), "at least 2");
  std::vector<Proportioned> known;
  known.reserve(from.size());
  for (const string& word : from) known.push_back(proportioned(word));
  Known all;
  for (const Proportioned& each : known) all.push_back(&each);

  const Fit fit(all, sheet);
  FittedMachine fitted;
  fitted.numbers = described(fit, known, sheet.sheet);
  json machine = file_of(fit.numbers(), sheet.name);
  machine["description"] = "fitted to a data sheet";
  machine["data_sheet"] = data_sheet_json(sheet.sheet);
  add_sources(fitted.numbers, machine);
  add_cylinders(all, machine_of(fit.numbers(), sheet.name), machine);
  fitted.file.text = machine.dump(2) + "\n";
  fitted.file.machine = read_machine(JsonObject::of_text(
      "the fitted machine " + in_quotes(sheet.name), fitted.file.text, "excavplan-machine"));
  fitted.file.data_sheet = sheet.sheet;
  fitted.file.warnings = {fitted_warning(fitted.numbers)};
  return fitted;
}

}  // namespace excavplan
