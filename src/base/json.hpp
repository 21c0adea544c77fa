// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// @file
/// Strict reading of our own JSON files: every error names the file, the key, the value and the
/// rule; a key that is not read, or appears twice, is an error. Private to the project.

namespace excavplan {

/// An object of a JSON file with its path in the file ("links.boom").
class JsonObject {
 public:
  /// Opens a file whose top object has "format": `format` and "version": `version`.
  /// @throws Error (bad_file)
  static JsonObject open(const std::string& path, const std::string& format, int version = 1);
  /// The same of a text that ends in its checksum, as sealed() writes it. `name` is for messages.
  static JsonObject open_sealed(const std::string& name, const std::string& content,
                                const std::string& format, int version = 1);

  /// The content of a file of another program, JSON or YAML (base/yaml.hpp); what is not read of
  /// it is no error. @throws Error (bad_file)
  static JsonObject of_others(const std::string& name, const std::string& content);

  bool has(const std::string& key) const;
  double number(const std::string& key, double lowest = -std::numeric_limits<double>::max(),
                double highest = std::numeric_limits<double>::max());
  double number_or(const std::string& key, double fallback,
                   double lowest = -std::numeric_limits<double>::max(),
                   double highest = std::numeric_limits<double>::max());
  std::string text(const std::string& key);
  std::string text_or(const std::string& key, const std::string& fallback);
  bool flag(const std::string& key);
  /// A list of numbers of exactly `size` entries.
  std::vector<double> numbers(const std::string& key, std::size_t size);
  /// One of any length.
  std::vector<double> numbers(const std::string& key);
  JsonObject object(const std::string& key);
  std::vector<JsonObject> objects(const std::string& key);

  /// Marks a key as read without reading it ("sources" and other free text).
  void ignore(const std::string& key) { read_.insert(key); }
  /// @throws Error (bad_file) if a key was not read
  void done() const;
  /// @throws Error (bad_file): "file: key: message"
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  JsonObject(std::string file, std::string where, nlohmann::json object);
  static JsonObject of_text(const std::string& name, const std::string& content,
                            const std::string& format, int version);
  const nlohmann::json& at(const std::string& key);

  std::string file_;
  std::string where_;
  nlohmann::json json_;
  std::set<std::string> read_;
};

/// What is to be written can be read again.
/// @throws Error (bad_input) "WHAT: KEY is ...": a number that is not finite, a text not UTF-8
void require_writable(const nlohmann::ordered_json& json, const std::string& what);

/// A JSON object without its closing brace, with its own checksum as the last key.
std::string sealed(const std::string& content);
/// An object as text, with its checksum as the last key.
std::string sealed_text(const nlohmann::ordered_json& object);

}  // namespace excavplan
