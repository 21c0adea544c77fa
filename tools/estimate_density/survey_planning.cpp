// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/survey_planning.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include <excavplan/sensing/survey_plan.hpp>

#include "frame/quantity.hpp"
#include "results/survey_results.hpp"

namespace excavplan::tools {
namespace {

struct Request {
  SurveyPlan plan;
  double target = 5.0;  ///< required standard deviation of the density [points]
};

struct Key {
  const char* name;
  Quantity quantity;
  double SurveyPlan::*field;
  const char* help;
};

constexpr std::array<Key, 6> keys = {{
    {"height", Quantity::length, &SurveyPlan::height, "of the sensor above the ground"},
    {"offset", Quantity::length, &SurveyPlan::offset,
     "of the sensor from the centre of the area, horizontal"},
    {"volume", Quantity::volume, &SurveyPlan::dig_volume, "of the dig"},
    {"depth", Quantity::length, &SurveyPlan::dig_depth, "of the dig"},
    {"area", Quantity::area, &SurveyPlan::surveyed_area, "around dig and heap, each"},
    {"k", Quantity::ratio, &SurveyPlan::bulking_factor, "bulking factor expected"},
}};

[[noreturn]] void plan_error(const std::string& what) { usage_error("--plan-survey: " + what); }

std::string key_names() {
  std::string text = "sensor";
  for (const Key& key : keys) text += std::string(", ") + key.name;
  return text + ", frames, moved, target";
}

void set(Request& request, const std::string& name, const std::string& value) {
  const std::string what = "--plan-survey " + name;
  for (const Key& key : keys) {
    if (name != key.name) continue;
    request.plan.*key.field = parse_quantity(what, value, key.quantity);
    return;
  }
  if (name == "sensor") {
    try {
      request.plan.sensor = sensor_of_word(value);
    } catch (const Error& error) {
      plan_error(error.what());
    }
  } else if (name == "frames") {
    const double frames = parse_quantity(what, value, Quantity::ratio);
    if (frames != std::floor(frames) || !(frames >= 1.0 && frames <= 1e6)) {
      plan_error("frames is " + value + ", must be a whole number in 1 .. 1000000");
    }
    request.plan.frames = static_cast<int>(frames);
  } else if (name == "moved") {
    if (value != "yes" && value != "no") plan_error("moved is '" + value + "', must be yes or no");
    request.plan.registered = value == "yes";
  } else if (name == "target") {
    request.target = parse_quantity(what, value, Quantity::percent);
  } else {
    plan_error("'" + name + "' is not one of " + key_names());
  }
}

Request parse(const std::string& text) {
  Request request;
  std::set<std::string> names;
  std::istringstream stream(text);
  for (std::string pair; std::getline(stream, pair, ',');) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos) plan_error("'" + pair + "' must be KEY=VALUE");
    const std::string name = pair.substr(0, equals);
    if (!names.insert(name).second) plan_error("'" + name + "' is given more than once");
    set(request, name, pair.substr(equals + 1));
  }
  return request;
}

constexpr const char* insufficient = "is not enough alone";

std::string at_most(const std::optional<double>& value, const std::string& unit) {
  return value ? "at most " + readable(*value, 2) + unit : insufficient;
}

std::vector<std::string> lines_of(const Request& request, const SurveyForecast& f,
                                  const SurveyNeeds& needs) {
  const auto percent = [](double share) { return readable(100.0 * share, 2) + " %"; };
  return {
      "sensor     " + request.plan.sensor.name + ", " + readable(f.range, 3) +
          " m from the centre of the area, ray spacing " + readable(1000.0 * f.ray_spacing, 2) +
          " mm",
      "bulking    sd " + readable(f.bulking_sd, 2),
      "density    sd " + readable(f.density_sd_percent, 2) +
          " points (one standard deviation, without the scatter of the law)",
      "  of which " + percent(f.white_share) + " noise, " + percent(f.correlated_share) +
          " pattern, " + percent(f.datum_share) + " datum, " + percent(f.occlusion_share) +
          " hidden ground",
      "for " + readable(request.target, 2) + " points, either",
      "  range    " + at_most(needs.range, " m at this angle of view"),
      "  frames   " + (needs.frames ? "at least " + std::to_string(*needs.frames) : insufficient),
      "  noise    " + at_most(needs.noise, " times that of this sensor")};
}

}  // namespace

std::string survey_keys() {
  std::string text = "predict the density error of a survey, without scans. Keys: sensor=";
  for (const Sensor& sensor : sensors()) {
    text += (&sensor == &default_sensor() ? "" : "|") + sensor.name;
  }
  for (const Key& key : keys) text += std::string(", ") + key.name + " (" + key.help + ")";
  return text +
         ", frames (averaged), moved=yes|no (the sensor moves between the scans), target "
         "(points of density)";
}

Outcome planned_survey(const std::string& text, const DensityLaw& law) {
  Request request = parse(text);
  request.plan.density_slope = density_slope(law.form, request.plan.bulking_factor);
  const SurveyForecast forecast = plan_survey(request.plan);
  const SurveyNeeds needs = survey_needs(request.plan, request.target);
  Outcome outcome;
  outcome.json = forecast_json(request.plan, forecast, needs, request.target);
  outcome.json["law"] = law.name;
  outcome.lines = lines_of(request, forecast, needs);
  if (!forecast.in_view) {
    outcome.warnings.emplace_back(WarningCode::not_in_view,
                                  "pit, spill and heap do not fit into the field of view; at this "
                                  "angle they fit from a range of " +
                                      readable(needs.nearest_range, 3) + " m");
  }
  return outcome;
}

}  // namespace excavplan::tools
