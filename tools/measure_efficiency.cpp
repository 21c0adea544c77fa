// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <excavplan/ground/volume_change.hpp>

#include "base/json.hpp"
#include "base/text.hpp"
#include "shared/scans.hpp"
#include "shared/table.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const About about = {
    "measure-efficiency",
    "measures what a real dig lifts per fuel or energy, and by how much a second dig is better. A "
    "log is a CSV file with the column time_s and one of: fuel_flow_ml_per_s; fuel_flow_l_per_h; "
    "power_w; boom_power_w, arm_power_w and bucket_power_w (power a joint gives back does not "
    "count).",
    {{"measure-efficiency fixed.csv planned.csv --volume 0.42 --second-volume 0.41",
      "fuel logs of two digs and the soil each left in the bucket"},
     {"measure-efficiency day.csv --from 61.5 --to 70 --mass 780kg", "one dig out of a longer log"},
     {"measure-efficiency dig.csv --dump-before heap0.pcd --dump-after heap1.pcd",
      "the volume from scans of the dump area"}},
    true};

/// One dig as the command line tells it.
struct RunInputs {
  std::string prefix;  ///< of its options: empty or "second-"
  std::optional<std::string> log;
  std::optional<double> volume;
  std::optional<double> volume_sd;
  std::optional<double> mass;
  std::optional<double> mass_sd;
  std::optional<std::string> dump_before;
  std::optional<std::string> dump_after;
  std::optional<double> from;
  std::optional<double> to;

  std::string option(const std::string& name) const { return "--" + prefix + name; }
};

struct Inputs {
  RunInputs first;
  RunInputs second;
  std::optional<std::string> before_frame;
  std::optional<std::string> after_frame;
  std::optional<double> cell_size;
};

void declare_run(Arguments& arguments, RunInputs& run, const std::string& prefix,
                 const std::string& whose) {
  run.prefix = prefix;
  arguments.option(prefix + "volume", run.volume, Quantity::volume, "soil in the bucket" + whose);
  arguments.option(prefix + "volume-sd", run.volume_sd, Quantity::volume,
                   "its standard deviation, if known");
  arguments.option(prefix + "mass", run.mass, Quantity::mass, "or its mass" + whose);
  arguments.option(prefix + "mass-sd", run.mass_sd, Quantity::mass,
                   "its standard deviation, if known");
  arguments.file(prefix + "dump-before", run.dump_before,
                 "or measure the heap: cloud of the dump area before" + whose);
  arguments.file(prefix + "dump-after", run.dump_after, "cloud of the dump area after" + whose);
  arguments.option(prefix + "from", run.from, Quantity::time,
                   "time_s at which the dig starts" + whose + " (default: the log's first)");
  arguments.option(prefix + "to", run.to, Quantity::time,
                   "time_s at which it ends (default: the log's last)");
}

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("RUN.csv", inputs.first.log, "log of a dig");
  arguments.require("RUN.csv");
  arguments.positional("SECOND.csv", inputs.second.log, "log of the dig to compare with it");
  declare_run(arguments, inputs.first, "", "");
  declare_run(arguments, inputs.second, "second-", ", second dig");
  arguments.file("before-frame", inputs.before_frame,
                 "4 x 4 matrix that takes the clouds before into the site frame");
  arguments.file("after-frame", inputs.after_frame, "the same for the clouds after");
  arguments.option("cell", inputs.cell_size, Quantity::length,
                   "cell of the height maps (default: from the density of the points, at least "
                   "0.05)");
}

// ---- What was spent ---------------------------------------------------------------------------

enum class Spent { fuel, energy };

/// A way in which a log tells what was spent.
struct Meter {
  std::vector<std::string> columns;
  Spent spent = Spent::fuel;
  double scale = 1.0;  ///< integral of the columns over seconds to mL or kJ
};

const std::array<Meter, 4>& meters() {
  static const std::array<Meter, 4> list = {
      {{{"fuel_flow_ml_per_s"}, Spent::fuel, 1.0},
       {{"fuel_flow_l_per_h"}, Spent::fuel, 1000.0 / 3600.0},
       {{"power_w"}, Spent::energy, 0.001},
       {{"boom_power_w", "arm_power_w", "bucket_power_w"}, Spent::energy, 0.001}}};
  return list;
}

/// The one meter whose columns the log holds.
const Meter& meter_of(const Table& log, const std::string& file) {
  const Meter* found = nullptr;
  for (const Meter& meter : meters()) {
    const bool present = std::any_of(meter.columns.begin(), meter.columns.end(),
                                     [&](const std::string& name) { return log.has(name); });
    if (!present) continue;
    if (found) {
      throw Error(ErrorKind::bad_file, file + ": holds both " + found->columns.front() + " and " +
                                           meter.columns.front() + ", expected one of them");
    }
    found = &meter;
  }
  if (!found) {
    throw Error(ErrorKind::bad_file,
                file +
                    ": has no column of fuel or power, expected one of fuel_flow_ml_per_s, "
                    "fuel_flow_l_per_h, power_w, or boom_power_w with arm_power_w and "
                    "bucket_power_w");
  }
  return *found;
}

void require_increasing(const std::vector<double>& time, const std::string& file) {
  if (time.size() < 2) {
    throw Error(ErrorKind::bad_file, file + ": holds one row, at least 2 are needed");
  }
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > time[i - 1]) continue;
    throw Error(ErrorKind::bad_file, file + ": row " + std::to_string(i + 1) +
                                         " of the numbers: time_s is " + number_text(time[i]) +
                                         ", must be above " + number_text(time[i - 1]) +
                                         " of the row before");
  }
}

struct Interval {
  double from = 0.0;
  double to = 0.0;
};

Interval interval_of(const RunInputs& run, const std::vector<double>& time) {
  const Interval log{time.front(), time.back()};
  const Interval dig{run.from.value_or(log.from), run.to.value_or(log.to)};
  const auto require_inside = [&](const std::string& name, double value) {
    if (value >= log.from && value <= log.to) return;
    throw Error(ErrorKind::bad_input, run.option(name) + ": " + number_text(value) +
                                          " s is outside " + *run.log + ", which runs from " +
                                          number_text(log.from) + " to " + number_text(log.to) +
                                          " s");
  };
  require_inside("from", dig.from);
  require_inside("to", dig.to);
  if (!(dig.from < dig.to)) {
    throw Error(ErrorKind::bad_input, run.option("from") + ": " + number_text(dig.from) +
                                          " s must be before " + run.option("to") + ", " +
                                          number_text(dig.to) + " s");
  }
  return dig;
}

/// Integral of a straight line from a to b, of its positive part if only that counts.
double area_under(double a, double b, double width, bool only_positive) {
  if (!only_positive || (a >= 0.0 && b >= 0.0)) return 0.5 * (a + b) * width;
  const double top = std::max(a, b);
  return top > 0.0 ? 0.5 * top * top / std::abs(b - a) * width : 0.0;
}

/// Trapezoid rule over the part of the log inside the dig.
double integral(const std::vector<double>& time, const std::vector<double>& rate,
                const Interval& dig, bool only_positive) {
  double sum = 0.0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double from = std::max(time[i - 1], dig.from);
    const double to = std::min(time[i], dig.to);
    if (!(from < to)) continue;
    const double slope = (rate[i] - rate[i - 1]) / (time[i] - time[i - 1]);
    const auto at = [&](double t) { return rate[i - 1] + slope * (t - time[i - 1]); };
    sum += area_under(at(from), at(to), to - from, only_positive);
  }
  return sum;
}

/// Longest pause between two rows of the dig, if it stands out from the others.
std::optional<Warning> gap_in(const std::vector<double>& time, const Interval& dig,
                              const std::string& file) {
  constexpr double most_usual_steps = 10.0;  // ours
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > dig.from && time[i - 1] < dig.to) steps.push_back(time[i] - time[i - 1]);
  }
  const double longest = *std::max_element(steps.begin(), steps.end());
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (!(longest > most_usual_steps * *middle)) return std::nullopt;
  return Warning{"gap_in_log", file + ": no row for " + readable(longest) + " s, where " +
                                   readable(*middle) +
                                   " s are usual: what was spent in it is a guess"};
}

struct Cost {
  Spent spent = Spent::fuel;
  double amount = 0.0;  ///< [mL] or [kJ]
  double duration = 0.0;
};

Cost read_cost(const RunInputs& run, std::vector<Warning>& warnings) {
  const std::string& file = *run.log;
  const Table log = Table::read(file);
  const Meter& meter = meter_of(log, file);
  const std::vector<double>& time = log.column("time_s");
  require_increasing(time, file);
  const Interval dig = interval_of(run, time);
  Cost cost{meter.spent, 0.0, dig.to - dig.from};
  for (const std::string& name : meter.columns) {
    cost.amount +=
        meter.scale * integral(time, log.column(name), dig, meter.spent == Spent::energy);
  }
  if (!(cost.amount > 0.0)) {
    throw Error(ErrorKind::bad_file,
                file + ": " + meter.columns.front() + " adds up to " + number_text(cost.amount) +
                    (cost.spent == Spent::fuel ? " mL" : " kJ") + " from " + number_text(dig.from) +
                    " to " + number_text(dig.to) + " s, must be above 0");
  }
  if (auto gap = gap_in(time, dig, file)) warnings.push_back(std::move(*gap));
  return cost;
}

// ---- What was lifted --------------------------------------------------------------------------

/// Volume of the heap between two scans of the dump area.
Measured heap_volume(const RunInputs& run, const Inputs& inputs, std::vector<Warning>& warnings) {
  const SeenPair scans =
      read_scans(*run.dump_before, *run.dump_after, {inputs.before_frame, inputs.after_frame, {}});
  const std::string files = scans.files() + ": ";
  const HeightMapPair dump = surfaces(scans, inputs.cell_size.value_or(cell_for(scans)));
  try {
    const HeightMapPair no_dig{dump.before, dump.before};
    const VolumeChange change = measure_change(no_dig, dump);
    if (!(change.dumped.value > 0.0)) {
      throw Error(ErrorKind::bad_file, "no ground rose by more than the noise of the scans");
    }
    for (const Warning& warning : change.warnings) {
      if (warning.code != "no_hole_found")
        warnings.push_back({warning.code, files + warning.message});
    }
    return change.dumped;
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, files + error.what());
  }
}

enum class Lifted { volume, mass };

struct Payload {
  Lifted lifted = Lifted::volume;
  Measured amount;  ///< [m^3] or [kg]; the sd is NaN if unknown
};

/// What the user states, with its standard deviation if that is stated as well.
Measured stated(const RunInputs& run, const std::string& name, double value,
                const std::optional<double>& sd) {
  const auto require = [&](bool holds, const std::string& option, double number, const char* rule) {
    if (holds) return;
    throw Error(ErrorKind::bad_input, option + ": " + number_text(number) + ", must be " + rule);
  };
  require(value > 0.0, run.option(name), value, "above 0");
  if (sd) require(*sd >= 0.0, run.option(name + "-sd"), *sd, "0 or more");
  return {value, sd.value_or(unknown)};
}

void check_options(const RunInputs& run) {
  const auto go_together = [&](bool broken, const std::string& name, const std::string& other) {
    if (broken) {
      throw Error(ErrorKind::bad_input,
                  run.option(name) + " needs " + run.option(other) + ", which is missing");
    }
  };
  go_together(run.volume_sd && !run.volume, "volume-sd", "volume");
  go_together(run.mass_sd && !run.mass, "mass-sd", "mass");
  go_together(run.dump_before && !run.dump_after, "dump-before", "dump-after");
  go_together(run.dump_after && !run.dump_before, "dump-after", "dump-before");
  const int ways =
      int{run.volume.has_value()} + int{run.mass.has_value()} + int{run.dump_before.has_value()};
  if (ways != 1) {
    throw Error(ErrorKind::bad_input, "what did " + *run.log + " lift? Give one of " +
                                          run.option("volume") + ", " + run.option("mass") +
                                          ", or " + run.option("dump-before") + " with " +
                                          run.option("dump-after"));
  }
}

Payload read_payload(const RunInputs& run, const Inputs& inputs, std::vector<Warning>& warnings) {
  if (run.volume) return {Lifted::volume, stated(run, "volume", *run.volume, run.volume_sd)};
  if (run.mass) return {Lifted::mass, stated(run, "mass", *run.mass, run.mass_sd)};
  return {Lifted::volume, heap_volume(run, inputs, warnings)};
}

// ---- Efficiency -------------------------------------------------------------------------------

struct Run {
  std::string file;
  Cost cost;
  Payload payload;

  Measured efficiency() const {
    return {payload.amount.value / cost.amount, payload.amount.sd / cost.amount};
  }
  std::string lifted_unit() const { return payload.lifted == Lifted::volume ? "m3" : "kg"; }
  std::string spent_unit() const { return cost.spent == Spent::fuel ? "ml" : "kj"; }
  std::string unit() const { return lifted_unit() + "_per_" + spent_unit(); }
};

/// For people.
std::string text(const std::string& unit) {
  const std::string lifted = unit.substr(0, 2);
  return lifted + "/" + (unit.substr(unit.size() - 2) == "ml" ? "mL" : "kJ");
}

/// More than a 12-t excavator could lift while it idles: 0.45 m^3 (of 1500 kg/m^3) in 8 s at 2 L/h.
/// Digging takes 6 .. 10 L/h, which makes 0.02 .. 0.034 m^3/mL. Ours.
std::optional<Warning> implausible(const Run& run) {
  if (run.cost.spent != Spent::fuel) return std::nullopt;
  const double most = run.payload.lifted == Lifted::volume ? 0.1 : 150.0;
  const double efficiency = run.efficiency().value;
  if (!(efficiency > most)) return std::nullopt;
  return Warning{"implausible_fuel",
                 run.file + ": " + readable(efficiency) + " " + text(run.unit()) + " is above " +
                     readable(most) +
                     ", which a 12-t excavator would reach idling: check the unit of the fuel "
                     "flow. The gain of one run over another of the same meter still holds"};
}

Run measure(const RunInputs& inputs, const Inputs& all, Outcome& outcome) {
  check_options(inputs);
  Run run{*inputs.log, read_cost(inputs, outcome.warnings), {}};
  run.payload = read_payload(inputs, all, outcome.warnings);
  if (auto warning = implausible(run)) outcome.warnings.push_back(std::move(*warning));
  return run;
}

/// Gain of the second run over the first [%]; an error the runs share, as of the meter, cancels.
Measured gain(const Run& first, const Run& second) {
  if (first.unit() != second.unit()) {
    throw Error(ErrorKind::bad_input, "the runs cannot be compared: " + first.file + " is in " +
                                          text(first.unit()) + ", " + second.file + " in " +
                                          text(second.unit()));
  }
  const Measured a = first.efficiency();
  const Measured b = second.efficiency();
  const double ratio = b.value / a.value;
  return {100.0 * (ratio - 1.0), 100.0 * ratio * std::hypot(a.sd / a.value, b.sd / b.value)};
}

nlohmann::ordered_json to_json(const Run& run) {
  nlohmann::ordered_json json = {{"file", run.file}, {"duration_s", run.cost.duration}};
  for (const char* key :
       {"volume_m3", "volume_sd_m3", "mass_kg", "mass_sd_kg", "fuel_ml", "energy_kj", "efficiency",
        "efficiency_sd", "efficiency_unit", "efficiency_m3_per_ml", "efficiency_m3_per_kj",
        "efficiency_kg_per_ml", "efficiency_kg_per_kj"}) {
    json[key] = nullptr;
  }
  const Measured efficiency = run.efficiency();
  const std::string lifted = run.payload.lifted == Lifted::volume ? "volume" : "mass";
  json[lifted + "_" + run.lifted_unit()] = run.payload.amount.value;
  json[lifted + "_sd_" + run.lifted_unit()] = run.payload.amount.sd;
  json[run.cost.spent == Spent::fuel ? "fuel_ml" : "energy_kj"] = run.cost.amount;
  json["efficiency"] = efficiency.value;
  json["efficiency_sd"] = efficiency.sd;
  json["efficiency_unit"] = run.unit();
  json["efficiency_" + run.unit()] = efficiency.value;
  return json;
}

std::string line(const Run& run) {
  const Measured efficiency = run.efficiency();
  return run.file + ": " + readable(run.payload.amount.value, run.payload.amount.sd) + " " +
         run.lifted_unit() + ", " + readable(run.cost.amount) +
         (run.cost.spent == Spent::fuel ? " mL" : " kJ") + " in " + readable(run.cost.duration) +
         " s: " + readable(efficiency.value, efficiency.sd) + " " + text(run.unit());
}

bool casts_doubt(const Warning& warning) {
  const auto codes = {"implausible_fuel", "gap_in_log", "zone_at_border", "zone_partly_unseen",
                      "scans_do_not_fit"};
  return std::find(codes.begin(), codes.end(), warning.code) != codes.end();
}

void refuse_stray_options(const RunInputs& second) {
  const bool any = second.volume || second.volume_sd || second.mass || second.mass_sd ||
                   second.dump_before || second.dump_after || second.from || second.to;
  if (any && !second.log) {
    throw Error(ErrorKind::bad_input,
                "SECOND.csv is missing, but options of a second dig are given");
  }
}

Outcome work(const Inputs& inputs) {
  refuse_stray_options(inputs.second);
  Outcome outcome;
  const Run first = measure(inputs.first, inputs, outcome);
  outcome.json["runs"].push_back(to_json(first));
  outcome.lines = {line(first)};
  Measured better{unknown, unknown};
  if (inputs.second.log) {
    const Run second = measure(inputs.second, inputs, outcome);
    better = gain(first, second);
    outcome.json["runs"].push_back(to_json(second));
    outcome.lines.push_back(line(second));
    outcome.lines.push_back("gain of the second: " + readable(better.value, better.sd) + " %");
  }
  outcome.json["gain_percent"] = better.value;
  outcome.json["gain_sd_percent"] = better.sd;
  outcome.trustworthy = std::none_of(outcome.warnings.begin(), outcome.warnings.end(), casts_doubt);
  outcome.json["trustworthy"] = outcome.trustworthy;
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
