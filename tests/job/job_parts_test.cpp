// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <excavplan/base/data_files.hpp>
#include <excavplan/job/job_motion.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/trial/job_score.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "base/statistics.hpp"
#include "design/design_checks.hpp"
#include "job/dump_place.hpp"
#include "job/hand_made_job.hpp"
#include "job/job_ground.hpp"
#include "job/job_map.hpp"
#include "job/job_record.hpp"
#include "job/job_stations.hpp"
#include "job/lane_view.hpp"
#include "job/lookout.hpp"
#include "job/station_place.hpp"
#include "job/step_search.hpp"
#include "job/trench_job.hpp"
#include "planning/simulated_dig.hpp"
#include "support/errors.hpp"

/// @file
/// Parts of a job on ground and designs made by hand.

namespace excavplan::test {
namespace {

TEST(JobMap, HoldsTheDesignWhereItIs) {
  const HandMadeJob job;
  const JobMap map = job.map();
  const double cells = 10.0 * 1.0 / (0.05 * 0.05);
  EXPECT_NEAR(static_cast<double>((!map.target.z.isNaN()).count()), cells, 0.02 * cells);
  const auto middle = *cell_at(map.target, 5.0, 0.0);
  EXPECT_NEAR(map.target.z(middle.row, middle.col), -0.5, 1e-9);
  EXPECT_TRUE(map.counts(middle.row, middle.col));
  const auto rim = *cell_at(map.target, 5.0, 0.48);
  EXPECT_FALSE(map.counts(rim.row, rim.col));
}

TEST(JobFrame, LiesAlongTheHeadingOfTheStart) {
  HandMadeJob job;
  const JobFrame frame = job.frame();
  EXPECT_NEAR(frame.near, 4.0, 0.06);
  EXPECT_NEAR(frame.far, 14.0, 0.06);
  EXPECT_NEAR(frame.left - frame.right, 1.0, 0.11);
  EXPECT_LT((frame.of(frame.place(3.0, -2.0)) - Eigen::Vector2d(3.0, -2.0)).norm(), 1e-12);
}

TEST(JobStations, GoBackwardsAndReachAllOfTheDesign) {
  const HandMadeJob job;
  const JobFrame frame = job.frame();
  const auto stations = stations_of(frame, job.settings);
  double covered = frame.far;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(stations[i].along, stations[i - 1].along);
    }
    const WorkRange range = work_range(frame, job.settings.site.machine, stations[i].along);
    EXPECT_GT(range.far, range.near);
    EXPECT_GE(stations[i].along + range.far, covered - 0.07) << "a gap before station " << i;
    covered = stations[i].along + range.near;
  }
  EXPECT_LT(covered, frame.near + 0.1);
}

TEST(JobStations, OfEveryMachineShareMuchOfWhatTheyReach) {
  for (const char* machine : {"generic-mini", "generic-20t", "zx120", "zx200"}) {
    HandMadeJob job(15.0, 1.0);
    job.settings.site.machine =
        load_machine(find_data_file(std::string("machines/") + machine + ".json"));
    const auto stations = stations_of(job.frame(), job.settings);
    ASSERT_GT(stations.size(), 2u) << machine;
    const WorkRange range = work_range(job.frame(), job.settings.site.machine, stations[1].along);
    const double back = stations[0].along - stations[1].along;
    EXPECT_LT(back, 0.7 * (range.far - range.near)) << machine;
    EXPECT_GT(back, 0.25 * (range.far - range.near)) << machine;
  }
}

TEST(JobStations, LanesCoverTheWidth) {
  for (const double width : {0.9, 1.0, 1.6, 3.0}) {
    const HandMadeJob job(10.0, width);
    const double half = 0.5 * job.settings.site.machine.bucket.width_outside;
    const JobFrame frame = job.frame();
    double right = 10.0, left = -10.0;
    for (const JobStation& station : stations_of(frame, job.settings)) {
      for (const double lane : station.lanes) {
        right = std::min(right, lane - half);
        left = std::max(left, lane + half);
        EXPECT_LE(std::abs(lane - station.beside), station.is_wide ? 1.6 : 0.34);
      }
    }
    EXPECT_NEAR(right, frame.right, 0.05) << width;
    EXPECT_NEAR(left, frame.left, 0.05) << width;
  }
}

TEST(JobStations, AWideDesignIsDugFromTheMiddleAndShapedFromItsSides) {
  const HandMadeJob narrow(10.0, 1.2), wide(10.0, 3.6), wider(10.0, 5.0);
  const auto rows = stations_of(narrow.frame(), narrow.settings).size();
  const auto stations = stations_of(wide.frame(), wide.settings);
  EXPECT_LE(stations.size(), 3 * rows);
  ASSERT_EQ(stations.size() % 3, 0U);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    EXPECT_TRUE(stations[i].is_wide);
    EXPECT_FALSE(stations[i].has_others_beside);
    EXPECT_EQ(stations[i].leaves_passes, i % 3 == 0) << i;
    EXPECT_EQ(stations[i].is_again, i % 3 != 0) << i;
  }
  EXPECT_EQ(stations[1].lanes.front(), stations[0].lanes.front());
  EXPECT_EQ(stations[2].lanes.back(), stations[0].lanes.back());
  EXPECT_EQ(stations[1].lanes.size() + stations[2].lanes.size(), stations[0].lanes.size());
  const auto beside = stations_of(wider.frame(), wider.settings);
  EXPECT_GT(beside.size(), stations.size());
  EXPECT_TRUE(beside.front().has_others_beside);
  EXPECT_FALSE(stations_beyond(wider.frame(), wider.settings).back().leaves_passes);
}

/// A pit 1.2 m deep whose walls lean back.
HandMadeJob pit(double batter) {
  HandMadeJob job;
  DesignWords words;
  words.length = 10.0;
  words.floor_width = 3.6;
  words.depth = 1.2;
  words.batter = batter;
  job.settings.surface = design_of_words(words, job.ground.bank);
  return job;
}

TEST(JobStations, NoLaneRunsAlongAWallTooSteepToCount) {
  for (const double batter : {0.5, 1.0}) {  // 63 and 45 degrees
    const HandMadeJob job = pit(batter);
    const JobFrame frame = job.frame();
    const double half = batter < 0.6 ? 1.8 : 1.8 + 1.2 * batter;
    EXPECT_NEAR(frame.left, half, 0.08) << batter;
    EXPECT_NEAR(frame.right, -half, 0.08) << batter;
  }
}

TEST(JobStations, ABenchIsAsWideAsTheDesignIsThere) {
  const HandMadeJob job = pit(0.5);
  const JobMap map = job.map();
  const JobFrame frame = job.frame();
  const Machine& machine = job.settings.site.machine;
  const auto stations = stations_of(frame, job.settings);
  const JobStation& middle = stations[0];
  const JobStation& right = stations[1];
  const auto widest = [&](const JobStation& station, double height) {
    return on_bench(station, frame, across_below(map, frame, height), machine).lanes;
  };
  const double half = 0.5 * machine.bucket.width_outside;
  for (const double height : {-0.4, -0.8}) {
    const double side = 1.8 + 0.5 * (1.2 + height);  // of the design there
    const auto lanes = widest(middle, height);
    ASSERT_EQ(lanes.size(), middle.lanes.size() + 2);
    EXPECT_NEAR(lanes.front() - half, -side, 0.08);
    EXPECT_NEAR(lanes.back() + half, side, 0.08);
    EXPECT_EQ(widest(right, height).size(), right.lanes.size() + 1);
    EXPECT_NEAR(widest(right, height).front(), lanes.front(), 1e-9);
  }
  EXPECT_EQ(widest(middle, -1.19).size(), middle.lanes.size());  // no wider than the floor
}

TEST(JobStations, AWideDesignIsDugFartherAhead) {
  const HandMadeJob job(20.0, 3.6);
  const Machine& machine = job.settings.site.machine;
  const double narrow = work_range(job.frame(), machine, 0.0, false).far;
  const double wide = work_range(job.frame(), machine, 0.0, true).far;
  EXPECT_GT(wide, narrow + 0.4);
  EXPECT_LT(wide, machine.boom_pin.x() + machine.full_length());
}

TEST(JobStations, AFaceAtTheFarEndOfAWideDesignIsDugFromFartherBack) {
  const auto to_end = [](const HandMadeJob& job) {
    return job.frame().far - stations_of(job.frame(), job.settings).front().along;
  };
  EXPECT_GT(to_end(pit(1.0)), to_end(HandMadeJob(10.0, 3.6)) + 0.3);
}

TEST(JobStations, AFanOfPlanesReachesLanesThatAreTooFarAside) {
  const HandMadeJob job(10.0, 3.6);
  const Machine& machine = job.settings.site.machine;
  JobStation station = stations_of(job.frame(), job.settings)[1];  // beside the right wall
  const auto straight =
      work_lines(job.frame(), station, machine, {station.along, station.beside}, false);
  EXPECT_EQ(straight.size(), station.lanes.size());
  // From so far to the right they all lie to the left.
  const Eigen::Vector2d at(station.along, station.lanes.front() - 2.0);
  const auto fan = work_lines(job.frame(), station, machine, at, false);
  ASSERT_GT(fan.size(), 3U);
  double least = 1.0, most = 0.0;
  for (const WorkLine& line : fan) {
    EXPECT_EQ(line.lane, 0.0);
    EXPECT_GE(line.near * std::cos(line.turned), straight.front().near - 1e-9);
    EXPECT_GT(line.far, line.near);
    least = std::min(least, line.turned);
    most = std::max(most, line.turned);
  }
  EXPECT_NEAR(std::tan(least), 2.0 / straight.front().far, 0.01);
  EXPECT_GT(most, least + 0.2);
  EXPECT_EQ(work_lines(job.frame(), station, machine, at, true).size(), fan.size());
}

struct StandingJob : HandMadeJob {
  StandingJob() : HandMadeJob(10.0, 3.6) {
    // Over ground before the machine alone.
    settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-6.0, 3.0, 14.0, 8.0)}};
    first = ground;
    station = stations_of(frame(), settings).back();
  }
  std::optional<JobStation> nearest() const {
    const JobMap of_design = map_of(settings, first.bank);
    const JobFrame line = frame_of(settings, of_design);
    return nearest_place({settings, of_design, first, ground}, line, station);
  }
  Eigen::Vector2d at(const JobStation& there) const {
    return frame_of(settings, map_of(settings, first.bank)).place(there.along, there.beside);
  }
  Terrain first;
  JobStation station;
};

TEST(StationPlace, IsTheStationIfNothingIsInItsWay) {
  const StandingJob job;
  const auto place = job.nearest();
  ASSERT_TRUE(place);
  EXPECT_EQ(job.at(*place), job.at(job.station));
}

TEST(StationPlace, MovesAsideWhereSomethingStands) {
  StandingJob job;
  const Eigen::Vector2d at = job.at(job.station);
  job.settings.design.obstacles = {
      {"pole", box(at.x() - 0.1, at.y() - 2.2, at.x() + 0.1, at.y() - 2.0), 5.0}};
  const auto place = job.nearest();
  ASSERT_TRUE(place);
  const double shift = (job.at(*place) - at).norm();
  EXPECT_GT(shift, 0.1);
  EXPECT_LT(shift, 1.0);
  EXPECT_EQ(place->lanes, job.station.lanes);
}

TEST(StationPlace, IsNotOnGroundThatWasDug) {
  StandingJob job;
  const Eigen::Vector2d at = job.at(job.station);
  for_each_cell(job.ground.bank.z, [&](Cell cell) {
    if (job.ground.bank.x(cell.col) > at.x() + 1.0) job.ground.bank.z(cell.row, cell.col) -= 0.4;
  });
  const auto place = job.nearest();
  ASSERT_TRUE(place);
  EXPECT_LT(job.at(*place).x(), at.x() - 0.9);
  job.ground.bank.z -= 0.4;
  EXPECT_FALSE(job.nearest());
}

TEST(StationPlace, IsAsFarFromAnEdgeAsThatIsDeep) {
  for (const double deep : {0.4, 0.9, 1.2}) {
    StandingJob job;
    const double edge = job.at(job.station).x() + job.settings.site.machine.track_front + 0.7;
    for_each_cell(job.ground.bank.z, [&](Cell cell) {
      if (job.ground.bank.x(cell.col) > edge) job.ground.bank.z(cell.row, cell.col) -= deep;
    });
    const auto place = job.nearest();
    ASSERT_TRUE(place) << deep;
    const double away = edge - job.at(*place).x() - job.settings.site.machine.track_front;
    EXPECT_GT(away, std::min(0.8, deep) - 0.16) << deep;
    if (deep < 0.5) {
      EXPECT_NEAR(away, 0.7, 1e-9) << "it need not move";
    }
  }
}

TEST(StationPlace, MovesToWhereTheTruckIsWithinReach) {
  StandingJob job;
  job.settings.design.dump_areas.clear();
  const Eigen::Vector2d at = job.at(job.station);
  job.settings.design.truck =
      JobTruck{box(at.x() - 3.0, at.y() + 6.5, at.x() + 3.0, at.y() + 9.0), 2.0, 9000.0};
  const auto place = job.nearest();
  ASSERT_TRUE(place);
  EXPECT_GT(job.at(*place).y(), at.y() + 0.3);
}

TEST(JobStations, OnlyTheFarOneEndsAtTheWall) {
  HandMadeJob job;
  const Machine& machine = job.settings.site.machine;
  const auto stations = stations_of(job.frame(), job.settings);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const WorkRange range = work_range(job.frame(), machine, stations[i].along);
    EXPECT_EQ(range.ends_at_wall, i == 0) << i;
  }
}

/// Lanes of all passes from the last station of a trench so wide [m].
std::vector<double> passes_of(double width) {
  const HandMadeJob job(10.0, width);
  const JobFrame frame = job.frame();
  const JobStation station = stations_of(frame, job.settings).back();
  std::vector<double> lanes;
  for (const WorkLine& line :
       work_lines(frame, station, job.settings.site.machine, {station.along, station.beside}, true))
    lanes.push_back(line.lane + station.beside);
  std::sort(lanes.begin(), lanes.end());
  return lanes;
}

TEST(JobStations, PassesRunBetweenLanesOnlyWhereTheseLeaveARidge) {
  // A bucket of 0.7 m: both lanes of a trench of 1 m reach over its middle.
  const std::vector<double> narrow = passes_of(1.0), wide = passes_of(1.3);
  EXPECT_EQ(narrow.size(), 4U);  // two at the walls, and two a little off them
  for (const double lane : narrow) EXPECT_GT(std::abs(lane), 0.03);
  EXPECT_EQ(wide.size(), 5U);
  EXPECT_NEAR(wide[2], 0.0, 0.03);
}

TEST(JobStations, WhatAPlaceBeyondShapesIsNoWallAndTakesNoPasses) {
  const HandMadeJob job;
  const Machine& machine = job.settings.site.machine;
  const JobFrame frame = job.frame();
  JobStation station = stations_of(frame, job.settings).front();
  const Eigen::Vector2d at(station.along, station.beside);
  const auto far_of = [&](bool finishing) {
    return station.along + work_lines(frame, station, machine, at, finishing).front().far;
  };
  EXPECT_TRUE(work_lines(frame, station, machine, at, false).front().ends_at_wall);
  const double end = far_of(true);
  station.shapes_to = end - 0.8;
  EXPECT_FALSE(work_lines(frame, station, machine, at, false).front().ends_at_wall);
  EXPECT_NEAR(far_of(false), end, 1e-9);
  EXPECT_NEAR(far_of(true), end - 0.8, 1e-9);
}

/// A cut along x with a face to its left, between two places for soil, and the machine at its foot.
struct SlopeJob : HandMadeJob {
  SlopeJob() {
    ground = undisturbed(flat_ground({-12.0, -12.0, 18.0, 8.0}, 0.05));
    settings.design.start = BasePose{4.5, -6.0, 0.0, 0.0};
    settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-4.5, -8.0, -0.8, 0.0)},
                                  {DumpArea::Kind::windrow, box(9.6, -8.0, 13.5, 0.0)}};
    DesignWords words;
    words.kind = DesignKind::slope;
    words.length = 9.0;
    words.floor_width = 3.5;
    words.batter = 1.5;
    words.floor_z = -0.4;
    settings.surface = design_of_words(words, ground.bank);
  }
};

TEST(JobMap, AsksForNothingWhereTheDesignIsAboveTheGround) {
  const SlopeJob job;
  const JobMap map = job.map();
  double highest = -10.0;
  for (const double z : map.target.z.reshaped()) highest = std::fmax(highest, z);
  constexpr double of_cell = 0.05 / 1.5;
  EXPECT_NEAR(highest, 0.0, of_cell);
}

TEST(JobFrame, IsTurnedAcrossTheCutForAFaceAlongIt) {
  const SlopeJob job;
  const JobMap map = job.map();
  EXPECT_GT(frame_of(job.settings, map).faces_across, 0.1);
  const JobFrame frame = work_frame(job.settings, map, job.ground);
  EXPECT_NEAR(frame.heading, 0.5 * pi, 1e-9);
  EXPECT_EQ(frame.faces_across, 0.0);
  EXPECT_GT(frame.near, 0.0);
}

TEST(JobFrame, IsNotTurnedIfSoilThenHasNoPlace) {
  SlopeJob job;
  job.settings.design.dump_areas.pop_back();
  EXPECT_EQ(work_frame(job.settings, job.map(), job.ground).heading, 0.0);
}

TEST(JobFrame, OfUprightWallsIsNotTurned) {
  const HandMadeJob job;
  EXPECT_EQ(work_frame(job.settings, job.map(), job.ground).heading, 0.0);
}

TEST(JobStations, OfAFaceAheadAreMetBetweenAgain) {
  const SlopeJob job;
  const JobMap map = job.map();
  const JobFrame frame = work_frame(job.settings, map, job.ground);
  const auto stations = stations_of(frame, job.settings);
  EXPECT_GT(stations.front().shapes_from, frame.near);
  EXPECT_LT(stations.back().shapes_from, frame.near);
  for (const JobStation& each : stations) EXPECT_TRUE(each.has_others_beside);
  // Passes only then, each in one place of its row: along all lanes and over the ridges between.
  std::vector<double> passes;
  for (const JobStation& each : stations) {
    EXPECT_EQ(each.leaves_passes, !each.is_again);
    if (!each.is_again || each.along != stations.front().along) continue;
    for (const double pass : each.passes) {
      EXPECT_LT(std::abs(pass - each.beside), 0.5) << "the bucket is hardly yawed";
      passes.push_back(pass);
    }
  }
  std::sort(passes.begin(), passes.end());
  for (std::size_t i = 1; i < passes.size(); ++i) {
    EXPECT_GT(passes[i] - passes[i - 1], 1e-6);
    EXPECT_LT(passes[i] - passes[i - 1], 0.5 * zx120().bucket.width_outside);
  }
  EXPECT_NEAR(passes.front(), stations.front().lanes.front(), 1e-9);
  EXPECT_NEAR(passes.back(), frame.left + frame.right - passes.front(), 1e-9);
  const HandMadeJob narrow(10.0, 1.2);
  for (const JobStation& each : stations_of(narrow.frame(), narrow.settings))
    EXPECT_FALSE(each.has_others_beside);
}

TEST(JobStations, PassesAlongAFaceLieCloserThanLanesForVolume) {
  SlopeJob job;
  const auto stations = stations_of(job.frame(), job.settings);
  for (const JobStation& each : stations) {
    ASSERT_FALSE(each.passes.empty());
    for (std::size_t i = 1; i < each.passes.size(); ++i)
      EXPECT_LE(each.passes[i] - each.passes[i - 1], 0.1 + 1e-9);
    EXPECT_EQ(each.passes.front(), each.lanes.front());
    EXPECT_EQ(each.passes.back(), each.lanes.back());
    EXPECT_LE(each.lanes.size(), each.passes.size() / 3 + 2);
  }
}

TEST(JobFrame, KnowsItsFloorBetweenFaces) {
  const HandMadeJob job = leaning_trench();
  const JobFrame frame = job.frame();
  EXPECT_NEAR(frame.floor.right, -0.5, 0.08);
  EXPECT_NEAR(frame.floor.left, 0.5, 0.08);
  EXPECT_NEAR(frame.left, 1.54, 0.08);
}

TEST(JobStations, TheFloorBetweenFacesIsShapedFromTheLastSide) {
  const HandMadeJob job = leaning_trench();
  const double half = 0.5 * job.settings.site.machine.bucket.width_outside;
  const auto stations = stations_of(job.frame(), job.settings);
  ASSERT_EQ(stations.size() % 3, 0U);
  for (std::size_t i = 0; i < stations.size(); i += 3) {
    const JobStation &first = stations[i + 1], &last = stations[i + 2];
    EXPECT_FALSE(stations[i].leaves_floor);
    EXPECT_TRUE(first.leaves_floor);
    EXPECT_FALSE(last.leaves_floor);
    EXPECT_LT(first.passes.back() - half, -0.5);
    EXPECT_LT(last.passes.front(), first.passes.back() - 0.1) << "the foot of the first face too";
    EXPECT_GT(last.passes.front() - half, -1.0);
    EXPECT_EQ(first.passes.front(), stations[i].passes.front());
    EXPECT_EQ(last.passes.back(), stations[i].passes.back());
  }
  const HandMadeJob upright(10.0, 3.6);
  for (const JobStation& each : stations_of(upright.frame(), upright.settings))
    EXPECT_FALSE(each.leaves_floor);
}

TEST(LaneView, APassAlongAFaceShapesWhatItsEdgeComesTo) {
  const HandMadeJob job = leaning_trench();
  const JobMap map = job.map();
  const Terrain ground = dug_to(map, job.ground, 0.1);
  // The right edge of the bucket runs 1 m beside the middle of the trench.
  const double width = job.settings.site.machine.bucket.width_outside;
  const LaneView view(ground, map, dig_line({0.0, 0.0, 0.0, 0.0}, 0.0, -1.0 + 0.5 * width),
                      {-2.0, -2.0, 12.0, 2.0}, width);
  EXPECT_NEAR(view.fall(view.columns() / 2), 0.5 / 1.73, 0.07);
  TerrainPatch patch;
  const Terrain& seen = view.ground().terrain();
  patch.bank = seen.bank.z;
  patch.loose = seen.loose;
  for_each_cell(patch.bank, [&](Cell at) {
    const double x = seen.bank.x(at.col), y = seen.bank.y(at.row);
    if (x < 4.0 || x > 6.0 || std::abs(y) > 0.5 * width) return;
    (y < 0.1 - 0.5 * width ? patch.bank : patch.loose)(at.row, at.col) +=
        y < 0.1 - 0.5 * width ? -0.1 : 0.02;
  });
  const ShapeRules all = {0.0, 0.03, 1e9}, own = {0.0, 0.03, 1e9, 0.08};
  EXPECT_NEAR(view.change(patch, all).shaped, 0.0, 0.01) << "what it cuts falls beside its edge";
  EXPECT_NEAR(view.change(patch, own).shaped, 2.0 * 0.1 * 0.1, 0.004);
  EXPECT_NEAR(view.change(patch, own).finished, 2.0 * 0.1, 0.04);
}

TEST(StepSearch, PassesAlongAFaceBeginAtItsTop) {
  const HandMadeJob job = leaning_trench();
  const JobMap map = job.map();
  const Terrain ground = dug_to(map, job.ground, 0.08);
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  const std::vector<DigStart> none;
  StepTask task{job.settings, map, ground, base, {{4.5, 3.5, 3.0}, 1.57, 2.0, false}, none};
  for (const double lane : {0.0, 0.4, 0.55, 0.7}) task.lines.push_back({0.0, lane, 3.0, 6.5});
  task.finishing = task.has_faces = task.has_steps = true;
  auto dig = best_dig(task);
  ASSERT_TRUE(dig.has_value());
  EXPECT_EQ(dig->lane, 0.7);
  EXPECT_GT(dig->path.start_x, 5.9) << "all along at once";
  EXPECT_GT(dig->path.parameters.drag_length, 2.0);
  const std::vector<DigStart> done = {
      {0.7, 4.0, 0.0, true}, {0.55, 6.0, 0.0, true}, {0.4, 6.0, 0.0, true}};
  StepTask next{job.settings, map, ground, base, {{4.5, 3.5, 3.0}, 1.57, 2.0, false}, done};
  next.lines = task.lines;
  next.finishing = next.has_faces = next.has_steps = true;
  dig = best_dig(next);
  ASSERT_TRUE(dig.has_value());
  EXPECT_EQ(dig->lane, 0.0) << "each lane along a face once";
  next.leaves_floor = true;
  EXPECT_FALSE(best_dig(next).has_value());
}

TEST(StepSearch, APassBringsAFaceAheadIntoShape) {
  SlopeJob job;
  JobMap map = job.map();
  const JobFrame frame = work_frame(job.settings, map, job.ground);
  const JobStation station = stations_of(frame, job.settings)[2];
  constexpr double left = 0.06;  // on face and floor [m]
  job.ground = dug_to(map, std::move(job.ground), left);
  const BasePose base = base_at(frame, station, job.ground, job.settings.site.machine);
  const WorkRange range = work_range(frame, job.settings.site.machine, station.along);
  StepTask task{job.settings, map, job.ground, base, {{-2.0, -1.5, 2.4}, 1.0, 2.4, false}, {}};
  task.lines = {{0.0, 0.0, range.far - 1.5, range.far}};  // the face and its foot
  task.finishing = true;
  task.has_faces = true;
  const auto dig = best_dig(task);
  ASSERT_TRUE(dig.has_value());
  EXPECT_GT(dig->change.cleared, 0.6 * left * 0.7 * 0.6);
  EXPECT_LT(dig->change.too_deep, 0.005);
}

TEST(StepSearch, TheTopOfAFaceIsTakenInLayersAlongIt) {
  SlopeJob job;
  const JobMap map = job.map();
  const JobFrame frame = work_frame(job.settings, map, job.ground);
  const JobStation station = stations_of(frame, job.settings)[2];
  job.ground = dug_to(map, std::move(job.ground), 0.0);
  for_each_cell(map.target.z, [&](Cell at) {
    const double target = map.target.z(at.row, at.col);
    if (target > -0.25) job.ground.bank.z(at.row, at.col) = std::min(0.0, target + 0.2);
  });
  const BasePose base = base_at(frame, station, job.ground, job.settings.site.machine);
  const WorkRange range = work_range(frame, job.settings.site.machine, station.along);
  StepTask task{job.settings, map, job.ground, base, {{-2.0, -1.5, 2.4}, 1.0, 2.4, false}, {}};
  task.lines = {{0.0, 0.0, range.near, range.far}};
  task.finishing = true;
  task.has_faces = task.has_others_beside = true;
  const auto dig = best_dig(task);
  ASSERT_TRUE(dig.has_value());
  EXPECT_GT(dig->path.drag_grade, 0.3);
  EXPECT_GT(dig->change.cleared, 0.02);
  EXPECT_FALSE(dig->may_stall);
}

/// Of a floor in shape but for a place so long, 2 cm above what may stay [m].
std::optional<StepDig> pass_over_bump(double length, bool has_many) {
  HandMadeJob job;
  const JobMap map = job.map();
  job.ground = dug_to(map, std::move(job.ground), 0.0);
  for_each_cell(job.ground.bank.z, [&](Cell at) {
    const double x = job.ground.bank.x(at.col), y = job.ground.bank.y(at.row);
    if (std::abs(y) < 0.2 && x > 7.5 && x < 7.5 + length) job.ground.bank.z(at.row, at.col) += 0.05;
  });
  StepTask task{
      job.settings, map, job.ground, {3.0, 0.0, 0.0, 0.0}, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  task.lines = {{0.0, 0.0, 2.95, 6.0}};
  task.finishing = true;
  task.has_faces = task.has_others_beside = has_many;
  return best_dig(task);
}

TEST(StepSearch, APassOfADesignOfManyPlacesBringsMoreIntoShape) {
  EXPECT_TRUE(pass_over_bump(0.3, false));
  EXPECT_FALSE(pass_over_bump(0.3, true));
  EXPECT_TRUE(pass_over_bump(0.6, true));
}

/// The first dig at the far end of a trench that is dug up to so far before it [m].
std::optional<StepDig> dig_at_wall(double left, double strength) {
  HandMadeJob job;
  const JobMap map = job.map();
  for_each_cell(job.ground.bank.z, [&](Cell at) {
    const double x = job.ground.bank.x(at.col), y = job.ground.bank.y(at.row);
    if (std::abs(y) < 0.5 && x > 0.0 && x < 10.0 - left) job.ground.bank.z(at.row, at.col) = -0.5;
  });
  const BasePose base = {4.3, 0.0, 0.0, 0.0};
  StepTask task{job.settings, map, job.ground, base, {{4.5, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  task.lines = {{0.0, -0.11, 2.95, 5.67, true}, {0.0, 0.11, 2.95, 5.67, true}};
  task.strength_factor = task.hard_factor = strength;
  return best_dig(task);
}

TEST(StepSearch, AnEndWallIsCutAsSteeplyAsSoilIsLifted) {
  const auto whole = dig_at_wall(3.0, 1.0);
  ASSERT_TRUE(whole);
  EXPECT_GE(whole->path.parameters.penetration_angle, 1.3);
  // Of what is left there the steepest cut loses most.
  const auto rest = dig_at_wall(1.5, 0.3);
  ASSERT_TRUE(rest);
  EXPECT_GE(rest->path.parameters.penetration_angle, 1.1);
  EXPECT_GT(rest->dig.payload_mass, 120.0);
}

TEST(StepSearch, LittleIsSpilledBesideForMoreInTheBucket) {
  HandMadeJob job;
  DesignWords words;
  words.length = 10.0;
  words.floor_width = 1.0;
  words.depth = 0.2;
  job.settings.surface = design_of_words(words, job.ground.bank);
  const JobMap map = job.map();
  StepTask task{
      job.settings, map, job.ground, {3.0, 0.0, 0.0, 0.0}, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  task.lines = {{0.0, 0.0, 2.95, 6.0}};
  const auto dig = best_dig(task);
  ASSERT_TRUE(dig);
  EXPECT_LT(dig->change.spilled, 0.25 * dig->change.gained);
}

TEST(StepSearch, NoDragGoesDownAWall) {
  const HandMadeJob job;
  const JobMap map = job.map();
  StepTask task{
      job.settings, map, job.ground, {4.3, 0.0, 0.0, 0.0}, {{5.0, 3.0, 2.4}, 0.6, 2.4, false}, {}};
  task.lines = {{0.0, 0.1, 2.95, 5.75}};  // to just beyond the end
  task.has_faces = true;
  EXPECT_TRUE(best_dig(task).has_value());
}

TEST(StepSearch, NoDigGoesThroughGroundThatIsNotKnown) {
  HandMadeJob job;
  const JobMap map = job.map();
  const auto hole = cell_at(job.ground.bank, 8.8, 0.02);
  job.ground.bank.z(hole->row, hole->col) = std::nan("");
  StepTask task{
      job.settings, map, job.ground, {4.3, 0.0, 0.0, 0.0}, {{5.0, 3.0, 2.4}, 0.6, 2.4, false}, {}};
  task.lines = {{0.0, 0.1, 2.95, 5.75}};
  const auto dig = best_dig(task);
  if (!dig) return;
  const auto& poses = dig->path.poses;
  const bool is_before = poses.front().bucket.x<4.5, is_beyond = poses.back().bucket.x> 4.5;
  EXPECT_TRUE(is_before || is_beyond);
}

/// Fails under the sanitizers if it reads beside the map.
TEST(JobFrame, OfADesignOverTheWholeScanEndsWithIt) {
  const JobFrame frame = HandMadeJob(40.0, 40.0).frame();
  EXPECT_NEAR(frame.of({18.0, 0.0}).x(), frame.far, 1e-9);
  EXPECT_FALSE(frame.is_battered);
  EXPECT_EQ(frame.faces_across, 0.0);
}

TEST(JobFrame, ReversedIsTheSameDesignFromItsOtherEnd) {
  HandMadeJob job;
  const JobFrame frame = job.frame(), back = reversed(frame);
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(5.0, 0.3), Eigen::Vector2d(12.0, -0.2)})
    EXPECT_LT((back.of(frame.place(at.x(), at.y())) + at).norm(), 1e-12);
  EXPECT_EQ(back.near, -frame.far);
  EXPECT_EQ(back.far, -frame.near);
  EXPECT_EQ(back.left, -frame.right);
}

TEST(JobStations, FromBeyondTheFarEndIsTheNearOne) {
  HandMadeJob job;
  const JobFrame frame = job.frame(), back = reversed(frame);
  const auto beyond = stations_beyond(frame, job.settings);
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_TRUE(beyond.front().is_beyond);
  const BasePose base = base_at(back, beyond.front(), job.ground, job.settings.site.machine);
  const Eigen::Vector2d at = frame.of({base.x, base.y});
  EXPECT_GT(at.x(), frame.far + job.settings.site.machine.track_front);
  const Eigen::Vector2d ahead(std::cos(base.heading), std::sin(base.heading));
  EXPECT_LT(
      (frame.of(Eigen::Vector2d(base.x, base.y) + ahead) - at - Eigen::Vector2d(-1.0, 0.0)).norm(),
      1e-9);
  const WorkRange range = work_range(back, job.settings.site.machine, beyond.front().along);
  EXPECT_NEAR(at.x() - range.near, frame.far, 0.05);
}

/// A pole so far ahead of the second station and to its left [m]; soil goes to the left.
void expect_clear_of_pole(double ahead, double left) {
  HandMadeJob job;
  job.settings.design.start = BasePose{-4.0, 0.0, 0.0, 0.0};
  const JobFrame frame = job.frame();
  const Machine& machine = job.settings.site.machine;
  const auto usual = stations_of(frame, job.settings);
  const Eigen::Vector2d at = frame.place(usual[1].along + ahead, left);
  job.settings.design.obstacles = {
      {"pole", box(at.x() - 0.15, at.y() - 0.15, at.x() + 0.15, at.y() + 0.15), 6.0}};
  const JobMap map = job.map();
  const auto turn = [&](const JobStation& station) {
    const BasePose base = base_at(frame, station, job.ground, machine);
    const auto dump = dump_place(job.settings, map, job.ground, base);
    return dump && turns_clear(job.settings, base, dump->swing);
  };
  EXPECT_FALSE(turn(usual[1]));
  const auto clear = clear_of_obstacles(usual, frame, job.settings, map, job.ground);
  ASSERT_GE(clear.size(), usual.size());
  double dug_to = frame.far;
  for (const JobStation& station : clear) {
    EXPECT_TRUE(turn(station)) << station.along;
    const WorkRange range = work_range(frame, machine, station.along);
    EXPECT_GE(station.along + range.far, dug_to - 0.15) << "a gap at " << station.along;
    dug_to = station.along + range.near;
  }
  EXPECT_LT(dug_to, frame.near + 0.1);
  job.settings.design.obstacles.clear();
  const auto same = clear_of_obstacles(usual, frame, job.settings, map, job.ground);
  for (std::size_t i = 0; i < usual.size(); ++i) EXPECT_EQ(same[i].along, usual[i].along);
}

TEST(JobStations, StandWhereTheTailTurnsClearOfAPole) { expect_clear_of_pole(-1.0, -1.7); }

TEST(JobStations, StandOnBothSidesOfAPoleThatNoPlaceBetweenIsClearOf) {
  for (const double ahead : {-0.6, -0.4, -0.2, 0.0, 0.2}) {
    SCOPED_TRACE(ahead);
    expect_clear_of_pole(ahead, -1.8);
  }
}

TEST(JobStations, TheTailSweepsBehindOnTheSideAwayFromTheSwing) {
  HandMadeJob job;
  const auto clear_of = [&](double x, double y, double swing) {
    job.settings.design.obstacles = {{"pole", box(x, y, x + 0.1, y + 0.1), 6.0}};
    return turns_clear(job.settings, {0.0, 0.0, 0.0, 0.0}, swing);
  };
  EXPECT_FALSE(clear_of(-1.5, -1.2, 1.2));
  EXPECT_TRUE(clear_of(-1.0, 1.7, 1.2));
  EXPECT_FALSE(clear_of(-1.0, 1.7, -1.2));
  EXPECT_TRUE(clear_of(1.0, 1.7, -0.5));
  EXPECT_FALSE(clear_of(-1.9, 0.0, 0.0));
  EXPECT_FALSE(clear_of(0.0, -1.75, 0.5));  // near the axis the tail takes up a wider angle
  EXPECT_TRUE(clear_of(-3.0, 0.0, 0.0));
  EXPECT_FALSE(clear_of(2.0, 0.0, 2.6));  // straight ahead, where the tail comes round to
  EXPECT_FALSE(clear_of(2.0, -0.1, 2.6));
}

TEST(JobStations, OfAWallThatReachesFarWhatIsNearCounts) {
  HandMadeJob job;
  const auto clear_of = [&](double left) {
    job.settings.design.obstacles = {{"wall", box(-1e9, left, 1e9, left + 0.1), 6.0}};
    return turns_clear(job.settings, {0.0, 0.0, 0.0, 0.0}, 1.2);
  };
  EXPECT_TRUE(clear_of(5.0));
  EXPECT_FALSE(clear_of(-2.0));
  EXPECT_TRUE(clear_of(-4.0));
}

TEST(ScanDatum, TheMeanOfAllScansTellsHowFarTheFirstWasOff) {
  // The first scan lies 9 mm too high and rises by 1 mm/m along x too much; the others are exact.
  ScanDatum datum;
  Alignment found;
  found.centre = {4.0, -3.0, 0.0};
  found.motion.setConstant(7.0);  // what is corrected for does not count
  found.found[2] = -0.009 - 0.001 * found.centre.x();
  found.found[4] = 0.001;
  for (int i = 0; i < 99; ++i) datum.learn(found);
  EXPECT_NEAR(datum.plane().x(), 0.99 * 0.009, 1e-12);
  EXPECT_NEAR(datum.plane().y(), 0.99 * 0.001, 1e-12);
  EXPECT_NEAR(datum.plane().z(), 0.0, 1e-12);
}

/// A hand-made job that is dug, with a corner of its floor that was not seen.
struct HiddenCorner : HandMadeJob {
  /// @param far_hidden  from there the far end is hidden too, along the design [m]
  explicit HiddenCorner(double far_hidden = 1e9) {
    const JobMap of_level = map();
    seen = Eigen::ArrayXXd::Zero(ground.bank.z.rows(), ground.bank.z.cols());
    for_each_cell(of_level.target.z, [&](Cell at) {
      const double target = of_level.target.z(at.row, at.col);
      if (std::isnan(target)) return;
      dug.bank.z(at.row, at.col) = target;
      const bool is_hidden = ground.bank.x(at.col) < 0.4 && ground.bank.y(at.row) < -0.1;
      if (is_hidden || ground.bank.x(at.col) > far_hidden) seen(at.row, at.col) = std::nan("");
    });
  }
  std::optional<JobStation> best(const std::vector<SensorLook>& looks) const {
    const JobFrame lies = frame();
    const JobMap of_level = map();
    return best_lookout({lies, settings, of_level, dug, seen, looks, {-4.0, 0.0, 0.0, 0.0}});
  }

  /// Of several looks, from where the machine is along the design.
  std::optional<JobStation> first(double along, std::optional<JobStation> next = {}) const {
    const JobFrame lies = frame();
    const JobMap of_level = map();
    LookTask task{lies, settings, of_level, dug, seen, usual_looks(), {along, 0.0, 0.0, 0.0}};
    task.may_stay = 0.005;
    task.most = 3;
    task.next = std::move(next);
    return best_lookout(task);
  }

  Terrain dug = ground;
  Eigen::ArrayXXd seen;
};

TEST(Lookout, OfSeveralTheFirstIsOnTheShortestWay) {
  const HiddenCorner job(9.2);  // the far end hides more
  const auto from_near = job.first(-4.0);
  ASSERT_TRUE(from_near);
  EXPECT_LT(from_near->along, 5.0);
  const auto from_far = job.first(14.0);
  ASSERT_TRUE(from_far);
  EXPECT_GT(from_far->along, 5.0);
}

TEST(Lookout, WhatIsDugNextNeedsNoLook) {
  HiddenCorner job(9.2);
  const JobStation beyond = stations_beyond(job.frame(), job.settings).front();
  const auto of_corner = job.first(-4.0, beyond);
  ASSERT_TRUE(of_corner);
  for_each_cell(job.seen, [&](Cell at) {
    if (job.ground.bank.x(at.col) < 5.0) job.seen(at.row, at.col) = 0.0;
  });
  EXPECT_FALSE(job.first(-4.0, beyond));
  EXPECT_TRUE(job.first(-4.0));
}

TEST(Lookout, IsBesideTheDesignOffTheSpoil) {
  HiddenCorner job;  // the windrow is on the left
  const auto right = job.best(usual_looks());
  ASSERT_TRUE(right);
  EXPECT_TRUE(right->is_lookout());
  const Machine& machine = job.settings.site.machine;
  const Eigen::Vector2d stands = job.frame().place(right->along, right->beside);
  const Eigen::Rotation2Dd turn(job.frame().heading + right->turned);
  for (double x = -1.0; x <= 1.0; x += 0.1) {
    for (double y = -1.0; y <= 1.0; y += 0.1) {
      const Eigen::Vector2d track =
          stands +
          turn * Eigen::Vector2d(x * machine.track_front, 0.5 * y * machine.undercarriage_width());
      const Eigen::Vector2d off((track - Eigen::Vector2d(5.0, 0.0)).cwiseAbs() -
                                Eigen::Vector2d(5.0, 0.5));
      EXPECT_GT(off.cwiseMax(0.0).norm(), 0.5) << track.transpose();
      EXPECT_FALSE(track.y() > 1.55 && track.x() > -5.95) << track.transpose();
    }
  }
  job.settings.design.obstacles = {{"shed", box(-9.0, -8.0, 17.0, -1.0), 3.0},
                                   {"fence", box(-11.0, -1.0, -0.5, 1.5), 2.0},
                                   {"bank", box(10.5, -1.0, 17.0, 6.0), 2.0}};
  EXPECT_FALSE(job.best(usual_looks()));
}

/// Share of the corner's floor that a look sees past the edges of the trench, from a place.
double share_of_corner(const HiddenCorner& job, const SensorLook& look, const JobStation& place) {
  const Eigen::Vector2d at = job.frame().place(place.along, place.beside);
  const double heading = job.frame().heading + place.turned;
  const Eigen::Vector2d eye = at + Eigen::Rotation2Dd(heading) * look.from.head<2>();
  int open = 0, all = 0;
  for (double x = 0.05; x < 0.4; x += 0.05) {
    for (double y = -0.45; y < -0.1; y += 0.05) {
      ++all;
      const Eigen::Vector2d way = Eigen::Vector2d(x, y) - eye;
      const double off = std::atan2(way.y(), way.x()) - heading - look.azimuth;
      if (std::abs(std::remainder(off, 2.0 * pi)) > look.half_sector) continue;
      if (std::atan2(look.from.z() + 0.5, way.norm()) > look.steepest) continue;
      // Where the ray is half a metre over the floor, it must be within the trench.
      const Eigen::Vector2d edge = Eigen::Vector2d(x, y) - way * 0.5 / (look.from.z() + 0.5);
      if (edge.x() > 0.0 && edge.x() < 10.0 && std::abs(edge.y()) < 0.5) ++open;
    }
  }
  return static_cast<double>(open) / all;
}

TEST(Lookout, SeesFromThereWhatIsHiddenFromTheLastPlaceOfTheJob) {
  const HiddenCorner job;
  const JobStation last = stations_of(job.frame(), job.settings).back();
  for (const SensorLook& look :
       {usual_looks().front(), SensorLook{{0.9, -0.2, 3.0}, -1.05, 0.55, 12.0, 0.8}}) {
    const auto place = job.best({look});
    ASSERT_TRUE(place);
    const double before = share_of_corner(job, look, last);
    EXPECT_LT(before, 0.15);
    EXPECT_GT(share_of_corner(job, look, *place), before + 0.1);
  }
}

TEST(Lookout, IsNoneIfNothingIsHidden) {
  HiddenCorner job;
  job.seen.setZero();
  EXPECT_FALSE(job.best(usual_looks()));
}

TEST(DumpPlace, IsInTheAreaAndAwayFromTheTrench) {
  HandMadeJob job;
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  const auto place = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(place);
  EXPECT_GT(place->place.y(), 0.5 + 0.6);
  EXPECT_GT(place->swing, 0.0);
  const Eigen::Vector2d from = place->place.head<2>() - Eigen::Vector2d(base.x, base.y);
  EXPECT_NEAR(std::atan2(from.y(), from.x()), place->swing, 1e-9);
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(20.0, 1.5, 24.0, 6.0)}};
  EXPECT_FALSE(dump_place(job.settings, job.map(), job.ground, base));
}

TEST(DumpPlace, NoSoilRunsIntoAKeepOut) {
  HandMadeJob job;
  const SitePolygon manhole = box(3.2, 1.8, 3.5, 2.1);  // small, where the nearest heap would lie
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  const auto distance = [&](const DumpPlace& dump) {
    return (dump.place.head<2>() - Eigen::Vector2d(3.35, 1.95)).norm();
  };
  job.settings.design.start = base;
  const auto before = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(before);
  job.settings.design.keep_out = {{"manhole", manhole, {}}};
  const auto place = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(place);
  EXPECT_GT(distance(*place), 0.9 + 0.15);  // the radius of a heaped bucket of loam at rest
  job.settings.design.keep_out = {{"cable", manhole, 0.8}};  // soil may lie over a buried one
  const auto over = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(over);
  EXPECT_EQ(over->place, before->place);
}

TEST(LearntNumber, ABoundMovesItByTheMomentsOfItsPosterior) {
  // Against the posterior summed on a grid.
  const double variance = 0.4, error = 0.06, bound = 0.5;
  for (const bool is_above : {true, false}) {
    for (const double other : {0.0, 0.2}) {
      double sum = 0.0, first = 0.0, second = 0.0;
      for (double x = -5.0; x < 5.0; x += 1e-3) {
        const double below = normal_cdf((x - bound) / std::sqrt(error));
        const double likelihood = other + (1.0 - other) * (is_above ? below : 1.0 - below);
        const double weight = std::exp(-0.5 * x * x / variance) * likelihood;
        sum += weight;
        first += weight * x;
        second += weight * x * x;
      }
      LearntNumber number = {0.0, variance};
      number.learn_bound(bound, is_above, error, other);
      EXPECT_NEAR(number.mean, first / sum, 1e-6) << is_above << " " << other;
      EXPECT_NEAR(number.variance, second / sum - first * first / (sum * sum), 1e-6) << other;
    }
  }
}

TEST(JobLearning, AStallThatOnlyMuchStrongerSoilWouldExplainHasAnotherCause) {
  JobLearning learnt;
  StepReport report;
  report.stalled = true;
  for (int i = 0; i < 6; ++i) learnt.learn({}, {0.0, 15.0}, report);
  EXPECT_LT(learnt.strength_factor(), 1.5);
  for (int i = 0; i < 3; ++i) learnt.learn({}, {0.0, 1.6}, report);
  EXPECT_GT(learnt.strength_factor(), 1.6);
}

TEST(StepSearch, TheBucketCurlsWithinItsViewWhereTheWorkIsFarAhead) {
  const HandMadeJob job;
  const JobMap map = job.map();
  for (const double near : {4.0, 4.35, 4.7}) {
    StepTask task{job.settings,
                  map,
                  job.ground,
                  {1.5, 0.0, 0.0, 0.0},
                  {{3.0, 3.5, 3.0}, 1.57, 2.0, false},
                  {}};
    task.lines = {{0.0, 0.1, near, 6.0}};
    task.strength_factor = task.hard_factor = 4.0;  // where it bites, up to the end of the work
    EXPECT_TRUE(best_dig(task).has_value()) << near;
  }
}

TEST(LearntNumber, ManyStallsDoNotFreezeIt) {
  LearntNumber number = {0.0, 0.4};
  for (int i = 0; i < 6; ++i) number.learn_bound(number.mean + number.sd(), true, 0.06);
  EXPECT_GT(number.mean, 1.5);
  EXPECT_GT(number.sd(), 0.05);
}

/// The dig that a machine finds in a trench of soil so much stronger than its kind.
std::optional<StepDig> dig_in_soil(const HandMadeJob& job, double strength, bool may_bite = true) {
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  const JobMap map = job.map();
  const std::vector<DigStart> barren;
  StepTask task{job.settings, map, job.ground, base, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, barren};
  task.lines = {{0.0, -0.11, 2.95, 6.0}, {0.0, 0.11, 2.95, 6.0}};
  task.strength_factor = strength;
  task.hard_factor = 1.3 * strength;
  task.slack = 0.015;
  task.may_bite = may_bite;
  return best_dig(task);
}

TEST(StepSearch, BitesWhereNoFlatCutIsStrongEnough) {
  const HandMadeJob job;
  const auto soft = dig_in_soil(job, 0.5);
  ASSERT_TRUE(soft);
  EXPECT_LT(soft->path.parameters.penetration_angle, 0.9);
  EXPECT_GT(soft->dig.fill, 0.8);
  const auto hard = dig_in_soil(job, 4.0);
  ASSERT_TRUE(hard);
  EXPECT_GE(hard->path.parameters.penetration_angle, 1.0);
  EXPECT_GT(hard->path.overcut, 0.05);  // its curl goes below the penetration
  EXPECT_GT(hard->dig.payload_mass, 60.0);
  EXPECT_GT(hard->signs.stalls_at, 4.0);
  EXPECT_LT(hard->signs.stalls_at, 20.0);
  EXPECT_FALSE(dig_in_soil(job, 4.0, false));  // where passes are to take what is left
}

TEST(StepSearch, ABankOfHardSoilIsShavedFromTheOpenGroundBeyond) {
  HandMadeJob job;
  const JobMap map = job.map();
  for_each_cell(job.ground.bank.z, [&](Cell at) {
    const double x = job.ground.bank.x(at.col), y = job.ground.bank.y(at.row);
    if (std::abs(y) < 0.5 && x > 7.3 && x < 10.0) job.ground.bank.z(at.row, at.col) = -0.5;
  });
  const auto dig = dig_in_soil(job, 4.5);
  ASSERT_TRUE(dig);
  EXPECT_FALSE(dig->may_stall);
  EXPECT_EQ(dig->path.parameters.penetration_length, 0.0);
  const BucketPose& first = dig->path.poses.front().bucket;
  EXPECT_GT(first.x, 4.3) << "beyond the bank";
  EXPECT_LT(first.z, -0.03) << "below its top";
  EXPECT_GT(first.z, -0.2) << "over the floor";
}

/// Of the ground before a machine that falls towards it by so much, as hard soil.
std::optional<StepDig> dig_on_slope(double slope) {
  HandMadeJob job;
  const JobMap map = job.map();
  for_each_cell(job.ground.bank.z, [&](Cell at) {
    const double x = job.ground.bank.x(at.col);
    job.ground.bank.z(at.row, at.col) = std::clamp(slope * (x - 6.0), 0.0, 0.6);
  });
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  StepTask task{job.settings, map, job.ground, base, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  task.lines = {{0.0, 0.0, 2.95, 6.0}};
  task.strength_factor = 2.0;
  task.hard_factor = 2.1;
  return best_dig(task);
}

TEST(StepSearch, HardGroundThatFallsTowardsTheMachineIsDugAlongItsSlope) {
  const auto level = dig_on_slope(0.0), falling = dig_on_slope(0.2);
  ASSERT_TRUE(level && falling);
  EXPECT_EQ(level->path.drag_grade, 0.0);
  EXPECT_GT(falling->path.drag_grade, 0.15);
  EXPECT_GT(falling->dig.payload_mass, 140.0);
  EXPECT_FALSE(falling->may_stall);
}

TEST(StepSearch, APassBeginsAboveTheGroundAndReachesTheNearEnd) {
  HandMadeJob job;
  const JobMap map = job.map();
  constexpr double left = 0.06;  // over the floor [m]
  job.ground = dug_to(map, std::move(job.ground), left);
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  StepTask task{job.settings, map, job.ground, base, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  constexpr double near = 3.6;  // farther than where the bucket would curl at the tracks [m]
  task.lines = {{0.0, -0.11, near, 6.0}};
  task.finishing = true;
  const auto dig = best_dig(task);
  ASSERT_TRUE(dig.has_value());
  const auto& poses = dig->path.poses;
  EXPECT_NEAR(poses.front().bucket.z, -0.5 + left + 0.015, 1e-6);
  const auto last = std::find_if(poses.rbegin(), poses.rend(),
                                 [](const DigPose& pose) { return pose.phase == DigPhase::drag; });
  ASSERT_NE(last, poses.rend());
  EXPECT_NEAR(last->bucket.x, near, 0.02);
}

/// The height at which a bank of 0.4 m, left at the end of a trench, is cut first.
std::optional<double> first_cut_at_end(double strength, bool finishing) {
  HandMadeJob job;
  const JobMap map = job.map();
  job.ground = dug_to(map, std::move(job.ground), 0.0);
  for_each_cell(job.ground.bank.z, [&](Cell at) {
    if (job.ground.bank.x(at.col) > 5.3 && !std::isnan(map.target.z(at.row, at.col)))
      job.ground.bank.z(at.row, at.col) = -0.1;
  });
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  StepTask task{job.settings, map, job.ground, base, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  task.lines = {{0.0, 0.0, 2.95, 6.0, true}};
  task.strength_factor = strength;
  task.hard_factor = 1.05 * strength;
  task.finishing = finishing;
  const auto dig = best_dig(task);
  if (!dig) return std::nullopt;
  const auto& poses = dig->path.poses;
  EXPECT_NEAR(poses.front().bucket.z, finishing ? -0.085 : -0.1, 1e-6);
  const auto drag = std::find_if(poses.begin(), poses.end(),
                                 [](const DigPose& pose) { return pose.phase == DigPhase::drag; });
  EXPECT_NE(drag, poses.end());
  return drag->bucket.z;
}

TEST(StepSearch, ALayerThatBeginsAboveTheGroundIsCutAsDeepAsOneOnIt) {
  for (const double strength : {1.0, 1.25, 2.0}) {
    const auto for_volume = first_cut_at_end(strength, false);
    const auto for_shape = first_cut_at_end(strength, true);
    ASSERT_TRUE(for_volume && for_shape) << strength;
    EXPECT_NEAR(*for_shape, *for_volume, 1e-3) << strength;
  }
}

TEST(StepSearch, APassThatIsCountedOnDoesNotStallInGroundThatIsHigher) {
  HandMadeJob job;
  const JobMap map = job.map();
  constexpr double left = 0.06;  // over the floor [m]
  for_each_cell(map.target.z, [&](Cell at) {
    const double target = map.target.z(at.row, at.col);
    if (!std::isnan(target)) job.ground.bank.z(at.row, at.col) = target + left;
  });
  const Machine& machine = job.settings.site.machine;
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  StepTask task{job.settings, map, job.ground, base, {{3.0, 3.5, 3.0}, 1.57, 2.0, false}, {}};
  task.lines = {{0.0, -0.11, 2.95, 6.0}};
  task.finishing = true;
  int counted_on = 0;
  for (double strength = 1.0; strength < 8.0; strength *= 1.3) {
    task.strength_factor = strength;
    task.hard_factor = 1.05 * strength;
    const auto dig = best_dig(task);
    if (!dig || dig->may_stall) continue;
    ++counted_on;
    Terrain higher = undisturbed(flat_ground({0.0, -2.0, 9.0, 2.0}, 0.05));
    higher.bank.z += left - 0.5 + 0.01;
    const HeightMapSimulator simulator(machine, with_strength(job.settings.site.soil, strength),
                                       task.density_percent);
    const auto dug = dig_of_path(machine, simulator, higher, dig->path);
    EXPECT_TRUE(std::holds_alternative<PlannedDig>(dug)) << strength;
  }
  EXPECT_GT(counted_on, 2);
}

TEST(DumpPlace, ATruckIsLoadedFromAboveItsBed) {
  HandMadeJob job;
  job.settings.design.truck = JobTruck{box(2.0, 3.0, 6.0, 5.4), 1.5, 9000.0};
  const auto place = dump_place(job.settings, job.map(), job.ground, {3.0, 0.0, 0.0, 0.0});
  ASSERT_TRUE(place);
  EXPECT_TRUE(place->in_truck);
  EXPECT_GT(place->place.z(), 1.5 + job.settings.site.machine.bucket_length);
  const BasePose far = {-8.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(dump_place(job.settings, job.map(), job.ground, far));
}

TEST(DumpPlace, ATruckIsLoadedWhereverInItsBedTheFrontReaches) {
  HandMadeJob job;
  job.settings.design.truck = JobTruck{box(2.0, 3.0, 14.0, 5.4), 1.5, 9000.0};
  const BasePose base = {3.0, 0.0, 0.0, 0.0};  // the middle of the bed is 6.5 m away
  const auto place = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(place);
  EXPECT_GT(place->place.y(), 3.4);
  EXPECT_LT(place->place.y(), 5.0);
  EXPECT_GT(place->place.x(), 2.4);
  EXPECT_LT(std::hypot(place->place.x() - 3.0, place->place.y()), 6.5);
  job.settings.design.truck->bed_height = 4.0;
  EXPECT_FALSE(dump_place(job.settings, job.map(), job.ground, {3.0, -2.2, 0.0, 0.0}));
  // 4 m up at 6 m, to which the front reaches from the foot of its boom, not from the tracks
  job.settings.design.truck = JobTruck{box(2.0, 5.4, 4.0, 7.0), 2.4, 9000.0};
  EXPECT_TRUE(dump_place(job.settings, job.map(), job.ground, base));
}

TEST(DumpPlace, OfAnAreaThatIsTooSmallTheLeastRunsOut) {
  HandMadeJob job;
  const SitePolygon area = box(2.0, 3.4, 5.0, 4.8);  // narrower than a heap
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, area}};
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  const auto place = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->place.y(), 4.1, 0.3) << "midway";
  // Nothing of it may come near a manhole there.
  job.settings.design.keep_out = {{"manhole", box(2.0, 4.4, 3.4, 4.8), {}}};
  const auto beside = dump_place(job.settings, job.map(), job.ground, base);
  ASSERT_TRUE(beside);
  EXPECT_GT(beside->place.x(), 3.4 + 0.3);
  // What cannot be laid within is laid so that some of it runs in.
  job.settings.design.keep_out = {};
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(2.0, 1.2, 5.0, 1.8)}};
  const auto past = dump_place(job.settings, job.map(), job.ground, {-0.5, 0.0, 0.0, 0.0});
  ASSERT_TRUE(past);
  EXPECT_GT(past->place.y(), 1.8);
  // Nor into the cut.
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(2.0, 0.6, 5.0, 1.3)}};
  EXPECT_FALSE(dump_place(job.settings, job.map(), job.ground, base));
}

/// A small place for soil, and a heap on it that leaves no room.
struct FullArea : HandMadeJob {
  explicit FullArea(double depth) {
    settings.design.dump_areas = {{DumpArea::Kind::heap, box(2.0, 2.6, 5.0, 5.6)}};
    DesignWords words;
    words.length = 10.0;
    words.floor_width = 1.0;
    words.depth = depth;
    settings.surface = design_of_words(words, ground.bank);
    of_job = map();
    dug = ground;
    for_each_cell(of_job.target.z, [&](Cell at) {
      const double target = of_job.target.z(at.row, at.col);
      if (!std::isnan(target)) dug.bank.z(at.row, at.col) = target;
    });
    for (int i = 0; i < 40; ++i) heap_soil(dug, settings.site.soil, 50.0, {3.5, 4.1}, 0.43);
  }
  JobMap of_job;
  Terrain dug;
  BasePose base = {3.0, 0.0, 0.0, 0.0};
};

TEST(DumpPlace, WhatFullAreasDoNotHoldIsLaidAroundThemAndTold) {
  const FullArea job(0.5);
  const auto place = dump_place(job.settings, job.of_job, job.dug, job.base, {0.0, true});
  ASSERT_TRUE(place);
  EXPECT_GT(place->outside, 0.5);
  const auto warnings = dump_warnings(*place);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings.front().code, WarningCode::dump_areas_full);
  EXPECT_FALSE(warnings.front().ends_trust);
  EXPECT_GT(std::abs(place->place.y()), 0.5 + 0.6) << "not in the cut";
  const auto first = dump_place(job.settings, job.of_job, job.ground, job.base);
  ASSERT_TRUE(first);
  EXPECT_TRUE(dump_warnings(*first).empty());
}

TEST(DumpPlace, SoilIsLaidShortOfAreasOutOfReachOnlyIfItMay) {
  HandMadeJob job;
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(2.0, 7.6, 5.0, 7.9)}};
  const BasePose base = {3.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(dump_place(job.settings, job.map(), job.ground, base));
  const auto place = dump_place(job.settings, job.map(), job.ground, base, {0.0, true});
  ASSERT_TRUE(place);
  EXPECT_GT(place->place.y(), 7.6 - 4.1);
  EXPECT_EQ(dump_warnings(*place).size(), 1U);
}

TEST(DumpPlace, AHeapBesideACutIsTheSameHoweverDeepItIs) {
  const FullArea shallow(0.3), deep(2.0);
  const auto beside_shallow =
      dump_place(shallow.settings, shallow.of_job, shallow.dug, shallow.base, {0.0, true});
  const auto beside_deep = dump_place(deep.settings, deep.of_job, deep.dug, deep.base, {0.0, true});
  ASSERT_TRUE(beside_shallow && beside_deep);
  EXPECT_LT((beside_shallow->place - beside_deep->place).norm(), 1e-9);
}

TEST(DumpPlace, AHeapThatIsNotKnownAsLooseStillTakesUpRoom) {
  FullArea job(0.5);
  const auto place = dump_place(job.settings, job.of_job, job.dug, job.base, {0.0, true});
  job.dug.bank.z += job.dug.loose;
  job.dug.loose.setZero();
  const auto same = dump_place(job.settings, job.of_job, job.dug, job.base, {0.0, true});
  ASSERT_TRUE(place && same);
  EXPECT_LT((place->place - same->place).norm(), 1e-9);
}

TEST(LaneView, TheNoiseOfAHeapThatComesToRestTouchesNothing) {
  HandMadeJob job;
  job.settings.design.keep_out = {{"manhole", box(4.0, 1.0, 5.0, 1.8), {}}};
  const LaneView view(job.ground, job.map(), dig_line({0.0, 0.0, 0.0, 0.0}),
                      {-2.0, -2.0, 12.0, 2.0}, job.settings.site.machine.bucket.width_outside);
  TerrainPatch patch;
  const Terrain& before = view.ground().terrain();
  patch.bank = before.bank.z;
  patch.loose = before.loose;
  for_each_cell(patch.loose, [&](Cell at) {
    patch.loose(at.row, at.col) += (at.row + at.col) % 2 == 0 ? 0.01 : -0.01;
  });
  const ShapeChange noise = view.change(patch, {});
  EXPECT_LT(noise.touched, 2e-4);
  EXPECT_LT(noise.spilled, 2e-4);
  patch.loose += 0.011;
  const ShapeChange fallen = view.change(patch, {});
  EXPECT_NEAR(fallen.touched, 0.011 * 0.8, 1e-3);
  EXPECT_GT(fallen.spilled, 0.05);
}

TEST(LaneView, NothingIsCutBelowABench) {
  HandMadeJob job;
  LaneView view(job.ground, job.map(), dig_line({0.0, 0.0, 0.0, 0.0}), {-2.0, -2.0, 12.0, 2.0},
                job.settings.site.machine.bucket.width_outside);
  const double all = view.excess(0.0).sum();
  view.keep_above(-0.2);
  EXPECT_NEAR(view.floor(0.0)(3.0), -0.2, 1e-9);
  EXPECT_NEAR(view.excess(0.0).sum(), 0.4 * all, 0.01 * all);
}

TEST(LaneView, ItsFloorIsTheDesignAndAboveAKeepOut) {
  HandMadeJob job;
  KeepOut cable = {"cable", box(5.0, -3.0, 6.0, 3.0), 0.2};
  KeepOut manhole = {"manhole", box(8.0, -0.2, 8.5, 0.2), {}};
  job.settings.design.keep_out = {cable, manhole};
  const Machine& machine = job.settings.site.machine;
  const LaneView view(job.ground, job.map(), dig_line({0.0, 0.0, 0.0, 0.0}),
                      {-2.0, -2.0, 12.0, 2.0}, machine.bucket.width_outside);
  const GroundProfile floor = view.floor(0.0);
  EXPECT_NEAR(floor(3.0), -0.5, 1e-9);
  for (double x = 5.05; x < 5.95; x += 0.1) EXPECT_GE(floor(x), -0.2 - 1e-9) << x;
  for (double x = 8.05; x < 8.45; x += 0.1) EXPECT_FALSE(floor(x) < -1e-9) << x;
  EXPECT_FALSE(floor(-1.0) < -1e-9);
}

TEST(LaneView, OneCellThatIsNotKnownIsUnderTheBucketOrBesideIt) {
  HandMadeJob job;
  const auto known = [&](double x, double y, double from, double to) {
    Terrain ground = job.ground;
    const auto cell = cell_at(ground.bank, x, y);
    ground.bank.z(cell->row, cell->col) = std::nan("");
    const Machine& machine = job.settings.site.machine;
    const LaneView view(ground, job.map(), dig_line({0.0, 0.0, 0.0, 0.0}), {-2.0, -2.0, 12.0, 2.0},
                        machine.bucket.width_outside);
    return view.is_known(from, to);
  };
  EXPECT_FALSE(known(5.02, 0.02, 4.0, 6.0));
  EXPECT_FALSE(known(5.02, -0.37, 4.0, 6.0));
  EXPECT_TRUE(known(5.02, 0.8, 4.0, 6.0));
  EXPECT_TRUE(known(6.4, 0.02, 4.0, 6.0));
  EXPECT_FALSE(known(11.0, 1.5, 4.0, 12.5)) << "beside the map";
}

/// A bank of 0.3 m at the right of the lane y = 0, so wide [m], over a floor at -0.5 m.
LaneView view_of_bank(HandMadeJob& job, double width) {
  for_each_cell(job.ground.bank.z, [&](Cell at) {
    const double y = job.ground.bank.y(at.row);
    if (y > -0.35 + width && y < 0.5) job.ground.bank.z(at.row, at.col) = -0.5;
    if (y < -0.35 + width) job.ground.bank.z(at.row, at.col) = -0.2;
  });
  const HandMadeJob level;
  return LaneView(job.ground, level.map(), dig_line({0.0, 0.0, 0.0, 0.0}), {-2.0, -2.0, 12.0, 2.0},
                  job.settings.site.machine.bucket.width_outside);
}

TEST(LaneView, ADigBeginsOnTheBankInItsLaneButNotOnTheEdgeThatItMayMiss) {
  HandMadeJob job, edge;
  const LaneView wide = view_of_bank(job, 0.3);
  EXPECT_NEAR(wide.top()(5.0), -0.2, 0.02);
  EXPECT_NEAR(wide.mean()(5.0), -0.38, 0.05);
  const LaneView narrow = view_of_bank(edge, 0.05);
  EXPECT_NEAR(narrow.top()(5.0), -0.5, 1e-9);
}

TEST(LaneView, WhatIsPushedAsideIsNotOfThePassThatPushedIt) {
  HandMadeJob job;
  job.ground.bank.z -= 0.45;  // 5 cm over the design
  const JobMap map = HandMadeJob().map();
  const LaneView view(job.ground, map, dig_line({0.0, 0.0, 0.0, 0.0}, 0.0, -0.1),
                      {-2.0, -2.0, 12.0, 2.0}, job.settings.site.machine.bucket.width_outside);
  TerrainPatch patch;
  const Terrain& ground = view.ground().terrain();
  patch.bank = ground.bank.z;
  patch.loose = ground.loose;
  const double cell = ground.bank.cell_size;
  double under = 0.0, aside = 0.0;
  for_each_cell(patch.bank, [&](Cell at) {
    const double x = ground.bank.x(at.col), y = ground.bank.y(at.row);
    if (x < 4.0 || x > 6.0) return;
    if (std::abs(y) < 0.2) {
      patch.bank(at.row, at.col) = -0.5;
      under += 0.05 * cell * cell;
    }
    if (y > 0.36 && y < 0.45) {
      patch.loose(at.row, at.col) = 0.1;
      aside += 0.1 * cell * cell;
    }
  });
  ASSERT_GT(aside, 0.0);
  const ShapeChange change = view.change(patch, {0.0, 0.03, 1e9});
  EXPECT_NEAR(change.cleared, under, 1e-9);
  EXPECT_NEAR(change.finished, under / 0.05, 1e-9);
  EXPECT_NEAR(change.gained, under - aside, 1e-9);
  EXPECT_NEAR(change.pushed, aside, 1e-9);
  EXPECT_EQ(change.at_end, 0.0);
  EXPECT_NEAR(view.change(patch, {0.0, 0.03, 5.0}).at_end, 0.5 * change.gained, 0.01 * under);
}

TEST(JobLearning, ADigThatIsLittleOfItsCycleTellsNothingOfItsEnergy) {
  PlannedDig dig;
  dig.fill = 0.9;
  dig.energy = 5e3;
  dig.cycle_energy = 1e5;
  StepReport report;
  report.joint_work = 2e5;
  JobLearning learning;
  learning.learn(dig, {}, report);
  EXPECT_EQ(learning.energy.mean, 0.0);
  dig.energy = 4e4;
  learning.learn(dig, {}, report);
  EXPECT_GT(learning.energy.mean, 0.0);
}

TEST(JobLearning, OfADigInSofterSoilTheStrengthIsThatOfTheSoil) {
  PlannedDig dig;
  dig.fill = 0.9;
  dig.energy = 4e4;
  dig.cycle_energy = 1e5;
  constexpr double share = 0.5, planned = -0.6, truth = -0.3;
  StepReport report;
  report.joint_work = 6e4 + 4e4 * std::exp(share * (truth - planned));
  JobLearning learning;
  for (int i = 0; i < 50; ++i) learning.learn(dig, {share, 0.0, std::exp(planned)}, report);
  EXPECT_NEAR(learning.strength.mean, truth, 0.05);
  EXPECT_NEAR(learning.foretell(dig, {share, 0.0, std::exp(planned)}).energy, *report.joint_work,
              2e3);
}

/// Digs that come as far from what was foretold as the layer under them errs by so much.
TEST(JobLearning, IntervalsHoldNineteenOfTwentyDigsThinOnesToo) {
  for (const double layer_sd : {0.006, 0.02}) {
    Random random(7, 0, 0);
    JobLearning learning;
    int held = 0, count = 0;
    for (int i = 0; i < 600; ++i) {
      PlannedDig dig;
      dig.payload_mass = i % 2 == 0 ? 350.0 : 60.0;
      dig.fill = dig.payload_mass / 500.0;
      dig.energy = 5e4;
      dig.cycle_energy = 1.2e5;
      const DigSigns signs = {0.0, 0.0, 1.0, 3000.0};
      const ForetoldStep foretold = learning.foretell(dig, signs);
      StepReport report;
      report.payload_mass = std::max(0.0, dig.payload_mass * (1.0 + 0.05 * random.normal()) +
                                              signs.layer * layer_sd * random.normal());
      report.joint_work = dig.cycle_energy * (1.0 + 0.1 * random.normal());
      const auto& [low, high] = foretold.payload_interval;
      if (i > 60) {
        ++count;
        held += *report.payload_mass >= low && *report.payload_mass <= high;
      }
      learning.learn(dig, signs, report);
    }
    EXPECT_GE(held, 0.9 * count) << layer_sd;
    EXPECT_LE(held, 0.98 * count) << layer_sd;
  }
}

TEST(JobMap, ACableThatIsNarrowerThanACellIsNotTouched) {
  HandMadeJob job;
  job.settings.design.keep_out = {{"cable", box(5.06, -3.0, 5.08, 3.0), 0.3}};
  job.settings.design.obstacles = {{"pole", box(2.06, -1.59, 2.08, -1.57), 8.0}};
  const JobMap map = job.map();
  for (const double y : {-2.99, -0.3, 0.02, 0.48, 2.99}) {
    const auto cell = cell_at(map.target, 5.07, y);
    EXPECT_NEAR(map.forbidden(cell->row, cell->col), -0.3, 1e-9) << y;
  }
  const auto pole = cell_at(map.target, 2.07, -1.58);
  EXPECT_TRUE(map.untouched(pole->row, pole->col));
  job.settings.design.keep_out = {{"bed", box(5.0, -3.0, 5.2, 3.0), std::nullopt}};
  const JobMap beside = job.map();
  for (const auto& [x, is_in] :
       {std::pair(4.97, false), {5.03, true}, {5.17, true}, {5.23, false}}) {
    const auto cell = cell_at(beside.target, x, 0.0);
    EXPECT_EQ(beside.untouched(cell->row, cell->col), is_in) << x;
  }
}

TEST(DesignWarnings, TellWhatCannotBeDoneAsAskedFor) {
  HandMadeJob job;
  const auto codes = [&] {
    std::set<WarningCode> found;
    for (const Warning& each : design_warnings(job.settings.design, job.settings.surface,
                                               job.ground.bank, job.settings.site.machine)) {
      EXPECT_TRUE(each.ends_trust);
      found.insert(each.code);
    }
    return found;
  };
  EXPECT_TRUE(codes().empty());
  job.settings.design.tolerance = 0.3;
  EXPECT_EQ(codes(), std::set{WarningCode::wide_tolerance});
  job.settings.design.tolerance = 0.03;
  job.settings.design.dump_areas.push_back({DumpArea::Kind::heap, box(4.0, -2.0, 6.0, 2.0)});
  EXPECT_EQ(codes(), std::set{WarningCode::dump_on_design});
  job.settings.design.dump_areas.pop_back();
  DesignWords words;
  words.length = 10.0;
  words.floor_width = 1.0;
  words.depth = 6.0;
  job.settings.surface = design_of_words(words, job.ground.bank);
  EXPECT_EQ(codes(), std::set{WarningCode::design_out_of_reach});
  words.depth = 0.5;
  words.from.x() = 13.0;
  job.settings.surface = design_of_words(words, job.ground.bank);
  EXPECT_EQ(codes(), std::set{WarningCode::design_beyond_scan});
  job.settings.surface.shape = flat_ground({0.0, -3.0, 4.0, 1.0}, 0.05, -0.5);
  std::get<HeightMap>(job.settings.surface.shape).z.leftCols(40).setConstant(0.4);
  EXPECT_TRUE(codes().empty());  // it only cuts
  job.settings.surface.cuts_only = false;
  EXPECT_EQ(codes(), std::set{WarningCode::design_above_ground});
}

TEST(JobRecord, ComesBackWithAllThatItRemembers) {
  const TemporaryFolder folder;
  JobRecord record;
  record.signs = {0.4, 1.7, 0.8, 2900.0};
  record.learning.layer_variance = 3e-5;
  record.learning.cycle_variance = 0.02;
  record.barren = {{0.12, 5.4}, {-0.12, 4.6, 0.3}};
  record.bench = 2;
  record.passes_here = 3;
  record.carried = CarriedLoad{0.07, {0.1, 0.2, -0.3, 0.4}};
  record.looks = {{{0.6, 0.7, 3.0}, 0.1, 0.5, 12.0, 0.8}, usual_looks().front()};
  record.present = JobStep{};
  record.present->keeps_load = true;
  save_record(folder.file(""), record);
  const JobRecord read = load_record(folder.file(""));
  ASSERT_EQ(read.barren.size(), 2U);
  EXPECT_EQ(read.barren[1].lane, -0.12);
  EXPECT_EQ(read.barren[1].along, 4.6);
  EXPECT_EQ(read.barren[1].turned, 0.3);
  EXPECT_EQ(read.signs.strength, 0.8);
  EXPECT_EQ(read.signs.layer, 2900.0);
  EXPECT_EQ(read.learning.layer_variance, 3e-5);
  EXPECT_EQ(read.learning.cycle_variance, 0.02);
  EXPECT_EQ(read.learning.datum.scans, 1);
  EXPECT_EQ(read.bench, 2);
  EXPECT_EQ(read.passes_here, 3);
  ASSERT_TRUE(read.carried.has_value());
  EXPECT_EQ(read.carried->volume, 0.07);
  EXPECT_EQ(read.carried->joints, record.carried->joints);
  EXPECT_TRUE(read.present->keeps_load);
  ASSERT_EQ(read.looks.size(), 2U);
  EXPECT_EQ(read.looks[0].from, Eigen::Vector3d(0.6, 0.7, 3.0));
  EXPECT_EQ(read.looks[0].steepest, 0.8);
  EXPECT_EQ(read.looks[1].half_sector, pi);
}

TEST(JobRecord, WithoutItsFirstScanIsRefused) {
  const TemporaryFolder folder;
  for (const int scans : {0, -1}) {
    JobRecord record;
    record.learning.datum.scans = scans;
    save_record(folder.file(""), record);
    EXPECT_THROW(load_record(folder.file("")), Error);
  }
}

TEST(JobGround, WhatADigChangedIsNotSeenUntilAScanSeesIt) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  do {
    of.make_step(job);
  } while (job.progress().digs == 0);
  const double dug = job.progress().seen;
  EXPECT_LT(dug, 0.9);
  job.look(of.truth.scan(), of.truth.time() + 1.0);
  EXPECT_GT(job.progress().seen, dug);
  EXPECT_LE(job.progress().seen, of.truth.seen_share(footprint_of(of.hidden)) + 0.03);
}

TEST(JobGround, WhereScansAreNoisyACutThatNoneShowsIsKnownToACentimetre) {
  const ShortTrench site;
  TrenchJob of{site};
  of.settings.design.sensor = SensorErrors{0.001, 0.02, 0.0};
  const TemporaryFolder folder;
  JobGround ground(folder.file("job"), of.settings);
  SiteEvent first;
  first.scan = of.first;
  first.time = trial_begin;
  ground.take_in(first);
  const Cell cut = *cell_at(ground.expected().bank, 5.5, 0.0);
  EXPECT_EQ(ground.sd_at(cut), 0.0);
  JobStep dig;
  dig.what = JobAction::dig;
  dig.path = std::get<DigPath>(
      make_dig_path(of.settings.site.machine, {0.7, 0.3, 1.2}, 6.2, [](double) { return 0.0; }));
  dig.dump = {5.0, 4.0, 2.4};
  ground.expect(dig, 0.0);
  EXPECT_NEAR(ground.sd_at(cut), 0.01, 0.005);
}

TEST(JobGround, ADigThatDidNotStallIsExpectedToItsEnd) {
  HandMadeJob job;
  const SoilKind loam = job.settings.site.soil;
  const Machine& machine = job.settings.site.machine;
  const auto made = make_dig_path(machine, {0.6, 0.5, 1.5}, 6.5, boom_plane_profile(job.ground));
  const auto& path = std::get<DigPath>(made);
  const DigLine line = dig_line({}, 0.0, 0.0);
  const auto dug = [&](double strength) {
    job.settings.site.soil = with_strength(loam, strength);
    return whole_dig(job.settings, job.ground, line, path, 0.0);
  };
  const HeightMapSimulator hard(machine, with_strength(loam, 10.0), job.settings.density_percent);
  const SoilVoids voids = soil_voids(loam, job.settings.density_percent);
  ASSERT_TRUE(dig_along(hard, machine, job.ground, {line, voids, path}).stall);
  const DigResult in_soft = dug(1.0), in_hard = dug(10.0);
  ASSERT_FALSE(in_soft.stall);
  EXPECT_FALSE(in_hard.stall);
  EXPECT_NEAR(in_hard.payload_volume, in_soft.payload_volume, 0.1 * in_soft.payload_volume);
}

TEST(JobMotion, TheToothStaysOnItsLane) {
  const HandMadeJob job;
  const Machine& machine = job.settings.site.machine;
  JobStep step;
  step.id = 1;
  step.what = JobAction::dig;
  step.base = {2.0, 0.3, 0.0, 0.1};
  step.swung = -0.1;
  step.lane = 0.25;
  step.path =
      std::get<DigPath>(make_dig_path(machine, {0.7, 0.3, 1.2}, 6.2, [](double) { return 0.0; }));
  step.dump = {5.0, 4.0, 2.4};
  auto made = motion_of(job.settings, job.ground, step);
  const auto* blocked = std::get_if<BlockedWay>(&made);
  ASSERT_EQ(blocked, nullptr) << blocked->message;
  const Trajectory& motion = std::get<Trajectory>(made);
  const DigPhase last = motion.points.back().phase;
  EXPECT_EQ(last, DigPhase::back);
  double dumped_at = 1e9;
  for (const TrajectoryPoint& point : motion.points) {
    const double turn = step.base.heading + point.swing.angle;
    const double y = step.base.y + point.bucket.x * std::sin(turn);
    if (point.phase == DigPhase::penetrate || point.phase == DigPhase::drag) {
      EXPECT_NEAR(y, 0.3 + 0.25, 0.005) << point.time;
    }
    const LinkPositions links = link_positions(machine, point.joints);
    const Eigen::Vector3d pin(step.base.x + links.bucket_pin.x() * std::cos(turn),
                              step.base.y + links.bucket_pin.x() * std::sin(turn),
                              links.bucket_pin.y());
    dumped_at = std::min(dumped_at, (pin - step.dump).norm());
  }
  EXPECT_LT(dumped_at, 0.02);
  EXPECT_NEAR(motion.points.front().swing.angle, motion.points.back().swing.angle, 1e-6);
  EXPECT_LT((motion.points.front().joints - motion.points.back().joints).norm(), 1e-6);
}

TEST(StepSearch, ABucketHoldsSoilWhereADigBeginsFlatterThanThatRests) {
  const SoilKind loam = load_soil(std::string(EXCAVPLAN_DATA_SOURCE) + "/soils/loam.json");
  DigPathOptions pass;
  pass.floor = [](double) { return -0.1; };
  pass.drag_keeps_angle = true;
  pass.penetration_clearance = 0.12;
  const auto holds = [&](double angle) {
    const auto path = make_dig_path(
        zx120(), {angle, 1.0, 1.0}, 5.5, [](double) { return 0.0; }, pass);
    return can_hold_load(loam, std::get<DigPath>(path));
  };
  const double rests = 0.9 * loam.angle_of_repose - pass.penetration_clearance;
  EXPECT_TRUE(holds(0.1));
  EXPECT_TRUE(holds(rests - 0.01));
  EXPECT_FALSE(holds(rests + 0.01));
}

TEST(JobMotion, ALoadThatIsKeptGoesBackWithoutADump) {
  const HandMadeJob job;
  JobStep step;
  step.id = 1;
  step.what = JobAction::finish;
  step.base = {2.0, 0.0, 0.0, 0.0};
  step.path = std::get<DigPath>(
      make_dig_path(job.settings.site.machine, {0.7, 0.3, 1.2}, 6.2, [](double) { return 0.0; }));
  step.keeps_load = true;
  auto made = motion_of(job.settings, job.ground, step);
  const auto* motion = std::get_if<Trajectory>(&made);
  ASSERT_NE(motion, nullptr) << std::get<BlockedWay>(made).message;
  EXPECT_EQ(motion->points.back().phase, DigPhase::back);
  for (const TrajectoryPoint& point : motion->points) {
    EXPECT_NE(point.phase, DigPhase::swing);
    EXPECT_NE(point.phase, DigPhase::dump);
  }
  EXPECT_LT((motion->points.front().joints - motion->points.back().joints).norm(), 1e-6);
}

TEST(JobMotion, WhatIsCarriedIsDumpedFirst) {
  const HandMadeJob job;
  const DigPath path =
      std::get<DigPath>(make_dig_path(zx120(), {0.7, 0.3, 1.2}, 6.2, [](double) { return 0.0; }));
  JobStep step;
  step.what = JobAction::scan;
  step.base = {2.0, 0.0, 0.0, 0.0};
  step.dump = {5.0, 4.0, 2.4};
  CarriedLoad load;
  load.volume = 0.15;
  load.joints << path.poses.back().joints, 0.1;
  step.carried = load;
  auto still = motion_of(job.settings, job.ground, step);
  EXPECT_TRUE(std::get<Trajectory>(still).points.empty());
  step.dumps_first = true;
  const auto alone = motion_of(job.settings, job.ground, step);
  const auto* motion = std::get_if<Trajectory>(&alone);
  ASSERT_NE(motion, nullptr) << std::get<BlockedWay>(alone).message;
  EXPECT_TRUE(motion->warnings.empty());
  const auto pin_off = [&](const TrajectoryPoint& point) {
    const double turn = point.swing.angle + step.base.heading;
    const Eigen::Vector2d pin = link_positions(zx120(), point.joints).bucket_pin;
    const Eigen::Vector3d at(step.base.x + pin.x() * std::cos(turn), pin.x() * std::sin(turn),
                             pin.y());
    return (at - step.dump).norm();
  };
  const auto nearest = [&](const Trajectory& of) {
    double least = 10.0;
    for (const TrajectoryPoint& point : of.points) least = std::min(least, pin_off(point));
    return least;
  };
  EXPECT_LT(nearest(*motion), 0.02);
  EXPECT_LT((motion->points.front().joints - load.joints.head<3>()).norm(), 1e-9);
  EXPECT_NEAR(motion->points.front().swing.angle, 0.1, 1e-9);

  step.what = JobAction::finish;
  step.path = path;
  step.keeps_load = true;  // of the dig after it: what was carried is over the dump once
  const auto made = motion_of(job.settings, job.ground, step);
  const auto* dig = std::get_if<Trajectory>(&made);
  ASSERT_NE(dig, nullptr) << std::get<BlockedWay>(made).message;
  EXPECT_LT(nearest(*dig), 0.02);
  EXPECT_EQ(dig->points.front().phase, DigPhase::approach);
  EXPECT_EQ(dig->points.back().phase, DigPhase::back);
}

TEST(JobMotion, ATruckInTheWayBlocksIt) {
  HandMadeJob job;
  job.settings.design.obstacles = {{"wall", box(4.0, 1.0, 7.0, 1.5), 9.0}};
  JobStep step;
  step.what = JobAction::dig;
  step.base = {2.0, 0.0, 0.0, 0.0};
  step.path =
      std::get<DigPath>(make_dig_path(zx120(), {0.7, 0.3, 1.2}, 6.2, [](double) { return 0.0; }));
  step.dump = {5.0, 4.0, 2.4};
  const auto made = motion_of(job.settings, job.ground, step);
  ASSERT_TRUE(std::holds_alternative<BlockedWay>(made));
  EXPECT_NE(std::get<BlockedWay>(made).message, "");
}

TEST(JobOrder, ComesBackWholeWithoutItsSources) {
  HandMadeJob job;
  job.settings.site.law =
      load_density_law(std::string(EXCAVPLAN_DATA_SOURCE) + "/laws/zx120-loam.json");
  job.settings.site.soil.void_ratio_max += 0.01;
  job.settings.site.cell_size = 0.06;
  job.settings.density_percent = 61.5;
  JobDesign& design = job.settings.design;
  design.name = "main";
  design.tolerance = 0.025;
  design.keep_out = {{"cable", box(5.0, -3.0, 6.0, 3.0), 0.8}, {"", box(1.0, 1.0, 2.0, 2.0), {}}};
  design.obstacles = {{"pole", box(8.0, 2.0, 8.2, 2.2), 4.0}};
  design.truck = JobTruck{box(2.0, 3.0, 6.0, 5.4), 1.5, 9000.0};
  std::get<Tin>(job.settings.surface.shape).origin += Eigen::Vector3d(5e5, 4e6, 0.0);
  const TemporaryFolder folder;
  const std::string path = folder.file("job");
  save_order(path, job.settings,
             {std::string(EXCAVPLAN_DATA_SOURCE) + "/machines/zx120.json",
              std::string(EXCAVPLAN_DATA_SOURCE) + "/laws/zx120-loam.json"});
  const JobSettings kept = load_order(path);
  EXPECT_EQ(fingerprint(kept.site.soil), fingerprint(job.settings.site.soil));
  EXPECT_EQ(fingerprint(kept.site.machine), fingerprint(job.settings.site.machine));
  EXPECT_EQ(kept.site.law.name, job.settings.site.law.name);
  EXPECT_EQ(kept.site.cell_size, 0.06);
  EXPECT_EQ(kept.density_percent, 61.5);
  EXPECT_EQ(kept.design.tolerance, 0.025);
  ASSERT_EQ(kept.design.keep_out.size(), 2U);
  EXPECT_EQ(kept.design.keep_out[0].polygon, design.keep_out[0].polygon);
  EXPECT_EQ(kept.design.keep_out[0].depth, 0.8);
  EXPECT_FALSE(kept.design.keep_out[1].depth);
  EXPECT_EQ(kept.design.obstacles[0].height, 4.0);
  EXPECT_EQ(kept.design.truck->target_mass, 9000.0);
  EXPECT_EQ(kept.design.start->x, -4.0);
  EXPECT_TRUE(kept.surface.cuts_only);
  EXPECT_NEAR(area_in_plan(kept.surface), area_in_plan(job.settings.surface), 1e-9);
  const Rectangle a = extent_of(kept.surface), b = extent_of(job.settings.surface);
  EXPECT_NEAR(a.x_min, b.x_min, 1e-9);
  EXPECT_NEAR(a.y_max, b.y_max, 1e-9);
}

TEST(JobOrder, ARasterComesBackCellByCell) {
  HandMadeJob job;
  HeightMap raster = flat_ground({0.0, -0.5, 10.0, 0.5}, 0.1);
  raster.z += -0.5;
  raster.z(0, 0) = std::nan("");
  job.settings.surface = {};
  job.settings.surface.shape = raster;
  const TemporaryFolder folder;
  save_order(folder.file("job"), job.settings,
             {std::string(EXCAVPLAN_DATA_SOURCE) + "/machines/zx120.json", ""});
  const DesignSurface kept = load_order(folder.file("job")).surface;
  const auto& map = std::get<HeightMap>(kept.shape);
  EXPECT_TRUE(std::isnan(map.z(0, 0)));
  EXPECT_EQ(map.z(3, 4), -0.5);
  EXPECT_EQ(map.origin, raster.origin);
}

TEST(JobOrder, DamageIsTold) {
  const HandMadeJob job;
  const TemporaryFolder folder;
  EXPECT_NE(
      error_of([&] { load_order(folder.file("none")); }, ErrorKind::bad_file).find("holds no job"),
      std::string::npos);
  const std::string path = folder.file("job");
  save_order(path, job.settings, {std::string(EXCAVPLAN_DATA_SOURCE) + "/machines/zx120.json", ""});
  std::string text = content_of(path + "/order.json");
  text.replace(text.find("0.03"), 4, "0.05");
  std::ofstream(path + "/order.json", std::ios::binary) << text;
  EXPECT_NE(error_of([&] { load_order(path); }, ErrorKind::bad_file).find("order.json"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan::test
