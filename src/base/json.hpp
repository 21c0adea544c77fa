// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/base/warning.hpp>

#include "base/text.hpp"

/// @file
/// JSON, read and written in one place. Strict reading of our own files: every error names the
/// file, the key, the value and the rule; a key that is not read is an error. Private to the
/// project.

namespace excavplan {

constexpr std::size_t most_json_levels = 64;      ///< of arrays and objects in one another; ours
constexpr std::size_t most_json_values = 500000;  ///< of a file, each of some 100 bytes; ours

/// The value of a text from anywhere, which must be UTF-8, at most most_json_levels deep, of no
/// more values than that, and hold no key of an object twice. @param name  of the text, for
/// messages
/// @throws Error (bad_file)
nlohmann::json parse_json(const std::string& name, const std::string& content,
                          std::size_t most_values = most_json_values);
/// The same with the keys in the order of the text, for few of them.
nlohmann::ordered_json parse_ordered_json(const std::string& name, const std::string& content);

/// The text of a value. @param indent  of a level; -1: all on one line
/// @throws Error (bad_input) if a text in it is not UTF-8
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);
/// A value in a message: cut, and fit for a terminal.
std::string shown(const nlohmann::json& value);

/// An object of a JSON file with its path in the file ("links.boom").
class JsonObject {
 public:
  /// Opens a file whose top object has "format": `format` and "version": `version`.
  /// @throws Error (bad_file)
  static JsonObject open(const std::string& path, const std::string& format, int version = 1);
  /// The same of the text of a file. `name` is for messages.
  static JsonObject of_text(const std::string& name, const std::string& content,
                            const std::string& format, int version = 1);
  /// The same of a text that ends in its checksum, as sealed() writes it. `name` is for messages.
  static JsonObject open_sealed(const std::string& name, const std::string& content,
                                const std::string& format, int version = 1,
                                std::size_t most_values = most_json_values);

  /// An object of keys alone, without "format" and "version". @throws Error (bad_file)
  static JsonObject of_plain(const std::string& name, const std::string& content);

  /// The content of a file of another program, JSON or YAML (base/yaml.hpp); what is not read of
  /// it is no error. @throws Error (bad_file)
  static JsonObject of_others(const std::string& name, const std::string& content);

  /// What a tool printed with --json, or an object with keys of the same names that does not say
  /// where it is from. @throws Error (bad_file) if it is of another tool or a file with a "format"
  static JsonObject result_of(const std::string& tool, const std::string& path);

  /// @throws Error (bad_file) unless "format" and "version" are these
  void require_format(const std::string& format, int version = 1);

  bool has(const std::string& key) const;
  /// Whether it has the key with a value other than null.
  bool states(const std::string& key) const;
  double number(const std::string& key, double lowest = -std::numeric_limits<double>::max(),
                double highest = std::numeric_limits<double>::max());
  double number_or(const std::string& key, double fallback,
                   double lowest = -std::numeric_limits<double>::max(),
                   double highest = std::numeric_limits<double>::max());
  /// A text on one line without control characters (base/text.hpp), of at most so many bytes.
  std::string text(const std::string& key, std::size_t most_bytes = longest_text);
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
  using Value = std::shared_ptr<const nlohmann::json>;  ///< in the value of the whole file
  JsonObject(std::string file, std::string where, Value object);
  /// Of a whole file. @throws Error (bad_file) with `expected` unless it is an object
  static JsonObject top(const std::string& name, nlohmann::json value, const char* expected);
  const nlohmann::json& at(const std::string& key);

  std::string file_;
  std::string where_;
  Value json_;
  std::set<std::string> read_;
};

/// What is to be written can be read again.
/// @throws Error (bad_input) "WHAT: KEY is ...": a number that is not finite, a text that
/// JsonObject::text() would refuse
void require_storable(const nlohmann::ordered_json& json, const std::string& what);

/// A JSON object without its closing brace, with its own checksum as the last key.
std::string sealed(const std::string& content);
/// An object as text, with its checksum as the last key.
std::string sealed_text(const nlohmann::ordered_json& object);

/// Key `warnings` of a result, a record or a log: of each its code, its message and whether it ends
/// trust.
nlohmann::ordered_json warnings_json(const std::vector<Warning>& warnings);
/// Reads them back. @throws Error (bad_file) naming file, key, value and rule
std::vector<Warning> read_warnings(std::vector<JsonObject> list);

}  // namespace excavplan
