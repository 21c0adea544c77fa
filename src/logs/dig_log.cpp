// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/logs/dig_log.hpp>

#include <algorithm>
#include <cmath>

namespace excavplan {
namespace {

/// Integral of a straight line from a to b, of its positive part if only that counts.
double area_under(double a, double b, double width, bool only_positive) {
  if (!only_positive || (a >= 0.0 && b >= 0.0)) return 0.5 * (a + b) * width;
  const double top = std::max(a, b);
  return top > 0.0 ? 0.5 * top * top / std::abs(b - a) * width : 0.0;
}

}  // namespace

const char* name(LogMeter meter) {
  switch (meter) {
    case LogMeter::fuel_flow:
      return "fuel flow";
    case LogMeter::power:
      return "power";
    case LogMeter::joint_powers:
      return "joint powers";
    case LogMeter::torques:
      return "torques and rates";
    case LogMeter::pressures:
      return "pressures and speeds";
  }
  return "";
}

std::optional<std::array<PistonAreas, 3>> piston_areas(const Machine& machine) {
  if (!machine.hydraulics || !machine.cylinders) return std::nullopt;
  std::array<PistonAreas, 3> areas;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const Piston& piston = machine.hydraulics->pistons[i];
    const double count = (*machine.cylinders)[i].count();
    areas[i] = {count * piston.area_filled(1.0), count * piston.area_filled(-1.0)};
  }
  return areas;
}

LogRows rows_around(const std::vector<double>& time, const LogInterval& interval) {
  const auto row = [&](auto at) { return static_cast<std::size_t>(at - time.begin()); };
  const std::size_t inside = row(std::lower_bound(time.begin(), time.end(), interval.from));
  const std::size_t behind = row(std::upper_bound(time.begin(), time.end(), interval.to));
  return {inside == 0 ? 0 : inside - 1, std::min(behind + 1, time.size())};
}

std::vector<double> DigLog::rate() const {
  std::vector<double> sum(time.size(), 0.0);
  for (const std::vector<double>& part : rates) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += spent == Spent::energy ? std::max(0.0, part[i]) : part[i];
    }
  }
  return sum;
}

double DigLog::integral(const LogInterval& during, double idle) const {
  const LogRows rows = rows_around(time, during);
  double sum = 0.0;
  for (const std::vector<double>& part : rates) {
    for (std::size_t i = rows.first + 1; i < rows.last; ++i) {
      const double from = std::max(time[i - 1], during.from);
      const double to = std::min(time[i], during.to);
      if (!(from < to)) continue;
      const double slope = (part[i] - part[i - 1]) / (time[i] - time[i - 1]);
      const auto at = [&](double t) { return part[i - 1] + slope * (t - time[i - 1]); };
      sum += area_under(at(from), at(to), to - from, spent == Spent::energy);
    }
  }
  return sum - idle * (during.to - during.from);
}

std::optional<double> idle_of(const DigLog& log) {
  constexpr double window = 2.0;      // [s]; ours
  constexpr double steadiness = 0.1;  // ours
  constexpr double well_below = 0.8;  // ours
  const std::vector<double> rate = log.rate();
  const std::vector<double>& time = log.time;
  std::optional<double> lowest;
  std::size_t first = 0;
  double sum = rate.front();
  double next_look = time.front() + window;
  for (std::size_t last = 1; last < rate.size(); ++last) {
    sum += rate[last];
    while (first + 1 < last && time[last] - time[first + 1] >= window) sum -= rate[first++];
    if (time[last] < next_look || last - first < 4) continue;
    next_look = time[last] + 0.25 * window;
    const double mean = sum / static_cast<double>(last - first + 1);
    if (lowest && mean >= *lowest) continue;
    const auto is_near = [&](double value) { return std::abs(value - mean) <= steadiness * mean; };
    const auto begin = rate.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = rate.begin() + static_cast<std::ptrdiff_t>(last + 1);
    if (mean > 0.0 && std::all_of(begin, end, is_near)) lowest = mean;
  }
  const double duration = time.back() - time.front();
  const double mean = log.integral({time.front(), time.back()}) / duration;
  return lowest && *lowest < well_below * mean ? lowest : std::nullopt;
}

}  // namespace excavplan
