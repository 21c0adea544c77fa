// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/belief/belief_file.hpp>

#include <limits>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/json.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* belief_format = "excavplan-belief";

/// The settings by their keys.
constexpr std::pair<const char*, double BeliefSettings::*> setting_keys[] = {
    {"mean_percent", &BeliefSettings::mean_percent},
    {"level_sd_percent", &BeliefSettings::level_sd_percent},
    {"trend_sd_percent_per_m", &BeliefSettings::trend_sd_percent_per_m},
    {"spread_percent", &BeliefSettings::spread_percent},
    {"length_m", &BeliefSettings::length},
    {"depth_length_m", &BeliefSettings::depth_length},
    {"law_sd_percent", &BeliefSettings::law_sd_percent},
    {"payload_sd_percent", &BeliefSettings::payload_sd_percent},
    {"log_strength_sd", &BeliefSettings::log_strength_sd}};

// ---- written ------------------------------------------------------------------------------------

Json law_json(Json object, const ResistanceLaw& law) {
  object["at_percent"] = law.at_percent;
  object["rise_per_percent"] = law.rise_per_percent;
  object["strength_share"] = law.strength_share;
  return object;
}

Json survey_json(const SurveyReading& survey) {
  Json scans = Json::array();
  for (const ScanError& scan : survey.scans) {
    scans.push_back({{"scan", scan.scan}, {"effect_percent", scan.effect_percent}});
  }
  return {{"raw_percent", survey.raw_percent}, {"sd_percent", survey.sd_percent}, {"scans", scans}};
}

Json dig_json(const DigEvidence& dig) {
  Json bank = Json::array();
  for (const BankPart& part : dig.bank) {
    bank.push_back({{"x_m", part.place.x},
                    {"y_m", part.place.y},
                    {"depth_m", part.place.depth},
                    {"volume_m3", part.volume}});
  }
  Json resistance = Json::array();
  for (const ResistanceReading& reading : dig.resistance) {
    resistance.push_back(
        law_json({{"log_ratio", reading.log_ratio}, {"sd", reading.sd}}, reading.law));
  }
  Json limits = Json::array();
  for (const LimitReading& limit : dig.limits) {
    limits.push_back(
        law_json({{"was_met", limit.was_met}, {"log_margin", limit.log_margin}, {"sd", limit.sd}},
                 limit.law));
  }
  Json object = {{"bank", bank}, {"bank_share", dig.bank_share}};
  if (dig.survey) object["survey"] = survey_json(*dig.survey);
  if (dig.payload_percent) {
    object["payload"] = {{"percent", dig.payload_percent->value},
                         {"sd_percent", dig.payload_percent->sd}};
  }
  object["resistance"] = resistance;
  object["limits"] = limits;
  return object;
}

// ---- read ---------------------------------------------------------------------------------------

ResistanceLaw law_of(JsonObject& object) {
  ResistanceLaw law;
  law.at_percent = object.number("at_percent");
  law.rise_per_percent = object.number("rise_per_percent");
  law.strength_share = object.number("strength_share");
  return law;
}

int whole_number(JsonObject& object, const std::string& key) {
  constexpr int most = std::numeric_limits<int>::max();
  const double number = object.number(key, -most, most);
  const int whole = static_cast<int>(number);
  if (static_cast<double>(whole) != number) object.fail(key, "must be a whole number");
  return whole;
}

SurveyReading survey_of(JsonObject object) {
  SurveyReading survey{object.number("raw_percent"), object.number("sd_percent")};
  for (JsonObject& scan : object.objects("scans")) {
    survey.scans.push_back({whole_number(scan, "scan"), scan.number("effect_percent")});
    scan.done();
  }
  object.done();
  return survey;
}

Measured payload_of(JsonObject object) {
  const Measured payload{object.number("percent"), object.number("sd_percent")};
  object.done();
  return payload;
}

DigEvidence dig_of(JsonObject& object) {
  DigEvidence dig;
  for (JsonObject& part : object.objects("bank")) {
    dig.bank.push_back({{part.number("x_m"), part.number("y_m"), part.number("depth_m")},
                        part.number("volume_m3")});
    part.done();
  }
  dig.bank_share = object.number("bank_share");
  if (object.has("survey")) dig.survey = survey_of(object.object("survey"));
  if (object.has("payload")) dig.payload_percent = payload_of(object.object("payload"));
  for (JsonObject& reading : object.objects("resistance")) {
    const double log_ratio = reading.number("log_ratio");
    dig.resistance.push_back({log_ratio, reading.number("sd"), law_of(reading)});
    reading.done();
  }
  for (JsonObject& limit : object.objects("limits")) {
    const bool was_met = limit.flag("was_met");
    const double log_margin = limit.number("log_margin");
    dig.limits.push_back({was_met, log_margin, limit.number("sd"), law_of(limit)});
    limit.done();
  }
  object.done();
  return dig;
}

BeliefSettings settings_of(JsonObject object) {
  BeliefSettings settings;
  for (const auto& [key, setting] : setting_keys) settings.*setting = object.number(key);
  object.done();
  return settings;
}

}  // namespace

std::string to_json(const DensityBelief& belief) {
  Json settings;
  for (const auto& [key, setting] : setting_keys) settings[key] = belief.settings().*setting;
  Json digs = Json::array();
  for (const DigEvidence& dig : belief.digs()) digs.push_back(dig_json(dig));
  Json file = {{"format", belief_format}, {"version", 1}, {"settings", settings}, {"digs", digs}};
  if (belief.forgotten()) file["forgotten"] = dig_json(*belief.forgotten());
  require_storable(file, "belief");
  return json_text(file, 1) + "\n";
}

void save_belief(const std::string& path, const DensityBelief& belief) {
  write_file(path, to_json(belief));
}

DensityBelief load_belief(const std::string& path) {
  JsonObject file = JsonObject::open(path, belief_format);
  const BeliefSettings settings = settings_of(file.object("settings"));
  std::vector<DigEvidence> digs;
  for (JsonObject& dig : file.objects("digs")) digs.push_back(dig_of(dig));
  std::optional<DigEvidence> forgotten;
  if (file.has("forgotten")) {
    JsonObject dig = file.object("forgotten");
    forgotten = dig_of(dig);
  }
  file.done();
  try {
    return DensityBelief(settings, digs, std::move(forgotten));
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, path + ": " + error.what());
  }
}

}  // namespace excavplan
