// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Hostile machines, soils, paths and laws: the rooms machine and soil.

#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/dig_cycle.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/soil/density_fit.hpp>
#include <excavplan/soil/soil_scatter.hpp>

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

double level(double) { return 0.0; }

DigPath good_path() {
  return std::get<DigPath>(make_dig_path_anywhere(zx120(), paper_fixed_path(), level));
}

bool sound(const std::variant<DigPath, Infeasible>& path) {
  if (const auto* stop = std::get_if<Infeasible>(&path)) return !stop->message.empty();
  for (const DigPose& pose : std::get<DigPath>(path).poses) {
    if (!finite(pose.joints) || !finite(pose.bucket.x + pose.bucket.z)) return false;
  }
  return std::get<DigPath>(path).poses.size() >= 2;
}

bool sound(const Trajectory& trajectory) {
  double time = -1.0;
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!(point.time > time) || !finite(point.joints) || !finite(point.rates)) return false;
    time = point.time;
  }
  return finite(trajectory.dig_duration());
}

std::vector<test::Member<Machine>> machine_members() {
  std::vector<test::Member<Machine>> members = {
      {"boom_pin.x", [](Machine& m) -> double& { return m.boom_pin.x(); }},
      {"boom_pin.z", [](Machine& m) -> double& { return m.boom_pin.y(); }},
      {"boom_length", [](Machine& m) -> double& { return m.boom_length; }},
      {"arm_length", [](Machine& m) -> double& { return m.arm_length; }},
      {"bucket_length", [](Machine& m) -> double& { return m.bucket_length; }},
      {"track_front", [](Machine& m) -> double& { return m.track_front; }},
      {"tail_radius", [](Machine& m) -> double& { return *m.tail_radius; }},
      {"track_width", [](Machine& m) -> double& { return *m.track_width; }},
      {"profile[0].x", [](Machine& m) -> double& { return m.bucket.profile[0].x(); }},
      {"profile[2].y", [](Machine& m) -> double& { return m.bucket.profile[2].y(); }},
      {"width_outside", [](Machine& m) -> double& { return m.bucket.width_outside; }},
      {"width_inside", [](Machine& m) -> double& { return m.bucket.width_inside; }},
      {"edge_thickness", [](Machine& m) -> double& { return m.bucket.edge_thickness; }},
      {"edge_angle", [](Machine& m) -> double& { return m.bucket.edge_angle; }},
      {"teeth.width", [](Machine& m) -> double& { return m.bucket.teeth->width; }},
      {"teeth.length", [](Machine& m) -> double& { return m.bucket.teeth->length; }},
      {"body.mass", [](Machine& m) -> double& { return m.body->mass; }},
      {"body.centre", [](Machine& m) -> double& { return m.body->centre.x(); }},
      {"body.rear_edge", [](Machine& m) -> double& { return m.body->rear_edge; }},
      {"body.track_friction", [](Machine& m) -> double& { return m.body->track_friction; }},
      {"swing.speed", [](Machine& m) -> double& { return m.swing->speed; }},
      {"swing.inertia", [](Machine& m) -> double& { return m.swing->inertia; }},
      {"engine.power", [](Machine& m) -> double& { return m.engine->power; }},
      {"engine.idle_power", [](Machine& m) -> double& { return m.engine->idle_power; }},
      {"pump_flow", [](Machine& m) -> double& { return m.hydraulics->pump_flow; }},
      {"piston", [](Machine& m) -> double& { return m.hydraulics->pistons[1].diameter; }},
      {"rod", [](Machine& m) -> double& { return m.hydraulics->pistons[1].rod_diameter; }}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto limit = [&](const char* name, double JointLimits::*field) {
      members.push_back({name, [=](Machine& m) -> double& { return m.limits[i].*field; }});
    };
    limit("lower", &JointLimits::lower);
    limit("upper", &JointLimits::upper);
    limit("speed", &JointLimits::speed);
    limit("acceleration", &JointLimits::acceleration);
    limit("torque", &JointLimits::torque);
    members.push_back({"mass", [=](Machine& m) -> double& { return m.links[i].mass; }});
    members.push_back({"along", [=](Machine& m) -> double& { return m.links[i].along; }});
    members.push_back({"across", [=](Machine& m) -> double& { return m.links[i].across; }});
  }
  return members;
}

/// All that takes a machine and says that it refuses bad ones.
std::vector<test::Function<Machine>> machine_functions() {
  const DigPath path = good_path();
  const SoilKind soil = loam();
  const PlannedDig dig = {paper_fixed_path(), path.start_x, 500.0, 0.35, 2e4, 4.0};
  const Terrain ground = level_planning_ground(zx120(), 0.1);
  return {
      {"make_dig_path",
       [](const Machine& m) { return sound(make_dig_path(m, paper_fixed_path(), 6.5, level)); }},
      {"make_dig_path_anywhere",
       [](const Machine& m) {
         return sound(make_dig_path_anywhere(m, paper_fixed_path(), level));
       }},
      {"way_down",
       [path](const Machine& m) {
         const auto way = way_down(m, path, level);
         return std::holds_alternative<Infeasible>(way) ||
                std::get<std::vector<DigPose>>(way).size() < 20000;
       }},
      {"time_dig_path", [path](const Machine& m) { return sound(time_dig_path(m, path)); }},
      {"cycle_of",
       [path, dig](const Machine& m) {
         const auto cycle = cycle_of(m, path, dig);
         return !cycle || finite(cycle->total.energy + cycle->total.time);
       }},
      {"heaped_capacity", [](const Machine& m) { return finite(heaped_capacity(m)); }},
      {"bucket_capacity",
       [](const Machine& m) {
         return finite(bucket_capacity(m, -1.0, 0.1, {0.6, 0.5}));
       }},
      {"planning_extent", [](const Machine& m) { return finite(planning_extent(m).x_max); }},
      {"level_planning_ground",
       [](const Machine& m) { return level_planning_ground(m, 0.5).bank.z.allFinite(); }},
      {"a simulator digs",
       [path, soil, ground](const Machine& m) {
         const HeightMapSimulator simulator(m, soil, 40.0);
         const DigResult result = simulator.dig(ground, path);
         return finite(result.payload_mass) && finite(result.energy.total);
       }},
      {"fingerprint", [](const Machine& m) { return fingerprint(m).size() == 16; }}};
}

TEST(HostileMachine, NumbersAreRefusedOrHarmless) {
  test::make_hostile(zx120(), machine_members(), machine_functions());
}

TEST(HostileMachine, EmptyOnesAreRefused) {
  Machine flat = zx120();
  flat.bucket.profile.clear();
  Machine line = zx120();
  line.bucket.profile.resize(2);
  Machine longer = zx120();  // its profile no longer begins at the tip
  longer.bucket_length *= 2.0;
  Machine wide = zx120();
  wide.bucket.width_outside = wide.boom_length + 0.1;
  Machine oil = zx120();
  oil.cylinders.reset();
  Machine moved = zx120();
  const Machine taken = std::move(moved);
  for (const auto& [name, call] : machine_functions()) {
    if (name == "fingerprint" || name == "heaped_capacity") continue;
    for (const Machine& machine : {Machine{}, flat, line, longer, wide, oil, moved}) {
      EXPECT_TRUE(refuses([&, &call = call] { call(machine); }, "machine")) << name;
    }
  }
  for (const Machine& machine : {Machine{}, flat}) {
    EXPECT_TRUE(refuses([&] { struck_capacity(machine); }, "profile"));
    EXPECT_TRUE(refuses([&] { heaped_capacity(machine); }, "profile"));
    EXPECT_TRUE(refuses([&] { static_cast<void>(machine.beta()); }, "profile"));
    EXPECT_TRUE(refuses([&] { forward_kinematics(machine, JointAngles::Zero()); }, "profile"));
    EXPECT_TRUE(refuses([&] { inverse_kinematics(machine, {5.0, 0.0, 0.5}); }, "profile"));
  }
  moved = taken;
  EXPECT_NO_THROW(require_machine(moved));
}

TEST(HostileMachine, TheErrorNamesMachineMemberValueAndRule) {
  Machine machine = zx120();
  machine.boom_length = nan;
  EXPECT_TRUE(refuses([&] { make_dig_path(machine, paper_fixed_path(), 6.5, level); },
                      "machine 'zx120': boom_length is nan, must be above 0 and at most 100"));
  machine = zx120();
  machine.limits[1].upper = 7.0;
  EXPECT_TRUE(refuses([&] { require_machine(machine); },
                      "machine 'zx120': arm limits.upper is 7, "
                      "must be in 0 .. 3.14159"));
  machine = zx120();
  std::swap(machine.bucket.profile[1], machine.bucket.profile[2]);
  EXPECT_TRUE(refuses([&] { require_machine(machine); }, "convex"));
  for (const double slope : {nan, infinity, -0.1, 1.6}) {
    EXPECT_TRUE(refuses([&] { heaped_capacity(zx120(), slope); }, "slope"));
  }
}

TEST(HostileMachine, PosturesGiveNoFalseAnswer) {
  const Machine machine = zx120();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_TRUE(std::holds_alternative<Unreachable>(inverse_kinematics(machine, {bad, 0.0, 0.5})));
    EXPECT_TRUE(std::holds_alternative<Unreachable>(inverse_kinematics(machine, {5.0, bad, 0.5})));
    const auto turned = inverse_kinematics(machine, {5.0, 0.0, bad});
    const auto* joints = std::get_if<JointAngles>(&turned);
    EXPECT_TRUE(!joints || finite(*joints));
    const auto held = inverse_kinematics_fixed_bucket(machine, 5.0, 0.0, bad);
    joints = std::get_if<JointAngles>(&held);
    EXPECT_TRUE(!joints || finite(*joints));
  }
  Machine bent = machine;
  bent.limits[2] = {nan, nan, 1.0, 1.0, 1.0};
  EXPECT_TRUE(std::holds_alternative<Unreachable>(inverse_kinematics(bent, {6.5, 0.0, 0.7})));
  bent.limits[2] = {1.0, -1.0, 1.0, 1.0, 1.0};
  EXPECT_TRUE(std::holds_alternative<Unreachable>(inverse_kinematics(bent, {6.5, 0.0, 0.7})));
  EXPECT_TRUE(std::isnan(limit_margin(machine, {0.0, nan, 0.0}).margin));
}

TEST(HostilePath, ParametersAndOptions) {
  const Machine machine = zx120();
  const std::vector<test::Member<DigParameters>> parameters = {
      {"angle", [](DigParameters& p) -> double& { return p.penetration_angle; }},
      {"penetration", [](DigParameters& p) -> double& { return p.penetration_length; }},
      {"drag", [](DigParameters& p) -> double& { return p.drag_length; }}};
  test::make_hostile<DigParameters>(
      paper_fixed_path(), parameters,
      {{"make_dig_path",
        [&](const DigParameters& p) { return sound(make_dig_path(machine, p, 6.5, level)); }},
       {"make_dig_path_anywhere",
        [&](const DigParameters& p) { return sound(make_dig_path_anywhere(machine, p, level)); }}});
  const std::vector<test::Member<DigPathOptions>> options = {
      {"step", [](DigPathOptions& o) -> double& { return o.step; }},
      {"heel", [](DigPathOptions& o) -> double& { return o.min_heel_clearance; }},
      {"depth", [](DigPathOptions& o) -> double& { return o.max_depth; }},
      {"tracks", [](DigPathOptions& o) -> double& { return o.track_margin; }},
      {"lift", [](DigPathOptions& o) -> double& { return o.lift_clearance; }}};
  test::make_hostile<DigPathOptions>(
      {}, options, {{"make_dig_path_anywhere", [&](const DigPathOptions& o) {
                       return sound(make_dig_path_anywhere(machine, paper_fixed_path(), level, o));
                     }}});
  for (const double x : test::hostile_numbers) {
    EXPECT_TRUE(
        answers([&] { return sound(make_dig_path(machine, paper_fixed_path(), x, level)); }));
    EXPECT_TRUE(answers([&] {
      return sound(make_dig_path(machine, paper_fixed_path(), 6.5, [&](double) { return x; }));
    }));
  }
  EXPECT_TRUE(refuses([&] { make_dig_path(machine, paper_fixed_path(), 6.5, GroundProfile()); },
                      "ground profile"));
  EXPECT_TRUE(refuses([&] { to_dig_parameters(Eigen::VectorXd::Zero(2)); }, "numbers of a dig"));
}

TEST(HostilePath, TimesOnlyPathsThatAreOne) {
  const Machine machine = zx120();
  const DigPath good = good_path();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    DigPath path = good;
    path.poses[3].joints[1] = bad;
    EXPECT_TRUE(refuses([&] { time_dig_path(machine, path); }, "pose 3"));
    const std::vector<JointAngles> torques(2, JointAngles(0.0, bad, 0.0));
    EXPECT_TRUE(refuses([&] { time_dig_path(machine, good, {}, torques); }, "torque 0"));
    path = good;
    path.poses.front().joints[0] = bad;
    EXPECT_TRUE(answers([&] { return way_down(machine, path, level).index() == 1; }));
    for (TrajectoryOptions options : {TrajectoryOptions{bad, 0.001}, TrajectoryOptions{0.8, bad}}) {
      EXPECT_TRUE(refuses([&] { time_dig_path(machine, good, options); }, "TrajectoryOptions"));
    }
  }
  EXPECT_TRUE(refuses([&] { time_dig_path(machine, DigPath{}); }, "poses"));
  EXPECT_TRUE(refuses([&] { way_down(machine, DigPath{}, level); }, "no pose"));
  DigPath moved = good;
  const DigPath taken = std::move(moved);
  EXPECT_TRUE(refuses([&] { time_dig_path(machine, moved); }, "poses"));
  Trajectory trajectory = time_dig_path(machine, taken);
  trajectory.machine = "\xff\xfe";
  EXPECT_TRUE(refuses([&] { to_json(trajectory); }, "trajectory: '/machine' is not UTF-8"));
  trajectory.machine = "zx120";
  trajectory.points[1].rates[0] = nan;
  EXPECT_TRUE(refuses([&] { to_json(trajectory); }, "rates_rad_per_s/0' is nan"));
  EXPECT_EQ(Trajectory{}.dig_duration(), 0.0);
  EXPECT_NO_THROW(to_csv(Trajectory{}));
}

TEST(HostileCylinder, GeometryIsFinite) {
  CylinderGeometry good;
  good.foot = {0.5, -1.0};
  good.rod = PolarPin{1.5, 0.3};
  const auto make = [](const CylinderGeometry& g, double lower, double upper) {
    return answers([&] {
      const Cylinder cylinder(g, lower, upper);
      return finite(cylinder.stroke()) && cylinder.stroke() > 0.0 &&
             !cylinder.joint_angle(nan).has_value();
    });
  };
  for (const double bad : test::hostile_numbers) {
    CylinderGeometry geometry = good;
    geometry.foot.distance = bad;
    EXPECT_TRUE(make(geometry, -0.5, 0.5)) << bad;
    geometry = good;
    geometry.foot.angle = bad;
    EXPECT_TRUE(make(geometry, -0.5, 0.5)) << bad;
    geometry = good;
    geometry.rod = FourBar{{{bad, 0.1}, 0.4}, {{0.3, 0.2}, bad}};
    EXPECT_TRUE(make(geometry, -0.5, 0.5)) << bad;
    EXPECT_TRUE(make(good, bad, 0.5)) << bad;
    EXPECT_TRUE(make(good, -0.5, bad)) << bad;
  }
  EXPECT_TRUE(refuses([] { Cylinder({}, nan, nan); }));
}

std::vector<test::Member<SoilKind>> soil_members() {
  std::vector<test::Member<SoilKind>> members;
  const std::vector<std::pair<const char*, double SoilKind::*>> fields = {
      {"specific_gravity", &SoilKind::specific_gravity},
      {"water_content", &SoilKind::water_content},
      {"void_ratio_max", &SoilKind::void_ratio_max},
      {"void_ratio_min", &SoilKind::void_ratio_min},
      {"void_ratio_loose", &SoilKind::void_ratio_loose},
      {"cohesion_loosest", &SoilKind::cohesion_loosest},
      {"cohesion_growth", &SoilKind::cohesion_growth},
      {"friction_loosest", &SoilKind::friction_loosest},
      {"friction_gain", &SoilKind::friction_gain},
      {"tool_friction_ratio", &SoilKind::tool_friction_ratio},
      {"adhesion_ratio", &SoilKind::adhesion_ratio},
      {"angle_of_repose", &SoilKind::angle_of_repose},
      {"cone_index_reference", &SoilKind::cone_index_reference},
      {"cone_index_rate", &SoilKind::cone_index_rate},
      {"cone_index_reference_density", &SoilKind::cone_index_reference_density}};
  for (const auto& [name, field] : fields) {
    members.push_back({name, [field = field](SoilKind& s) -> double& { return s.*field; }});
  }
  return members;
}

std::vector<test::Function<SoilKind>> soil_functions() {
  const auto sound = [](const SoilState& s) {
    return finite(s.bulk_density + s.cohesion + s.friction_angle + s.saturation) &&
           s.bulk_density > 0.0;
  };
  return {
      {"bank_state", [=](const SoilKind& s) { return sound(bank_state(s, 40.0)); }},
      {"bank_state_of_void_ratio",
       [=](const SoilKind& s) { return sound(bank_state_of_void_ratio(s, 0.8)); }},
      {"loose_state", [=](const SoilKind& s) { return sound(loose_state(s)); }},
      {"bulking_of_density", [](const SoilKind& s) { return finite(bulking_of_density(s, 40.0)); }},
      {"density_law_of",
       [](const SoilKind& s) {
         return finite(relative_density(density_law_of(s), {1.2, 0.01}).percent);
       }},
      {"drawn_soil", [](const SoilKind& s) { return finite(drawn_soil(s, {}, 1).void_ratio_max); }},
      {"density_of_bulk_density",
       [](const SoilKind& s) { return finite(density_of_bulk_density(s, 1600.0)); }},
      {"a dig", [](const SoilKind& s) {
         static const Machine machine = zx120();
         static const DigPath path = good_path();
         static const Terrain ground = level_planning_ground(machine, 0.1);
         const DigResult result = HeightMapSimulator(machine, s, 40.0).dig(ground, path);
         return finite(result.payload_mass + result.energy.total + result.peak_force);
       }}};
}

TEST(HostileSoil, NumbersAreRefusedOrHarmless) {
  test::make_hostile(loam(), soil_members(), soil_functions());
}

TEST(HostileSoil, DefaultIsRefusedByName) {
  for (const auto& [name, call] : soil_functions()) {
    if (name == "bank_state_of_void_ratio") continue;
    EXPECT_TRUE(refuses([&, &call = call] { call(SoilKind{}); },
                        "soil '': specific_gravity is 0, must be in 0.5 .. 10"))
        << name;
  }
  for (const double density : {nan, infinity, -1.0, 101.0, 1e300}) {
    EXPECT_TRUE(refuses([&] { bank_state(loam(), density); }, "relative density is"));
    EXPECT_TRUE(refuses([&] { bulking_of_density(loam(), density); }, "relative density is"));
    EXPECT_TRUE(refuses([&] { bank_state_of_void_ratio(loam(), density); }, "void ratio"));
  }
  EXPECT_TRUE(refuses([] { critical_height(SoilState{}); }, "unit weight"));
  EXPECT_TRUE(refuses([] { stable_slope({}, nan, 0.5); }, "stable slope"));
  EXPECT_TRUE(refuses([] { density_of_bulk_density(loam(), 0.0); }, "bulk density is 0"));
  for (const double share : {nan, infinity, -0.1, 1e300}) {
    EXPECT_TRUE(refuses([&] { drawn_soil(loam(), {share, 0.0, 0.0}, 1); }, "scatter"));
    EXPECT_TRUE(refuses([&] { drawn_soil(loam(), {0.0, 0.0, share}, 1); }, "scatter"));
  }
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const SoilKind drawn = drawn_soil(loam(), {1.0, 1.0, 1.0}, seed);
    EXPECT_NO_THROW(require_soil(drawn));
  }
  SoilKind narrow = loam();
  narrow.void_ratio_max = 0.03;
  narrow.void_ratio_min = 0.01;
  narrow.void_ratio_loose = 0.02;
  narrow.water_content = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_NO_THROW(require_soil(drawn_soil(narrow, {}, seed)));
  }
}

TEST(HostileLaw, FormsAndFactors) {
  EXPECT_TRUE(refuses([] { relative_density({}, {1.2, 0.0}); }, "density law, line: a is 0"));
  DensityLaw law = density_law_of(loam());
  for (const double bad : {nan, infinity, -1.0, 0.0}) {
    EXPECT_TRUE(refuses([&] { relative_density(law, {bad, 0.0}); }, "bulking factor"));
    EXPECT_TRUE(refuses([&] { free_of_fallback(bad, 0.1); }, "bulking factor"));
    if (bad != 0.0) {
      EXPECT_TRUE(refuses([&] { relative_density(law, {1.2, bad}); }, "deviation"));
      EXPECT_TRUE(refuses([&] { free_of_fallback(1.2, bad); }, "fallback"));
    }
    DensityClosedForm form = std::get<DensityClosedForm>(law.form);
    form.A = bad;
    EXPECT_TRUE(refuses([&] { bulking_of_density(DensityForm(form), 50.0); }, "closed_form: A"));
    form = std::get<DensityClosedForm>(law.form);
    form.residual_sd = bad == 0.0 ? -1.0 : bad;
    law.form = form;
    EXPECT_TRUE(refuses([&] { relative_density(law, {1.2, 0.0}); }, "residual_sd"));
    law = density_law_of(loam());
  }
  EXPECT_TRUE(answers([&] { return finite(relative_density(law, {1e300, 0.0}).percent); }));
  EXPECT_TRUE(refuses([&] { bulking_of_density(law.form, nan); }, "relative density"));
  EXPECT_TRUE(refuses([&] { density_scatter(loam(), DensityLine{}, 50.0, {}); }, "line: a"));
  EXPECT_TRUE(refuses([&] { density_scatter(loam(), law.form, nan, {}); }, "density is nan"));
}

TEST(HostileLaw, SamplesAndCalibrations) {
  const std::vector<BulkingSample> none;
  EXPECT_TRUE(refuses([&] { fit_line(none); }));
  EXPECT_TRUE(refuses([&] { fit_closed_form(none); }));
  EXPECT_TRUE(refuses([&] { calibrate_density(none); }));
  DensityForm form = DensityLine{100.0, 0.0};
  EXPECT_TRUE(refuses([&] { set_scatter(form, none); }, "no dig"));
  EXPECT_TRUE(refuses([&] { set_scatter(form, {{nan, 50.0}}); }, "scatter"));
  EXPECT_TRUE(refuses(
      [&] {
        fit_density_forms({{1.1, 0.0}, {1.2, 50.0}, {nan, 70.0}});
      },
      "sample 3"));
  EXPECT_TRUE(refuses([] { law_of({}); }, "no form"));
  DensityCalibration calibration =
      calibrate_density({{1.0, 0.0}, {1.1, 30.0}, {1.22, 60.0}, {1.42, 100.0}});
  calibration.source = "\xc3\x28";
  EXPECT_TRUE(refuses([&] { to_json(calibration); }, "'/source' is not UTF-8"));
  calibration.source = "here";
  calibration.samples[1].bulking_factor = infinity;
  EXPECT_TRUE(refuses([&] { to_json(calibration); }, "bulking_factor' is inf"));
  EXPECT_FALSE(bulking_difference({}).has_value());
}

TEST(HostileLaw, OptionsOfACalibration) {
  const auto refused = [](const CalibrationOptions& options, const char* what) {
    return refuses([&] { calibrate_density(zx120(), loam(), options); }, what);
  };
  for (const int count : {-1, std::numeric_limits<int>::max()}) {
    CalibrationOptions options;
    options.draws = count;
    EXPECT_TRUE(refused(options, "number of draws"));
  }
  for (const double bad : {nan, infinity, -1.0, 0.0, 1e-9, 1e300}) {
    CalibrationOptions options;
    options.draws = 0;
    options.cell_size = bad;
    EXPECT_TRUE(refused(options, "cell size"));
  }
  CalibrationOptions options;
  options.draws = 0;
  options.densities_percent = {10.0, nan, 50.0, 60.0};
  EXPECT_TRUE(refused(options, "density is nan"));
  options = {};
  options.draws = 0;
  options.path = {0.8, 0.35, nan};
  EXPECT_TRUE(refused(options, "drag length"));
  options = {};
  options.threads = std::numeric_limits<unsigned>::max();
  EXPECT_TRUE(refused(options, "number of threads is 4294967295"));
}

}  // namespace
}  // namespace excavplan
