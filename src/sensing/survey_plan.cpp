// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/survey_plan.hpp>

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/check.hpp"

namespace excavplan {
namespace {

constexpr double margin = 0.10;       // by which zones are wider than what changed [m]
constexpr double scans = 2.0;         // before and after
constexpr double least_stable = 0.1;  // of what is seen: stable ground that is always left [-]
// Ours: what the datum's variance is worth more than that of a mean over all stable ground, because
// it is found robustly, and if a motion is found with it (k within 1.80 % instead of 1.48 % at 3.4
// m in simulated surveys).
constexpr double datum_cost = 1.5;
constexpr double registration_cost = 2.5;
constexpr double farthest_place = 1000.0;  // [m]
constexpr int most_frames = 1000;

void require(bool holds, const char* name, double value, const char* rule) {
  excavplan::require(holds && std::isfinite(value), std::string("survey plan: ") + name, value,
                     rule);
}

void require_in(const char* name, double value, double lowest, double highest) {
  excavplan::require_in(std::string("survey plan: ") + name, value, lowest, highest);
}

void check(const Sensor& sensor) {
  require(sensor.noise >= 0.0, "noise of the sensor", sensor.noise, ">= 0 m");
  require(sensor.pattern >= 0.0, "pattern of the sensor", sensor.pattern, ">= 0 m");
  require(sensor.pattern_rays >= 0.0, "width of the pattern", sensor.pattern_rays, ">= 0 rays");
  require(sensor.range_power >= 0.0 && sensor.range_power <= 4.0, "power of the range",
          sensor.range_power, "in 0 .. 4");
  require(sensor.ray_angle > 0.0 && sensor.ray_angle < 0.5, "angle between rays", sensor.ray_angle,
          "in 0 .. 0.5 rad");
  for (const double view : {sensor.view_across, sensor.view_along}) {
    require(view > 0.0 && view < pi, "field of view", view, "in 0 .. pi rad");
  }
}

void check(const SurveyPlan& plan) {
  // Of volumes as estimate_density() takes them for a dig, of k with what it takes for likely;
  // the others ours.
  require_in("dig volume [m^3]", plan.dig_volume, 0.001, 1000.0);
  require_in("dig depth [m]", plan.dig_depth, 0.01, 30.0);
  require_in("bulking factor", plan.bulking_factor, 0.9, 3.0);
  require(plan.spill_share >= 0.0 && plan.spill_share < 1.0, "share of spill", plan.spill_share,
          "in [0, 1)");
  require(plan.wall_angle > 0.0 && plan.wall_angle <= 0.5 * pi, "wall angle", plan.wall_angle,
          "in 0 .. pi/2 rad");
  require(plan.angle_of_repose > 0.0 && plan.angle_of_repose < 1.5, "angle of repose",
          plan.angle_of_repose, "in 0 .. 1.5 rad");
  require_in("surveyed area [m^2]", plan.surveyed_area, 0.1, 1e4);
  require_in("height of the sensor [m]", plan.height, 0.1, 100.0);
  require_in("offset of the sensor [m]", plan.offset, 0.0, 100.0);
  require(plan.frames >= 1, "number of frames", plan.frames, ">= 1");
  require(plan.density_slope > 0.0, "slope of the density law", plan.density_slope, "> 0 %");
  check(plan.sensor);
}

/// Pit twice as long as wide, spill as a ridge along it, heap as a cone [m], [m^2].
struct Shapes {
  double pit_length;
  double pit_width;
  double pit_zone;
  double spill_half_width;
  double spill_zone;
  double heap_radius;
  double heap_height;
  double heap_zone;
  double changed_area() const { return pit_length * pit_width + pi * heap_radius * heap_radius; }
};

Shapes shapes_of(const SurveyPlan& plan) {
  const double slope = std::tan(plan.angle_of_repose);
  const double loose = plan.dig_volume * plan.bulking_factor;
  Shapes s{};
  // Volume of a pit with sloped walls, to first order in their width.
  const double wall = plan.dig_depth / std::tan(plan.wall_angle);
  const double mean_width = std::sqrt(0.5 * plan.dig_volume / plan.dig_depth);
  s.pit_width = mean_width + wall;
  s.pit_length = 2.0 * mean_width + wall;
  s.pit_zone = (s.pit_length + 2.0 * margin) * (s.pit_width + 2.0 * margin);
  const double spill = loose * plan.spill_share;
  if (spill > 0.0) {
    s.spill_half_width = std::sqrt(spill / (s.pit_length * slope));
    s.spill_zone = (s.pit_length + 2.0 * s.spill_half_width + 2.0 * margin) *
                   (2.0 * s.spill_half_width + 2.0 * margin);
  }
  s.heap_radius = std::cbrt(3.0 * loose * (1.0 - plan.spill_share) / (pi * slope));
  s.heap_height = s.heap_radius * slope;
  s.heap_zone = pi * std::pow(s.heap_radius + margin, 2);
  return s;
}

/// The view of the sensor onto one area.
struct View {
  double range;
  double cosine;  // of the angle from the vertical
  double sine;
  double across;  // width of its footprint on the ground [m]
  double along;   // length of it
};

View view_of(const SurveyPlan& plan) {
  View view{};
  view.range = std::hypot(plan.height, plan.offset);
  view.cosine = plan.height / view.range;
  view.sine = plan.offset / view.range;
  view.across = 2.0 * view.range * std::tan(0.5 * plan.sensor.view_across);
  const double tilt = std::atan2(plan.offset, plan.height);
  const double half = 0.5 * plan.sensor.view_along;
  const double far = std::min(tilt + half, 89.0 * degree);
  view.along = plan.height * (std::tan(far) - std::tan(tilt - half));
  return view;
}

/// Variance of a volume per area of ground from one change between two scans [m^4], by kind.
struct Noise {
  double white;
  double correlated;
};

/// Mean over ground that spreads by `spread` [m] about the middle of the view: both grow with
/// range to the power 2 p + 2, as the ground under a ray grows with its square.
Noise noise_over(const SurveyPlan& plan, const View& view, double spread) {
  const double power = 2.0 * plan.sensor.range_power + 2.0;
  const double away = spread * view.sine / view.range;
  const double unevenness = 1.0 + 0.5 * power * (power - 1.0) * away * away;
  const double spacing = plan.sensor.ray_angle * view.range;
  const double per_ray = scans * std::pow(view.range, 2.0 * plan.sensor.range_power) * spacing *
                         spacing * view.cosine * unevenness;
  const double rays = 2.0 * pi * std::pow(plan.sensor.pattern_rays, 2);
  return {per_ray * std::pow(plan.sensor.noise, 2) / plan.frames,
          per_ray * std::pow(plan.sensor.pattern, 2) * std::max(rays, 1.0)};
}

/// An edge behind which ground falls away [m].
struct Edge {
  double height;
  double length;
  double face;   // angle of the ground behind it [rad]
  double reach;  // ground farther behind it is seen, or does not count
};

/// Volume and area hidden behind an edge.
struct Hidden {
  double volume_sd = 0.0;
  double area = 0.0;
};

/// @param sight gradient of the ray over the edge, in plan over height
Hidden hidden_behind(const Edge& edge, double sight) {
  const double strip =
      std::clamp(edge.height * (sight - 1.0 / std::tan(edge.face)), 0.0, edge.reach);
  return {0.5 * edge.height * strip * edge.length, strip * edge.length};
}

/// Variances of one of the two volumes of k [m^6].
struct Budget {
  double white = 0.0;
  double correlated = 0.0;
  double datum = 0.0;
  double occlusion = 0.0;
  double datum_height = 0.0;  // variance [m^2]
  double sum() const { return white + correlated + datum + occlusion; }
};

/// @param changed zones of the area that count [m^2]
/// @param in_sight all zones of the area [m^2]
Budget budget_of(const SurveyPlan& plan, const View& view, double changed, double in_sight) {
  const Noise here = noise_over(plan, view, std::sqrt(in_sight / 12.0));
  const double seen = std::min(plan.surveyed_area, view.across * view.along);
  const double stable = std::max(seen - in_sight, least_stable * seen);
  const Noise around = noise_over(plan, view, std::sqrt(seen / 12.0));
  Budget budget;
  budget.white = changed * here.white;
  budget.correlated = changed * here.correlated;
  budget.datum_height = datum_cost * (plan.registered ? registration_cost : 1.0) *
                        (around.white + around.correlated) / stable;
  budget.datum = changed * changed * budget.datum_height;
  return budget;
}

/// Both volumes of k.
struct Budgets {
  Budget pit;
  Budget after;               // spill and heap
  double shared_datum = 0.0;  // pit and spill have one: a high one makes the pit deeper and the
                              // spill lower [m^6]
  double hidden_area = 0.0;   // [m^2]
};

Budgets budgets_of(const SurveyPlan& plan, const View& view, const Shapes& shapes) {
  const double dig_zones = shapes.pit_zone + shapes.spill_zone;
  const Budget spill = budget_of(plan, view, shapes.spill_zone, dig_zones);
  const Hidden floor =
      hidden_behind({plan.dig_depth, shapes.pit_length, plan.wall_angle, shapes.pit_width},
                    (plan.offset - 0.5 * shapes.pit_width) / plan.height);
  const Hidden flank = hidden_behind(
      {shapes.heap_height, shapes.heap_radius, plan.angle_of_repose, 2.0 * shapes.heap_radius},
      plan.offset / plan.height);
  Budgets budgets;
  budgets.pit = budget_of(plan, view, shapes.pit_zone, dig_zones);
  budgets.pit.occlusion = std::pow(floor.volume_sd, 2);
  budgets.after = budget_of(plan, view, shapes.heap_zone, shapes.heap_zone);
  budgets.after.white += spill.white;
  budgets.after.correlated += spill.correlated;
  budgets.after.datum += spill.datum;
  budgets.after.occlusion = std::pow(flank.volume_sd, 2);
  budgets.shared_datum = std::sqrt(budgets.pit.datum * spill.datum);
  budgets.hidden_area = floor.area + flank.area;
  return budgets;
}

bool fits(const View& view, const Shapes& shapes) {
  const double longest = std::max(shapes.pit_length, 2.0 * shapes.heap_radius) + 2.0 * margin;
  const double widest =
      std::max(shapes.pit_width + 2.0 * shapes.spill_half_width, 2.0 * shapes.heap_radius) +
      2.0 * margin;
  return longest <= view.across && widest <= view.along;
}

SurveyPlan at_range(SurveyPlan plan, double range) {
  const double scale = range / std::hypot(plan.height, plan.offset);
  plan.height *= scale;
  plan.offset *= scale;
  return plan;
}

/// The place between `low` and `high` where `holds` changes from true to false.
template <typename Holds>
double last_that(double low, double high, const Holds& holds) {
  for (int step = 0; step < 60; ++step) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

SurveyForecast forecast_of(const SurveyPlan& plan) {
  const Shapes shapes = shapes_of(plan);
  const View view = view_of(plan);
  const Budgets budgets = budgets_of(plan, view, shapes);
  const double before = plan.dig_volume;
  const double loose = before * plan.bulking_factor;
  const auto relative = [&](double Budget::*part) {
    return budgets.pit.*part / (before * before) + budgets.after.*part / (loose * loose);
  };
  const double white = relative(&Budget::white);
  const double correlated = relative(&Budget::correlated);
  const double datum = relative(&Budget::datum) + 2.0 * budgets.shared_datum / (before * loose);
  const double occlusion = relative(&Budget::occlusion);
  const double variance = white + correlated + datum + occlusion;

  SurveyForecast forecast;
  forecast.range = view.range;
  forecast.ray_spacing = plan.sensor.ray_angle * view.range;
  forecast.excavated_sd = std::sqrt(budgets.pit.sum());
  forecast.after_sd = std::sqrt(budgets.after.sum());
  forecast.bulking_sd = plan.bulking_factor * std::sqrt(variance);
  forecast.density_sd_percent = plan.density_slope * forecast.bulking_sd;
  forecast.datum_sd = std::sqrt(budgets.pit.datum_height);
  if (variance > 0.0) {
    forecast.white_share = white / variance;
    forecast.correlated_share = correlated / variance;
    forecast.datum_share = datum / variance;
    forecast.occlusion_share = occlusion / variance;
  }
  forecast.hidden_share = std::min(1.0, budgets.hidden_area / shapes.changed_area());
  forecast.in_view = fits(view, shapes);
  require(forecast.datum_sd >= 0.0, "datum", forecast.datum_sd, "finite: a number is too large");
  require(forecast.density_sd_percent >= 0.0, "sd of the density", forecast.density_sd_percent,
          "finite: a number is too large");
  return forecast;
}

}  // namespace

SurveyForecast plan_survey(const SurveyPlan& plan) {
  check(plan);
  return forecast_of(plan);
}

SurveyNeeds survey_needs(const SurveyPlan& plan, double density_sd_percent) {
  require(density_sd_percent > 0.0 && density_sd_percent <= 100.0, "target", density_sd_percent,
          "> 0 and at most 100 points of density");
  const SurveyForecast planned = plan_survey(plan);
  const Shapes shapes = shapes_of(plan);
  constexpr double nearest = 0.01;
  const auto sd_at = [&](double range) {
    return forecast_of(at_range(plan, range)).density_sd_percent;
  };
  SurveyNeeds needs;
  needs.nearest_range = last_that(nearest, farthest_place, [&](double range) {
    return !fits(view_of(at_range(plan, range)), shapes);
  });
  if (sd_at(needs.nearest_range) <= density_sd_percent) {
    needs.range = last_that(needs.nearest_range, farthest_place,
                            [&](double range) { return sd_at(range) <= density_sd_percent; });
  }
  SurveyPlan still = plan;
  for (still.frames = 1; still.frames <= most_frames && !needs.frames; ++still.frames) {
    if (forecast_of(still).density_sd_percent <= density_sd_percent) needs.frames = still.frames;
  }
  const double variance = std::pow(planned.density_sd_percent, 2);
  const double left = std::pow(density_sd_percent, 2) - variance * planned.occlusion_share;
  const double by_noise = variance * (1.0 - planned.occlusion_share);
  if (left > 0.0 && by_noise > 0.0) needs.noise = std::sqrt(left / by_noise);
  return needs;
}

}  // namespace excavplan
