// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/settings_file.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

// toml++ 3.3 asserts, or with NDEBUG lets clang++ assume, that the header of a table begins as a
// key. Its parser refuses others by itself.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/text.hpp"

namespace excavplan::tools {
namespace {

// Of the command line alone.
constexpr std::array<std::string_view, 3> not_in_files = {"config", "help", "version"};

class Settings {
 public:
  Settings(const std::string& name, const std::string& tool,
           const std::vector<Arguments::Entry>& entries)
      : name_(name), tool_(tool), entries_(entries) {}

  StatedSettings read(const std::string& text) {
    const toml::table all = parsed(text);
    for (const auto& [key, value] : all) {
      const std::string name(key.str());
      if (!value.is_table()) {
        take(name, value, false);
      } else if (name != tool_) {
        require_tool(name, value);
        stated_.left_out.push_back("[" + name + "]");
      }
    }
    if (const toml::node* own = all.get(tool_)) {
      if (!own->is_table()) refuse(*own, "'" + tool_ + "' must be a table, [" + tool_ + "]");
      for (const auto& [key, value] : *own->as_table()) take(std::string(key.str()), value, true);
    }
    return std::move(stated_);
  }

 private:
  toml::table parsed(const std::string& text) const {
    refuse_long_lines(text);
    if (const auto bad = first_not_utf8(text)) {
      throw Error(ErrorKind::bad_file,
                  name_ + ": byte " + std::to_string(*bad) + " is no UTF-8 text");
    }
    try {
      return toml::parse(text);
    } catch (const toml::parse_error& error) {
      throw Error(ErrorKind::bad_file,
                  place(error.source()) + safe_text(error.description(), longest_text));
    }
  }

  /// Dotted keys nest once per dot, and tables are destroyed level by level on the stack.
  void refuse_long_lines(const std::string& text) const {
    std::istringstream lines(text);
    std::size_t number = 1;
    for (std::string line; std::getline(lines, line); ++number) {
      if (line.size() <= longest_text) continue;
      throw Error(ErrorKind::bad_file, name_ + ": line " + std::to_string(number) + ": " +
                                           std::to_string(line.size()) + " bytes, at most " +
                                           std::to_string(longest_text) + " are allowed");
    }
  }

  std::string place(const toml::source_region& source) const {
    return name_ + ": line " + std::to_string(source.begin.line) + ", column " +
           std::to_string(source.begin.column) + ": ";
  }

  [[noreturn]] void refuse(const toml::node& node, const std::string& why) const {
    throw Error(ErrorKind::bad_file, place(node.source()) + why);
  }

  /// `own`: from the table of this tool, so that the key must be one of its options.
  void take(const std::string& name, const toml::node& value, bool own) {
    if (std::find(not_in_files.begin(), not_in_files.end(), name) != not_in_files.end()) {
      refuse(value, "--" + name + " is of the command line alone");
    }
    const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const auto& each) {
      return !each.positional && each.name == name;
    });
    if (entry == entries_.end()) {
      if (own) refuse_unknown(name, value);
      stated_.left_out.push_back(name);
      return;
    }
    if (entry->output || entry->place) {
      refuse(value, "--" + name + " is of the command line alone: a file names nothing to write");
    }
    const auto index = static_cast<std::size_t>(entry - entries_.begin());
    StatedSettings::Option option = {index, texts_of(*entry, value), place(value.source())};
    if (entry->check_in_file) check(*entry, option);
    const auto same = std::find_if(stated_.options.begin(), stated_.options.end(),
                                   [&](const auto& each) { return each.entry == index; });
    if (same == stated_.options.end()) {
      stated_.options.push_back(std::move(option));
    } else {
      *same = std::move(option);
    }
  }

  static void check(const Arguments::Entry& entry, const StatedSettings::Option& option) {
    try {
      for (const std::string& text : option.texts) entry.check_in_file(text);
    } catch (const Error& error) {
      throw Error(ErrorKind::bad_file, option.place + error.what());
    }
  }

  void require_tool(const std::string& name, const toml::node& value) const {
    const std::vector<std::string> tools = split(EXCAVPLAN_TOOL_NAMES, ' ');
    if (name == tool_ || std::find(tools.begin(), tools.end(), name) != tools.end()) return;
    refuse(value, in_quotes("[" + name + "]") + " is the name of no tool" + meant(name, tools));
  }

  [[noreturn]] void refuse_unknown(const std::string& name, const toml::node& value) const {
    std::vector<std::string> names;
    for (const Arguments::Entry& entry : entries_) {
      if (!entry.positional) names.push_back(entry.name);
    }
    refuse(value, in_quotes(name) + " is no option of " + tool_ + meant(name, names));
  }

  static std::string meant(const std::string& name, const std::vector<std::string>& names) {
    const auto nearest = nearest_word(name, names);
    return nearest ? ", did you mean '" + *nearest + "'?" : "";
  }

  std::vector<std::string> texts_of(const Arguments::Entry& entry, const toml::node& value) const {
    const bool is_flag = entry.placeholder.empty();
    if (const auto flag = value.value_exact<bool>()) {
      if (!is_flag) refuse(value, "'" + entry.name + "' needs a value, " + entry.placeholder);
      return *flag ? std::vector<std::string>{"true"} : std::vector<std::string>{};
    }
    if (is_flag) refuse(value, "'" + entry.name + "' must be true or false");
    const toml::array* list = value.as_array();
    if (!list) return {text_of(value)};
    if (!entry.repeated) return {joined(*list)};
    std::vector<std::string> texts;
    for (const toml::node& each : *list) {
      texts.push_back(each.is_array() ? joined(*each.as_array()) : text_of(each));
    }
    return texts;
  }

  std::string joined(const toml::array& list) const {
    std::string text;
    for (const toml::node& each : list) text += (text.empty() ? "" : ",") + text_of(each);
    return text;
  }

  std::string text_of(const toml::node& value) const {
    if (const auto text = value.value_exact<std::string>()) {
      if (const auto fault = fault_of_line(*text, longest_text))
        refuse(value, "a text is " + *fault);
      return *text;
    }
    if (const auto whole = value.value_exact<std::int64_t>()) return std::to_string(*whole);
    if (const auto number = value.value_exact<double>()) return number_text(*number);
    refuse(value, "must be a text, a number, true, false or a list of texts or numbers");
  }

  const std::string& name_;
  const std::string& tool_;
  const std::vector<Arguments::Entry>& entries_;
  StatedSettings stated_;
};

}  // namespace

StatedSettings read_settings_file(const std::string& path, const std::string& tool,
                                  const std::vector<Arguments::Entry>& entries) {
  return parse_settings(path, read_file(path, most_foreign_bytes), tool, entries);
}

StatedSettings parse_settings(const std::string& name, const std::string& text,
                              const std::string& tool,
                              const std::vector<Arguments::Entry>& entries) {
  return Settings(name, tool, entries).read(text);
}

}  // namespace excavplan::tools
