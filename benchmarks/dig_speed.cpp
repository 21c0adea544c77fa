// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// What a dig of the built-in simulator costs, and whether two builds dig the same:
///
///     dig_speed fixed|full|overfull CELL_M DIGS    the same dig over and over, in medium loam
///     dig_speed settled CELL_M DIGS                the fixed path, the ground at rest afterwards
///     dig_speed random DIGS                        a checksum of random digs for each kind of
///     ground dig_speed candidates [SCAN]                  dig_many() over the digs of one search
///     dig_speed screening SEEDS                    search_screened() beside search_dig()
///
/// Prints digs per second of the processor; `random` prints every bit of the results as a checksum:
/// builds of the same physics print the same. `candidates` is on the shipped scan of ground before
/// a dig and compares payload and energy on coarser cells and in coarser steps with the fine ones.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/screened_search.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/compaction.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/dig_many.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "base/random.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

const Machine& zx120() {
  static const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  return machine;
}

SoilKind soil_named(const char* name) {
  return load_soil(find_data_file("soils/" + std::string(name) + ".json"));
}

// ---- the same dig -------------------------------------------------------------------------------

/// Its bucket is struck full at the end.
constexpr DigParameters full_path = {0.7853981633974483, 0.5, 1.6};
/// It cuts twice what the bucket holds.
constexpr DigParameters overfull_path = {0.7853981633974483, 0.6, 2.5};

void dig_over_and_over(const DigParameters& parameters, const DigOptions& options, double cell,
                       int digs) {
  const Terrain ground = level_planning_ground(zx120(), cell);
  const auto path =
      make_dig_path_anywhere(zx120(), parameters, boom_plane_profile(ground.surface()));
  const HeightMapSimulator simulator(zx120(), soil_named("loam"), 40.0);
  DigResult result;
  const double begin = processor_time();
  for (int i = 0; i < digs; ++i) result = simulator.dig(ground, std::get<DigPath>(path), options);
  const double seconds = processor_time() - begin;
  std::printf("%.0f digs/s, %.3f ms a dig; %a kg, %a J\n", digs / seconds, 1e3 * seconds / digs,
              result.payload_mass, result.energy.total);
}

// ---- random digs --------------------------------------------------------------------------------

/// FNV-1a of numbers, bit by bit.
class Checksum {
 public:
  Checksum& operator<<(double value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) sum_ = (sum_ ^ byte) * 0x100000001b3U;
    return *this;
  }
  Checksum& operator<<(const Eigen::ArrayXXd& values) {
    for (Index i = 0; i < values.size(); ++i) *this << values.data()[i];
    return *this;
  }
  Checksum& operator<<(const DigResult& dig) {
    const EnergyLedger& energy = dig.energy;
    const SoilLedger& soil = dig.soil;
    for (const double number :
         {dig.payload_mass, dig.payload_volume, dig.peak_force, energy.total, energy.soil,
          energy.edge, energy.payload, energy.links, energy.lift, soil.bank_cut, soil.loose_cut,
          soil.payload, soil.spilled, soil.fallen_back, soil.solids_before, soil.solids_after}) {
      *this << number;
    }
    *this << static_cast<double>(dig.given_up) << (dig.stall ? dig.stall->travelled : -1.0);
    for (const JointAngles& torque : dig.torques) *this << torque(0) << torque(1) << torque(2);
    for (const ForceSample& at : dig.history) *this << at.soil(0) << at.soil(1) << at.bucket_fill;
    return *this << dig.patch.bank << dig.patch.loose << dig.patch.loose_void_ratio;
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325U;
};

/// What lies and stands where a dig begins.
struct GroundKind {
  const char* name;
  std::function<Terrain(const SoilKind&, double cell, Random&)> make;
};

Terrain sloped(double slope, double cell) { return sloped_planning_ground(zx120(), slope, cell); }

Terrain with_pit(const SoilKind& soil, double cell, Random& random) {
  Terrain ground = sloped(0.0, cell);
  const HeightMapSimulator simulator(zx120(), soil, 30.0);
  for (int i = 0; i < 3; ++i) {
    const DigParameters dig = {0.7, random.uniform(0.2, 0.5), random.uniform(0.5, 2.0)};
    const auto path = make_dig_path_anywhere(zx120(), dig, boom_plane_profile(ground.surface()));
    if (const auto* drivable = std::get_if<DigPath>(&path)) {
      ground = simulator.dig(ground, *drivable).after(ground);
    }
  }
  return ground;
}

Terrain with_loose(double cell, Random& random) {
  Terrain ground = sloped(random.uniform(-0.2, 0.2), cell);
  const double thickness = random.uniform(0.05, 0.5);
  const double wave = random.uniform(1.0, 6.0);
  for (Index col = 0; col < ground.loose.cols(); ++col) {
    for (Index row = 0; row < ground.loose.rows(); ++row) {
      const double x = ground.bank.x(col);
      const double y = ground.bank.y(row);
      ground.loose(row, col) = std::max(0.0, thickness * std::sin(wave * x + y));
    }
  }
  return ground;
}

Terrain with_void_ratios(const SoilKind& soil, double cell, Random& random) {
  Terrain ground = with_loose(cell, random);
  Load load;
  load.area = {3.0, -0.6, 6.0, 0.8};
  load.pressure = random.uniform(1e4, 1e5);
  compact(ground, soil, load);
  ground.bank_void_ratio.resize(ground.loose.rows(), ground.loose.cols());
  for (Index i = 0; i < ground.loose.size(); ++i) {
    ground.bank_void_ratio.data()[i] = random.uniform(soil.void_ratio_min, soil.void_ratio_max);
  }
  return ground;
}

const std::vector<GroundKind>& ground_kinds() {
  static const std::vector<GroundKind> kinds = {
      {"level", [](const SoilKind&, double cell, Random&) { return sloped(0.0, cell); }},
      {"rising", [](const SoilKind&, double cell, Random&) { return sloped(0.26, cell); }},
      {"falling", [](const SoilKind&, double cell, Random&) { return sloped(-0.26, cell); }},
      {"pit", with_pit},
      {"loose",
       [](const SoilKind&, double cell, Random& random) { return with_loose(cell, random); }},
      {"void ratios", with_void_ratios}};
  return kinds;
}

/// The next path that the machine can drive.
DigPath draw_path(const Terrain& ground, Random& random) {
  const DigBounds bounds = machine_bounds(zx120());
  while (true) {
    DigParameters dig;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      dig.*info.field = random.uniform(bounds.lower.*info.field, bounds.upper.*info.field);
    }
    auto path =
        make_dig_path(zx120(), dig, random.uniform(3.5, 7.5), boom_plane_profile(ground.surface()));
    if (auto* drivable = std::get_if<DigPath>(&path)) return *drivable;
  }
}

void dig_at_random(const GroundKind& kind, int digs) {
  constexpr const char* soils[] = {"loam", "sand", "clay", "gravel"};
  constexpr double cells[] = {0.05, 0.1, 0.05, 0.025};
  Checksum all;
  int stalls = 0;
  for (int i = 0; i < digs; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    const SoilKind soil = soil_named(soils[random.index(4)]);
    const double cell = cells[random.index(4)];
    const Terrain ground = kind.make(soil, cell, random);
    const DigPath path = draw_path(ground, random);
    const HeightMapSimulator simulator(zx120(), soil, random.uniform(0.0, 100.0));
    DigOptions options;
    options.history = random.uniform() < 0.3;
    options.settle = random.uniform() < 0.3;
    if (random.uniform() < 0.2) options.give_up_below = 0.02;
    if (random.uniform() < 0.1) options.dump_at = Eigen::Vector2d(5.0, 0.5);
    const DigResult result = simulator.dig(ground, path, options);
    stalls += result.stall ? 1 : 0;
    all << result;
  }
  std::printf("%-12s %d digs, %d stalled: %016llx\n", kind.name, digs, stalls,
              static_cast<unsigned long long>(all.sum()));
}

// ---- the digs of one search ---------------------------------------------------------------------

/// Keeps the paths that it is asked to dig.
class Listening : public SoilSimulator {
 public:
  explicit Listening(const SoilSimulator& other) : other_(other) {}
  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    paths_.push_back(path);
    return other_.dig(terrain, path, options);
  }
  std::string identity() const override { return other_.identity(); }
  const std::vector<DigPath>& paths() const { return paths_; }

 private:
  const SoilSimulator& other_;
  mutable std::mutex mutex_;
  mutable std::vector<DigPath> paths_;
};

/// A search on the ground itself alone.
DigSearchOptions usual_search(std::uint64_t seed) {
  DigSearchOptions options = budget_search();
  options.seed = seed;
  options.threads = 1;
  options.stop.evaluations = evaluation_budget(false, false);
  auto& method = std::get<MemeticSearch>(options.method);
  method.first_generation = 48;
  method.polish_evaluations = 30;
  return options;
}

struct Digs {
  std::vector<double> worth;  ///< payload per energy, 0 where the machine stalls [kg/J]
  double per_second = 0.0;
};

Digs dig_all(const SoilSimulator& simulator, const Terrain& ground,
             const std::vector<DigPath>& paths) {
  DigOptions options;
  options.settle = false;
  options.worth_alone = true;
  std::vector<DigResult> results;
  double shortest = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 5; ++pass) {  // a machine that does other work too slows some of them
    const double begin = processor_time();
    results = dig_many(simulator, ground, paths, options, 1);
    shortest = std::min(shortest, processor_time() - begin);
  }
  Digs digs;
  digs.per_second = static_cast<double>(paths.size()) / shortest;
  for (const DigResult& dig : results) digs.worth.push_back(dig.stall ? 0.0 : dig.efficiency());
  return digs;
}

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<double>(i);
  return ranks;
}

double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks_of(a);
  const std::vector<double> y = ranks_of(b);
  const auto n = static_cast<double>(x.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return 1.0 - 6.0 * sum / (n * (n * n - 1.0));
}

/// Searches on the ground itself and screened, as plan_dig() does; prints the worth, what the
/// screened one gains on it and the seconds of both.
void search_both(const SoilSimulator& simulator, const Terrain& ground, std::uint64_t seed) {
  const DigSearchOptions options = usual_search(seed);
  const double begin = processor_time();
  const auto usual = search_dig(zx120(), simulator, ground, options);
  const double between = processor_time();
  DigSearchOptions on_coarse_ground = options;
  on_coarse_ground.stop.evaluations = 900;  // of plan_dig()
  const auto screened = search_screened(zx120(), simulator, ground, on_coarse_ground);
  const double end = processor_time();
  const double worth = usual ? usual->worth : 0.0;
  std::printf("%.4g %+.2f %%  %.3f %.3f s\n", worth,
              100.0 * ((screened ? screened->worth : 0.0) / worth - 1.0), between - begin,
              end - between);
  std::fflush(stdout);
}

void compare_screening(int seeds) {
  for (const char* soil : {"loam", "sand", "clay", "gravel"}) {
    for (const double density : {10.0, 40.0, 80.0}) {
      const HeightMapSimulator simulator(zx120(), soil_named(soil), density);
      for (const double slope : {0.0, 0.26, -0.26}) {
        const Terrain ground = sloped(slope, usual_cell(zx120()));
        for (int seed = 1; seed <= seeds; ++seed) {
          std::printf("%s %g %g %d: ", soil, density, slope, seed);
          search_both(simulator, ground, static_cast<std::uint64_t>(seed));
        }
      }
    }
  }
}

void dig_candidates(const std::string& scan_file) {
  Scan scan;
  scan.files = {scan_file};
  const Terrain ground =
      terrain_from_scan(scan, planning_extent(zx120()), usual_cell(zx120())).terrain;
  const HeightMapSimulator simulator(zx120(), soil_named("loam"), 40.0);
  const Listening listening(simulator);
  if (!search_dig(zx120(), listening, ground, usual_search(1))) std::puts("no dig found");
  const std::vector<DigPath>& paths = listening.paths();
  const Digs fine = dig_all(simulator, ground, paths);
  std::printf("%zu candidates, fine: %.0f digs/s\n", paths.size(), fine.per_second);
  const Terrain coarse = coarser(ground, Screening().cells);
  const GroundProfile profile = boom_plane_profile(coarse);
  std::vector<DigPath> rough;
  std::vector<double> worth;  // fine, of those that are laid out in coarse steps too
  for (std::size_t i = 0; i < paths.size(); ++i) {
    DigPathOptions rules;
    rules.step *= Screening().steps;
    const auto path = make_dig_path(zx120(), paths[i].parameters, paths[i].start_x, profile, rules);
    if (!std::holds_alternative<DigPath>(path)) continue;
    rough.push_back(std::get<DigPath>(path));
    worth.push_back(fine.worth[i]);
  }
  Digs screened = dig_all(simulator, coarse, rough);
  std::size_t differ = 0;  // of which only one stalls
  std::size_t kept = 0;
  for (std::size_t i = 0; i < worth.size(); ++i) {
    if ((worth[i] > 0.0) != (screened.worth[i] > 0.0)) ++differ;
    if (!(worth[i] > 0.0 && screened.worth[i] > 0.0)) continue;
    worth[kept] = worth[i];
    screened.worth[kept++] = screened.worth[i];
  }
  worth.resize(kept);
  screened.worth.resize(kept);
  const auto best = static_cast<std::size_t>(
      std::max_element(screened.worth.begin(), screened.worth.end()) - screened.worth.begin());
  std::printf(
      "%zu screened: %.0f digs/s; of %zu only one stalls; Spearman of %zu %.4f, loss of the "
      "best %.2f %%\n",
      rough.size(), screened.per_second, differ, kept, spearman(worth, screened.worth),
      100.0 * (1.0 - worth[best] / *std::max_element(worth.begin(), worth.end())));
  for (const std::uint64_t seed : {1U, 2U, 3U}) search_both(simulator, ground, seed);
}

int run(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  if (what == "random" && count == 3) {
    for (const GroundKind& kind : ground_kinds()) dig_at_random(kind, std::atoi(words[2]));
    return 0;
  }
  if (what == "candidates" && count <= 3) {
    dig_candidates(count == 3 ? words[2] : find_data_file("quickstart/before.pcd"));
    return 0;
  }
  if (what == "screening" && count == 3) {
    compare_screening(std::atoi(words[2]));
    return 0;
  }
  DigOptions options;
  options.settle = what == "settled";
  options.worth_alone = what != "settled" && what != "unsettled";
  if (count == 4 && (what == "fixed" || what == "settled" || what == "unsettled" ||
                     what == "full" || what == "overfull")) {
    dig_over_and_over(what == "full"       ? full_path
                      : what == "overfull" ? overfull_path
                                           : paper_fixed_path(),
                      options, std::atof(words[2]), std::atoi(words[3]));
    return 0;
  }
  std::puts(
      "dig_speed fixed|full|overfull|settled|unsettled CELL_M DIGS, random DIGS, candidates [SCAN] "
      "or screening SEEDS");
  return 2;
}

}  // namespace
}  // namespace excavplan

int main(int count, char** words) { return excavplan::run(count, words); }
