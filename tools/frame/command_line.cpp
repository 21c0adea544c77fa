// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"
#include "frame/settings_file.hpp"
#include "frame/used_files.hpp"

namespace excavplan::tools {
namespace {

std::vector<bool> given_entries(const ParsedWords& words) {
  std::vector<bool> given;
  for (const ParsedWords::Given& each : words.of_entry) given.push_back(!each.texts.empty());
  return given;
}

bool excludes(const Arguments::Entry& entry, const Arguments::Entry& other) {
  const std::vector<std::string>& names = entry.excludes;
  return std::find(names.begin(), names.end(), other.name) != names.end();
}

/// The first of the given entries beside which an entry may not stand.
std::optional<std::size_t> excluded_by(const std::vector<Arguments::Entry>& entries,
                                       const std::vector<bool>& given, std::size_t entry) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!given[i]) continue;
    if (excludes(entries[i], entries[entry]) || excludes(entries[entry], entries[i])) return i;
  }
  return std::nullopt;
}

/// The first of some names.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

std::string shown_name(const Arguments::Entry& entry) {
  return entry.positional ? entry.name : "--" + entry.name;
}

std::string file_in(const Arguments::Entry& entry, const std::string& text) {
  return entry.file_in ? entry.file_in(text) : text;
}

void assign(const Arguments::Entry& entry, const ParsedWords::Given& given, StandardInput& input) {
  const std::string name = shown_name(entry);
  if (given.texts.empty()) return;
  if (entry.placeholder.empty()) {
    entry.assign("");
    return;
  }
  if (given.texts.size() > 1 && !entry.repeated) usage_error(name + " is given more than once");
  for (const std::string& text : given.texts) {
    if (text.empty()) usage_error(name + " is empty");
    if (!entry.positional && text.rfind("--", 0) == 0) {
      usage_error(name + " needs a value, got " + text);
    }
    if ((entry.output || entry.place) && !entry.standard_output && file_in(entry, text) == "-") {
      usage_error(name + ": standard output is no file to write, ./- is one of that name");
    }
    entry.assign(entry.input && text == "-" ? input.path() : text);
  }
}

std::vector<UsedFile> used_files(const std::vector<Arguments::Entry>& entries,
                                 const ParsedWords& words) {
  std::vector<UsedFile> files;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Arguments::Entry& entry = entries[i];
    const bool writes = entry.output || entry.place;
    if (!writes && !entry.input) continue;
    for (const std::string& text : words.of_entry[i].texts) {
      if (entry.standard_output && text == "-") continue;
      files.push_back({shown_name(entry), file_in(entry, text), writes});
      if (!entry.beside) continue;
      for (const std::string& name : entry.beside(text)) {
        files.push_back({shown_name(entry), name, true});
      }
    }
  }
  return files;
}

void require_ending(const Arguments::Entry& entry, const std::string& file) {
  const std::filesystem::path path(file);
  const std::string own = small_letters(path.extension().string());
  const std::string whole = small_letters(path.filename().string());
  if (!whole.empty() &&
      std::find(entry.endings.begin(), entry.endings.end(), whole) != entry.endings.end()) {
    usage_error(shown_name(entry) + ": '" + file + "' is an ending without a name before it");
  }
  std::string rule;
  for (const std::string& ending : entry.endings) {
    if (ending == own) return;
    if (!ending.empty()) rule += (rule.empty() ? "" : " or ") + ending;
  }
  const bool matters = !entry.by_ending || entry.by_ending();
  if (matters && !rule.empty()) {
    usage_error(shown_name(entry) + ": '" + file + "' must end in " + rule);
  }
}

/// The first use of an option that does not hold; nothing if it has its effect.
const Arguments::Use* broken_use(const Arguments::Entry& entry) {
  const auto broken = std::find_if(entry.uses.begin(), entry.uses.end(),
                                   [](const auto& use) { return !use.holds(); });
  return broken == entry.uses.end() ? nullptr : &*broken;
}

/// A file that would be missed, unlike other options without effect.
void refuse_unwritten(const std::vector<Arguments::Entry>& entries, const ParsedWords& words) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!entries[i].output || words.of_entry[i].texts.empty()) continue;
    if (const Arguments::Use* broken = broken_use(entries[i])) {
      usage_error(shown_name(entries[i]) + " would not be written: " + broken->otherwise);
    }
  }
}

/// What was given for an option, as text.
std::string shown_value(const Arguments::Entry& entry, const std::vector<std::string>& given) {
  if (entry.placeholder.empty()) return "yes";
  std::string value;
  for (const std::string& text : given) {
    if (!value.empty()) value += "; ";
    value += entry.input && text == "-" ? "standard input" : text;
  }
  return value;
}

}  // namespace

ParsedWords sort_words(int argc, const char* const* argv,
                       const std::vector<Arguments::Entry>& entries) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  ParsedWords words;
  words.of_entry.resize(entries.size());
  std::vector<const CLI::Option*> options;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Arguments::Entry& entry = entries[i];
    const std::string name =
        entry.positional ? entry.name : (entry.name == "help" ? "-h,--help" : "--" + entry.name);
    const bool is_flag = entry.placeholder.empty();
    CLI::Option* option =
        is_flag ? app.add_flag(name) : app.add_option(name, words.of_entry[i].text);
    if (is_flag) option->disable_flag_override();
    option->type_name(entry.placeholder)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    options.push_back(option);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    usage_error(error.what());
  }
  for (std::size_t i = 0; i < entries.size(); ++i) words.of_entry[i].texts = options[i]->results();
  words.left_over = app.remaining();
  return words;
}

std::string add_settings(const std::vector<Arguments::Entry>& entries, const About& about,
                         StandardInput& input, ParsedWords& words) {
  const auto config = std::find_if(entries.begin(), entries.end(),
                                   [](const auto& entry) { return entry.name == "config"; });
  ParsedWords::Given& file = words.of_entry[static_cast<std::size_t>(config - entries.begin())];
  if (file.texts.empty()) return {};
  std::string& path = file.texts.back();
  if (path == "-") path = input.path();
  StatedSettings stated = read_settings_file(path, about.name, entries);
  const std::vector<bool> by_words = given_entries(words);
  std::vector<std::string> taken;
  std::vector<std::string> left_out;
  for (StatedSettings::Option& option : stated.options) {
    ParsedWords::Given& given = words.of_entry[option.entry];
    if (!given.texts.empty() || option.texts.empty()) continue;
    const std::string name = "--" + entries[option.entry].name;
    if (const auto other = excluded_by(entries, by_words, option.entry)) {
      left_out.push_back(name + " (--" + entries[*other].name + " is given)");
      continue;
    }
    given.texts = std::move(option.texts);
    given.place = std::move(option.place);
    taken.push_back(name);
  }
  left_out.insert(left_out.end(), stated.left_out.begin(), stated.left_out.end());
  return path + ": " + (taken.empty() ? "nothing" : listed(taken)) +
         (left_out.empty() ? "" : "; left out: " + listed(left_out));
}

void refuse_excluded(const std::vector<Arguments::Entry>& entries, const ParsedWords& words) {
  const std::vector<bool> given = given_entries(words);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto other = given[i] ? excluded_by(entries, given, i) : std::nullopt;
    if (!other) continue;
    const bool first = excludes(entries[i], entries[*other]);
    usage_error("--" + entries[first ? i : *other].name + " excludes --" +
                entries[first ? *other : i].name);
  }
}

void refuse_left_over(const std::vector<std::string>& left_over,
                      const std::vector<Arguments::Entry>& entries) {
  std::vector<std::string> names;
  for (const Arguments::Entry& entry : entries) {
    if (!entry.positional) names.push_back(entry.name);
  }
  const auto names_begin = std::find(left_over.begin(), left_over.end(), "--");
  for (auto at = left_over.begin(); at != left_over.end(); ++at) {
    if (at == names_begin) continue;
    const std::string& word = *at;
    const std::size_t start = word.find_first_not_of('-');
    const bool is_option = at < names_begin && start != std::string::npos && start > 0;
    if (!is_option) usage_error("unexpected argument '" + word + "'");
    const std::string option = word.substr(0, word.find('='));
    const auto meant = nearest_word(option.substr(start), names);
    usage_error("unknown option " + option + (meant ? ", did you mean --" + *meant + "?" : ""));
  }
}

void refuse_beside_json(const std::vector<Arguments::Entry>& entries, const ParsedWords& words) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& texts = words.of_entry[i].texts;
    if (!entries[i].standard_output || texts.empty() || texts.front() != "-") continue;
    usage_error("--json and " + shown_name(entries[i]) +
                " - are both for standard output: write one of them to a file");
  }
}

void assign(const std::vector<Arguments::Entry>& entries, const ParsedWords& words,
            StandardInput& input) {
  for (std::size_t i = 0; i < entries.size(); ++i) assign(entries[i], words.of_entry[i], input);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].required && words.of_entry[i].texts.empty()) {
      usage_error(shown_name(entries[i]) + " is missing: " + entries[i].help);
    }
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!entries[i].check) continue;
    for (const std::string& text : words.of_entry[i].texts) entries[i].check(text);
  }
  refuse_unwritten(entries, words);
  refuse_shared_files(used_files(entries, words));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!entries[i].output) continue;
    for (const std::string& text : words.of_entry[i].texts) {
      if (entries[i].standard_output && text == "-") continue;
      const std::string file = file_in(entries[i], text);
      require_ending(entries[i], file);
      require_writable(file);
    }
  }
}

std::vector<Warning> ignored_options(const std::vector<Arguments::Entry>& entries,
                                     const ParsedWords& words) {
  std::vector<std::pair<std::string, std::string>> names_of_reason;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (words.of_entry[i].texts.empty()) continue;
    const Arguments::Use* broken = broken_use(entries[i]);
    if (!broken) continue;
    const auto same =
        std::find_if(names_of_reason.begin(), names_of_reason.end(),
                     [&](const auto& of_reason) { return of_reason.first == broken->otherwise; });
    if (same == names_of_reason.end()) {
      names_of_reason.emplace_back(broken->otherwise, shown_name(entries[i]));
    } else {
      same->second += ", " + shown_name(entries[i]);
    }
  }
  std::vector<Warning> warnings;
  warnings.reserve(names_of_reason.size());
  for (const auto& [reason, names] : names_of_reason) {
    warnings.emplace_back(WarningCode::options_ignored, "without effect: " + names + "; " + reason);
  }
  return warnings;
}

std::vector<Setting> settings_of(const std::vector<Arguments::Entry>& entries,
                                 const ParsedWords& words, std::size_t count) {
  std::vector<Setting> settings;
  settings.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Arguments::Entry& entry = entries[i];
    const auto& given = words.of_entry[i].texts;
    if (!given.empty()) {
      settings.push_back({shown_name(entry), shown_value(entry, given), true});
    } else if (!entry.default_text.empty()) {
      settings.push_back({shown_name(entry), entry.default_text, false});
    }
  }
  return settings;
}

}  // namespace excavplan::tools
