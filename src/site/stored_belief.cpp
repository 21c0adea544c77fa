// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/stored_belief.hpp"

#include <array>
#include <utility>
#include <vector>

#include "base/json.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* belief_format = "excavplan-belief";

/// The settings by their names in a file.
template <typename Settings>
auto rows_of(Settings& settings) {
  using Row = std::pair<const char*, decltype(&settings.mean_percent)>;
  return std::array{Row{"mean_percent", &settings.mean_percent},
                    Row{"level_sd_percent", &settings.level_sd_percent},
                    Row{"trend_sd_percent_per_m", &settings.trend_sd_percent_per_m},
                    Row{"spread_percent", &settings.spread_percent},
                    Row{"length_m", &settings.length},
                    Row{"depth_length_m", &settings.depth_length},
                    Row{"law_sd_percent", &settings.law_sd_percent},
                    Row{"payload_sd_percent", &settings.payload_sd_percent},
                    Row{"log_strength_sd", &settings.log_strength_sd}};
}

// ---- writing ----------------------------------------------------------------------------------

Json json_of(const ResistanceLaw& law) {
  return {{"at_percent", law.at_percent},
          {"rise_per_percent", law.rise_per_percent},
          {"strength_share", law.strength_share}};
}

Json json_of(const SurveyReading& survey) {
  Json scans = Json::array();
  for (const ScanError& each : survey.scans) {
    scans.push_back({{"scan", each.scan}, {"effect_percent", each.effect_percent}});
  }
  return {{"raw_percent", survey.raw_percent}, {"sd_percent", survey.sd_percent}, {"scans", scans}};
}

Json json_of(const DigEvidence& dig) {
  Json json = {{"bank_share", dig.bank_share},
               {"bank", Json::array()},
               {"resistance", Json::array()},
               {"limits", Json::array()}};
  for (const BankPart& part : dig.bank) {
    json["bank"].push_back({{"x_m", part.place.x},
                            {"y_m", part.place.y},
                            {"depth_m", part.place.depth},
                            {"volume_m3", part.volume}});
  }
  if (dig.survey) json["survey"] = json_of(*dig.survey);
  if (dig.payload_percent) {
    json["payload"] = {{"percent", dig.payload_percent->value},
                       {"sd_percent", dig.payload_percent->sd}};
  }
  for (const ResistanceReading& each : dig.resistance) {
    json["resistance"].push_back(
        {{"log_ratio", each.log_ratio}, {"sd", each.sd}, {"law", json_of(each.law)}});
  }
  for (const LimitReading& each : dig.limits) {
    json["limits"].push_back({{"was_met", each.was_met},
                              {"log_margin", each.log_margin},
                              {"sd", each.sd},
                              {"law", json_of(each.law)}});
  }
  return json;
}

// ---- reading: DensityBelief checks the numbers ------------------------------------------------

ResistanceLaw law_in(JsonObject& reading) {
  JsonObject law = reading.object("law");
  const ResistanceLaw found = {law.number("at_percent"), law.number("rise_per_percent"),
                               law.number("strength_share")};
  law.done();
  return found;
}

SurveyReading survey_in(JsonObject& dig) {
  JsonObject survey = dig.object("survey");
  SurveyReading found = {survey.number("raw_percent"), survey.number("sd_percent"), {}};
  for (JsonObject& each : survey.objects("scans")) {
    constexpr double most_scan = 2e9;
    found.scans.push_back({static_cast<int>(each.number("scan", -most_scan, most_scan)),
                           each.number("effect_percent")});
    each.done();
  }
  survey.done();
  return found;
}

DigEvidence dig_in(JsonObject& json) {
  DigEvidence dig;
  dig.bank_share = json.number("bank_share");
  for (JsonObject& part : json.objects("bank")) {
    dig.bank.push_back({{part.number("x_m"), part.number("y_m"), part.number("depth_m")},
                        part.number("volume_m3")});
    part.done();
  }
  if (json.has("survey")) dig.survey = survey_in(json);
  if (json.has("payload")) {
    JsonObject payload = json.object("payload");
    dig.payload_percent = Measured{payload.number("percent"), payload.number("sd_percent")};
    payload.done();
  }
  for (JsonObject& each : json.objects("resistance")) {
    dig.resistance.push_back({each.number("log_ratio"), each.number("sd"), law_in(each)});
    each.done();
  }
  for (JsonObject& each : json.objects("limits")) {
    dig.limits.push_back(
        {each.flag("was_met"), each.number("log_margin"), each.number("sd"), law_in(each)});
    each.done();
  }
  json.done();
  return dig;
}

BeliefSettings settings_in(JsonObject& file) {
  JsonObject json = file.object("settings");
  BeliefSettings settings;
  for (const auto& [name, value] : rows_of(settings)) *value = json.number(name);
  json.done();
  return settings;
}

}  // namespace

std::string belief_text(const DensityBelief& belief) {
  Json json = {{"format", belief_format}, {"version", 1}, {"settings", Json::object()}};
  for (const auto& [name, value] : rows_of(belief.settings())) json["settings"][name] = *value;
  if (belief.forgotten()) json["forgotten"] = json_of(*belief.forgotten());
  json["digs"] = Json::array();
  for (const DigEvidence& each : belief.digs()) json["digs"].push_back(json_of(each));
  return sealed_text(json);
}

DensityBelief belief_of(const std::string& name, const std::string& content) {
  JsonObject file = JsonObject::open_sealed(name, content, belief_format);
  const BeliefSettings settings = settings_in(file);
  std::optional<DigEvidence> forgotten;
  if (file.has("forgotten")) {
    JsonObject json = file.object("forgotten");
    forgotten = dig_in(json);
  }
  std::vector<DigEvidence> digs;
  for (JsonObject& each : file.objects("digs")) digs.push_back(dig_in(each));
  file.done();
  try {
    return DensityBelief(settings, digs, forgotten);
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, name + ": " + error.what());
  }
}

}  // namespace excavplan
