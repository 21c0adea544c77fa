// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Simulators of users that throw, or answer with what no dig can have: refused with their name.

#include <functional>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/experiments/experiment.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/non_finite.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "support/energy_bound.hpp"
#include "support/errors.hpp"
#include "support/hostile.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::loam;
using test::refuses;
using test::zx120;

const Terrain& level_ground() {
  static const Terrain terrain = level_planning_ground(zx120(), 0.1);
  return terrain;
}

/// Changes the result of a dig, or throws.
using Spoil = std::function<void(const DigPath& path, DigResult& result)>;

/// The section simulator, whose results are spoilt.
class Spoilt : public SoilSimulator {
 public:
  Spoilt(double density, Spoil spoil, std::string identity = "spoilt 1, of a test")
      : inner_(simulator_of_word("section").make(zx120(), loam(), density)),
        spoil_(std::move(spoil)),
        identity_(std::move(identity)) {}

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    DigResult result = inner_->dig(terrain, path, options);
    spoil_(path, result);
    return result;
  }
  std::string identity() const override {
    if (identity_ == "throws") throw std::runtime_error("no identity");
    return identity_;
  }

 private:
  std::unique_ptr<const SoilSimulator> inner_;
  Spoil spoil_;
  std::string identity_;
};

SimulatorKind kind_of(const Spoil& spoil) {
  return {"spoilt", "spoilt 1", [spoil](const Machine&, const SoilKind&, double density) {
            return std::make_unique<const Spoilt>(density, spoil);
          }};
}

struct Case {
  const char* text;  ///< in the error
  Spoil spoil;
};

/// What no search looks at is refused where the ground of one dig is wanted.
std::vector<Case> spoilt_patches() {
  const auto patch = [](const std::function<void(TerrainPatch&)>& change) {
    return [change](const DigPath&, DigResult& r) { change(r.patch); };
  };
  return {{"patch", patch([](TerrainPatch& p) { p.row = -5; })},
          {"patch", patch([](TerrainPatch& p) { p.col = 100000; })},
          {"patch", patch([](TerrainPatch& p) { p.loose.resize(1, 1); })},
          {"patch", patch([](TerrainPatch& p) { p.bank.setZero(5000, 5000); })},
          {"bank of nan", patch([](TerrainPatch& p) { p.bank(0, 0) = nan; })},
          {"bank of inf", patch([](TerrainPatch& p) { p.bank(0, 0) = infinity; })},
          {"loose layer of -1", patch([](TerrainPatch& p) { p.loose(1, 1) = -1.0; })},
          {"loose layer of nan", patch([](TerrainPatch& p) { p.loose(1, 1) = nan; })},
          {"whose void ratio is none", patch([](TerrainPatch& p) {
             p.loose_void_ratio = Eigen::ArrayXXd::Constant(p.bank.rows(), p.bank.cols(), nan);
           })}};
}

std::vector<Case> spoilt_results() {
  std::vector<Case> cases;
  for (const double bad : {nan, infinity, -infinity, -1.0}) {
    const auto add = [&](const char* text, std::function<double&(DigResult&)> number) {
      cases.push_back({text, [=](const DigPath&, DigResult& r) { number(r) = bad; }});
    };
    add("payload_mass", [](DigResult& r) -> double& { return r.payload_mass; });
    add("payload_volume", [](DigResult& r) -> double& { return r.payload_volume; });
    add("energy.total", [](DigResult& r) -> double& { return r.energy.total; });
    add("by_phase", [](DigResult& r) -> double& { return r.energy.by_phase[1]; });
    add("peak_force", [](DigResult& r) -> double& { return r.peak_force; });
    add("soil ledger", [](DigResult& r) -> double& { return r.soil.bank_cut; });
  }
  const auto add = [&](const char* text, std::function<void(const DigPath&, DigResult&)> spoil) {
    cases.push_back({text, std::move(spoil)});
  };
  add("a payload of 0 kg in", [](const DigPath&, DigResult& r) { r.payload_mass = 0.0; });
  add("torques between", [](const DigPath& p, DigResult& r) { r.torques.resize(p.poses.size()); });
  add("torque that is not", [](const DigPath&, DigResult& r) { r.torques.at(0)[1] = nan; });
  add("with 0 J, less than", [](const DigPath&, DigResult& r) { r.energy.total = 0.0; });
  add("its dig gave up", [](const DigPath&, DigResult& r) {
    r.given_up = true;
    r.energy.total = 1e-3;
  });
  add("a payload of 1000000 kg", [](const DigPath&, DigResult& r) {
    r.payload_mass = 1e6;
    r.energy.total = 1e8;
  });
  add("the bucket holds", [](const DigPath&, DigResult& r) {
    r.payload_mass = 1000.0;
    r.payload_volume = 10.0;
    r.energy.total = 1e8;
  });
  add("with 1 J, less than", [](const DigPath&, DigResult& r) { r.energy.total = 1.0; });
  add("it threw: a fault", [](const DigPath&, DigResult&) { throw std::logic_error("a fault"); });
  add("it threw something", [](const DigPath&, DigResult&) { throw 42; });
  add(": its own error",
      [](const DigPath&, DigResult&) { throw Error(ErrorKind::bad_input, "its own error"); });
  return cases;
}

TEST(UsersSimulator, BadResultOfOneDigIsRefusedByName) {
  for (const Case& bad : spoilt_results()) {
    const Spoilt simulator(40.0, bad.spoil);
    EXPECT_TRUE(
        refuses([&] { evaluate_dig(zx120(), simulator, level_ground(), paper_fixed_path()); },
                "simulator 'spoilt 1': "));
    EXPECT_TRUE(refuses(
        [&] { evaluate_dig(zx120(), simulator, level_ground(), paper_fixed_path()); }, bad.text));
  }
  const Spoilt sound(40.0, [](const DigPath&, DigResult&) {});
  EXPECT_EQ(evaluate_dig(zx120(), sound, level_ground(), paper_fixed_path()).index(), 0U);
}

TEST(UsersSimulator, WithoutIdentityItsClassNamesIt) {
  for (const char* identity : {"", "throws"}) {
    const Spoilt simulator(
        40.0, [](const DigPath&, DigResult& r) { r.payload_mass = nan; }, identity);
    EXPECT_TRUE(
        refuses([&] { evaluate_dig(zx120(), simulator, level_ground(), paper_fixed_path()); },
                "simulator 'Spoilt': "));
  }
}

TEST(UsersSimulator, AnIdentityThatThrowsIsAnErrorOfACheckpoint) {
  const test::TemporaryFolder folder;
  const Spoilt simulator(
      40.0, [](const DigPath&, DigResult&) {}, "throws");
  DigSearchOptions options;
  options.stop.evaluations = 10;
  options.checkpoint = folder.file("digs.txt");
  EXPECT_TRUE(refuses([&] { search_dig(zx120(), simulator, level_ground(), options); },
                      "simulator 'Spoilt': it threw: no identity"));
}

TEST(UsersSimulator, ALackOfMemoryIsNotItsFault) {
  const Spoilt simulator(40.0, [](const DigPath&, DigResult&) { throw std::bad_alloc(); });
  EXPECT_THROW(evaluate_dig(zx120(), simulator, level_ground(), paper_fixed_path()),
               std::bad_alloc);
}

TEST(UsersSimulator, PlansScenesAndExperimentsRefuseIt) {
  Terrain field = undisturbed(flat_ground(scene_extent(zx120(), default_dump_point()), 0.1));
  field.loose_void_ratio =
      Eigen::ArrayXXd::Constant(field.loose.rows(), field.loose.cols(), loam().void_ratio_loose);
  std::vector<Case> cases = spoilt_results();
  for (Case& bad : spoilt_patches()) {
    SceneOptions options;
    options.simulator = kind_of(bad.spoil);
    EXPECT_TRUE(refuses([&] { run_scene(zx120(), loam(), 40.0, field, options); },
                        "simulator 'spoilt 1': its dig leaves"));
    EXPECT_TRUE(refuses([&] { run_scene(zx120(), loam(), 40.0, field, options); }, bad.text));
  }
  for (const Case& bad : {cases.front(), cases.back(), cases[cases.size() - 4]}) {
    const SimulatorKind kind = kind_of(bad.spoil);
    const char* named = "simulator 'spoilt 1': ";
    SceneOptions scene;
    scene.simulator = kind;
    EXPECT_TRUE(refuses([&] { run_scene(zx120(), loam(), 40.0, field, scene); }, named));
    CalibrationOptions calibration;
    calibration.simulator = kind;
    calibration.cell_size = 0.1;
    for (const int draws : {0, 3}) {
      calibration.draws = draws;
      EXPECT_TRUE(refuses([&] { calibrate_density(zx120(), loam(), calibration); }, named));
    }
    PlanOptions plan;
    plan.simulator = kind;
    EXPECT_TRUE(refuses([&] { plan_dig(zx120(), loam(), 50.0, plan); }, named));
    ExperimentOptions experiment;
    experiment.plan.simulator = kind;
    EXPECT_TRUE(refuses(
        [&] { run_experiment(zx120(), loam(), density_law_of(loam()), 50.0, experiment); }, named));
  }
}

TEST(UsersSimulator, KindsThatMakeNone) {
  const auto refused = [](SimulatorKind kind, const char* text) {
    kind.name = "mine 3";
    PlanOptions plan;
    plan.simulator = kind;
    plan.method = PlanMethod::search;
    return refuses([&] { plan_dig(zx120(), loam(), 50.0, plan); },
                   std::string("simulator 'mine 3': ") + text);
  };
  using Made = std::unique_ptr<const SoilSimulator>;
  const auto kind = [](std::function<Made()> make) {
    return SimulatorKind{"mine", "",
                         [make](const Machine&, const SoilKind&, double) { return make(); }};
  };
  EXPECT_TRUE(refused({}, "it has no function"));
  EXPECT_TRUE(refused(kind([] { return Made(); }), "the function that makes one gave none"));
  EXPECT_TRUE(refused(kind([]() -> Made { throw std::runtime_error("no"); }), "it threw: no"));
  EXPECT_TRUE(refused(kind([]() -> Made { throw 'x'; }), "it threw something"));
}

DigSearchOptions budget(int evaluations) {
  DigSearchOptions options;
  options.stop.evaluations = evaluations;
  options.threads = 2;
  return options;
}

TEST(UsersSimulator, OneThatAlwaysFailsEndsASearchWithinTwentyDigs) {
  for (const Case& bad : spoilt_results()) {
    if (std::string(bad.text).find(" J, ") != std::string::npos) continue;  // not of empty buckets
    int digs = 0;
    const Spoilt simulator(40.0, [&](const DigPath& path, DigResult& result) {
      ++digs;
      bad.spoil(path, result);
    });
    DigSearchOptions options = budget(300);
    options.threads = 1;
    const std::string text =
        test::error_of([&] { search_dig(zx120(), simulator, level_ground(), options); });
    EXPECT_LE(digs, 20) << bad.text;
    EXPECT_NE(text.find("evaluations failed, the first one: simulator 'spoilt 1': "),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(bad.text), std::string::npos) << text;
  }
}

// Each fault in a twentieth of all paths, decided by the path: not a number, infinite, an
// exception.
TEST(UsersSimulator, OneThatFailsNowAndThenFindsAsGoodADig) {
  constexpr int digs = 260;
  const auto good = simulator_of_word("section").make(zx120(), loam(), 40.0);
  const auto best = search_dig(zx120(), *good, level_ground(), budget(digs));
  ASSERT_TRUE(best);
  int reached = 0;
  for (const std::uint64_t seed : {1U, 2U}) {
    const Spoilt simulator(40.0, [](const DigPath& path, DigResult& result) {
      std::string numbers;
      for (const double n : {path.parameters.drag_length, path.parameters.penetration_length}) {
        numbers += number_text(n) + " ";
      }
      switch (checksum(numbers) % 20) {
        case 0:
          result.energy.total = nan;
          break;
        case 1:
          result.payload_mass = infinity;
          break;
        case 2:
          throw std::runtime_error("now and then");
        default:
          break;
      }
    });
    DigSearchOptions options = budget(digs * 13 / 10);
    options.seed = seed;
    const auto found = search_dig(zx120(), simulator, level_ground(), options);
    ASSERT_TRUE(found);
    EXPECT_GT(found->failed, 0);
    EXPECT_LT(found->failed, found->evaluations / 3);
    EXPECT_NE(found->first_failure.find("simulator 'spoilt 1': "), std::string::npos);
    EXPECT_GE(found->worth, 0.99 * best->worth) << seed;
    reached += found->worth >= 0.99 * best->worth ? 1 : 0;
  }
  EXPECT_EQ(reached, 2);
}

// The bound holds of the built-in simulators with room to spare, and is not weaker than its test.
TEST(UsersSimulator, TheBoundOfEnergyIsThatOfTheBuiltInOnes) {
  Random random(5);
  double share = 0.0, efficiency = 0.0;
  int digs = 0;
  for (int i = 0; i < 120; ++i) {
    const double density = random.uniform(0.0, 100.0);
    const auto& kind = simulator_kinds()[static_cast<std::size_t>(i) % simulator_kinds().size()];
    DigParameters parameters;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      parameters.*info.field = random.uniform(info.lower, info.upper);
    }
    const auto laid =
        make_dig_path_anywhere(zx120(), parameters, boom_plane_profile(level_ground()));
    if (laid.index() != 0) continue;
    const auto& path = std::get<DigPath>(laid);
    const DigResult result = kind.make(zx120(), loam(), density)->dig(level_ground(), path);
    if (result.stall || result.payload_mass <= 0.0) continue;
    ++digs;
    share = std::max(share, test::share_of_lifting(zx120(), path, result));
    efficiency = std::max(efficiency, result.efficiency());
    bool spoilt = false;
    const Spoilt cheap(density, [&](const DigPath& p, DigResult& r) {
      if (!(test::share_of_lifting(zx120(), p, r) > 0.01)) return;
      r.energy.total *= 0.001;
      spoilt = true;
    });
    const bool refused =
        refuses([&] { evaluate_dig(zx120(), cheap, level_ground(), parameters); }, "less than");
    EXPECT_EQ(refused, spoilt);
  }
  EXPECT_GT(digs, 40);
  EXPECT_LE(share, 1.0);
  EXPECT_LT(efficiency * 9.80665 * 0.1, 0.5) << "least_rise of checked_dig.cpp";
  RecordProperty("largest_efficiency_kg_per_kj", std::to_string(1e3 * efficiency));
  RecordProperty("largest_share_of_bound", std::to_string(share));
}

}  // namespace
}  // namespace excavplan
