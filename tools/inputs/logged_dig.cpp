// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/logged_dig.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <tuple>
#include <utility>

#include "base/read_double.hpp"
#include "frame/quantity.hpp"
#include "logs/log_columns.hpp"

namespace excavplan::tools {
namespace {

std::optional<char> sign_of(const std::string& word) {
  static const std::map<std::string, char> signs = {
      {"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"bar", '|'}, {"point", '.'}};
  const auto found = signs.find(word);
  return found == signs.end() ? std::nullopt : std::optional(found->second);
}

/// The first, then those of LogMeter.
const std::vector<std::string> meter_words = {"auto",         "fuel",    "power",
                                              "joint-powers", "torques", "pressures"};

/// "2.8L/h" [mL/s], "5kW" [W], and which it is.
std::pair<double, Spent> parse_rate(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = read_double(text.data(), end, value);
  const std::string unit(stop, end);
  if (error == std::errc{} && std::isfinite(value)) {
    for (const auto& [measure, kind] :
         {std::pair(Measure::flow, Spent::fuel), {Measure::power, Spent::energy}}) {
      if (const auto factor = factor_of(unit, measure)) return {value * *factor, kind};
    }
  }
  usage_error("--idle: '" + text + "' is no rate, expected one such as 2.8L/h, 0.8mL/s or 5kW");
}

ScanPair pair_of(const std::string& before, const std::string& after, const ScanFrames& frames) {
  ScanReport unread;
  return placed_pair(before, after, frames, unread);
}

}  // namespace

const OptionNames log_options = {
    {"state the delimiter", "give --delimiter"},
    {"state the decimal mark", "give --decimal"},
    {"state the column of the time", "give --time-column"},
    {"state the column of fuel or power", "give --rate-column"},
    {"state the meter", "give --meter"},
    {"state the unit", "or give --time-unit or --rate-unit"},
    {"the rate at rest is", "--idle is"},
    {"state the rate at rest", "give --idle"},
    {"state when the dig begins and ends, or what counts",
     "give --from and --to, or --phases found; --subtract-idle or --count cycle if idling is to be "
     "left out or in"},
    {"check the rate at rest", "check --idle"},
    {"the areas of the pistons are unknown", "the file of --machine states no hydraulics"}};

void LogFormat::declare(Arguments& arguments) {
  arguments.text("time-column", "NAME", time_column, "column of the time (default: found)");
  arguments.text("time-unit", "UNIT", time_unit,
                 "its unit, if its name does not say it: " + usual_units(Measure::time));
  arguments.text("rate-column", "NAME", rate_column,
                 "column of fuel flow or power (default: found)");
  arguments.text("rate-unit", "UNIT", rate_unit,
                 "its unit, if its name does not say it: " + usual_units(Measure::flow) + ", " +
                     usual_units(Measure::power));
  arguments.choice("meter", meter, meter_words, "what counts of a log that has several");
  arguments.choice("delimiter", delimiter, {"auto", "comma", "semicolon", "tab", "bar"},
                   "between the fields of a log");
  arguments.choice("decimal", decimal, {"auto", "point", "comma"}, "decimal mark of a log");
  arguments.choice("phases", phases, {"auto", "marked", "found", "none"},
                   "how the digs in a log are known: by its column phase, by the joint angles, or "
                   "not; auto: by the column if there is one");
  arguments.option("meter-sd", meter_sd, Quantity::percent,
                   "standard deviation of the meter, of its reading");
}

void LogFormat::apply_to(DigLogSource& source) const {
  static const std::map<std::string, PhaseSource> sources = {
      {"marked", PhaseSource::marked}, {"found", PhaseSource::found}, {"none", PhaseSource::none}};
  source.time_column = time_column;
  source.time_unit = time_unit;
  source.rate_column = rate_column;
  source.rate_unit = rate_unit;
  const auto word = std::find(meter_words.begin(), meter_words.end(), meter);
  if (meter != "auto") source.meter = static_cast<LogMeter>(word - meter_words.begin() - 1);
  source.delimiter = sign_of(delimiter);
  source.decimal_mark = sign_of(decimal);
  if (phases != "auto") source.phases = sources.at(phases);
}

double LogFormat::meter_share() const {
  if (!(meter_sd >= 0.0 && meter_sd <= 100.0)) {
    usage_error("--meter-sd: " + number_text(meter_sd) + " must be in 0 .. 100");
  }
  return meter_sd / 100.0;
}

void LogInputs::declare(Arguments& arguments) {
  format.declare(arguments);
  arguments.choice("count", count, {"dig", "cycle"},
                   "what counts of a log with phases: penetrate, drag and scoop, or all");
  arguments.text(
      "idle", "RATE", idle,
      "fuel flow or power at rest, such as 2.8L/h (default: the low plateau of the log)");
  arguments.flag("subtract-idle", subtracts_idle, "idling is no part of the consumption");
  arguments.machine(machine);
}

void LogInputs::apply_to(LoggedDig& dig) const {
  format.apply_to(dig);
  dig.counted = count == "cycle" ? Counted::cycle : Counted::dig;
  if (idle) std::tie(dig.idle, dig.idle_kind) = parse_rate(*idle);
  dig.subtracts_idle = subtracts_idle;
  dig.meter_sd = format.meter_share();
  dig.pistons = piston_areas(machine_named(machine));
}

Measured parse_measured(const std::string& what, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() > 2 || parts.back().empty()) {
    usage_error(what + ": '" + text + "' is not VALUE or VALUE,SD");
  }
  const double value = parse_quantity(what, parts[0], Quantity::ratio);
  return {value, parts.size() == 2 ? parse_quantity(what, parts[1], Quantity::ratio) : 0.0};
}

void RunInputs::declare(Arguments& arguments, const std::string& its_prefix,
                        const std::string& whose) {
  prefix = its_prefix;
  const auto scans = [&](const std::string& name, auto& before, auto& after,
                         const std::string& what, const std::string& first,
                         const std::string& second) {
    arguments.file(prefix + name + "-before", before,
                   "or volume from scans: " + what + first + whose);
    arguments.file(prefix + name + "-after", after, what + second + whose);
  };
  arguments.option(prefix + "volume", volume, Quantity::volume, "loose soil in the bucket" + whose);
  arguments.option(prefix + "volume-sd", volume_sd, Quantity::volume,
                   "its standard deviation, if known");
  arguments.option(prefix + "bank-volume", bank_volume, Quantity::volume,
                   "or the volume that it had in the ground" + whose);
  arguments.option(prefix + "bank-volume-sd", bank_volume_sd, Quantity::volume,
                   "its standard deviation, if known");
  arguments.option(prefix + "mass", mass, Quantity::mass, "or its mass" + whose);
  arguments.option(prefix + "mass-sd", mass_sd, Quantity::mass, "its standard deviation, if known");
  scans("dump", dump_before, dump_after, "cloud of the dump area", " before", " after");
  scans("pit", pit_before, pit_after, "cloud of the dig area", " before", " after");
  scans("bucket", bucket_before, bucket_after, "cloud of the bucket, z out of its mouth, ", "empty",
        "loaded");
  arguments.text(prefix + "bulking-factor", "K[,SD]", bulking_factor,
                 "loose over undisturbed volume" + whose + ", with its standard deviation");
  arguments.option(prefix + "from", from, Quantity::time,
                   "time at which the dig starts" + whose + " (default: the log's first)");
  arguments.option(prefix + "to", to, Quantity::time,
                   "time at which it ends (default: the log's last)");
}

bool RunInputs::any() const {
  return volume || volume_sd || bank_volume || bank_volume_sd || mass || mass_sd || dump_before ||
         dump_after || pit_before || pit_after || bucket_before || bucket_after || bulking_factor ||
         from || to;
}

LoggedDig RunInputs::dig(const ScanFrames& frames, const LogInputs& logs) const {
  check();
  LoggedDig result;
  result.file = *log;
  result.from = from;
  result.to = to;
  result.prefix = option("");
  result.lifted = content(frames);
  if (bulking_factor) {
    result.bulking_factor = parse_measured(option("bulking-factor"), *bulking_factor);
  }
  logs.apply_to(result);
  return result;
}

BucketContent RunInputs::content(const ScanFrames& frames) const {
  const double unknown = std::nan("");
  if (volume) return Payload{Lifted::volume, {*volume, volume_sd.value_or(unknown)}};
  if (mass) return Payload{Lifted::mass, {*mass, mass_sd.value_or(unknown)}};
  if (bank_volume) return BankVolume{{*bank_volume, bank_volume_sd.value_or(unknown)}};
  if (pit_before) return PitScans{pair_of(*pit_before, *pit_after, frames)};
  if (bucket_before) return BucketScans{pair_of(*bucket_before, *bucket_after, frames)};
  return pair_of(*dump_before, *dump_after, frames);
}

void RunInputs::check() const {
  const auto go_together = [&](bool broken, const std::string& name, const std::string& other) {
    if (broken) {
      usage_error(option(name) + " needs " + option(other) + ", which is missing");
    }
  };
  go_together(volume_sd && !volume, "volume-sd", "volume");
  go_together(bank_volume_sd && !bank_volume, "bank-volume-sd", "bank-volume");
  go_together(mass_sd && !mass, "mass-sd", "mass");
  int ways = int{volume.has_value()} + int{mass.has_value()} + int{bank_volume.has_value()};
  for (const auto& [name, before, after] : {std::tuple("dump", &dump_before, &dump_after),
                                            {"pit", &pit_before, &pit_after},
                                            {"bucket", &bucket_before, &bucket_after}}) {
    const std::string word = name;
    go_together(*before && !*after, word + "-before", word + "-after");
    go_together(*after && !*before, word + "-after", word + "-before");
    ways += int{before->has_value()};
  }
  if (ways != 1) {
    usage_error("payload of " + *log + ": give exactly one of " + option("volume") + ", " +
                option("bank-volume") + ", " + option("mass") +
                ", or scans of dump, pit or bucket (" + option("dump-before") + " with " +
                option("dump-after") + " and so on)");
  }
}

}  // namespace excavplan::tools
