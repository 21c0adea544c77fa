// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/job/site_job.hpp>

#include "base/angles.hpp"
#include "job/job_map.hpp"
#include "job/job_record.hpp"
#include "job/job_stations.hpp"
#include "job/station_place.hpp"
#include "job/trench_job.hpp"

/// @file
/// Rules by which a job goes from step to step, each on ground and at a place made by hand.

namespace excavplan::test {
namespace {

constexpr double wide = 3.6, narrow = 1.0;  // [m]
constexpr double tolerance = 0.03;          // of plain sites [m]
constexpr double not_seen = -9999.0;        // in their grids
constexpr int no_more = 1000;               // digs or passes in vain

/// A pit from x = 2 to 6 with upright walls in level ground.
struct PitSite : PlainSiteFolder {
  using Change = std::function<void(PlainSiteFolder&)>;
  PitSite(double width, double depth, const Change& change = {}) {
    site["design"]["floor_width_m"] = width;
    site["design"]["depth_m"] = depth;
    site["design"]["floor_z_at_middle_m"] = -depth;
    site["dump_areas"][0]["polygon"] = {{-4.0, 3.0}, {8.0, 3.0}, {8.0, 6.8}, {-4.0, 6.8}};
    if (change) change(*this);
  }
};

class PitJob {
 public:
  explicit PitJob(double width, double depth = 0.4, const PitSite::Change& change = {})
      : half_(0.5 * width), site_(width, depth, change) {
    const JobMap map = map_of(of_.settings, first_.bank);
    frame_ = work_frame(of_.settings, map, first_);
    beside = places_beside(of_.settings, map, first_, frame_);
    if (!beside) {
      stations = stations_of(frame_, of_.settings);
      return;
    }
    stations = stations_of(frame_, of_.settings, swept_from(beside->places, beside->line, frame_));
    stations.insert(stations.end(), beside->places.begin(), beside->places.end());
  }

  /// A scan shows the pit as deep as that; the ground beside it is level.
  void dig(const std::function<double(double, double)>& height) {
    see([&](double x, double y) {
      return x > 2.0 && x < 6.0 && std::abs(y) < half_ ? height(x, y) : 0.0;
    });
  }

  /// A scan shows the ground as high as that.
  void see(const std::function<double(double, double)>& height) {
    auto cloud = std::make_shared<Cloud>();
    for (double x = -7.975; x < 10.0; x += 0.05) {
      for (double y = -6.975; y < 7.0; y += 0.05) {
        cloud->points.emplace_back(x, y, height(x, y));
      }
    }
    Scan scan;
    scan.clouds = {cloud};
    job_.look(scan, trial_begin + 60.0);
  }

  /// Puts the machine at a station, and changes what the job remembers.
  void stand_at(
      std::size_t station, const std::function<void(JobRecord&)>& change = [](auto&) {}) {
    { const SiteJob ended = std::move(job_); }
    JobRecord record = load_record(of_.path());
    record.present.reset();
    record.station = station;
    const JobFrame& line = stations[station].is_across ? beside->line : frame_;
    record.base = base_at(line, stations[station], first_, of_.settings.site.machine);
    record.has_arrived = true;
    change(record);
    save_record(of_.path(), record);
    job_ = of_.resume();
  }

  JobStep next() { return job_.next(); }
  /// Of the present step.
  void done(double payload_mass) {
    StepReport report;
    report.payload_mass = payload_mass;
    report.time = trial_begin + 120.0;
    job_.done(job_.next().id, report);
  }
  JobRecord record() const { return load_record(of_.path()); }
  JobProgress progress() const { return job_.progress(); }

  std::vector<JobStation> stations;
  std::optional<PlacesBeside> beside;  ///< those at the end

 private:
  double half_;  ///< of the width [m]
  PitSite site_;
  TrenchJob of_{site_};
  SiteJob job_ = of_.begin();
  Terrain first_ = job_.ground();  ///< before the job
  JobFrame frame_;
};

/// What comes after so many passes from a place whose floor is still too high.
JobAction after_passes(PitJob pit, std::size_t station, int passes) {
  pit.dig([](double, double) { return -0.34; });
  pit.stand_at(station, [&](JobRecord& record) {
    record.fruitless_digs = no_more;
    record.passes_here = passes;
  });
  return pit.next().what;
}

TEST(JobRules, AWidePitTakesTwiceThePassesOfATrench) {
  EXPECT_EQ(after_passes(PitJob(wide), 4, 15), JobAction::finish);
  EXPECT_NE(after_passes(PitJob(wide), 4, 16), JobAction::finish);
  EXPECT_NE(after_passes(PitJob(narrow), 0, 8), JobAction::finish);
}

TEST(JobRules, FacesOfGroundThatWasNotDugTakeNoPasses) {
  PitJob trench(narrow, 0.4, [](PlainSiteFolder& of) {
    of.site["design"]["wall_horizontal_per_vertical"] = 1.0;
  });
  ASSERT_FALSE(trench.stations.front().is_wide);
  trench.stand_at(0);
  EXPECT_EQ(trench.next().what, JobAction::dig);
}

/// The machine cannot stand beside the trench, so that it is shaped from its line.
void keep_off_side(PlainSiteFolder& of) {
  of.site["keep_out"] = {
      {{"kind", "meadow"}, {"polygon", {{3.0, -4.2}, {5.0, -4.2}, {5.0, -3.2}, {3.0, -3.2}}}}};
}

TEST(JobRules, ATrenchWhoseWallsLeanBackTakesMore) {
  const auto lean = [](PlainSiteFolder& of) {
    of.site["design"]["wall_horizontal_per_vertical"] = 1.0;
    keep_off_side(of);
  };
  EXPECT_EQ(after_passes(PitJob(narrow, 0.4, lean), 0, 29), JobAction::finish);
  EXPECT_NE(after_passes(PitJob(narrow, 0.4, lean), 0, 30), JobAction::finish);
}

/// A trench with walls that lean back so far that its top is wide.
PitJob battered_trench(bool is_free_beside = false) {
  return PitJob(narrow, 0.55, [&](PlainSiteFolder& of) {
    of.site["design"]["wall_horizontal_per_vertical"] = 1.73;
    if (!is_free_beside) keep_off_side(of);
  });
}

TEST(JobRules, ATrenchWithFacesBesideIsDugInThinLayers) {
  PitJob trench = battered_trench();
  ASSERT_TRUE(trench.stations.front().is_wide);
  trench.stand_at(0);
  const JobStep dig = trench.next();
  ASSERT_EQ(dig.what, JobAction::dig);
  double lowest = 0.0;
  for (const DigPose& pose : dig.path.poses) lowest = std::min(lowest, pose.bucket.z);
  EXPECT_GT(lowest, -0.3);
  EXPECT_LT(lowest, -0.05);
}

TEST(JobRules, PassesBeginWhereLanesForVolumeLeaveStepsOfAFace) {
  PitJob trench = battered_trench();
  ASSERT_TRUE(trench.stations.at(4).is_again);
  trench.see([](double x, double y) {
    if (x < 2.0 || x > 6.0) return 0.0;
    const double face = (std::abs(y) - 0.5 * narrow) / 1.73;
    return face < 0.0 ? -0.55 : std::min(0.0, -0.55 + face + 0.2);
  });
  trench.stand_at(4, [](JobRecord& record) { record.fruitless_digs = no_more; });
  EXPECT_EQ(trench.next().what, JobAction::finish);
}

TEST(JobRules, FacesBesideAMachineAreSweptAcrossItsTracks) {
  PitJob trench = battered_trench(true);
  ASSERT_TRUE(trench.beside);
  trench.see([](double x, double y) {
    if (x < 2.0 || x > 6.0) return 0.0;
    const double face = (std::abs(y) - 0.5 * narrow) / 1.73;
    return std::min(0.0, -0.55 + std::max(0.0, face) + 0.07);
  });
  const auto first = std::find_if(trench.stations.begin(), trench.stations.end(),
                                  [](const JobStation& each) { return each.is_across; });
  trench.stand_at(static_cast<std::size_t>(first - trench.stations.begin()) + 2);
  int passes = 0;
  for (; trench.next().what == JobAction::finish && passes < 5; ++passes) {
    const JobStep pass = trench.next();
    EXPECT_TRUE(pass.trustworthy);
    EXPECT_NEAR(pass.swung, 0.5 * pi, 1e-6);
    EXPECT_LT(pass.dump.y(), 6.8);
    EXPECT_GT(pass.dump.y(), 3.0);
    trench.done(pass.predicted.payload_mass);
  }
  EXPECT_GT(passes, 1);
  const JobStep look = trench.next();
  ASSERT_EQ(look.what, JobAction::scan);
  EXPECT_NEAR(look.swung, 0.5 * pi, 1e-6) << "it looks where it digs";
}

TEST(JobRules, FacesAreShapedBeforeWhatFallsOffThemIsDug) {
  PitJob trench = battered_trench();
  ASSERT_TRUE(trench.stations.at(4).leaves_floor);
  double left = 0.08;  // on the faces [m]
  const auto below_faces = [&](double x, double y) {
    if (x < 2.0 || x > 6.0) return 0.0;
    const double face = (std::abs(y) - 0.5 * narrow) / 1.73;
    return std::min(0.0, -0.45 + std::max(0.0, face - 0.1 + left));
  };
  trench.see(below_faces);
  for (const std::size_t place : {4U, 5U}) {
    trench.stand_at(place);
    const JobStation& station = trench.stations[place];
    const double outermost = (place == 4 ? station.passes.front() : station.passes.back());
    const JobStep step = trench.next();
    EXPECT_EQ(step.what, JobAction::finish) << place;
    EXPECT_NEAR(step.lane, outermost - station.beside, 0.31) << place;
    const std::size_t laid_aside = trench.record().barren.size();
    EXPECT_GT(laid_aside, 0U) << "each lane along a face once";
    left += 0.001;
    trench.see(below_faces);
    EXPECT_EQ(trench.record().barren.size(), laid_aside - 1) << "not if the pass was not done";
  }
  trench.stand_at(5, [&](JobRecord& record) {
    for (const double lane : trench.stations[5].passes)
      record.barren.push_back({lane - trench.stations[5].beside, 5.0, 0.0, true});
  });
  EXPECT_EQ(trench.next().what, JobAction::dig);
  trench.stand_at(4, [&](JobRecord& record) {
    for (const double lane : trench.stations[4].passes)
      record.barren.push_back({lane - trench.stations[4].beside, 5.0, 0.0, true});
  });
  EXPECT_EQ(trench.next().what, JobAction::move) << "the soil is left to the other side";
}

/// What comes after the last place before the far end is dug from beyond, where a strip there is
/// too high and the rest so far, in tolerances.
JobStep after_last_place(double width, double above) {
  PitJob pit(width);
  pit.dig([&](double x, double y) {
    const bool is_strip = x > 5.5 && x < 5.6 && y < 0.1 * width;
    return -0.4 + (is_strip ? 1.3 : above) * tolerance;
  });
  EXPECT_EQ(pit.progress().p95 > 0.9 * tolerance, above > 0.9);
  EXPECT_TRUE(pit.progress().is_finished);
  pit.stand_at(pit.stations.size() - 1,
               [](JobRecord& record) { record.fruitless_digs = record.fruitless = no_more; });
  return pit.next();
}

TEST(JobRules, AWidePitIsDugFromBeyondUnlessItIsSurelyInShape) {
  const JobStep step = after_last_place(wide, 0.93);
  EXPECT_EQ(step.what, JobAction::move);
  EXPECT_GT(step.base.x, 7.0);
  EXPECT_EQ(after_last_place(wide, 0.88).what, JobAction::stop);
  EXPECT_EQ(after_last_place(narrow, 0.93).what, JobAction::stop);
}

TEST(JobRules, ADigThatLiftsLessThanAThirdOfWhatWasForetoldIsFruitless) {
  PitJob trench(narrow);
  for (const double share : {0.5, 0.2}) {
    trench.stand_at(0);
    const JobStep dig = trench.next();
    ASSERT_EQ(dig.what, JobAction::dig);
    ASSERT_GT(dig.predicted.payload_mass, 100.0);
    trench.done(share * dig.predicted.payload_mass);
    EXPECT_EQ(trench.record().fruitless_digs, share < 0.3 ? 1 : 0) << share;
  }
}

/// Whether a strip of the floor that is too high is shaped from the first place after so many
/// stalls.
bool is_shaped(double from, double to, int stalls) {
  PitJob trench(narrow, 0.4, [](PlainSiteFolder& of) {
    of.site["design"]["origin_m"] = {-1.0, 0.0};
    of.site["start_pose"]["x"] = -3.2;
  });
  trench.see([&](double x, double y) {
    if (x < -1.0 || x > 3.0 || std::abs(y) > 0.5 * narrow) return 0.0;
    return x > from && x < to ? -0.34 : -0.4;
  });
  trench.stand_at(0, [&](JobRecord& record) {
    record.fruitless_digs = no_more;
    record.progress.stalls = stalls;
  });
  return trench.next().what == JobAction::finish;
}

TEST(JobRules, WhereADigStalledTheFarEndIsShapedFromBeyond) {
  EXPECT_TRUE(is_shaped(2.3, 3.0, 0));
  EXPECT_FALSE(is_shaped(2.3, 3.0, 1));
  EXPECT_TRUE(is_shaped(0.5, 2.0, 1)) << "what is nearer is not the far end";
}

TEST(JobRules, APassKeepsItsLoadWhileTheBucketHasRoomForMore) {
  for (const double held : {0.0, 0.39}) {
    PitJob trench(narrow);
    trench.dig([](double, double) { return -0.36; });
    trench.stand_at(0, [&](JobRecord& record) {
      record.fruitless_digs = no_more;
      if (held > 0.0)
        record.carried = CarriedLoad{held * heaped_capacity(zx120()), {-0.5, 1.8, -0.4, 0.0}};
    });
    const JobStep pass = trench.next();
    ASSERT_EQ(pass.what, JobAction::finish) << held;
    EXPECT_EQ(pass.keeps_load, held == 0.0) << held;
  }
}

TEST(JobRules, AMachineWhoseSoilHasRoomGoesOnToItsNextPlace) {
  PitJob pit(wide);
  pit.stand_at(0, [](JobRecord& record) {
    record.base.x -= 0.4;
    record.fruitless_digs = no_more;
  });
  EXPECT_EQ(pit.next().what, JobAction::move);
  EXPECT_GT(pit.record().station, 0U);
}

TEST(JobRules, AMachineLeavesWhereItsDigsBroughtTheEdgeNear) {
  for (const double away : {0.3, 1.5}) {
    PitJob pit(wide, 1.0);
    pit.stand_at(0);
    const double edge = pit.record().base.x + zx120().track_front + away;
    pit.dig([&](double x, double) { return x > edge && x < edge + 1.0 ? -1.0 : 0.0; });
    pit.stand_at(0);
    EXPECT_EQ(pit.next().what, away < 1.0 ? JobAction::move : JobAction::dig) << away;
  }
}

/// A bite of some 50 kg would still come off the bench.
TEST(JobRules, ABenchIsLeftForTheNextWhereOnlyABiteWouldTakeIt) {
  PitJob pit(wide, 1.2);
  pit.dig([](double x, double) { return x > 3.0 ? -0.28 : 0.0; });
  pit.stand_at(0);
  const JobStep step = pit.next();
  EXPECT_EQ(step.what, JobAction::dig);
  EXPECT_EQ(pit.record().bench, 1);
  EXPECT_GT(step.predicted.payload_mass, 300.0);
}

/// Of soil that is believed to be so many times as strong, after so many digs in vain.
std::function<void(JobRecord&)> in_hard_soil(double factor, int digs_in_vain) {
  return [=](JobRecord& record) {
    record.learning.strength = {std::log(factor), 0.01};
    record.fruitless_digs = digs_in_vain;
  };
}

TEST(JobRules, SoilIsHopedToBeMuchSofterThanBelievedOnce) {
  PitJob trench(narrow);
  trench.stand_at(0, in_hard_soil(12.0, 0));
  EXPECT_EQ(trench.next().what, JobAction::dig);
  trench.stand_at(0, in_hard_soil(12.0, 1));
  EXPECT_NE(trench.next().what, JobAction::dig);
}

/// A trench of 5 m, and how far the machine goes from its first place.
double way_after_stalls(int stalls, double gone) {
  PitJob trench(narrow, 0.4, [](PlainSiteFolder& of) {
    of.site["design"]["length_m"] = 5.0;
    of.site["design"]["origin_m"] = {1.0, 0.0};
  });
  const double from = trench.stations[0].along, to = trench.stations[1].along;
  EXPECT_GT(from - to, 1.9);
  trench.stand_at(gone > 0.0 ? 1 : 0, [&](JobRecord& record) {
    record.fruitless_digs = no_more;
    record.fruitless = no_more;
    record.progress.stalls = stalls;
    record.base.x += gone > 0.0 ? from - gone - to : 0.0;
  });
  const double at = trench.record().base.x;
  const JobStep step = trench.next();
  EXPECT_EQ(step.what, JobAction::move);
  return (at - step.base.x) / (from - to);
}

TEST(JobRules, ARowOfHardSoilIsGoneAlongInShorterMoves) {
  EXPECT_NEAR(way_after_stalls(1, 0.0), 1.0, 1e-6);
  EXPECT_NEAR(way_after_stalls(2, 0.0), 0.5, 1e-6);
  EXPECT_GT(way_after_stalls(2, 1.0), 0.4) << "the rest of the way to the second place";
}

/// A cut with a face to its left, from a machine at its foot.
void with_face_ahead(PlainSiteFolder& site) {
  site.site["design"] = {{"kind", "slope cut"},        {"length_m", 5.0},
                         {"floor_width_m", 3.5},       {"face_horizontal_per_vertical", 1.5},
                         {"origin_m", {-1.5, 3.5}},    {"heading_rad", 0.0},
                         {"floor_z_at_middle_m", -0.3}};
  site.site["start_pose"] = {{"x", 1.0}, {"y", -2.5}, {"heading_rad", 0.0}};
  site.site["dump_areas"] = {
      {{"kind", "windrow"}, {"polygon", {{-6.0, -4.0}, {-2.2, -4.0}, {-2.2, 3.0}, {-6.0, 3.0}}}},
      {{"kind", "windrow"}, {"polygon", {{4.2, -4.0}, {8.0, -4.0}, {8.0, 3.0}, {4.2, 3.0}}}}};
}

TEST(JobRules, SmallBitesAreLeftToTheRowThatMakesPasses) {
  PitJob slope(narrow, 0.3, with_face_ahead);
  ASSERT_TRUE(slope.stations.front().leaves_passes);
  slope.stand_at(0, in_hard_soil(5.0, 1));
  EXPECT_EQ(slope.next().what, JobAction::move);
  const auto again = std::find_if(slope.stations.begin(), slope.stations.end(),
                                  [](const JobStation& each) { return each.is_again; });
  slope.stand_at(static_cast<std::size_t>(again - slope.stations.begin()), in_hard_soil(5.0, 1));
  EXPECT_EQ(slope.next().what, JobAction::dig);
}

TEST(JobRules, WhatTwoRowsLeaveOfAFaceIsShapedOnceMoreAtTheEnd) {
  constexpr std::size_t last_look = 3;  // of four after all places
  for (const double left : {0.0, 0.08}) {
    PitJob slope(narrow, 0.3, with_face_ahead);
    slope.see([left](double x, double y) {
      if (x < -1.5 || x > 3.5 || y < 0.0) return 0.0;
      const double design = std::min(-0.3 + std::max(0.0, y - 3.5) / 1.5, 0.0);
      return x > 1.0 && x < 2.0 ? std::min(design + left, 0.0) : design;
    });
    slope.stand_at(0,
                   [&](JobRecord& record) { record.station = slope.stations.size() + last_look; });
    const JobStep step = slope.next();
    if (left == 0.0) {
      EXPECT_EQ(step.what, JobAction::stop);
      continue;
    }
    EXPECT_EQ(step.what, JobAction::move);
    EXPECT_NEAR(step.base.x, 1.5, 0.6);
    EXPECT_TRUE(slope.record().station > slope.stations.size() + last_look);
  }
}

TEST(JobRules, NoPlaceOfAFaceIsGoneToAgainWhereItsGroundIsDug) {
  constexpr std::size_t looks = 4, of_last_row = 5;  // before the places of the first one again
  PitJob slope(narrow, 0.3, with_face_ahead);
  slope.see([](double x, double y) {
    if (x < -1.5 || x > 3.5 || y < 0.0) return 0.0;
    const double design = std::min(-0.3 + std::max(0.0, y - 3.5) / 1.5, 0.0);
    return y > 3.3 ? std::min(design + 0.2, 0.0) : design;
  });
  ASSERT_EQ(slope.stations.size(), 4 * of_last_row) << "two rows, each twice";
  slope.stand_at(0, [&](JobRecord& record) {
    record.station = slope.stations.size() + looks + of_last_row - 1;
    record.fruitless_digs = record.fruitless = no_more;
  });
  EXPECT_EQ(slope.next().what, JobAction::stop);
}

/// The dig from where the front swings over ground beside the pit that no scan saw, from here on.
struct BesideUnseen : PitJob {
  explicit BesideUnseen(double from)
      : PitJob(wide, 1.2, [from](PlainSiteFolder& of) {
          of.height = [from](double x, double y) {
            return x > from && y > 1.9 && y < 2.9 ? not_seen : 0.0;
          };
        }) {
    stand_at(0);
    step = next();
    laid_aside = record().barren.size();
  }
  JobStep step;
  std::size_t laid_aside = 0;
};

TEST(JobRules, ADigThatIsNotTrustedIsLaidAsideForAnother) {
  const BesideUnseen none(9.0), far(5.6);
  EXPECT_TRUE(none.step.trustworthy);
  EXPECT_EQ(none.laid_aside, 0U);
  EXPECT_TRUE(far.step.trustworthy);
  EXPECT_EQ(far.laid_aside, 1U);
  EXPECT_NE(far.step.path.start_x, none.step.path.start_x);
}

TEST(JobRules, ADigThatIsNotTrustedIsOfferedIfThereIsNoOther) {
  const BesideUnseen all(5.0);
  EXPECT_EQ(all.step.what, JobAction::dig);
  EXPECT_FALSE(all.step.trustworthy);
  EXPECT_EQ(all.laid_aside, 0U);
}

/// Steps of a job in a pit beside a truck, whose machine always comes to stand out of reach of it.
std::vector<JobStep> steps_out_of_reach() {
  const PitSite site(wide, 0.4);
  TrenchJob of{site, truth_cell};
  of.settings.design.dump_areas.clear();
  const SitePolygon bed = {{-6.0, 7.5}, {8.0, 7.5}, {8.0, 10.0}, {-6.0, 10.0}};
  of.settings.design.truck = JobTruck{bed, 2.0, 9000.0};
  SiteJob job = of.begin();
  std::vector<JobStep> steps = {job.next()};
  while (steps.back().what == JobAction::move && steps.size() < 200) {
    StepReport report;
    report.base = steps.back().base;
    report.base->y -= 1.5;
    job.done(steps.back().id, report);
    steps.push_back(job.next());
  }
  return steps;
}

TEST(JobRules, AMachineThatMissesEveryPlaceGoesToEachAFewTimesAndStops) {
  const std::vector<JobStep> steps = steps_out_of_reach();
  int times = 0, rounds = 0;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const BasePose& base = steps[i].base;
    const bool is_same = i > 0 && base.x == steps[i - 1].base.x && base.y == steps[i - 1].base.y;
    times = is_same ? times + 1 : 1;
    ASSERT_LE(times, 4);
    const bool was_beyond = i > 0 && steps[i - 1].base.x > 7.0;
    if (base.x > 7.0 && !was_beyond) ++rounds;
  }
  EXPECT_EQ(rounds, 3) << "beyond the far end: once, and twice more in turn with the near end";
  EXPECT_EQ(steps.back().what, JobAction::stop);
  const std::string reason = "what is left cannot be dug, as its soil has no place within reach: ";
  EXPECT_EQ(steps.back().reason.rfind(reason, 0), 0U) << steps.back().reason;
}

}  // namespace
}  // namespace excavplan::test
