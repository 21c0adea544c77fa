// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "job/dump_place.hpp"
#include "job/hand_made_job.hpp"
#include "job/job_stations.hpp"
#include "job/lane_view.hpp"
#include "job/station_place.hpp"
#include "job/step_search.hpp"

/// @file
/// Places beside a trench whose sides lean back, from which it is swept across.

namespace excavplan::test {
namespace {

std::optional<PlacesBeside> beside(const HandMadeJob& job) {
  const JobMap map = job.map();
  return places_beside(job.settings, map, job.ground, work_frame(job.settings, map, job.ground));
}

TEST(JobBeside, ATrenchWithFacesIsWorkedFromItsOtherSideThanTheSoil) {
  HandMadeJob job = leaning_trench();
  const auto from_right = beside(job);
  ASSERT_TRUE(from_right);
  EXPECT_NEAR(from_right->line.heading, 0.5 * pi, 1e-9);
  EXPECT_NEAR(from_right->line.tracks, -0.5 * pi, 1e-9);
  EXPECT_TRUE(from_right->line.is_beside());
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-6.0, -6.0, 14.0, -1.8)}};
  const auto from_left = beside(job);
  ASSERT_TRUE(from_left);
  EXPECT_NEAR(from_left->line.heading, -0.5 * pi, 1e-9);
}

TEST(JobBeside, NoneIsForUprightWallsNorWhereAMachineCannotStandOrDump) {
  EXPECT_FALSE(beside(HandMadeJob()));
  HandMadeJob keep_out = leaning_trench();
  keep_out.settings.design.keep_out = {{"meadow", box(-4.0, -4.0, 14.0, -3.0)}};
  EXPECT_FALSE(beside(keep_out));
  HandMadeJob far_soil = leaning_trench();
  far_soil.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-6.0, 7.0, 14.0, 7.9)}};
  EXPECT_FALSE(beside(far_soil));
  HandMadeJob held = leaning_trench();
  held.settings.site.machine.swing->lower = -1.4;
  held.settings.site.machine.swing->upper = 1.4;
  EXPECT_FALSE(beside(held)) << "its swing ends before the trench";
  HandMadeJob light = leaning_trench();
  Body& body = light.settings.site.machine.body.value();
  body.centre.x() = 0.75 * body.front_edge;
  EXPECT_FALSE(beside(light)) << "swung to a side it stands on the edge of its tracks";
}

TEST(JobBeside, NoneIsWhereTheTopOfTheFarFaceIsOutOfReach) {
  const auto trench = [](double depth, double batter) {
    HandMadeJob job;
    DesignWords words;
    words.length = 10.0;
    words.floor_width = 1.0;
    words.depth = depth;
    words.batter = batter;
    job.settings.surface = design_of_words(words, job.ground.bank);
    job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-6.0, 2.0, 14.0, 7.0)}};
    return job;
  };
  EXPECT_TRUE(beside(trench(0.6, 1.73)));
  EXPECT_FALSE(beside(trench(1.3, 1.73))) << "5.5 m across";
}

TEST(JobBeside, ItsPlacesAreOffTheEdgeAndReachAllOfTheTrench) {
  const HandMadeJob job = leaning_trench();
  const Machine& machine = job.settings.site.machine;
  const auto all = beside(job);
  ASSERT_TRUE(all);
  const JobFrame& line = all->line;
  const double tracks = 0.5 * machine.undercarriage_width();
  const double half = 0.5 * machine.bucket.width_outside;
  for (const JobStation& each : all->places) {
    EXPECT_TRUE(each.is_across && each.is_again);
    const BasePose base = base_at(line, each, job.ground, machine);
    EXPECT_NEAR(base.heading, 0.0, 1e-9) << "its tracks lie along the trench";
    EXPECT_NEAR(ahead_of(base, line).heading, 0.5 * pi, 1e-9);
    EXPECT_LT(base.y + tracks, -1.54 - 0.8);
    EXPECT_GT(base.y + tracks, -1.54 - 1.0);
    const WorkRange range = work_range(line, machine, each.along);
    EXPECT_LT(base.y + range.near, -1.4);
    EXPECT_GT(base.y + range.far, 1.4);
    for (const double lane : each.passes)
      EXPECT_LT(std::abs(lane - each.beside), 0.5) << "the bucket is hardly yawed";
  }
  const auto swept = swept_from(all->places, line, job.frame());  // from 4 m before the trench
  EXPECT_NEAR(swept.front() - half, 4.0 - 1.04, 0.12);
  EXPECT_NEAR(swept.back() + half, 14.0 + 1.04, 0.12);
  for (std::size_t i = 1; i < swept.size(); ++i) EXPECT_LT(swept[i] - swept[i - 1], half);
}

TEST(JobBeside, TheFloorAtEachEndComesAfterTheFaceThatFallsOnIt) {
  const HandMadeJob job = leaning_trench();
  const auto all = beside(job);
  ASSERT_TRUE(all);
  const auto middle = [&](const JobStation& each) { return all->line.place(0.0, each.beside).x(); };
  const double last_floor = middle(all->places.back());
  EXPECT_GT(last_floor, 8.0);
  EXPECT_LT(last_floor, 10.0) << "on the floor";
  EXPECT_GT(middle(all->places.end()[-2]), last_floor) << "at the face of the end";
  EXPECT_LT(middle(all->places.front()), 0.5) << "at that of the near end";
}

TEST(JobBeside, TheyAreLeftAllPassesFromTheLine) {
  const HandMadeJob job = leaning_trench();
  const auto all = beside(job);
  ASSERT_TRUE(all);
  const JobFrame frame = job.frame();
  const auto stations = stations_of(frame, job.settings, swept_from(all->places, all->line, frame));
  EXPECT_LT(stations.size(), stations_of(frame, job.settings).size());
  for (const JobStation& each : stations) EXPECT_TRUE(each.leaves_passes && !each.is_again);
}

TEST(JobBeside, WhereAPoleKeepsThemAwayRowsOfTheLineMakeTheirPasses) {
  HandMadeJob job = leaning_trench();
  job.settings.design.obstacles = {{"pole", box(9.0, -3.0, 9.3, -2.7), 5.0}};
  const auto some = beside(job);
  ASSERT_TRUE(some);
  const JobFrame frame = job.frame();
  const auto swept = swept_from(some->places, some->line, frame);
  EXPECT_LT(swept.back(), 4.0 + 9.0 - 1.0);
  const auto rows = stations_of(frame, job.settings, swept);
  EXPECT_FALSE(rows.front().is_again);
  EXPECT_TRUE(rows.at(1).is_again) << "the first row, at the pole, shapes its faces itself";
  EXPECT_FALSE(rows.back().is_again) << "the last one does not";
}

TEST(JobBeside, SoilFromTheLineIsLaidWhereItLeavesRoomForThatFromBeside) {
  const HandMadeJob job = leaning_trench();
  const JobMap map = job.map();
  const BasePose base = {-1.0, 0.0, 0.0, 0.0};
  const auto usual = dump_place(job.settings, map, job.ground, base);
  DumpRules rules;
  rules.off_line = 4.5;
  const auto off = dump_place(job.settings, map, job.ground, base, rules);
  ASSERT_TRUE(usual && off);
  EXPECT_LT(usual->place.y(), 4.0);
  EXPECT_GT(off->place.y(), 4.2);
}

TEST(JobBeside, FromThereSoilIsLaidAsFarAcrossAsItGoes) {
  const HandMadeJob job = leaning_trench();
  const auto all = beside(job);
  ASSERT_TRUE(all);
  const JobFrame* line = &all->line;
  const JobStation& place = all->places.at(4);
  const BasePose base =
      ahead_of(base_at(*line, place, job.ground, job.settings.site.machine), *line);
  for (const double load : {1.0, 0.3}) {  // a small one finds room nearer too
    const auto dump =
        dump_place(job.settings, job.map(), job.ground, base, {0.0, false, load, line->tracks});
    ASSERT_TRUE(dump);
    EXPECT_LT(std::abs(dump->swing), 0.1);
    EXPECT_GT((dump->place.head<2>() - Eigen::Vector2d(base.x, base.y)).norm(), 6.75);
  }
}

TEST(DumpPlace, TheLimitsOfTheSwingAreThoseFromTheTracks) {
  HandMadeJob job = leaning_trench();
  const auto all = beside(job);
  ASSERT_TRUE(all);
  const Machine& machine = job.settings.site.machine;
  const BasePose base =
      ahead_of(base_at(all->line, all->places.at(4), job.ground, machine), all->line);
  const DumpRules across = {0.0, false, 1.0, all->line.tracks};
  for (const double limit : {1.7, 1.4}) {
    job.settings.site.machine.swing->lower = -limit;
    job.settings.site.machine.swing->upper = limit;
    const auto dump = dump_place(job.settings, job.map(), job.ground, base, across);
    EXPECT_EQ(dump.has_value(), limit > 0.5 * pi) << limit;
  }
}

TEST(DumpPlace, ASmallLoadFindsRoomWhereABucketfulDoesNot) {
  HandMadeJob job = leaning_trench();
  job.settings.design.dump_areas = {{DumpArea::Kind::windrow, box(-2.0, 2.0, 2.0, 3.2)}};
  const JobMap map = job.map();
  const BasePose base = {-4.0, 0.0, 0.0, 0.0};
  const auto full = dump_place(job.settings, map, job.ground, base, {0.0, true});
  const auto small = dump_place(job.settings, map, job.ground, base, {0.0, true, 0.2});
  ASSERT_TRUE(full && small);
  EXPECT_GT(full->outside, 0.0);
  EXPECT_EQ(small->outside, 0.0);
  EXPECT_LT(small->place.z(), full->place.z());
}

/// Of a trench 0.6 m deep and 1 m wide at its foot, whose sides are 1.73:1.
double design_at(double y) { return std::min(0.0, -0.6 + std::max(0.0, std::abs(y) - 0.5) / 1.73); }

TEST(LaneView, ItsFloorLiesOnAFaceHoweverItsCellsLieToThoseOfTheDesign) {
  const HandMadeJob job = leaning_trench();
  const JobMap map = job.map();
  for (const double off : {0.0, 0.012, 0.024, 0.036, 0.049}) {
    for (const double turned : {0.0, 0.2}) {
      const BasePose base = {5.0, -4.0 + off, 0.0, 0.5 * pi + turned};
      const LaneView view(job.ground, map, dig_line(base), {1.0, -1.0, 6.5, 1.0}, 0.3);
      const GroundProfile floor = view.floor(0.0);
      for (const double y : {-1.0, -0.7, 0.0, 0.7, 1.0}) {
        const double x = (y - base.y) / std::cos(turned);
        const double under = 0.15 * std::sin(turned);  // the highest of the bucket's width
        EXPECT_NEAR(floor(x), std::max(design_at(y - under), design_at(y + under)), 0.006)
            << off << " " << turned << " " << y;
      }
    }
  }
}

/// The dig of a place beside a trench that is dug to so far over its design, and its line.
struct Sweep {
  explicit Sweep(double left, bool finishing) {
    ground = dug_to(map, job.ground, left);
    const auto all = beside(job);
    line = all.value().line;
    const JobStation& place = all->places.at(4);
    base = ahead_of(base_at(line, place, job.ground, job.settings.site.machine), line);
    StepTask task{
        job.settings, map, ground, base, {{base.x, base.y + 6.0, 2.5}, 0.0, 2.5, false}, {}};
    task.lines = work_lines(line, place, job.settings.site.machine,
                            line.of(Eigen::Vector2d(base.x, base.y)), finishing);
    task.finishing = finishing;
    task.has_faces = task.has_others_beside = true;
    task.tracks = line.tracks;
    task.slack = 0.015;
    dig = best_dig(task);
  }
  HandMadeJob job = leaning_trench();
  JobMap map = job.map();
  Terrain ground;
  JobFrame line;
  BasePose base;
  std::optional<StepDig> dig;
};

TEST(JobBeside, APassSweepsDownOneFaceAndUpTheOther) {
  const Sweep sweep(0.06, true);
  ASSERT_TRUE(sweep.dig);
  double first = -9.0, last = 9.0;
  for (const DigPose& pose : sweep.dig->path.poses) {
    if (pose.phase != DigPhase::drag) continue;
    const double y = sweep.base.y + pose.bucket.x;
    EXPECT_NEAR(sweep.base.z + pose.bucket.z, design_at(y), 0.03) << y;
    first = std::max(first, y);
    last = std::min(last, y);
  }
  EXPECT_GT(first, 0.6) << "on the far face";
  EXPECT_LT(last, -1.0) << "near the top of the near one";
  EXPECT_GT(sweep.dig->change.finished, 1.0) << "a lane of 2.8 m";
}

TEST(JobBeside, ADigForVolumeTakesALayerAcross) {
  const Sweep sweep(0.35, false);
  ASSERT_TRUE(sweep.dig);
  EXPECT_GT(sweep.dig->dig.payload_mass, 150.0);
  double lowest = 0.0;
  for (const DigPose& pose : sweep.dig->path.poses) lowest = std::min(lowest, pose.bucket.z);
  EXPECT_GT(lowest, -0.6 - sweep.base.z - 0.02);
}

}  // namespace
}  // namespace excavplan::test
