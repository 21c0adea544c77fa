// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/logs/dig_log.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/table.hpp"
#include "base/text.hpp"
#include "logs/dig_phases.hpp"
#include "logs/log_clock.hpp"
#include "logs/log_columns.hpp"

namespace excavplan {
namespace {

constexpr std::array<const char*, 3> joints = {"boom", "arm", "bucket"};

const Channel time_channel = {
    Measure::time,
    {"time", "t", "timestamp", "time_stamp", "elapsed_time", "elapsed", "clock", "time_of_day"}};
const Channel flow_channel = {Measure::flow,
                              {"fuel_flow", "fuel_rate", "fuel_flow_rate", "fuel_consumption",
                               "fuel_consumption_rate", "fuel", "flow"}};
const Channel power_channel = {
    Measure::power,
    {"power", "joint_power", "shaft_power", "engine_power", "hydraulic_power", "pump_power"}};

std::string at_line(const Table& table, std::size_t row) {
  return "line " + std::to_string(table.line(row)) + ": ";
}

/// A table and where its columns are.
struct LogTable {
  const DigLogSource& source;
  Table table;

  std::optional<FoundColumn> find(const Channel& channel, const std::string& unit = {}) const {
    return find_column(source.file, table.names(), channel, unit);
  }
  std::vector<double> values(const FoundColumn& column) const {
    std::vector<double> list = table.column(column.name);
    for (double& value : list) value *= column.factor;
    return list;
  }
  /// The column that is stated, with its unit or without.
  std::string named(const std::string& name) const {
    if (table.has(name)) return name;
    std::vector<std::string> found;
    for (const std::string& each : table.names()) {
      if (column_name(each).base == column_name(name).base) found.push_back(each);
    }
    if (found.size() != 1) table.column(name);  // which says what there is
    return found[0];
  }
};

// ---- Time -------------------------------------------------------------------------------------

std::string time_name(const LogTable& log) {
  if (log.source.time_column) return log.named(*log.source.time_column);
  std::vector<std::string> found;
  for (const std::string& name : log.table.names()) {
    const std::string base = column_name(name).base;
    const auto& known = time_channel.names;
    if (std::find(known.begin(), known.end(), base) != known.end()) found.push_back(name);
  }
  if (found.size() == 1) return found[0];
  if (found.empty()) {
    refuse_log(log.source.file, "has no column 'time_s', its columns are: " +
                                    log.table.listed_names() + ": state the column of the time");
  }
  refuse_log(log.source.file, "holds both " + safe_text(found[0], 40) + " and " +
                                  safe_text(found[1], 40) +
                                  ", expected one of them: state the column of the time");
}

std::vector<double> read_clock(const LogTable& log, const std::string& name,
                               const std::vector<std::string>& texts) {
  ClockTimes times = clock_times(texts);
  if (times.fault.empty()) return std::move(times.seconds);
  refuse_log(log.source.file, at_line(log.table, times.bad_row) + safe_text(name, 40) + " is " +
                                  in_quotes(texts[times.bad_row]) + ", " + times.fault);
}

void require_increasing(const LogTable& log, const std::vector<double>& time,
                        const std::string& name) {
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > time[i - 1]) continue;
    refuse_log(log.source.file, at_line(log.table, i) + safe_text(name, 40) + " is " +
                                    number_text(time[i]) + " s, must be above " +
                                    number_text(time[i - 1]) + " s of the row before");
  }
}

std::vector<double> times_of(const LogTable& log) {
  const std::string name = time_name(log);
  if (log.table.rows() < 2) refuse_log(log.source.file, "holds one row, at least 2 are needed");
  const std::vector<std::string> texts = log.table.texts(name);
  if (texts.front().find(':') != std::string::npos) return read_clock(log, name, texts);
  std::vector<double> time =
      log.values(named_column(log.source.file, name, Measure::time, log.source.time_unit));
  require_increasing(log, time, name);
  return time;
}

// ---- Fuel and power ---------------------------------------------------------------------------

/// What one kind of columns gives.
struct Reading {
  std::string first_column;
  LogMeter meter = LogMeter::fuel_flow;
  std::vector<std::vector<double>> rates;
};

std::optional<Reading> read_one(const LogTable& log, LogMeter meter) {
  const bool is_fuel = meter == LogMeter::fuel_flow;
  const std::string& unit = log.source.rate_unit;
  const auto column = log.find(is_fuel ? flow_channel : power_channel, unit);
  if (!column) return std::nullopt;
  return Reading{column->name, meter, {log.values(*column)}};
}

/// The column that is stated: fuel flow or power, as its unit says.
Reading read_stated(const LogTable& log) {
  const std::string name = log.named(*log.source.rate_column);
  const std::string own = column_name(name).unit.value_or("");
  const std::string unit = log.source.rate_unit.empty() ? own : log.source.rate_unit;
  const bool is_power = factor_of(unit, Measure::power).has_value();
  const Measure measure = is_power ? Measure::power : Measure::flow;
  const FoundColumn column = named_column(log.source.file, name, measure, unit);
  return {name, is_power ? LogMeter::power : LogMeter::fuel_flow, {log.values(column)}};
}

/// Columns of one channel of the three joints, all or none.
std::optional<std::array<std::vector<double>, 3>> read_joints(
    const LogTable& log, Measure measure, const std::vector<std::string>& endings) {
  std::array<std::vector<double>, 3> values;
  std::array<bool, 3> found{};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    Channel channel{measure, {}};
    for (const std::string& ending : endings) channel.names.push_back(joints[i] + ending);
    if (const auto column = log.find(channel)) {
      values[i] = log.values(*column);
      found[i] = true;
    }
  }
  if (found == std::array<bool, 3>{}) return std::nullopt;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (found[i]) continue;
    refuse_log(log.source.file, "has no column of " + (joints[i] + endings.front()) +
                                    ", but of another joint; all three are needed");
  }
  return values;
}

std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> list(a.size());
  std::transform(a.begin(), a.end(), b.begin(), list.begin(), std::multiplies<>());
  return list;
}

std::optional<Reading> read_joint_powers(const LogTable& log) {
  const auto powers = read_joints(log, Measure::power, {"_power"});
  if (!powers) return std::nullopt;
  return Reading{"boom_power", LogMeter::joint_powers, {powers->begin(), powers->end()}};
}

std::optional<Reading> read_torques(const LogTable& log) {
  const auto rates = read_joints(log, Measure::turn_rate,
                                 {"_rate", "_speed", "_velocity", "_angular_velocity", ""});
  const auto torques = read_joints(log, Measure::torque, {"_torque"});
  if (!rates || !torques) return std::nullopt;
  Reading reading{"boom_torque", LogMeter::torques, {}};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    reading.rates.push_back(products((*torques)[i], (*rates)[i]));
  }
  return reading;
}

std::optional<Reading> read_pressures(const LogTable& log) {
  const auto head = read_joints(log, Measure::pressure, {"_head_pressure", "_bottom_pressure"});
  const auto rod = read_joints(log, Measure::pressure, {"_rod_pressure"});
  if (!head && !rod) return std::nullopt;
  const auto speed = read_joints(log, Measure::speed, {"_piston_speed", "_cylinder_speed"});
  for (const auto& [values, name] :
       {std::pair(&head, "head_pressure"), {&rod, "rod_pressure"}, {&speed, "piston_speed"}}) {
    if (!*values) {
      refuse_log(log.source.file, std::string("has no columns of boom_") + name +
                                      " and so on, which pressures of cylinders need");
    }
  }
  if (!log.source.pistons) {
    refuse_log(log.source.file,
               "holds pressures of cylinders, but the areas of the pistons are unknown");
  }
  Reading reading{"boom_head_pressure", LogMeter::pressures, {}};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const PistonAreas& area = (*log.source.pistons)[i];
    std::vector<double> power((*head)[i].size());
    for (std::size_t row = 0; row < power.size(); ++row) {
      const double force = area.head * (*head)[i][row] - area.rod * (*rod)[i][row];
      power[row] = force * (*speed)[i][row];
    }
    reading.rates.push_back(std::move(power));
  }
  return reading;
}

std::optional<Reading> read_meter(const LogTable& log, LogMeter meter) {
  switch (meter) {
    case LogMeter::fuel_flow:
    case LogMeter::power:
      return read_one(log, meter);
    case LogMeter::joint_powers:
      return read_joint_powers(log);
    case LogMeter::torques:
      return read_torques(log);
    case LogMeter::pressures:
      return read_pressures(log);
  }
  return std::nullopt;
}

Reading reading_of(const LogTable& log) {
  if (log.source.rate_column) return read_stated(log);
  std::optional<Reading> found;
  for (const LogMeter meter : {LogMeter::fuel_flow, LogMeter::power, LogMeter::joint_powers,
                               LogMeter::torques, LogMeter::pressures}) {
    if (log.source.meter && meter != *log.source.meter) continue;
    auto reading = read_meter(log, meter);
    if (!reading) continue;
    if (found) {
      refuse_log(log.source.file, "holds both " + found->first_column + " and " +
                                      reading->first_column +
                                      ", expected one of them: state the meter");
    }
    found = std::move(reading);
  }
  if (found) return *found;
  refuse_log(
      log.source.file,
      "has no column of fuel or power, expected one of fuel_flow_ml_per_s, fuel_flow_l_per_h, "
      "power_w, or of boom, arm and bucket each boom_power_w, boom_torque_n_m with "
      "boom_rate_rad_per_s, or boom_head_pressure_pa with boom_rod_pressure_pa and "
      "boom_piston_speed_m_per_s; its columns are: " +
          log.table.listed_names() + ": state the column of fuel or power");
}

/// What is finite in the file may not be so in other units, or as a product.
void require_finite(const LogTable& log, const Reading& reading) {
  for (const std::vector<double>& part : reading.rates) {
    const auto is_finite = [](double value) { return std::isfinite(value); };
    const auto bad = std::find_if_not(part.begin(), part.end(), is_finite);
    if (bad == part.end()) continue;
    refuse_log(log.source.file, at_line(log.table, static_cast<std::size_t>(bad - part.begin())) +
                                    name(reading.meter) + " of " +
                                    safe_text(reading.first_column, 40) +
                                    " is too large for a number");
  }
}

/// One power is that of the joints by its name, or because it was stated.
bool is_of_joints(const DigLogSource& source, const Reading& reading) {
  if (reading.meter != LogMeter::power) return reading.meter != LogMeter::fuel_flow;
  return source.rate_column || column_name(reading.first_column).base == "joint_power";
}

// ---- What counts ------------------------------------------------------------------------------

LogInterval interval_of(const DigLogSource& source, const std::vector<double>& time) {
  const LogInterval log{time.front(), time.back()};
  const LogInterval interval{source.from.value_or(log.from), source.to.value_or(log.to)};
  const auto require_inside = [&](const char* name, double value) {
    if (value >= log.from && value <= log.to) return;
    throw Error(ErrorKind::bad_input, source.prefix + name + ": " + number_text(value) +
                                          " s is outside " + source.file + ", which runs from " +
                                          number_text(log.from) + " to " + number_text(log.to) +
                                          " s");
  };
  require_inside("from", interval.from);
  require_inside("to", interval.to);
  if (!(interval.from < interval.to)) {
    throw Error(ErrorKind::bad_input, source.prefix + "from: " + number_text(interval.from) +
                                          " s must be before " + source.prefix + "to, " +
                                          number_text(interval.to) + " s");
  }
  return interval;
}

LogInterval overlap(const LogInterval& a, const LogInterval& b) {
  return {std::max(a.from, b.from), std::min(a.to, b.to)};
}

void find_digs(const LogTable& log, DigLog& result) {
  result.digs = {result.whole};
  result.cycle = result.whole;
  const auto& names = log.table.names();
  const auto column = std::find_if(names.begin(), names.end(), [](const std::string& name) {
    return column_name(name).base == "phase";
  });
  const bool is_marked = column != names.end();
  const PhaseSource wanted =
      log.source.phases.value_or(is_marked ? PhaseSource::marked : PhaseSource::none);
  if (wanted == PhaseSource::none) return;
  std::vector<LogInterval> digs;
  if (wanted == PhaseSource::marked) {
    MarkedPhases marked = marked_phases(log.table, is_marked ? *column : "phase", result.time);
    digs = std::move(marked.digs);
    result.cycle = overlap(marked.cycle, result.whole);
  } else {
    const auto arm = log.find({Measure::angle, {"arm", "arm_angle", "arm_joint"}});
    const auto bucket = log.find({Measure::angle, {"bucket", "bucket_angle", "bucket_joint"}});
    if (!arm || !bucket) {
      refuse_log(
          log.source.file,
          "has no columns arm_rad and bucket_rad, which finding the dig by the joints needs");
    }
    digs = found_digs(result.time, log.values(*arm), log.values(*bucket));
  }
  std::vector<LogInterval> counted;
  for (const LogInterval& dig : digs) {
    const LogInterval part = overlap(dig, result.whole);
    if (part.from < part.to) counted.push_back(part);
  }
  if (counted.empty()) {
    refuse_log(log.source.file,
               "holds no dig from " + number_text(result.whole.from) + " to " +
                   number_text(result.whole.to) + " s" +
                   (wanted == PhaseSource::marked ? ": no row there is of penetrate, drag or scoop"
                                                  : ": arm and bucket do not curl in there"));
  }
  result.phases = wanted;
  result.digs = std::move(counted);
}

}  // namespace

DigLog read_dig_log(const DigLogSource& source) {
  const LogTable log{source, Table::read(source.file, {source.delimiter, source.decimal_mark})};
  DigLog result;
  result.file = source.file;
  Reading reading = reading_of(log);
  require_finite(log, reading);
  result.meter = reading.meter;
  result.of_joints = is_of_joints(source, reading);
  result.spent = reading.meter == LogMeter::fuel_flow ? Spent::fuel : Spent::energy;
  result.rates = std::move(reading.rates);
  result.time = times_of(log);
  result.whole = interval_of(source, result.time);
  find_digs(log, result);
  return result;
}

}  // namespace excavplan
