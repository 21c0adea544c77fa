// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/json.hpp"

#include <cmath>

#include <excavplan/error.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "base/yaml.hpp"

namespace excavplan {
namespace {

using nlohmann::json;

/// nlohmann silently keeps the last of two equal keys; this callback refuses them.
json parse(const std::string& path, const std::string& content) {
  std::vector<std::set<std::string>> keys;
  const auto refuse_duplicates = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) {
      keys.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      keys.pop_back();
    } else if (event == json::parse_event_t::key &&
               !keys.back().insert(parsed.get<std::string>()).second) {
      throw Error(ErrorKind::bad_file,
                  path + ": key '" + parsed.get<std::string>() + "' appears twice");
    }
    return true;
  };
  try {
    return json::parse(content, refuse_duplicates);
  } catch (const json::exception& e) {
    throw Error(ErrorKind::bad_file, path + ": not valid JSON: " + e.what());
  }
}

/// A value in a message.
std::string shown(const json& value) {
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() > 200 ? text.substr(0, 200) + "..." : text;
}

}  // namespace

JsonObject::JsonObject(std::string file, std::string where, json object)
    : file_(std::move(file)), where_(std::move(where)), json_(std::move(object)) {}

JsonObject JsonObject::of_text(const std::string& name, const std::string& content,
                               const std::string& format, int version) {
  JsonObject top(name, "", parse(name, content));
  if (!top.json_.is_object()) {
    throw Error(ErrorKind::bad_file, name + ": expected a JSON object");
  }
  if (top.text("format") != format) {
    top.fail("format", "is '" + top.text("format") + "', expected '" + format + "'");
  }
  if (const double found = top.number("version"); found != version) {
    top.fail("version", "is " + number_text(found) + ", this program reads version " +
                            std::to_string(version));
  }
  return top;
}

JsonObject JsonObject::open(const std::string& path, const std::string& format, int version) {
  return of_text(path, read_file(path), format, version);
}

JsonObject JsonObject::open_sealed(const std::string& name, const std::string& content,
                                   const std::string& format, int version) {
  JsonObject top = of_text(name, content, format, version);
  const std::size_t seal = sealed("").size();
  if (content.size() < seal || sealed(content.substr(0, content.size() - seal)) != content) {
    top.fail("checksum", "does not match the content: the file was modified");
  }
  top.ignore("checksum");
  return top;
}

JsonObject JsonObject::of_others(const std::string& name, const std::string& content) {
  const std::size_t start = content.find_first_not_of(" \t\r\n");
  const bool is_json = start != content.npos && content[start] == '{';
  JsonObject top(name, "", is_json ? parse(name, content) : parse_yaml(name, content));
  if (!top.json_.is_object()) {
    throw Error(ErrorKind::bad_file, name + ": expected keys with values, as JSON or YAML");
  }
  return top;
}

std::string sealed(const std::string& content) {
  return content + ",\n\"checksum\": \"" + checksum_text(content) + "\"\n}\n";
}

std::string sealed_text(const nlohmann::ordered_json& object) {
  const std::string text = object.dump(1);
  return sealed(text.substr(0, text.size() - 2));  // reopened
}

void JsonObject::fail(const std::string& key, const std::string& message) const {
  throw Error(ErrorKind::bad_file, file_ + ": " + where_ + key + ": " + message);
}

bool JsonObject::has(const std::string& key) const { return json_.contains(key); }

const json& JsonObject::at(const std::string& key) {
  read_.insert(key);
  const auto found = json_.find(key);
  if (found == json_.end()) fail(key, "is missing");
  return *found;
}

double JsonObject::number(const std::string& key, double lowest, double highest) {
  const json& value = at(key);
  if (!value.is_number()) fail(key, "is " + shown(value) + ", expected a number");
  const double number = value.get<double>();
  if (!std::isfinite(number) || number < lowest || number > highest) {
    fail(key, "is " + number_text(number) + ", must be in " + number_text(lowest) + " .. " +
                  number_text(highest));
  }
  return number;
}

double JsonObject::number_or(const std::string& key, double fallback, double lowest,
                             double highest) {
  return has(key) ? number(key, lowest, highest) : fallback;
}

std::string JsonObject::text(const std::string& key) {
  const json& value = at(key);
  if (!value.is_string()) fail(key, "is " + shown(value) + ", expected a text");
  return value.get<std::string>();
}

std::string JsonObject::text_or(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : fallback;
}

bool JsonObject::flag(const std::string& key) {
  const json& value = at(key);
  if (!value.is_boolean()) fail(key, "is " + shown(value) + ", expected true or false");
  return value.get<bool>();
}

std::vector<double> JsonObject::numbers(const std::string& key, std::size_t size) {
  const json& list = at(key);
  if (!list.is_array() || list.size() != size) {
    fail(key, "expected a list of " + std::to_string(size) + " numbers, got " + shown(list));
  }
  return numbers(key);
}

std::vector<double> JsonObject::numbers(const std::string& key) {
  const json& list = at(key);
  if (!list.is_array()) fail(key, "expected a list of numbers, got " + shown(list));
  std::vector<double> numbers;
  for (const json& entry : list) {
    if (!entry.is_number()) fail(key, "holds " + shown(entry) + ", expected a number");
    numbers.push_back(entry.get<double>());
  }
  return numbers;
}

JsonObject JsonObject::object(const std::string& key) {
  const json& value = at(key);
  if (!value.is_object()) fail(key, "expected an object");
  return {file_, where_ + key + ".", value};
}

std::vector<JsonObject> JsonObject::objects(const std::string& key) {
  const json& list = at(key);
  if (!list.is_array()) fail(key, "expected a list of objects");
  std::vector<JsonObject> objects;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = key + "[" + std::to_string(i) + "]";
    if (!list[i].is_object()) fail(place, "expected an object");
    objects.push_back({file_, where_ + place + ".", list[i]});
  }
  return objects;
}

void JsonObject::done() const {
  for (const auto& [key, value] : json_.items()) {
    if (read_.count(key) == 0) fail(key, "is not a key of this file");
  }
}

void require_writable(const nlohmann::ordered_json& json, const std::string& what) {
  const nlohmann::ordered_json flat = json.flatten();
  for (const auto& [place, value] : flat.items()) {
    const auto refuse = [&, &key = place](const std::string& found) {
      throw Error(ErrorKind::bad_input, what + ": " + excavplan::quoted(key) + " is " + found);
    };
    if (value.is_number_float() && !std::isfinite(value.get<double>())) {
      refuse(number_text(value.get<double>()) + ", must be finite");
    }
    if (!value.is_string()) continue;
    try {
      static_cast<void>(value.dump());
    } catch (const nlohmann::json::type_error&) {
      refuse("not UTF-8");
    }
  }
}

}  // namespace excavplan
