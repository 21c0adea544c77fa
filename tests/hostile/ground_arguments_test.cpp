// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Hostile maps, terrains, surfaces, scenes and sensors: the rooms ground and simulation.

#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/fallback.hpp>
#include <excavplan/change/blocks.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/resampling.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/sensing/scene.hpp>

#include "base/non_finite.hpp"
#include "support/hostile.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::answers;
using test::finite;
using test::loam;
using test::refuses;
using test::zx120;

/// Hilly ground of 40 x 40 cells, with a pit and a heap if it was dug.
HeightMap hills(bool dug) {
  HeightMap map = flat_ground({-1.0, -1.0, 1.0, 1.0}, 0.05);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      const double x = map.x(col), y = map.y(row);
      map.z(row, col) =
          0.02 * std::sin(7.0 * x) + 0.02 * std::cos(9.0 * y) + 0.002 * std::sin(1e3 * x * y);
      if (!dug) continue;
      map.z(row, col) -= 0.2 * std::exp(-20.0 * ((x + 0.5) * (x + 0.5) + y * y));
      map.z(row, col) += 0.25 * std::exp(-20.0 * ((x - 0.5) * (x - 0.5) + y * y));
    }
  }
  return map;
}

Surface surface_of(const HeightMap& map) {
  return {map, Eigen::ArrayXXd::Constant(map.z.rows(), map.z.cols(), 1e-6),
          Eigen::ArrayXXi::Constant(map.z.rows(), map.z.cols(), 4)};
}

bool sound(const VolumeChange& change) {
  const double sum = change.before.value + change.after.value + change.before.sd + change.after.sd;
  return finite(sum) && finite(change.errors.total());
}

using MapMembers = std::vector<test::Member<HeightMap>>;
MapMembers map_members() {
  return {{"cell", [](HeightMap& m) -> double& { return m.cell_size; }},
          {"origin.x", [](HeightMap& m) -> double& { return m.origin.x(); }},
          {"origin.y", [](HeightMap& m) -> double& { return m.origin.y(); }},
          {"z", [](HeightMap& m) -> double& { return m.z(7, 9); }}};
}

std::vector<test::Function<HeightMap>> map_functions() {
  return {
      {"height_at", [](const HeightMap& m) { return !std::isinf(height_at(m, 0.0, 0.0)); }},
      {"resampled",
       [](const HeightMap& m) {
         return !resampled(m, {-0.5, -0.5, 0.5, 0.5}, 0.1, 0.2).z.isInf().any();
       }},
      {"unseen_area", [](const HeightMap& m) { return unseen_area(m) >= 0.0; }},
      {"boom_plane_profile",
       [](const HeightMap& m) {
         boom_plane_profile(m)(0.1);
         return true;
       }},
      {"profile_under_bucket",
       [](const HeightMap& m) {
         profile_under_bucket(m, zx120())(0.1);
         return true;
       }},
      {"align",
       [](const HeightMap& m) {
         return finite(align(surface_of(m), surface_of(hills(true))).motion);
       }},
      {"measure_change", [](const HeightMap& m) { return sound(measure_change(m, hills(true))); }},
      {"measure_change of areas",
       [](const HeightMap& m) {
         return sound(measure_change(HeightMapPair{m, hills(true)}, {hills(false), m}));
       }},
      {"realigned",
       [](const HeightMap& m) {
         Alignment moved;
         moved.motion[0] = 0.01;
         return !realigned(m, moved).z.isInf().any();
       }},
      {"scan by a camera",
       [](const HeightMap& m) {
         DepthCamera camera = camera_above({0.0, 0.0}, 0.0);
         camera.width = 32;
         camera.height = 24;
         for (const auto& point : scan_surface(m, camera, 1)) {
           if (!finite(point)) return false;
         }
         return true;
       }},
      {"scan by a lidar", [](const HeightMap& m) {
         Lidar lidar;
         lidar.angle_step = {0.1, 0.1};
         for (const auto& point : scan_surface(m, lidar, 1)) {
           if (!finite(point)) return false;
         }
         return true;
       }}};
}

TEST(HostileMap, NumbersAreRefusedOrHarmless) {
  test::make_hostile(hills(false), map_members(), map_functions());
}

TEST(HostileMap, EmptyOnesAreRefused) {
  HeightMap moved = hills(false);
  const HeightMap taken = std::move(moved);
  for (const auto& [name, call] : map_functions()) {
    if (name == "height_at") continue;
    EXPECT_TRUE(refuses([&, &call = call] { call(HeightMap{}); }, "map is empty")) << name;
    EXPECT_TRUE(refuses([&, &call = call] { call(moved); }, "map is empty")) << name;
  }
  EXPECT_TRUE(std::isnan(height_at({}, 0.0, 0.0)));
  EXPECT_TRUE(std::isnan(height_at(taken, nan, infinity)));
  EXPECT_FALSE(same_grid(taken, {}));
}

TEST(HostileMap, NewOnesAreBounded) {
  for (const double bad : test::hostile_numbers) {
    const auto flat = [](const Rectangle& extent, double cell, double height) {
      return answers([&] {
        const HeightMap map = flat_ground(extent, cell, height);
        return map.z.size() > 0 && map.z.size() <= 100000000 && !map.z.isInf().any();
      });
    };
    EXPECT_TRUE(flat({bad, 0.0, 2.0, 1.0}, 0.5, 0.0)) << bad;
    EXPECT_TRUE(flat({0.0, 0.0, 2.0, bad}, 0.5, 0.0)) << bad;
    EXPECT_TRUE(flat({0.0, 0.0, 2.0, 1.0}, bad, 0.0)) << bad;
    EXPECT_TRUE(flat({0.0, 0.0, 2.0, 1.0}, 0.5, bad)) << bad;
    EXPECT_TRUE(answers([&] {
      return resampled(hills(false), {-0.5, -0.5, 0.5, 0.5}, 0.1, bad).z.size() > 0;
    }));
  }
  EXPECT_TRUE(refuses(
      [] {
        resampled(hills(false), {0, 0, 1, 1}, 0.1, nan);
      },
      "widest gap is nan"));
  EXPECT_TRUE(refuses([] { flat_ground({0, 0, 1e4, 1e4}, 1e-3); }, "cells, most are"));
}

TEST(HostileChange, SurfacesThatDoNotFit) {
  const SurfacePair good = {surface_of(hills(false)), surface_of(hills(true)), {}};
  ASSERT_TRUE(sound(measure_change(good)));
  const auto refused = [&](const std::function<void(SurfacePair&)>& spoil, const char* what) {
    SurfacePair bad = good;
    spoil(bad);
    EXPECT_TRUE(refuses([&] { measure_change(bad); }, what));
    EXPECT_TRUE(refuses([&] { measure_change(bad, bad); }, what));
  };
  refused([](SurfacePair& s) { s.after.height.z.resize(3, 3); }, "");
  refused([](SurfacePair& s) { s.before.variance.resize(3, 3); },
          "surface before: variance has 3 x 3");
  refused([](SurfacePair& s) { s.after.points.resize(3, 40); }, "surface after: points has 3 x 40");
  refused([](SurfacePair& s) { s.after.seen_from.resize(1, 1); }, "seen_from");
  refused([](SurfacePair& s) { s.before.sensors = {{0.0, nan, 2.0}}; }, "place of a sensor");
  refused([](SurfacePair& s) { s.before.sensors.resize(40, {0, 0, 2}); }, "number of sensors");
  refused([](SurfacePair& s) { s.before.height.z(3, 3) = infinity; }, "a height [m] is inf");
  refused([](SurfacePair& s) { s.alignment.motion[2] = nan; }, "alignment");
  refused([](SurfacePair& s) { s.alignment.left(2, 2) = infinity; }, "alignment");
  const SurfacePair none;
  EXPECT_TRUE(refuses([&] { measure_change(none); }, "map is empty"));
  EXPECT_TRUE(refuses([] { align({}, {}); }, "map is empty"));
  EXPECT_TRUE(refuses(
      [&] {
        measure_change(hills(false), flat_ground({0, 0, 2, 2}, 0.05));
      },
      "must be on one grid"));
}

TEST(HostileChange, LayersMayBeMissing) {
  std::vector<unsigned> choices = {0, 63};
  for (unsigned layer = 0; layer < 6; ++layer) {
    choices.push_back(1U << layer);
    choices.push_back(63U ^ (1U << layer));
  }
  for (const unsigned given : choices) {
    for (std::size_t sensors = 0; sensors < 3; ++sensors) {
      const auto scanned = [&](bool dug) {
        Surface surface{hills(dug), {}, {}};
        const Eigen::Index rows = surface.height.z.rows();
        const Eigen::Index cols = surface.height.z.cols();
        const auto is_given = [given](unsigned layer) { return ((given >> layer) & 1) != 0; };
        if (is_given(0)) surface.variance = Eigen::ArrayXXd::Constant(rows, cols, 1e-6);
        if (is_given(1)) surface.points = Eigen::ArrayXXi::Constant(rows, cols, 4);
        if (is_given(2)) surface.seen_from = Eigen::ArrayXXi::Constant(rows, cols, 1);
        if (is_given(3)) surface.doubt = Eigen::ArrayXXf::Zero(rows, cols);
        if (is_given(4)) surface.outlier_bias = Eigen::ArrayXXf::Zero(rows, cols);
        if (is_given(5)) surface.below = Eigen::ArrayXXf::Constant(rows, cols, 0.001F);
        for (std::size_t i = 0; i < sensors; ++i) {
          surface.sensors.emplace_back(-3.0 + 6.0 * static_cast<double>(i), 0.0, 2.0);
        }
        return surface;
      };
      EXPECT_TRUE(sound(measure_change({scanned(false), scanned(true), {}})))
          << "layers " << given << ", " << sensors << " sensors";
    }
  }
}

TEST(HostileChange, NothingChangedOrAllUnknown) {
  const HeightMap same = hills(false);
  const VolumeChange none = measure_change(same, same);
  EXPECT_TRUE(sound(none));
  EXPECT_FALSE(bulking_factor(none).has_value());
  EXPECT_NO_THROW(assess_blocks({same}, none));
  HeightMap flat = same;
  flat.z.setConstant(0.0);
  EXPECT_TRUE(sound(measure_change(flat, flat)));
  EXPECT_TRUE(sound(measure_change(surface_of(flat).height, same)));
  HeightMap unseen = same;
  unseen.z.setConstant(nan);
  EXPECT_TRUE(refuses([&] { measure_change(same, unseen); }, "share 0 known cells"));
}

TEST(HostileChange, Options) {
  const std::vector<test::Member<ChangeOptions>> change = {
      {"detection", [](ChangeOptions& o) -> double& { return o.detection; }},
      {"growth", [](ChangeOptions& o) -> double& { return o.growth; }},
      {"min_zone_area", [](ChangeOptions& o) -> double& { return o.min_zone_area; }},
      {"margin", [](ChangeOptions& o) -> double& { return o.margin; }},
      {"spill_distance", [](ChangeOptions& o) -> double& { return o.spill_distance; }},
      {"max_unknown_share", [](ChangeOptions& o) -> double& { return o.max_unknown_share; }},
      {"refused", [](ChangeOptions& o) -> double& { return o.refused_unknown_share; }},
      {"dig_area", [](ChangeOptions& o) -> double& { return o.dig_area->x_max; }},
      {"dump_area", [](ChangeOptions& o) -> double& { return o.dump_area->y_min; }}};
  ChangeOptions areas;
  areas.dig_area = {-1.0, -1.0, 0.0, 1.0};
  areas.dump_area = {0.0, -1.0, 1.0, 1.0};
  const HeightMap before = hills(false), after = hills(true);
  test::make_hostile<ChangeOptions>(areas, change,
                                    {{"measure_change", [&](const ChangeOptions& o) {
                                        return sound(measure_change(before, after, o));
                                      }}});
  const std::vector<test::Member<AlignmentOptions>> alignment = {
      {"shift", [](AlignmentOptions& o) -> double& { return o.shift_prior; }},
      {"turn", [](AlignmentOptions& o) -> double& { return o.turn_prior; }},
      {"steepest", [](AlignmentOptions& o) -> double& { return o.steepest; }}};
  test::make_hostile<AlignmentOptions>(
      {}, alignment, {{"align", [&](const AlignmentOptions& o) {
                         return finite(align(surface_of(before), surface_of(after), o).motion);
                       }}});
  const VolumeChange found = measure_change(before, after);
  const std::vector<test::Member<BlockOptions>> blocks = {
      {"repose", [](BlockOptions& o) -> double& { return o.angle_of_repose; }},
      {"noise", [](BlockOptions& o) -> double& { return *o.noise_sd; }},
      {"voids", [](BlockOptions& o) -> double& { return o.packed_voids; }},
      {"voids_sd", [](BlockOptions& o) -> double& { return o.packed_voids_sd; }}};
  BlockOptions with_noise;
  with_noise.noise_sd = 0.002;
  test::make_hostile<BlockOptions>(with_noise, blocks,
                                   {{"assess_blocks", [&](const BlockOptions& o) {
                                       return finite(assess_blocks({after}, found, o).score);
                                     }}});
}

TEST(HostileChange, ResultsThatWereChanged) {
  const HeightMap before = hills(false), after = hills(true);
  const VolumeChange found = measure_change(before, after);
  const auto refused = [&](const std::function<void(VolumeChange&)>& spoil, const char* what) {
    VolumeChange bad = found;
    spoil(bad);
    EXPECT_TRUE(refuses([&] { assess_blocks({after}, bad); }, what));
  };
  refused([](VolumeChange& c) { c.areas.clear(); }, "one map for each");
  refused([](VolumeChange& c) { c.areas[0].zone.resize(2, 2); }, "zone of an area");
  refused([](VolumeChange& c) { c.areas[0].zone(0, 0) = 99; }, "zone of an area");
  refused([](VolumeChange& c) { c.areas[0].noise_sd = nan; }, "noise of an area");
  refused([](VolumeChange& c) { c.areas[0].difference.z(0, 0) = infinity; }, "height");
  refused([](VolumeChange& c) { c.after.value = nan; }, "volume after");
  EXPECT_TRUE(refuses([&] { assess_blocks({HeightMap{}}, found); }, "grid of its area"));
  EXPECT_TRUE(refuses([&] { assess_blocks({}, VolumeChange{}); }, "at least one"));
  for (const double bad : {nan, infinity, -1.0, 0.0}) {
    VolumeChange change;
    change.before.value = bad;
    change.after.value = 1.0;
    EXPECT_FALSE(bulking_factor(change).has_value());
    EXPECT_FALSE(bulking_interval(change).has_value());
    EXPECT_EQ(bulking_errors(change).scans, 0.0);
    EXPECT_TRUE(finite(variance_by_readings(change)));
  }
  VolumeChange unseen = found;
  unseen.readings = {Reading{{ChangeKind::pressed}, "", 1.0, {1.2, 0.1}}};
  EXPECT_EQ(variance_by_readings(unseen), 0.0);
  EXPECT_STREQ(name(static_cast<ZoneKind>(99)), "other");
  EXPECT_STREQ(name(static_cast<ChangeKind>(99)), "water");
}

// ---- terrains -----------------------------------------------------------------------------------

const Terrain& ground_to_dig() {
  static const Terrain terrain = level_planning_ground(zx120(), 0.1);
  return terrain;
}
const DigPath& path() {
  static const DigPath laid = std::get<DigPath>(
      make_dig_path_anywhere(zx120(), paper_fixed_path(), boom_plane_profile(ground_to_dig())));
  return laid;
}

bool sound(const DigResult& result) {
  return finite(result.payload_mass) && finite(result.energy.total) && finite(result.peak_force) &&
         !result.patch.bank.isInf().any() && !result.patch.loose.isInf().any();
}

TEST(HostileTerrain, NumbersAreRefusedOrHarmless) {
  Terrain uneven = ground_to_dig();
  uneven.bank_void_ratio = Eigen::ArrayXXd::Constant(uneven.loose.rows(), uneven.loose.cols(), 0.7);
  uneven.loose_void_ratio = uneven.bank_void_ratio;
  const Eigen::Index row = uneven.loose.rows() / 2;
  const auto col = static_cast<Eigen::Index>((path().start_x - 0.5 - uneven.bank.origin.x()) /
                                             uneven.bank.cell_size);
  const std::vector<test::Member<Terrain>> members = {
      {"cell", [](Terrain& t) -> double& { return t.bank.cell_size; }},
      {"origin", [](Terrain& t) -> double& { return t.bank.origin.x(); }},
      {"bank", [=](Terrain& t) -> double& { return t.bank.z(row, col); }},
      {"corner", [=](Terrain& t) -> double& { return t.bank.z(0, 0); }},
      {"loose", [=](Terrain& t) -> double& { return t.loose(row, col); }},
      {"bank ratio", [=](Terrain& t) -> double& { return t.bank_void_ratio(row, col); }},
      {"loose ratio", [=](Terrain& t) -> double& { return t.loose_void_ratio(row, col); }}};
  std::vector<test::Function<Terrain>> functions = {
      {"slope", [](const Terrain& t) { return !std::isinf(boom_plane_slope(t, 2.0)); }},
      {"volumes",
       [=](const Terrain& t) {
         return !std::isnan(height_map_volumes(t, t, {5.0, 0.0}).excavated);
       }},
      {"evaluate_dig", [](const Terrain& t) {
         const auto simulator = default_simulator().make(zx120(), loam(), 40.0);
         const auto dig = evaluate_dig(zx120(), *simulator, t, paper_fixed_path());
         return dig.index() == 1 || finite(std::get<PlannedDig>(dig).payload_mass);
       }}};
  for (const SimulatorKind& kind : simulator_kinds()) {
    functions.push_back({kind.name, [make = kind.make](const Terrain& t) {
                           return sound(make(zx120(), loam(), 40.0)->dig(t, path()));
                         }});
  }
  test::make_hostile(uneven, members, functions);
}

TEST(HostileTerrain, LayersOfOtherSizesAreRefused) {
  Terrain thin = ground_to_dig(), wide = ground_to_dig(), dense = ground_to_dig(),
          moved = ground_to_dig();
  thin.loose.resize(0, 0);
  wide.loose.setZero(1000, 1000);
  dense.bank_void_ratio.setConstant(2, 2, 0.7);
  const Terrain taken = std::move(moved);
  const auto simulator = default_simulator().make(zx120(), loam(), 40.0);
  for (const Terrain& bad : {Terrain{}, thin, wide, dense, moved}) {
    EXPECT_TRUE(refuses([&] { simulator->dig(bad, path()); }, "dig: "));
    EXPECT_TRUE(refuses([&] { boom_plane_profile(bad); }, "ground profile: "));
    EXPECT_TRUE(refuses([&] { start_profile(bad, zx120()); }, "ground profile: "));
    EXPECT_TRUE(refuses([&] { boom_plane_slope(bad, 2.0); }, "ground profile: "));
    EXPECT_TRUE(refuses(
        [&] {
          height_map_volumes(bad, ground_to_dig(), {5, 0});
        },
        "volumes, before: "));
    EXPECT_TRUE(refuses(
        [&] {
          height_map_volumes(ground_to_dig(), bad, {5, 0});
        },
        "volumes, after: "));
    EXPECT_TRUE(refuses([&] { heap_slope(ground_to_dig(), bad, {5, 0}); }, "volumes, after: "));
    EXPECT_TRUE(refuses([&] { evaluate_dig(zx120(), *simulator, bad, paper_fixed_path()); }));
    EXPECT_TRUE(refuses([&] { run_scene(zx120(), loam(), 40.0, bad); }, "ground of a scene: "));
  }
  EXPECT_TRUE(refuses([&] { static_cast<void>(thin.surface()); }, "loose layer"));
  const Terrain other = level_planning_ground(zx120(), 0.2);
  EXPECT_TRUE(refuses([&] { height_map_volumes(ground_to_dig(), other, {5, 0}); }, "one grid"));
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_TRUE(refuses(
        [&] {
          height_map_volumes(ground_to_dig(), ground_to_dig(), {bad, 0});
        },
        "dump point"));
    EXPECT_TRUE(refuses(
        [&] {
          height_map_volumes(ground_to_dig(), ground_to_dig(), {5, 0}, bad);
        },
        "radius"));
    EXPECT_TRUE(refuses([&] { boom_plane_slope(ground_to_dig(), bad); }, "from x"));
    EXPECT_TRUE(refuses([&] { sloped_planning_ground(zx120(), bad, 0.1); }, "slope"));
    EXPECT_TRUE(refuses([&] { level_planning_ground(zx120(), bad); }, "cell"));
    EXPECT_TRUE(refuses([&] { scene_extent(zx120(), {bad, 0.0}); }, "dump point"));
  }
  EXPECT_TRUE(refuses([] { swept_strip(zx120(), {}); }, "no pose"));
  EXPECT_TRUE(std::isnan(swept_height({}, 1.0)));
  EXPECT_TRUE(std::isnan(swept_height(path(), nan)));
}

TEST(HostileTerrain, PatchesOfAnotherGridAreRefused) {
  TerrainPatch good;
  good.bank = good.loose = Eigen::ArrayXXd::Zero(3, 4);
  const auto refused = [&](const std::function<void(TerrainPatch&)>& spoil) {
    TerrainPatch bad = good;
    spoil(bad);
    Terrain terrain = ground_to_dig();
    return refuses([&] { apply(bad, terrain); }, "patch");
  };
  constexpr Eigen::Index most = std::numeric_limits<Eigen::Index>::max();
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.row = -1; }));
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.col = 1000; }));
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.col = most; }));
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.row = most - 1; }));
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.loose.resize(3, 3); }));
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.bank.setZero(900, 900); }));
  EXPECT_TRUE(refused([](TerrainPatch& p) { p.loose_void_ratio.setConstant(3, 4, 0.7); }));
  Terrain terrain = ground_to_dig();
  EXPECT_NO_THROW(apply({}, terrain));
  EXPECT_NO_THROW(apply(good, terrain));
  Terrain empty;
  EXPECT_TRUE(refuses([&] { apply(good, empty); }, "patch"));
}

TEST(HostileTerrain, PathsAndOptionsOfADig) {
  for (const SimulatorKind& kind : simulator_kinds()) {
    const auto simulator = kind.make(zx120(), loam(), 40.0);
    for (const double bad : {nan, infinity, -infinity, 1e300}) {
      const std::vector<std::function<void(DigPose&)>> spoils = {
          [=](DigPose& p) { p.bucket.x = bad; }, [=](DigPose& p) { p.bucket.z = bad; },
          [=](DigPose& p) { p.joints[1] = bad; }};
      for (const auto& spoil : spoils) {
        DigPath broken = path();
        spoil(broken.poses[5]);
        EXPECT_TRUE(refuses([&] { simulator->dig(ground_to_dig(), broken); }, "dig: "))
            << kind.name;
      }
      DigPath broken = path();
      broken.poses[5].bucket.floor_angle = bad;
      EXPECT_TRUE(answers([&] { return sound(simulator->dig(ground_to_dig(), broken)); }))
          << kind.name;
      DigOptions options;
      options.dump_at = Eigen::Vector2d(bad, 0.0);
      EXPECT_TRUE(refuses([&] { simulator->dig(ground_to_dig(), path(), options); }, "dump point"));
      options = {};
      options.give_up_below = bad;
      EXPECT_TRUE(answers([&] { return sound(simulator->dig(ground_to_dig(), path(), options)); }));
    }
    DigPath phase = path();
    phase.poses[2].phase = static_cast<DigPhase>(99);
    EXPECT_TRUE(refuses([&] { simulator->dig(ground_to_dig(), phase); }, "of a phase"));
    DigPath deep = path();
    for (DigPose& pose : deep.poses) pose.bucket.z -= 50.0;
    EXPECT_TRUE(answers([&] { return sound(simulator->dig(ground_to_dig(), deep)); }));
    EXPECT_TRUE(refuses([&] { simulator->dig(ground_to_dig(), {}); }, "2 poses"));
  }
  EXPECT_TRUE(refuses([] { simulator_of_word("none"); }, "none"));
}

TEST(HostileTerrain, FallbackAndScenes) {
  const HeightMap flat = ground_to_dig().bank;
  ASSERT_NO_THROW(measure_fallback(zx120(), path(), flat, flat));
  EXPECT_TRUE(refuses([&] { measure_fallback({}, path(), flat, flat); }, "machine"));
  EXPECT_TRUE(refuses([&] { measure_fallback(zx120(), {}, flat, flat); }, "fallback"));
  EXPECT_TRUE(refuses([&] { measure_fallback(zx120(), path(), {}, {}); }, "map is empty"));
  for (const double bad : {nan, infinity, -1.0}) {
    EXPECT_TRUE(refuses([&] { measure_fallback(zx120(), path(), flat, flat, bad); }, "tracking"));
  }
  const Terrain field = undisturbed(flat_ground(scene_extent(zx120(), default_dump_point()), 0.1));
  const std::vector<test::Member<SceneOptions>> members = {
      {"angle", [](SceneOptions& o) -> double& { return o.path.penetration_angle; }},
      {"start", [](SceneOptions& o) -> double& { return *o.start_x; }},
      {"dump.x", [](SceneOptions& o) -> double& { return o.dump_at.x(); }},
      {"dump.y", [](SceneOptions& o) -> double& { return o.dump_at.y(); }},
      {"size", [](SceneOptions& o) -> double& { return o.blocks->size; }},
      {"swell", [](SceneOptions& o) -> double& { return o.blocks->swell; }},
      {"fines", [](SceneOptions& o) -> double& { return o.blocks->fines; }},
      {"least", [](SceneOptions& o) -> double& { return o.blocks->least_density; }}};
  SceneOptions good;
  good.start_x = 6.5;
  good.blocks = BlockSettings{};
  test::make_hostile<SceneOptions>(
      good, members, {{"run_scene", [&](const SceneOptions& o) {
                         const DigScene scene = run_scene(zx120(), loam(), 90.0, field, o);
                         return finite(scene.volumes.bulking_factor) && finite(scene.duration);
                       }}});
  for (const double bad : {nan, infinity, -1.0, 1e300}) {
    EXPECT_TRUE(refuses([&] { run_scene(zx120(), loam(), bad, field); }, "relative density"));
  }
  SceneOptions nobody;
  nobody.simulator = {};
  EXPECT_TRUE(refuses([&] { run_scene(zx120(), loam(), 40.0, field, nobody); }, "simulator ''"));
  EXPECT_TRUE(refuses([] { scan_scene({}, {}, 1); }));
}

TEST(HostileSensor, CamerasAndLidars) {
  const HeightMap map = hills(true);
  DepthCamera good = camera_above({0.0, 0.0}, 0.0);
  good.width = 24;
  good.height = 16;
  const std::vector<test::Member<DepthCamera>> members = {
      {"position", [](DepthCamera& c) -> double& { return c.position.x(); }},
      {"height", [](DepthCamera& c) -> double& { return c.position.z(); }},
      {"target", [](DepthCamera& c) -> double& { return c.target.y(); }},
      {"view", [](DepthCamera& c) -> double& { return c.horizontal_view; }},
      {"noise", [](DepthCamera& c) -> double& { return c.noise; }},
      {"dropouts", [](DepthCamera& c) -> double& { return c.dropouts; }},
      {"range", [](DepthCamera& c) -> double& { return c.max_range; }},
      {"pattern", [](DepthCamera& c) -> double& { return c.pattern_noise; }},
      {"length", [](DepthCamera& c) -> double& { return c.pattern_length; }},
      {"step", [](DepthCamera& c) -> double& { return c.disparity_step; }},
      {"flying", [](DepthCamera& c) -> double& { return c.flying_pixels; }}};
  const auto all_finite = [](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) {
      if (!finite(point)) return false;
    }
    return true;
  };
  test::make_hostile<DepthCamera>(
      good, members,
      {{"camera", [&](const DepthCamera& c) { return all_finite(scan_surface(map, c, 1)); }}});
  for (const int count : test::hostile_counts) {
    for (int DepthCamera::*member :
         {&DepthCamera::width, &DepthCamera::height, &DepthCamera::frames}) {
      DepthCamera bad = good;
      bad.*member = count;
      EXPECT_TRUE(refuses([&] { scan_surface(map, bad, 1); }, "depth camera"));
    }
  }
  Lidar lidar;
  lidar.angle_step = {0.1, 0.1};
  const std::vector<test::Member<Lidar>> of_lidar = {
      {"position", [](Lidar& l) -> double& { return l.position.z(); }},
      {"azimuth", [](Lidar& l) -> double& { return l.azimuth(1); }},
      {"elevation", [](Lidar& l) -> double& { return l.elevation(0); }},
      {"step", [](Lidar& l) -> double& { return l.angle_step(1); }},
      {"noise", [](Lidar& l) -> double& { return l.range_noise; }},
      {"divergence", [](Lidar& l) -> double& { return l.divergence; }},
      {"pulse", [](Lidar& l) -> double& { return l.pulse_length; }},
      {"dropouts", [](Lidar& l) -> double& { return l.dropouts; }},
      {"range", [](Lidar& l) -> double& { return l.max_range; }}};
  test::make_hostile<Lidar>(
      lidar, of_lidar,
      {{"lidar", [&](const Lidar& l) { return all_finite(scan_surface(map, l, 1)); }}});
  EXPECT_TRUE(refuses([] { with_errors_of({}, {}); }, "image of the sensor"));
  EXPECT_TRUE(refuses([] { sensor_of_word(""); }, "sensor"));
}

}  // namespace
}  // namespace excavplan
