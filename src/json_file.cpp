// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "json_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using nlohmann::json;

/// nlohmann keeps the last of two equal keys without a word; this callback refuses them.
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
                  path + ": key '" + parsed.get<std::string>() + "' stands twice");
    }
    return true;
  };
  try {
    return json::parse(content, refuse_duplicates);
  } catch (const json::exception& e) {
    throw Error(ErrorKind::bad_file, path + ": not valid JSON: " + e.what());
  }
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
    top.fail("checksum", "does not fit the content: the file was altered");
  }
  top.ignore("checksum");
  return top;
}

std::uint64_t checksum(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

std::string checksum_text(const std::string& text) {
  std::uint64_t hash = checksum(text);
  std::string digits(16, '0');
  for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
  return digits;
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
  if (!value.is_number()) fail(key, "is " + value.dump() + ", expected a number");
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
  if (!value.is_string()) fail(key, "is " + value.dump() + ", expected a text");
  return value.get<std::string>();
}

std::string JsonObject::text_or(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : fallback;
}

bool JsonObject::flag(const std::string& key) {
  const json& value = at(key);
  if (!value.is_boolean()) fail(key, "is " + value.dump() + ", expected true or false");
  return value.get<bool>();
}

std::vector<double> JsonObject::numbers(const std::string& key, std::size_t size) {
  const json& list = at(key);
  if (!list.is_array() || list.size() != size) {
    fail(key, "expected a list of " + std::to_string(size) + " numbers, got " + list.dump());
  }
  std::vector<double> numbers;
  for (const json& entry : list) {
    if (!entry.is_number()) fail(key, "holds " + entry.dump() + ", expected a number");
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

std::string number_text(double value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string decimals(double value, int digits) {
  char text[400];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr;
  return {text, end};
}

void write_file(const std::string& path, const std::string& content) {
  struct stat status {};
  const bool stays = ::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
  char host[65] = {};  // a folder may be shared by machines
  ::gethostname(host, sizeof host - 1);
  const std::string beside = path + ".part-" + host + "-" + std::to_string(::getpid());
  const std::string& written = stays ? path : beside;
  std::ofstream out(written, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out || (!stays && std::rename(beside.c_str(), path.c_str()) != 0)) {
    if (!stays) std::remove(beside.c_str());
    throw Error(ErrorKind::bad_file, path + ": cannot be written");
  }
}

void require_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (std::filesystem::is_directory(folder)) return;
  throw Error(ErrorKind::bad_file, path + ": there is no folder " + folder.string());
}

std::string read_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw Error(ErrorKind::bad_file, path + ": no such file, or not readable");
  }
  if (!S_ISREG(status.st_mode)) throw Error(ErrorKind::bad_file, path + ": is not a regular file");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) throw Error(ErrorKind::bad_file, path + ": cannot be read");
  return content.str();
}

}  // namespace excavplan
