// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "experiments/study_summary.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan {
namespace {

bool tells_gain(const StudyResult& result, const StudyRun& run) {
  return run.failure.empty() && run.compared &&
         (!run.held_down || result.condition.setting.held_down);
}

void summarise_estimates(StudyResult& result) {
  double squares = 0.0, sum = 0.0, inside = 0.0;
  for (const StudyRun& run : result.runs) {
    if (!run.failure.empty()) {
      ++result.failed;
      continue;
    }
    const double error = run.estimate_percent - run.density_percent;
    squares += error * error;
    sum += error;
    inside += run.density_percent >= run.interval[0] && run.density_percent <= run.interval[1];
    result.untrusted += run.trustworthy ? 0 : 1;
    result.compared += run.compared ? 1 : 0;
    if (run.compared && !tells_gain(result, run)) ++result.held_down;
  }
  const auto count = static_cast<double>(result.runs.size()) - result.failed;
  result.rms = std::sqrt(squares / count);
  result.bias = sum / count;
  result.inside = inside / count;
}

void summarise_gains(const StudyResult& first, StudyResult& result, std::uint64_t seed) {
  bool any = false;
  for (const StudyRun& run : result.runs) {
    if (!tells_gain(result, run)) continue;
    result.unplanned += run.plan_failure.empty() ? 0 : 1;
    if (std::isnan(run.energy.gain)) continue;
    auto& [least, most] = result.densities;
    least = any ? std::min(least, run.density_percent) : run.density_percent;
    most = any ? std::max(most, run.density_percent) : run.density_percent;
    any = true;
  }
  const auto mean = [&](auto value) {
    std::vector<double> values;
    for (std::size_t i = 0; i < result.runs.size(); ++i) {
      if (!tells_gain(result, result.runs[i])) continue;
      const double of_run = value(i);
      if (!std::isnan(of_run)) values.push_back(of_run);
    }
    return bootstrap_mean(values, seed);
  };
  const auto gains = [&](StudyGain StudyRun::*goal) {
    const auto over_first = [&](std::size_t i) {
      const bool paired = !result.condition.setting.density_percent && i < first.runs.size() &&
                          tells_gain(first, first.runs[i]);
      return paired ? (result.runs[i].*goal).gain - (first.runs[i].*goal).gain : std::nan("");
    };
    return StudyGains{mean([&](std::size_t i) { return (result.runs[i].*goal).gain; }),
                      mean([&](std::size_t i) { return (result.runs[i].*goal).of_path; }),
                      mean([&](std::size_t i) { return (result.runs[i].*goal).payload; }),
                      mean(over_first)};
  };
  result.energy = gains(&StudyRun::energy);
  result.equal = gains(&StudyRun::equal);
  result.cycle = gains(&StudyRun::cycle);
}

}  // namespace

void summarise(std::vector<StudyResult>& results, std::uint64_t seed) {
  for (StudyResult& result : results) summarise_estimates(result);
  for (StudyResult& result : results) summarise_gains(results.front(), result, seed);
}

}  // namespace excavplan
