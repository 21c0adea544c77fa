// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// One plan and one estimate, to the last bit: same_answer [THREADS...]. Prints their checksums and
/// exits with 1 unless they are those of answers.txt beside this file, with each number of threads.
/// Uses what every compiler and standard library can build: no GoogleTest, no PCL.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/scan_surface.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"

using namespace excavplan;

namespace {

/// Numbers as text that holds every bit.
class Exact {
 public:
  Exact& operator<<(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%a\n", value);
    text_ += text;
    return *this;
  }
  Exact& operator<<(const HeightMap& map) {
    for (Eigen::Index i = 0; i < map.z.size(); ++i) *this << map.z.data()[i];
    return *this;
  }
  std::string checksum() const { return checksum_text(text_); }

 private:
  std::string text_;
};

/// The dig searched for uncertain loam of 40 % on a slope.
std::string plan(unsigned threads) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  PlanOptions options;
  options.method = PlanMethod::search;
  options.search.threads = threads;
  options.search.stop.evaluations = 120;
  const Terrain slope = sloped_planning_ground(machine, 0.1, 0.05);
  const DigPlan plan = plan_dig(machine, loam, GroundDensity(40.0, 8.0), slope, options);
  Exact text;
  text << plan.dig.value().payload_mass << plan.dig->energy << plan.search.value().worth
       << plan.spread.payload_mass << plan.spread.energy;
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    text << point.time << point.joints(0) << point.joints(1) << point.joints(2);
  }
  return text.checksum();
}

/// Surfaces, volumes, bulking factor and density from the shipped scans.
std::string estimate(unsigned threads) {
  ScanPair scans;
  scans.before.files = {find_data_file("quickstart/before.pcd")};
  scans.after.files = {find_data_file("quickstart/after.pcd")};
  const std::vector<ScanOutline> seen = outlines({scans.before, scans.after}, threads);
  RasterOptions raster;
  raster.cell_size = survey_cell(seen);
  const RegisteredPair pair = survey_registered(scans, seen.front().extent.value(), raster,
                                                4.0 * raster.cell_size, threads);
  const VolumeChange change = measure_change(pair.surfaces);
  const DensityLaw law = load_density_law(find_data_file("laws/zx120-loam.json"));
  const Measured bulking = bulking_factor(change).value();
  const RelativeDensity density = relative_density(law, bulking);
  Exact text;
  for (const Measured& volume : {change.excavated, change.spilled, change.dumped, bulking}) {
    text << volume.value << volume.sd;
  }
  text << density.percent << density.sd_percent << change.areas.front().difference;
  return text.checksum();
}

struct Answers {
  std::string plan;
  std::string estimate;
};

Answers expected_answers() {
  std::ifstream file(EXCAVPLAN_ANSWERS);
  Answers expected;
  file >> expected.plan >> expected.estimate;
  return expected;
}

}  // namespace

int main(int count, char** words) {
  const Answers expected = expected_answers();
  bool same = true;
  for (int i = 1; i < count; ++i) {
    const auto threads = static_cast<unsigned>(std::strtoul(words[i], nullptr, 10));
    const Answers found = {plan(threads), estimate(threads)};
    const bool equal = found.plan == expected.plan && found.estimate == expected.estimate;
    std::printf("%2u threads: %s %s %s\n", threads, found.plan.c_str(), found.estimate.c_str(),
                equal ? "as expected" : "DIFFERS");
    same = same && equal;
  }
  return same ? 0 : 1;
}
