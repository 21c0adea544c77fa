// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <excavplan/belief/density_belief.hpp>
#include "base/random.hpp"

namespace excavplan {
namespace {

/// Surveyed digs of 60 cells each, strewn over 15 m by 6 m.
std::vector<DigEvidence> strewn_digs(std::int64_t count) {
  std::vector<DigEvidence> digs(static_cast<std::size_t>(count));
  Random random(3);
  int scan = 0;
  for (DigEvidence& dig : digs) {
    const double x = random.uniform(0.0, 15.0);
    const double y = random.uniform(-3.0, 3.0);
    for (int i = 0; i < 60; ++i) {
      dig.bank.push_back(
          {{x + 0.25 * (i % 10), y + 0.25 * (i / 10 % 3), 0.1 + 0.2 * (i / 30)}, 0.01});
    }
    dig.survey = SurveyReading{random.uniform(30.0, 80.0), 3.5, {{scan, -2.0}, {scan + 1, 2.0}}};
    ++scan;
  }
  return digs;
}

std::vector<GroundPlace> thousand_cells() {
  std::vector<GroundPlace> cells;
  for (int i = 0; i < 1000; ++i) cells.push_back({0.3 * (i / 20), -3.0 + 0.3 * (i % 20), 0.2});
  return cells;
}

/// One dig more, and the density of a thousand cells; the argument is the number of digs.
void believe_one_dig_more(benchmark::State& state) {
  const std::vector<DigEvidence> digs = strewn_digs(state.range(0));
  const std::vector<GroundPlace> cells = thousand_cells();
  const DensityBelief before({}, {digs.begin(), digs.end() - 1});
  for (auto _ : state) {
    state.PauseTiming();
    DensityBelief belief = before;
    state.ResumeTiming();
    belief.add(digs.back());
    benchmark::DoNotOptimize(belief.at(cells));
  }
}
BENCHMARK(believe_one_dig_more)->Arg(60)->Arg(150)->Unit(benchmark::kMicrosecond);

/// The same from no digs at all.
void believe_anew(benchmark::State& state) {
  const std::vector<DigEvidence> digs = strewn_digs(state.range(0));
  const std::vector<GroundPlace> cells = thousand_cells();
  for (auto _ : state) benchmark::DoNotOptimize(DensityBelief({}, digs).at(cells));
}
BENCHMARK(believe_anew)->Arg(60)->Arg(150)->Unit(benchmark::kMicrosecond);

void refit_a_belief(benchmark::State& state) {
  const DensityBelief before({}, strewn_digs(state.range(0)));
  for (auto _ : state) {
    DensityBelief belief = before;
    belief.refit();
  }
}
BENCHMARK(refit_a_belief)->Arg(10)->Arg(60)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace excavplan
