// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "base/yaml.hpp"

namespace excavplan {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(ErrorKind::bad_file, name + ": " + why);
}

/// Builds the value of a text as it is read, level by level: neither depth nor width costs more
/// than in proportion, which nlohmann's own callbacks do.
template <typename Json>
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(const std::string& name, std::size_t most_values)
      : name_(name), most_values_(most_values) {}
  Json& value() { return value_; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(typename Json::number_integer_t value) override { return add(value); }
  bool number_unsigned(typename Json::number_unsigned_t value) override { return add(value); }
  bool number_float(double value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(typename Json::binary_t& value) override { return add(std::move(value)); }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    const auto [place, is_new] = open_.back()->emplace(name, nullptr);
    if (!is_new) refuse(name_, "key " + in_quotes(name) + " appears twice");
    place_ = &*place;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& e) override {
    refuse(name_, std::string("not valid JSON: ") + e.what());
  }

 private:
  template <typename Value>
  bool add(Value&& value) {
    if (++values_ > most_values_) {
      refuse(name_,
             "found more than " + std::to_string(most_values_) + " values, expected at most that");
    }
    if (open_.empty() || open_.back()->is_object()) {
      *place_ = std::forward<Value>(value);
    } else {
      open_.back()->push_back(std::forward<Value>(value));
      place_ = &open_.back()->back();
    }
    return true;
  }
  bool open(Json empty) {
    if (open_.size() == most_json_levels) {
      refuse(name_, "found more than " + std::to_string(most_json_levels) +
                        " levels of arrays and objects, expected at most that");
    }
    add(std::move(empty));
    open_.push_back(place_);
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const std::string& name_;
  const std::size_t most_values_;
  std::size_t values_ = 0;
  Json value_;
  Json* place_ = &value_;  ///< of the value that comes next, or came last
  std::vector<Json*> open_;
};

void require_utf8(const std::string& name, const std::string& content) {
  const auto bad = first_not_utf8(content);
  if (!bad) return;
  constexpr char digits[] = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(content[*bad]);
  throw Error(ErrorKind::bad_file, name + ": byte " + std::to_string(*bad) + ": found 0x" +
                                       digits[byte >> 4U] + digits[byte & 15U] +
                                       ", expected UTF-8");
}

template <typename Json>
Json parse(const std::string& name, const std::string& content, std::size_t most_values) {
  require_utf8(name, content);
  Builder<Json> builder(name, most_values);
  Json::sax_parse(content, &builder);
  return std::move(builder.value());
}

constexpr std::array warning_codes = {
#define EXCAVPLAN_WARNING(code, trust) WarningCode::code,
#include <excavplan/base/warning_codes.def>
};

}  // namespace

json parse_json(const std::string& name, const std::string& content, std::size_t most_values) {
  return parse<json>(name, content, most_values);
}

nlohmann::ordered_json parse_ordered_json(const std::string& name, const std::string& content) {
  return parse<nlohmann::ordered_json>(name, content, most_json_values);
}

std::string json_text(const nlohmann::ordered_json& value, int indent) {
  try {
    return value.dump(indent);
  } catch (const json::exception&) {
    throw Error(ErrorKind::bad_input,
                "a name or another text in a file to write is not UTF-8: " + shown(value));
  }
}

std::string shown(const json& value) {
  return safe_text(value.dump(-1, ' ', false, json::error_handler_t::replace), 200);
}

JsonObject::JsonObject(std::string file, std::string where, Value object)
    : file_(std::move(file)), where_(std::move(where)), json_(std::move(object)) {}

JsonObject JsonObject::top(const std::string& name, json value, const char* expected) {
  if (!value.is_object()) throw Error(ErrorKind::bad_file, name + ": expected " + expected);
  return {name, "", std::make_shared<const json>(std::move(value))};
}

JsonObject JsonObject::open(const std::string& path, const std::string& format, int version) {
  return of_text(path, read_file(path), format, version);
}

JsonObject JsonObject::of_text(const std::string& name, const std::string& content,
                               const std::string& format, int version) {
  JsonObject file = top(name, parse_json(name, content), "a JSON object");
  file.require_format(format, version);
  return file;
}

JsonObject JsonObject::open_sealed(const std::string& name, const std::string& content,
                                   const std::string& format, int version,
                                   std::size_t most_values) {
  JsonObject file = top(name, parse_json(name, content, most_values), "a JSON object");
  file.require_format(format, version);
  const std::size_t seal = sealed("").size();
  if (content.size() < seal || sealed(content.substr(0, content.size() - seal)) != content) {
    file.fail("checksum", "does not match the content: the file was modified");
  }
  file.ignore("checksum");
  return file;
}

JsonObject JsonObject::of_plain(const std::string& name, const std::string& content) {
  return top(name, parse_json(name, content), "a JSON object");
}

JsonObject JsonObject::of_others(const std::string& name, const std::string& content) {
  const std::size_t start = content.find_first_not_of(" \t\r\n");
  const bool is_json = start != content.npos && content[start] == '{';
  if (!is_json) require_utf8(name, content);
  return top(name, is_json ? parse_json(name, content) : parse_yaml(name, content),
             "keys with values, as JSON or YAML");
}

JsonObject JsonObject::result_of(const std::string& tool, const std::string& path) {
  const std::string expected = "a result of " + tool + " --json";
  JsonObject result = top(path, parse_json(path, read_file(path)), expected.c_str());
  const bool is_of_other = result.has("tool") && result.text("tool") != tool;
  if (!is_of_other && !result.has("format")) return result;
  const char* key = is_of_other ? "tool" : "format";
  result.fail(key, "is " + shown(result.at(key)) + ", expected " + expected);
}

void JsonObject::require_format(const std::string& format, int version) {
  if (const std::string found = text("format"); found != format) {
    fail("format", "is " + in_quotes(found) + ", expected '" + format + "'");
  }
  if (const double found = number("version"); found != version) {
    fail("version",
         "is " + number_text(found) + ", this program reads version " + std::to_string(version));
  }
}

std::string sealed(const std::string& content) {
  return content + ",\n\"checksum\": \"" + checksum_text(content) + "\"\n}\n";
}

std::string sealed_text(const nlohmann::ordered_json& object) {
  const std::string text = json_text(object, 1);
  return sealed(text.substr(0, text.size() - 2));  // reopened
}

void JsonObject::fail(const std::string& key, const std::string& message) const {
  constexpr std::size_t longest_place = 200;
  throw Error(ErrorKind::bad_file,
              file_ + ": " + safe_text(where_ + key, longest_place) + ": " + message);
}

bool JsonObject::has(const std::string& key) const { return json_->contains(key); }

bool JsonObject::states(const std::string& key) const {
  return has(key) && !json_->at(key).is_null();
}

const json& JsonObject::at(const std::string& key) {
  read_.insert(key);
  const auto found = json_->find(key);
  if (found == json_->end()) fail(key, "is missing");
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

std::string JsonObject::text(const std::string& key, std::size_t most_bytes) {
  const json& value = at(key);
  if (!value.is_string()) fail(key, "is " + shown(value) + ", expected a text");
  std::string text = value.get<std::string>();
  if (const auto fault = fault_of_line(text, most_bytes)) fail(key, "is " + *fault);
  return text;
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
  return {file_, where_ + key + ".", Value(json_, &value)};
}

std::vector<JsonObject> JsonObject::objects(const std::string& key) {
  const json& list = at(key);
  if (!list.is_array()) fail(key, "expected a list of objects");
  std::vector<JsonObject> objects;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = key + "[" + std::to_string(i) + "]";
    if (!list[i].is_object()) fail(place, "expected an object");
    objects.push_back({file_, where_ + place + ".", Value(json_, &list[i])});
  }
  return objects;
}

void JsonObject::done() const {
  for (const auto& [key, value] : json_->items()) {
    if (read_.count(key) == 0) fail(key, "is not a key of this file");
  }
}

void require_storable(const nlohmann::ordered_json& json, const std::string& what) {
  const nlohmann::ordered_json flat = json.flatten();
  for (const auto& [place, value] : flat.items()) {
    const auto refuse = [&, &key = place](const std::string& found) {
      throw Error(ErrorKind::bad_input, what + ": " + in_quotes(key) + " is " + found);
    };
    if (value.is_number_float() && !std::isfinite(value.get<double>())) {
      refuse(number_text(value.get<double>()) + ", must be finite");
    }
    if (!value.is_string()) continue;
    if (const auto fault = fault_of_line(value.get_ref<const std::string&>(), longest_text)) {
      refuse(*fault);
    }
  }
}

nlohmann::ordered_json warnings_json(const std::vector<Warning>& warnings) {
  auto list = nlohmann::ordered_json::array();
  for (const Warning& each : warnings) {
    list.push_back({{"code", code_text(each.code)},
                    {"message", each.message},
                    {"ends_trust", each.ends_trust}});
  }
  return list;
}

std::vector<Warning> read_warnings(std::vector<JsonObject> list) {
  std::vector<Warning> warnings;
  for (JsonObject& each : list) {
    const std::string code = each.text("code");
    const auto known =
        std::find_if(warning_codes.begin(), warning_codes.end(),
                     [&](WarningCode candidate) { return code_text(candidate) == code; });
    if (known == warning_codes.end()) each.fail("code", "is no code of a warning");
    warnings.emplace_back(*known, each.text("message"), each.flag("ends_trust"));
    each.done();
  }
  return warnings;
}

}  // namespace excavplan
