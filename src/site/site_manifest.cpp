// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/site_manifest.hpp"

#include "base/json.hpp"

namespace excavplan {
namespace {

constexpr const char* manifest_format = "excavplan-site";

nlohmann::ordered_json json_of(const StoredFile& file) {
  return {{"file", file.name}, {"checksum", file.digest}};
}

StoredFile file_of(JsonObject& manifest, const char* key) {
  if (!manifest.has(key)) return {};
  JsonObject object = manifest.object(key);
  StoredFile file = {object.text("file"), object.text("checksum")};
  object.done();
  return file;
}

long long count_of(JsonObject& object, const char* key) {
  const double count = object.number(key, 0.0, 1e15);
  const auto whole = static_cast<long long>(count);
  if (static_cast<double>(whole) != count) object.fail(key, "must be a whole number");
  return whole;
}

}  // namespace

std::string manifest_text(const SiteManifest& manifest) {
  nlohmann::ordered_json json = {{"format", manifest_format},
                                 {"version", 1},
                                 {"soil", manifest.soil},
                                 {"machine", manifest.machine},
                                 {"law", manifest.law},
                                 {"frame", manifest.frame},
                                 {"cell_size_m", manifest.cell_size},
                                 {"updates", manifest.generation},
                                 {"digs", manifest.digs}};
  if (!manifest.ground.name.empty()) json["ground"] = json_of(manifest.ground);
  if (!manifest.first.name.empty()) json["first"] = json_of(manifest.first);
  if (!manifest.belief.name.empty()) json["belief"] = json_of(manifest.belief);
  if (!manifest.previous.name.empty()) json["previous"] = json_of(manifest.previous);
  json["latest"] = nlohmann::ordered_json::array();
  for (const SiteRecord& each : manifest.latest) {
    json["latest"].push_back({{"scan", each.scan}, {"time_s", each.time}, {"dig", each.dug}});
  }
  require_storable(json, "site");
  return sealed_text(json);
}

SiteManifest manifest_of(const std::string& name, const std::string& content) {
  JsonObject file = JsonObject::open_sealed(name, content, manifest_format);
  SiteManifest manifest;
  manifest.soil = file.text("soil");
  manifest.machine = file.text("machine");
  manifest.law = file.text("law");
  manifest.frame = file.text("frame");
  manifest.cell_size = file.number("cell_size_m", 1e-6, 1e6);
  manifest.generation = count_of(file, "updates");
  manifest.digs = count_of(file, "digs");
  manifest.ground = file_of(file, "ground");
  manifest.first = file_of(file, "first");
  manifest.belief = file_of(file, "belief");
  manifest.previous = file_of(file, "previous");
  for (JsonObject& each : file.objects("latest")) {
    manifest.latest.push_back(
        {each.text("scan"), each.number("time_s", -latest_time, latest_time), each.flag("dig")});
    each.done();
  }
  file.done();
  return manifest;
}

}  // namespace excavplan
