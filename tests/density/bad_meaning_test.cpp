// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/machine_front.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/soil/density_fit.hpp>

#include "base/random.hpp"
#include "support/dig_survey.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"
#include "support/site_scenes.hpp"
#include "support/wrong_inputs.hpp"

/// @file
/// Well-formed inputs with a wrong meaning. Each must give the right answer, or one that is not
/// trusted with a warning that says what is doubtful, or an error that says what is wrong.

namespace excavplan {
namespace {

using namespace test;
using Eigen::Vector3d;
using Inputs = std::vector<WrongInput>;
using Codes = std::vector<std::string>;
using scenes::degree;
using test::loam;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// ---- Scans --------------------------------------------------------------------------------------

/// Scans of a dig, and the bulking factor that is true.
struct Pair {
  std::string name;
  DigScans scans;
  double bulking = 0.0;
};

/// Random points all over sloping, rough ground.
const Pair& rough() {
  static const Pair pair = [] {
    const Survey survey(6, true, 4.0 * degree, 0.01);
    return Pair{"rough", survey.scans(), survey.dig.bulking};
  }();
  return pair;
}

/// By a lidar that is known to have stood beside it.
const Pair& lidar() {
  static const Pair pair = [] {
    const auto& families = scenes::families();
    const auto family = std::find_if(families.begin(), families.end(),
                                     [](const auto& each) { return each.name == "lidar-one"; });
    const scenes::SiteScene scene = scenes::site_scene(*family, 1, 30000);
    return Pair{"lidar", scenes::scans_of(scene, 1), scene.truth.bulking()};
  }();
  return pair;
}

/// Of the pair that a Livox Avia took; nothing where the data are not there.
const std::optional<Pair>& measured() {
  static const std::optional<Pair> pair = []() -> std::optional<Pair> {
    const std::string folder = std::string(EXCAVPLAN_SHARED_DATA) + "/dig-pair-livox/";
    if (!std::filesystem::exists(folder)) return std::nullopt;
    Pair real{"measured", {}, 0.0};
    for (const bool after : {false, true}) {
      Scan& scan = after ? real.scans.after : real.scans.before;
      scan.clouds = {
          std::make_shared<const Cloud>(read_cloud(folder + (after ? "after.pcd" : "before.pcd")))};
      scan.site_from_scan = read_frame(folder + (after ? "after_frame.txt" : "before_frame.txt"));
      scan.area = Rectangle{0.3, 0.3, 9.0, 10.0};
    }
    return real;
  }();
  return pair;
}

using PointMap = std::function<Vector3d(const Vector3d&)>;

void map_points(Scan& scan, const PointMap& map) {
  for (auto& cloud : scan.clouds) {
    auto changed = std::make_shared<Cloud>(*cloud);
    for (Vector3d& point : changed->points) point = map(point);
    if (changed->sensor_origin) changed->sensor_origin = map(*changed->sensor_origin);
    cloud = std::move(changed);
  }
}

void map_both(DigScans& scans, const PointMap& map) {
  map_points(scans.before, map);
  map_points(scans.after, map);
}

PointMap scaled(double factor) {
  return [=](const Vector3d& p) { return Vector3d(factor * p); };
}
PointMap scaled(double x, double y, double z) {
  return [=](const Vector3d& p) { return Vector3d(x * p.x(), y * p.y(), z * p.z()); };
}
PointMap moved(const Affine& motion) {
  return [=](const Vector3d& p) { return Vector3d(motion * p); };
}
PointMap shifted(double x, double y, double z) {
  return [=](const Vector3d& p) { return Vector3d(p + Vector3d(x, y, z)); };
}
/// About the middle of the scene.
PointMap turned_about_middle(double angle, const Vector3d& axis) {
  const Eigen::Translation3d middle(2.7, 0.0, 0.0);
  return moved(middle * turned(angle, axis) * middle.inverse());
}

std::shared_ptr<const Cloud> cloud_of(std::vector<Vector3d> points) {
  auto cloud = std::make_shared<Cloud>();
  cloud->width = points.size();
  cloud->points = std::move(points);
  return cloud;
}

void add_points(Scan& scan, const std::vector<Vector3d>& more) {
  auto cloud = std::make_shared<Cloud>(*scan.clouds.front());
  cloud->points.insert(cloud->points.end(), more.begin(), more.end());
  cloud->width = cloud->points.size();
  scan.clouds.front() = std::move(cloud);
}

template <typename Keep>
void keep_points(Scan& scan, const Keep& keep) {
  std::vector<Vector3d> kept;
  for (const Vector3d& point : scan.clouds.front()->points) {
    if (keep(point)) kept.push_back(point);
  }
  scan.clouds = {cloud_of(std::move(kept))};
}

/// Within three standard deviations of what is true.
Verdict judged(const DensityEstimate& estimate, double bulking) {
  Verdict verdict;
  verdict.trusted = estimate.trustworthy;
  verdict.warnings = estimate.warnings;
  if (const auto& k = estimate.bulking) verdict.right = std::abs(k->value - bulking) < 3.0 * k->sd;
  return verdict;
}

DensityOptions one_thread() {
  DensityOptions options;
  options.threads = 1;
  return options;
}

using Spoil = std::function<void(DigScans&, DensityOptions&)>;

WrongInput wrong_scans(const Pair& pair, const std::string& name, const Spoil& spoil,
                       std::vector<std::string> reasons, bool may_be_right = false) {
  const auto made = [&pair, spoil] {
    DigScans scans = pair.scans;
    DensityOptions options = one_thread();
    spoil(scans, options);
    return judged(estimate_density(scans, paper_law(), options), pair.bulking);
  };
  return {pair.name + ": " + name, made, std::move(reasons), may_be_right};
}

/// On random points or those of a lidar, in turn.
void add(Inputs& inputs, const std::string& name, const Spoil& spoil,
         const std::vector<std::string>& reasons, bool may_be_right = false) {
  const Pair& pair = inputs.size() % 2 == 0 ? rough() : lidar();
  inputs.push_back(wrong_scans(pair, name, spoil, reasons, may_be_right));
}

/// On both.
void add_both(Inputs& inputs, const std::string& name, const Spoil& spoil,
              const std::vector<std::string>& reasons, bool may_be_right = false) {
  inputs.push_back(wrong_scans(rough(), name, spoil, reasons, may_be_right));
  inputs.push_back(wrong_scans(lidar(), name, spoil, reasons, may_be_right));
}

constexpr bool may_be_right = true;

TEST(BadMeaning, TheScansThemselvesAreRight) {
  Inputs inputs;
  add_both(
      inputs, "nothing wrong", [](DigScans&, DensityOptions&) {}, {}, may_be_right);
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, OrderAndUnits) {
  Inputs inputs;
  add_both(inputs, "swapped", [](DigScans& s, auto&) { std::swap(s.before, s.after); },
           {"swapped", "looks_swapped"});
  add(inputs, "the same scan twice", [](DigScans& s, auto&) { s.after = s.before; },
      {"no_hole_found"});
  for (const auto& [unit, factor] : {std::pair("mm", 1e3), std::pair("cm", 1e2)}) {
    add(inputs, std::string("both in ") + unit,
        [f = factor](DigScans& s, auto&) { map_both(s, scaled(f)); }, {"units", "`unit`"});
    add(inputs, std::string("the one after in ") + unit,
        [f = factor](DigScans& s, auto&) { map_points(s.after, scaled(f)); },
        {"units", "--after-unit"});
  }
  const double foot = 1.0 / 0.3048;
  add(
      inputs, "both in feet: k has no unit", [=](DigScans& s, auto&) { map_both(s, scaled(foot)); },
      {"units", "zone_partly_unseen", "scans_do_not_fit"}, may_be_right);
  add(inputs, "the one before in feet",
      [=](DigScans& s, auto&) { map_points(s.before, scaled(foot)); }, {"units", "`unit`"});
  add(inputs, "metres said to be millimetres",
      [](DigScans& s, auto&) { s.before.unit = s.after.unit = 1e-3; }, {"units", "`unit`"});
  add(inputs, "in kilometres", [](DigScans& s, auto&) { map_both(s, scaled(1e-3)); },
      {"units", "`unit`"});
  add(inputs, "a million times too large", [](DigScans& s, auto&) { map_both(s, scaled(1e6)); },
      {"units", "`unit`"});
  add(inputs, "heights in cm, places in m",
      [](DigScans& s, auto&) { map_both(s, scaled(1.0, 1.0, 100.0)); },
      {"units", "frame", "`unit`", "tilted"});
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, Frames) {
  Inputs inputs;
  const Vector3d x = Vector3d::UnitX();
  const Vector3d z = Vector3d::UnitZ();
  add(
      inputs, "both mirrored: volumes are the same",
      [](DigScans& s, auto&) { map_both(s, scaled(1.0, -1.0, 1.0)); }, {}, may_be_right);
  add(
      inputs, "the one after mirrored",
      [](DigScans& s, auto&) { map_points(s.after, scaled(1.0, -1.0, 1.0)); },
      {"registration_beyond_prior", "scans_do_not_fit", "swapped", "no_dumped_soil",
       "sensor_place_doubtful", "attribution_open", "zone_partly_unseen"},
      may_be_right);
  for (const double tilt : {2.0, 8.0, 20.0, 30.0}) {
    add_both(
        inputs, "tilted by " + std::to_string(std::lround(tilt)) + " deg",
        [=](DigScans& s, auto&) { map_both(s, turned_about_middle(tilt * degree, x)); },
        {"tilted", "zone_partly_unseen"}, may_be_right);
  }
  add(inputs, "turned upside down", [=](DigScans& s, auto&) { map_both(s, moved(turned(pi, x))); },
      {"swapped", "z points down", "looks_swapped", "sensor_place_doubtful"});
  add_both(inputs, "z down", [](DigScans& s, auto&) { map_both(s, scaled(1.0, 1.0, -1.0)); },
           {"swapped", "z points down", "looks_swapped", "sensor_place_doubtful"});
  add(inputs, "z down in the one after",
      [](DigScans& s, auto&) { map_points(s.after, scaled(1.0, 1.0, -1.0)); },
      {"registration_beyond_prior", "scans_do_not_fit", "swapped", "sensor_place_doubtful",
       "looks_swapped"});
  add(inputs, "y up", [=](DigScans& s, auto&) { map_both(s, moved(turned(-0.5 * pi, x))); },
      {"z is not up", "frame"});
  add(
      inputs, "both turned by 90 deg about z: nothing changes",
      [=](DigScans& s, auto&) { map_both(s, moved(turned(0.5 * pi, z))); }, {}, may_be_right);
  add_both(inputs, "the one after turned by 90 deg",
           [=](DigScans& s, auto&) { map_points(s.after, turned_about_middle(0.5 * pi, z)); },
           {"registration_beyond_prior", "scans_do_not_fit", "swapped", "no_dumped_soil",
            "zone_at_border", "zone_partly_unseen", "attribution_open", "no_hole_found"});
  add_both(inputs, "in the frame of a camera",
           [](DigScans& s, auto&) { map_both(s, moved(camera(60.0 * degree, 6.0))); },
           {"frame", "camera"});
  add(inputs, "the one after in the frame of a camera",
      [](DigScans& s, auto&) { map_points(s.after, moved(camera(60.0 * degree, 6.0))); },
      {"frame", "do not overlap", "camera"});
  add(inputs, "the inverse of the frame of the one after",
      [](DigScans& s, auto&) {
        const Affine frame =
            Eigen::Translation3d(1.0, 2.0, 0.3) * turned(20.0 * degree, Vector3d::UnitZ());
        map_points(s.after, moved(frame.inverse()));
        s.after.site_from_scan = frame.inverse().matrix();
      },
      {"registration_beyond_prior", "scans_do_not_fit", "swapped", "no_dumped_soil",
       "zone_at_border", "attribution_open"});
  add(inputs, "a frame whose translation is in mm",
      [](DigScans& s, auto&) { s.after.site_from_scan(0, 3) = 500.0; }, {"do not overlap"});
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, Places) {
  Inputs inputs;
  const Codes moved_codes = {"registration_beyond_prior",
                             "scans_do_not_fit",
                             "swapped",
                             "no_dumped_soil",
                             "zone_at_border",
                             "attribution_open",
                             "zone_partly_unseen"};
  add(inputs, "disjoint", [](DigScans& s, auto&) { map_points(s.after, shifted(50.0, 0.0, 0.0)); },
      {"do not overlap"});
  add(
      inputs, "moved by 2 cm",
      [](DigScans& s, auto&) { map_points(s.after, shifted(0.02, 0.0, 0.01)); }, {}, may_be_right);
  add_both(
      inputs, "moved by 0.5 m",
      [](DigScans& s, auto&) { map_points(s.after, shifted(0.5, 0.1, 0.2)); }, moved_codes,
      may_be_right);
  add_both(
      inputs, "moved by 3 m",
      [](DigScans& s, auto&) { map_points(s.after, shifted(3.0, 0.0, 0.0)); }, moved_codes);
  add(
      inputs, "raised by 1 m: no height is absolute",
      [](DigScans& s, auto&) { map_points(s.after, shifted(0.0, 0.0, 1.0)); }, moved_codes,
      may_be_right);
  // the ground is as level there: the dig of the scan after is what is measured
  const Pair a = {"rough", rough().scans, lidar().bulking};
  const Pair b = {"lidar", lidar().scans, rough().bulking};
  const auto other_site = [](const Pair& pair) {
    return [&pair](DigScans& s, DensityOptions&) { s.after = pair.scans.after; };
  };
  const Codes other = {"registration_beyond_prior",
                       "scans_do_not_fit",
                       "swapped",
                       "no_dumped_soil",
                       "zone_at_border",
                       "attribution_open",
                       "zone_partly_unseen",
                       "no_hole_found",
                       "other_change",
                       "earlier_soil",
                       "tilted",
                       "little_stable_ground"};
  inputs.push_back(
      wrong_scans(a, "after another dig of another site", other_site(b), other, may_be_right));
  inputs.push_back(
      wrong_scans(b, "after another dig of another site", other_site(a), other, may_be_right));
  add(inputs, "the heap is not in the scans",
      [](DigScans& s, auto&) {
        s.before.area = s.after.area = Rectangle{-3.0, -3.0, 2.0, 3.0};
      },
      {"no_dumped_soil"});
  add(inputs, "the hole is not in the scans",
      [](DigScans& s, auto&) {
        s.before.area = s.after.area = Rectangle{3.0, -3.0, 8.5, 3.0};
      },
      {"no_hole_found"});
  add(inputs, "an area that cuts the heap",
      [](DigScans& s, auto&) {
        s.before.area = s.after.area = Rectangle{-3.0, -3.0, 5.5, 3.0};
      },
      {"zone_at_border", "swapped", "no_dumped_soil"});
  add(inputs, "dig area and dump area exchanged",
      [](DigScans&, DensityOptions& options) {
        options.change.dig_area = Rectangle{3.5, -3.0, 9.0, 3.0};
        options.change.dump_area = Rectangle{-3.0, -3.0, 2.5, 3.0};
      },
      {"no_hole_found"});
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, BentScans) {
  Inputs inputs;
  const Codes codes = {"scans_do_not_fit", "zone_at_border",       "attribution_open",
                       "swapped",          "little_stable_ground", "no_dumped_soil",
                       "other_change",     "zone_partly_unseen",   "registration_beyond_prior"};
  const auto bent = [&](const std::string& name, const std::function<double(double, double)>& by) {
    add_both(
        inputs, "the one after bent: " + name,
        [=](DigScans& s, auto&) {
          map_points(s.after, [&](const Vector3d& p) {
            return Vector3d(p.x(), p.y(), p.z() + by(p.x(), p.y()));
          });
        },
        codes, may_be_right);
  };
  for (const auto& [height, length] :
       {std::pair(0.02, 6.0), std::pair(0.02, 1.5), std::pair(0.04, 3.0)}) {
    bent("waves of " + std::to_string(height) + " m by " + std::to_string(length) + " m",
         [height = height, length = length](double x, double) {
           return height * std::sin(2.0 * pi * x / length);
         });
  }
  bent("oblique waves", [](double x, double y) { return 0.02 * std::sin(pi * (x + 0.6 * y)); });
  bent("waves in both directions",
       [](double x, double y) { return 0.02 * std::sin(2.0 * x) * std::sin(3.0 * y); });
  bent("rings", [](double x, double y) { return 0.02 * std::sin(2.0 * std::hypot(x, y)); });
  for (const double height : {0.005, 0.01, -0.01}) {
    bent("a bowl of " + std::to_string(height) + " m at 2 m", [=](double x, double y) {
      return 0.25 * height * (std::pow(x - 2.7, 2) + std::pow(y - 1.0, 2));
    });
  }
  bent("a step", [](double, double y) { return y > 0.0 ? 0.04 : 0.0; });
  bent("a step across", [](double x, double) { return x > 2.5 ? 0.04 : 0.0; });
  bent("a quarter raised", [](double x, double y) { return x > 2.5 && y > 0.0 ? 0.04 : 0.0; });
  bent("a ramp", [](double x, double) { return 0.03 * std::max(0.0, x - 2.5); });
  expect_no_wrong_answer(inputs);
}

void add_before_to_after(DigScans& scans, int every, const Rectangle& where) {
  std::vector<Vector3d> more;
  int i = 0;
  for (const Vector3d& p : scans.before.clouds.front()->points) {
    if (i++ % every == 0 && where.contains(p.x(), p.y())) more.push_back(p);
  }
  add_points(scans.after, more);
}

// In most cells they are too few to show two levels.
TEST(BadMeaning, AThirdOfTheGroundBeforeAmongThatAfter) {
  const std::pair<const char*, Rectangle> places[] = {
      {"in the heap", {3.2, -100.0, 100.0, 100.0}}, {"in the hole", {-100.0, -100.0, 3.2, 100.0}}};
  for (const Pair& pair : {rough(), lidar()}) {
    for (const auto& [name, place] : places) {
      const Rectangle where = place;
      expect_no_wrong_answer({wrong_scans(
          pair, std::string("before among after ") + name,
          [where](DigScans& s, auto&) { add_before_to_after(s, 3, where); }, {"two_surfaces"})});
    }
  }
}

TEST(BadMeaning, TwoSurfaces) {
  Inputs inputs;
  const Codes codes = {"two_surfaces",     "no_dumped_soil", "zone_partly_unseen",
                       "attribution_open", "no_hole_found",  "swapped"};
  const Rectangle all = {-100.0, -100.0, 100.0, 100.0};
  for (const int every : {1, 2, 4}) {
    add_both(
        inputs, "before among after, every " + std::to_string(every),
        [=](DigScans& s, auto&) { add_before_to_after(s, every, all); }, codes);
  }
  for (const std::size_t count : {1500u, 6000u}) {
    add_both(
        inputs, std::to_string(count) + " points of dust",
        [=](DigScans& s, auto&) {
          Random random(5);
          std::vector<Vector3d> dust;
          for (std::size_t i = 0; i < count; ++i) {
            dust.emplace_back(random.uniform(-0.8, 0.8), random.uniform(-0.5, 0.5),
                              random.uniform(0.0, 0.3));
          }
          add_points(s.after, dust);
        },
        codes, may_be_right);
  }
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, PointsOffTheGround) {
  Inputs inputs;
  const Codes codes = {"outliers", "two_surfaces", "grass", "attribution_open"};
  for (const double off : {-0.1, 0.04, 0.08, 0.15}) {
    for (const double share : {0.02, 0.05, 0.2}) {
      add_both(
          inputs, std::to_string(share) + " of the points after by " + std::to_string(off) + " m",
          [=](DigScans& s, auto&) {
            Random random(7);
            map_points(s.after, [&](const Vector3d& p) {
              return Vector3d(p.x(), p.y(), p.z() + (random.uniform() < share ? off : 0.0));
            });
          },
          codes, may_be_right);
    }
  }
  for (const double height : {0.05, 0.15, 0.3}) {
    add_both(
        inputs, "a tenth of the points up to " + std::to_string(height) + " m above",
        [=](DigScans& s, auto&) {
          Random random(8);
          map_points(s.after, [&](const Vector3d& p) {
            const double off = random.uniform() < 0.1 ? random.uniform(0.0, height) : 0.0;
            return Vector3d(p.x(), p.y(), p.z() + off);
          });
        },
        codes, may_be_right);
  }
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, ALimitOfHeights) {
  Inputs inputs;
  const Codes codes = {"floor_cut", "hole_in_shadow", "zone_unseen", "zone_partly_unseen"};
  const auto lowest = [](const Scan& scan) {
    double z = 0.0;
    for (const Vector3d& p : scan.clouds.front()->points) z = std::min(z, p.z());
    return z;
  };
  for (const double above : {0.01, 0.02, 0.03, 0.05, 0.1}) {
    add_both(
        inputs, "cut " + std::to_string(above) + " m above the lowest point",
        [=](DigScans& s, auto&) {
          const double limit = lowest(s.after) + above;
          keep_points(s.after, [=](const Vector3d& p) { return p.z() > limit; });
        },
        codes, may_be_right);
  }
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, CoarseAndNoisyHeights) {
  Inputs inputs;
  const auto rounded = [](double step) {
    return
        [=](const Vector3d& p) { return Vector3d(p.x(), p.y(), step * std::round(p.z() / step)); };
  };
  for (const double step : {0.03, 0.05, 0.08, 0.1}) {
    const std::string name = "rounded to " + std::to_string(step) + " m";
    add(inputs, "the one after " + name,
        [=](DigScans& s, auto&) { map_points(s.after, rounded(step)); }, {"coarse_heights"});
    add(inputs, "both " + name, [=](DigScans& s, auto&) { map_both(s, rounded(step)); },
        {"coarse_heights"});
  }
  for (const double step : {0.001, 0.01}) {
    add_both(
        inputs, "both rounded to " + std::to_string(step) + " m",
        [=](DigScans& s, auto&) { map_both(s, rounded(step)); }, {"grass", "two_surfaces"},
        may_be_right);
  }
  for (const double sd : {0.05, 0.1, 0.15, 0.25}) {
    add(
        inputs, "noise of " + std::to_string(sd) + " m",
        [=](DigScans& s, auto&) {
          Random random(6);
          map_both(s, [&](const Vector3d& p) {
            return Vector3d(p.x(), p.y(), p.z() + sd * random.normal());
          });
        },
        {"grass", "scans_do_not_fit", "no_dumped_soil", "attribution_open", "zone_partly_unseen",
         "no_hole_found", "little_stable_ground", "zone_at_border", "swapped", "blocks"},
        may_be_right);
  }
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, Points) {
  Inputs inputs;
  add(inputs, "nothing in the one after",
      [](DigScans& s, auto&) { s.after.clouds = {cloud_of({})}; },
      {"fewer than 100 finite points"});
  add(inputs, "one point",
      [](DigScans& s, auto&) {
        s.after.clouds = {cloud_of({{1, 1, 0}})};
      },
      {"fewer than 100 finite points"});
  add(inputs, "all NaN",
      [](DigScans& s, auto&) {
        map_points(s.before, [](const Vector3d&) { return Vector3d::Constant(nan_value).eval(); });
      },
      {"fewer than 100 finite points"});
  add(inputs, "a thousand times one point",
      [](DigScans& s, auto&) {
        s.after.clouds = {cloud_of(std::vector<Vector3d>(1000, Vector3d(1.0, 1.0, 0.0)))};
      },
      {"units", "do not overlap", "unit"});
  add(
      inputs, "one point at 1e30",
      [](DigScans& s, auto&) {
        add_points(s.after, {{1e30, 1e30, 1e30}});
      },
      {}, may_be_right);
  add(
      inputs, "one point 1e30 high",
      [](DigScans& s, auto&) {
        add_points(s.before, {{1.0, 1.0, 1e30}});
      },
      {}, may_be_right);
  add(
      inputs, "a few points a kilometre away",
      [](DigScans& s, auto&) {
        add_points(s.after, {{900.0, 40.0, 3.0}, {-1000.0, 20.0, 1.0}, {10.0, 2000.0, 1.0}});
      },
      {}, may_be_right);
  add(inputs, "cells of 1e-9 m", [](DigScans&, DensityOptions& o) { o.cell_size = 1e-9; },
      {"cell"});
  add(inputs, "cells of 10 m", [](DigScans&, DensityOptions& o) { o.cell_size = 10.0; },
      {"cell", "zone_at_border", "known cells", "swapped"});
  add(inputs, "cells of 1 m", [](DigScans&, DensityOptions& o) { o.cell_size = 1.0; },
      {"cell", "zone_at_border", "known cells", "no_hole_found", "no_dumped_soil", "tilted",
       "attribution_open", "little_stable_ground"});
  add(inputs, "150 points are left",
      [](DigScans& s, auto&) {
        int i = 0;
        const auto every = [&](const Vector3d&) { return i++ % 300 == 0; };
        keep_points(s.before, every);
        keep_points(s.after, every);
      },
      {"known cells", "no_hole_found", "no_dumped_soil", "zone_at_border", "zone_partly_unseen",
       "attribution_open", "swapped", "tilted"});
  add(inputs, "the heap was carted off but for a third",
      [](DigScans& s, auto&) {
        map_points(s.after, [](const Vector3d& p) {
          return Vector3d(p.x(), p.y(), p.x() > 3.0 && p.z() > 0.05 ? 0.33 * p.z() : p.z());
        });
      },
      {"swapped", "no_dumped_soil", "scans_do_not_fit", "density_below_range"});
  add_both(
      inputs, "the loaded machine stands in the scan after",
      [](DigScans& s, auto&) {
        Random random(3);
        std::vector<Vector3d> machine;
        for (int i = 0; i < 15000; ++i) {
          const double along = random.uniform(-3.0, 0.6);
          const double across = random.uniform(-0.5, 0.5);
          machine.emplace_back(along, across - 0.1, random.uniform(1.0, 2.5));
        }
        add_points(s.after, machine);
      },
      {"object_taken_out", "zone_partly_unseen", "zone_unseen", "no_hole_found", "no_dumped_soil",
       "swapped"},
      may_be_right);
  expect_no_wrong_answer(inputs);
}

// ---- Where the sensor stood ---------------------------------------------------------------------

TEST(BadMeaning, SensorPlaces) {
  Inputs inputs;
  const Vector3d true_place = *lidar().scans.after.clouds.front()->sensor_origin;
  const auto add_place = [&](const std::string& name, const Vector3d& place,
                             bool is_right = false) {
    inputs.push_back(wrong_scans(
        lidar(), name,
        [=](DigScans& s, auto&) { s.before.sensor_origin = s.after.sensor_origin = place; },
        {"sensor_place_doubtful", "is said to have stood at"}, is_right));
  };
  add_place("the place of the scan after for both", true_place, may_be_right);
  add_place("5 m aside", true_place + Vector3d(5.0, 0.0, 0.0));
  add_place("2 m aside", true_place + Vector3d(-2.0, 0.0, 0.0));
  add_place("on the other side", {true_place.x(), -true_place.y(), true_place.z()});
  add_place("below the ground", {true_place.x(), true_place.y(), -1.0});
  add_place("the origin of the site", Vector3d::Zero());
  add_place("half as high", {true_place.x(), true_place.y(), 0.5 * true_place.z()});
  add_place("twice as high", {true_place.x(), true_place.y(), 2.0 * true_place.z()});
  add_place("30 m away", true_place + Vector3d(30.0, 0.0, 0.0));
  add_place("in mm", 1000.0 * true_place);
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, MachinesInView) {
  Inputs inputs;
  const auto add_posture = [&](const std::string& name, const MachinePosture& posture,
                               bool is_right) {
    inputs.push_back(wrong_scans(
        rough(), name,
        [=](DigScans& s, auto&) {
          s.before.machine = s.after.machine =
              std::make_shared<const MachineFront>(zx120(), posture);
        },
        {"machine_pose", "zone_partly_unseen", "zone_unseen", "no_hole_found", "no_dumped_soil"},
        is_right));
  };
  add_posture("a machine that is not in view", {0.5 * pi, {1.0, 1.0, 0.5}}, may_be_right);
  const auto dig = std::get<DigPath>(make_dig_path_anywhere(
      zx120(), paper_fixed_path(), boom_plane_profile(level_planning_ground(zx120(), 0.1).bank)));
  add_posture("a machine said to stand in the heap", {0.0, dig.poses.front().joints}, false);
  expect_no_wrong_answer(inputs);
}

// ---- The measured pair --------------------------------------------------------------------------

TEST(BadMeaning, TheMeasuredPair) {
  if (!measured()) GTEST_SKIP() << "without the measured pair";
  static Pair real = *measured();
  DensityEstimate known;
  const Verdict clean = verdict_of([&] {
    known = estimate_density(real.scans, paper_law(), one_thread());
    return judged(known, 0.0);
  });
  std::cout << "measured: as it is | " << clean.text() << std::endl;
  if (known.bulking) real.bulking = known.bulking->value;
  const Codes any = {"swapped",
                     "looks_swapped",
                     "frame",
                     "units",
                     "tilted",
                     "no_dumped_soil",
                     "no_hole_found",
                     "scans_do_not_fit",
                     "registration_beyond_prior",
                     "z is not up",
                     "attribution_open",
                     "zone_at_border",
                     "zone_partly_unseen",
                     "overlap",
                     "fewer than 100",
                     "little_stable_ground"};
  Inputs inputs;
  const auto add_real = [&](const std::string& name, const Spoil& spoil, bool right = false) {
    inputs.push_back(wrong_scans(real, name, spoil, any, right));
  };
  add_real("swapped", [](DigScans& s, auto&) { std::swap(s.before, s.after); });
  add_real("the one after in cm", [](DigScans& s, auto&) { map_points(s.after, scaled(100.0)); });
  add_real("the one after without its frame",
           [](DigScans& s, auto&) { s.after.site_from_scan.setIdentity(); });
  add_real("the same scan twice", [](DigScans& s, auto&) { s.after = s.before; });
  add_real("z down", [](DigScans& s, auto&) { map_both(s, scaled(1.0, 1.0, -1.0)); });
  add_real("the one after mirrored",
           [](DigScans& s, auto&) { map_points(s.after, scaled(1.0, -1.0, 1.0)); });
  expect_no_wrong_answer(inputs);
}

// ---- Depth cameras ------------------------------------------------------------------------------

/// What a camera 6 m above the scene, that looks down, makes of it with other numbers.
PointMap seen_by(const std::function<Vector3d(const Vector3d&)>& misread) {
  return [=](const Vector3d& p) {
    const Vector3d in_camera(p.x() - 2.7, -p.y(), 6.0 - p.z());
    const Vector3d read = misread(in_camera);
    return Vector3d(read.x() + 2.7, -read.y(), 6.0 - read.z());
  };
}

TEST(BadMeaning, DepthImages) {
  Inputs inputs;
  const auto add_camera = [&](const std::string& name, const PointMap& map, const Codes& reasons,
                              bool right = false) {
    inputs.push_back(wrong_scans(
        rough(), name, [=](DigScans& s, auto&) { map_both(s, map); }, reasons, right));
  };
  const auto depth_to = [](const std::function<double(double)>& depth) {
    return seen_by([=](const Vector3d& p) {
      const double z = depth(p.z());
      return Vector3d(z / p.z() * p.x(), z / p.z() * p.y(), z);
    });
  };
  add_camera("fx of another camera, twice as long: k has no unit",
             seen_by([](const Vector3d& p) { return Vector3d(0.5 * p.x(), p.y(), p.z()); }),
             {"tilted"}, may_be_right);
  add_camera("depths ten times too small", depth_to([](double z) { return 0.1 * z; }),
             {"units", "frame"});
  add_camera("depths ten times too large", depth_to([](double z) { return 10.0 * z; }),
             {"units", "zone_partly_unseen"}, may_be_right);
  add_camera("depths inverted", depth_to([](double z) { return 12.0 - z; }),
             {"no_dumped_soil", "swapped", "looks_swapped", "z points down"});
  add_camera("disparity for depth", depth_to([](double z) { return 36.0 / z; }),
             {"no_dumped_soil", "swapped", "looks_swapped", "z points down"});
  const auto along_ray = [](const std::function<double(const Vector3d&)>& factor) {
    return seen_by([=](const Vector3d& p) { return Vector3d(factor(p) * p); });
  };
  const auto cosine = [](const Vector3d& p) { return p.z() / p.norm(); };
  add_camera("ranges read as depths", along_ray([=](const Vector3d& p) { return 1.0 / cosine(p); }),
             {"curved_ground"});
  add_camera("depths read as ranges", along_ray(cosine), {"curved_ground"});
  inputs.push_back(wrong_scans(
      rough(), "fx of another camera in the one after",
      [](DigScans& s, auto&) {
        map_points(s.after,
                   seen_by([](const Vector3d& p) { return Vector3d(0.5 * p.x(), p.y(), p.z()); }));
      },
      {"units", "swapped", "no_dumped_soil", "registration_beyond_prior", "scans_do_not_fit",
       "attribution_open", "zone_at_border", "no_hole_found"}));
  expect_no_wrong_answer(inputs);
}

// ---- Soil, law, payload -------------------------------------------------------------------------

const SoilKind& sand() {
  static const SoilKind soil = load_soil(find_data_file("soils/sand.json"));
  return soil;
}

/// The dig's loose soil that was dumped, if it is loam [kg].
double true_payload() {
  const auto estimate = estimate_density(rough().scans, loam(), one_thread());
  return estimate.change.dumped.value * loose_state(loam()).bulk_density;
}

TEST(BadMeaning, SoilAndPayload) {
  const double mass = true_payload();
  Inputs inputs;
  const auto add_soil = [&](const std::string& name, const SoilKind& soil, Spoil spoil,
                            const Codes& reasons, bool right = false) {
    const auto made = [&soil, spoil] {
      DigScans scans = rough().scans;
      DensityOptions options = one_thread();
      spoil(scans, options);
      return judged(estimate_density(scans, soil, options), rough().bulking);
    };
    inputs.push_back({name, made, reasons, right});
  };
  const auto payload = [](double kilograms) {
    return [=](DigScans&, DensityOptions& options) {
      options.payload_mass = Measured{kilograms, 0.01 * std::abs(kilograms)};
    };
  };
  const auto water = [&](double content) {
    return [=](DigScans&, DensityOptions& options) {
      options.payload_mass = Measured{mass, 0.01 * mass};
      options.soil.water_content = Measured{content, 0.01};
    };
  };
  const Codes payload_codes = {"payload_disagrees", "payload"};
  add_soil("the payload fits", loam(), payload(mass), {}, may_be_right);
  add_soil("payload in t for kg", loam(), payload(0.001 * mass), payload_codes);
  add_soil("payload in kg for t", loam(), payload(1000.0 * mass), payload_codes);
  add_soil("payload in lb for kg", loam(), payload(2.2 * mass), payload_codes);
  add_soil("payload of another dig", loam(), payload(1.6 * mass), payload_codes);
  add_soil("payload below 0", loam(), payload(-mass), payload_codes);
  add_soil("moisture in percent", loam(), water(12.0), {"12 % is 0.12"});
  add_soil("moisture ten times too large", loam(), water(1.2), {"too_wet"});
  inputs.push_back({"law of another soil",
                    [] {
                      DensityOptions options = one_thread();
                      options.soil.kind = sand();
                      const DensityLaw law =
                          load_density_law(find_data_file("laws/zx120-loam.json"));
                      return judged(estimate_density(rough().scans, law, options), rough().bulking);
                    },
                    {"law_of_other_soil"}});
  expect_no_wrong_answer(inputs);
}

TEST(BadMeaning, Laws) {
  const auto density_of = [](double bulking) {
    return [=] {
      const RelativeDensity found = relative_density(paper_law(), {bulking, 0.01});
      return Verdict{found.trustworthy, false, {}, found.warnings};
    };
  };
  const TemporaryFolder folder;
  const auto line = [&](double a, double b) {
    return [&, a, b] {
      auto file = nlohmann::json::parse(content_of(find_data_file("laws/paper.json")));
      file["use"] = "line";
      file["line"]["a"] = a;
      file["line"]["b"] = b;
      load_density_law(folder.write("law.json", file.dump()));
      return Verdict{};
    };
  };
  const auto fitted = [](const std::vector<BulkingSample>& samples) {
    return [=] {
      fit_density_forms(samples);
      return Verdict{};
    };
  };
  expect_no_wrong_answer({
      {"density above 100 %", density_of(2.5), {"density_above_range"}},
      {"density below 0", density_of(0.7), {"density_below_range"}},
      {"a bulking factor below 0", density_of(-0.3), {"bulking factor"}},
      {"a bulking factor in percent", density_of(125.0), {"density_above_range"}},
      {"a law whose densities are fractions", line(2.1, -2.1), {"percent"}},
      {"a law of factors over densities", line(0.004, 1.05), {"percent"}},
      {"samples whose densities are fractions",
       fitted({{1.05, 0.1}, {1.15, 0.3}, {1.25, 0.5}, {1.4, 0.9}}),
       {"percent"}},
      {"samples with both columns exchanged",
       fitted({{10.0, 1.05}, {30.0, 1.15}, {50.0, 1.25}, {90.0, 1.4}}),
       {"must be ratios"}},
  });
}

// ---- Logs ---------------------------------------------------------------------------------------

TEST(BadMeaning, Logs) {
  const TemporaryFolder folder;
  int files = 0;
  /// A dig of 8 s from 10 s on: idling at `idle`, digging at `work`.
  const auto log = [&](const std::string& column, double idle, double work, double second = 1.0) {
    std::string text = "time_s," + column + "\n";
    for (int t = 0; t <= 30; ++t) {
      const bool is_dig = t >= 10 && t <= 18;
      text += std::to_string(second * t) + "," + std::to_string(is_dig ? work : idle) + "\n";
    }
    return folder.write("log" + std::to_string(files++) + ".csv", text);
  };
  const auto measured_by = [](const std::string& file, double from, double to, Payload payload) {
    return [=] {
      LoggedDig dig;
      dig.file = file;
      dig.from = from;
      dig.to = to;
      dig.lifted = payload;
      const DigEfficiency found = measure_efficiency(dig);
      return Verdict{found.trustworthy, found.trustworthy, {}, found.warnings};
    };
  };
  const Payload soil = {Lifted::volume, {0.42, 0.01}};
  const Payload mass = {Lifted::mass, {700.0, 10.0}};
  const Codes fuel = {"implausible_fuel"};
  const Codes energy = {"implausible_energy"};
  const std::string good = log("fuel_flow_ml_per_s", 0.6, 2.2);
  expect_no_wrong_answer({
      {"a log as it should be", measured_by(good, 10, 18, soil), {}, may_be_right},
      {"mL/min for mL/s", measured_by(log("fuel_flow_ml_per_s", 36, 132), 10, 18, soil), fuel},
      {"L/s for mL/s", measured_by(log("fuel_flow_ml_per_s", 6e-4, 2.2e-3), 10, 18, soil), fuel},
      {"mL/s for L/h is not far off", measured_by(log("fuel_flow_l_per_h", 0.6, 2.2), 10, 18, soil),
       fuel, may_be_right},
      {"kW for W", measured_by(log("power_w", 2.0, 8.0), 10, 18, mass), energy},
      {"mW for W", measured_by(log("power_w", 2e6, 8e6), 10, 18, mass), energy},
      {"times in ms", measured_by(log("fuel_flow_ml_per_s", 0.6, 2.2, 1000.0), 10000, 18000, soil),
       fuel},
      {"payload in litres for m3", measured_by(good, 10, 18, {Lifted::volume, {420.0, 10.0}}),
       fuel},
      {"payload in t for kg", measured_by(good, 10, 18, {Lifted::mass, {0.7, 0.01}}), fuel},
      {"the log's clock is 12 s late", measured_by(good, 0, 8, soil), {"dig_below_rest"}},
      {"idling above working",
       measured_by(log("fuel_flow_ml_per_s", 2.2, 0.6), 10, 18, soil),
       {"dig_below_rest"}},
      {"time running backwards",
       measured_by(log("fuel_flow_ml_per_s", 0.6, 2.2, -1.0), -18, -10, soil),
       {"time_s"}},
      {"both columns exchanged",
       measured_by(
           folder.write("swapped.csv", "fuel_flow_ml_per_s,time_s\n0,0.6\n1,2.2\n2,2.2\n3,2.1\n"),
           0.6, 2.0, soil),
       {"time_s"}},
      {"a payload below 0", measured_by(good, 10, 18, {Lifted::volume, {-0.42, 0.01}}), {"volume"}},
      {"a time beyond the log", measured_by(good, 100, 108, soil), {"outside"}},
  });
}

/// A heap of 0.4 m^3 that rose between two scans in some unit.
TEST(BadMeaning, HeapsOfEfficiency) {
  const TemporaryFolder folder;
  const std::string file = folder.write("log.csv", "time_s,power_w\n0,40000\n4,40000\n8,40000\n");
  const auto heaped = [&](double unit, double rise) {
    return [=] {
      ScanPair scans;
      for (const bool after : {false, true}) {
        std::vector<Vector3d> points;
        for (int i = 0; i < 14400; ++i) {
          const double x = 0.033 * (i % 120) - 2.0;
          const double y = 0.033 * (i / 120) - 2.0;
          const double top = rise * std::max(0.0, 1.0 - std::hypot(x, y)) * 0.38;
          points.push_back(unit * Vector3d(x, y, after ? top : 0.0));
        }
        (after ? scans.after : scans.before).clouds = {cloud_of(std::move(points))};
      }
      LoggedDig dig;
      dig.file = file;
      dig.lifted = scans;
      dig.threads = 1;
      const DigEfficiency found = measure_efficiency(dig);
      return Verdict{found.trustworthy,
                     std::abs(found.payload.amount.value - 0.398) < 0.01,
                     {},
                     found.warnings};
    };
  };
  expect_no_wrong_answer({
      {"a heap", heaped(1.0, 1.0), {}, may_be_right},
      {"a heap in mm", heaped(1000.0, 1.0), {"units"}},
      {"a heap in km", heaped(0.001, 1.0), {"units", "`unit`"}},
      {"scans of the heap exchanged", heaped(1.0, -1.0), {"rose"}},
  });
}

// ---- Machines, paths, plans ---------------------------------------------------------------------

TEST(BadMeaning, Machines) {
  const auto with = [](const std::vector<std::string>& pointers, double factor) {
    return [=] {
      nlohmann::json file = nlohmann::json::parse(content_of(zx120_path()));
      for (const std::string& pointer : pointers) {
        auto& value = file.at(nlohmann::json::json_pointer(pointer));
        value = factor * value.get<double>();
      }
      const std::string complaint = complaint_about_file(file);
      return Verdict{complaint == "no error", false, complaint, {}};
    };
  };
  expect_no_wrong_answer({
      {"boom in mm", with({"/geometry/boom_length_m"}, 1000.0), {"boom_length_m"}},
      {"arm in cm", with({"/geometry/arm_length_m"}, 100.0), {"arm_length_m"}},
      {"limits in degrees",
       with({"/joints/boom/lower_rad", "/joints/boom/upper_rad"}, 57.3),
       {"lower_rad", "upper_rad"}},
      {"bucket ten times too wide",
       with({"/bucket/width_outside_m", "/bucket/width_inside_m"}, 10.0),
       {"width_outside_m"}},
  });
}

TEST(BadMeaning, PathsAndPlans) {
  const auto path = [](const DigParameters& parameters, double start) {
    return [=] {
      const Terrain level = level_planning_ground(zx120(), 0.1);
      const auto laid = make_dig_path(zx120(), parameters, start, boom_plane_profile(level.bank));
      const auto* infeasible = std::get_if<Infeasible>(&laid);
      return Verdict{!infeasible, false, infeasible ? infeasible->message : "", {}};
    };
  };
  const auto plan = [](const GroundDensity& density, const std::optional<Terrain>& ground = {}) {
    return [=] {
      PlanOptions options;
      options.search.threads = 1;
      const DigPlan found = ground ? plan_dig(zx120(), loam(), density, *ground, options)
                                   : plan_dig(zx120(), loam(), density, options);
      return Verdict{found.trustworthy && found.dig, false, found.dig ? "" : found.reason,
                     found.warnings};
    };
  };
  const auto slope = [](double angle) {
    Terrain ground = level_planning_ground(zx120(), 0.1);
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      ground.bank.z.col(col) += std::tan(angle) * ground.bank.x(col);
    }
    return ground;
  };
  GroundDensity of_sand = 40.0;
  of_sand.soil = "sand";
  of_sand.trustworthy = false;
  const auto shipped = [](const char* name) {
    return std::make_shared<const PathLibrary>(
        load_path_library(find_data_file(std::string("libraries/") + name)));
  };
  const auto by_library = [](std::shared_ptr<const PathLibrary> library, const SoilKind& soil,
                             Machine machine) {
    return [=] {
      PlanOptions options;
      options.library = library;
      const DigPlan found = plan_dig(machine, soil, 40.0, options);
      return Verdict{found.trustworthy && found.dig, false, {}, found.warnings};
    };
  };
  Machine other = zx120();
  other.arm_length *= 1.1;
  const auto terrain = [](const PointMap& map) {
    return [=] {
      DigScans scans = rough().scans;
      map_points(scans.before, map);
      const ScannedTerrain seen = terrain_from_scan(scans.before, {2.0, -2.0, 9.0, 2.0}, 0.1);
      return Verdict{false, false, {}, seen.warnings};
    };
  };
  expect_no_wrong_answer({
      {"an angle in degrees", path({45.0, 0.35, 1.5}, 6.0), {"angle"}},
      {"lengths in mm", path({0.8, 350.0, 1500.0}, 6.0), {"reach", "joint", "m"}},
      {"a start beyond the reach", path({0.8, 0.35, 1.5}, 30.0), {"reach", "ground", "joint"}},
      {"a density of 0.4 for 40 %", plan(0.4), {"density_as_fraction"}},
      {"a density of 400 %", plan(400.0), {"density"}},
      {"a density that is not trusted, of another soil",
       plan(of_sand),
       {"density_not_trustworthy"}},
      {"a slope that no library has",
       plan(40.0, slope(0.5)),
       {"slope_outside_library", "library", "reach"}},
      {"a library of another soil",
       by_library(shipped("zx120-sand-cycle.json"), loam(), zx120()),
       {"soil"}},
      {"a library of another machine",
       by_library(shipped("zx120-loam-cycle.json"), loam(), other),
       {"machine"}},
      {"a map that does not hold the dig", terrain(shifted(500.0, 0.0, 0.0)), {"reach"}},
      {"a map that holds a part of it: the rest stays unknown",
       [] {
         Scan scan = rough().scans.before;
         map_points(scan, shifted(6.0, 0.0, 0.0));
         const HeightMap seen = terrain_from_scan(scan, {2.0, -2.0, 9.0, 2.0}, 0.1).terrain.bank;
         return Verdict{true, std::isnan(seen.z(20, 5)) && !std::isnan(seen.z(20, 20)), {}, {}};
       },
       {},
       may_be_right},
      {"a map in mm", terrain(scaled(1000.0)), {"reach", "sparse_terrain", "unseen_ground"}},
  });
}

}  // namespace
}  // namespace excavplan
