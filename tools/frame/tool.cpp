// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string_view>
#include <system_error>

#include <excavplan/base/data_files.hpp>
#include <excavplan/kit/kit_files.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/simulators.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "frame/settings_file.hpp"
#include "frame/stack.hpp"
#include "frame/standard_input.hpp"
#include "frame/used_files.hpp"

namespace excavplan::tools {
namespace {

// ---- Help -------------------------------------------------------------------------------------

constexpr std::size_t help_width = 96;

/// `text` broken at blanks, the lines after the first indented.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > help_width) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string help_row(const std::string& left, const std::string& right) {
  constexpr std::size_t indent = 30;
  const std::string start = "  " + left;
  const std::string gap = start.size() + 2 > indent ? '\n' + std::string(indent, ' ')
                                                    : std::string(indent - start.size(), ' ');
  return start + gap + wrapped(right, indent) + '\n';
}

std::string help_text(const About& about, const std::vector<Arguments::Entry>& entries) {
  std::string usage = "Usage: " + about.name;
  std::string positionals;
  std::string options;
  for (const Arguments::Entry& entry : entries) {
    if (entry.positional) {
      usage += entry.required ? " " + entry.name : " [" + entry.name + "]";
      positionals += help_row(entry.name, entry.help);
      continue;
    }
    std::string help = entry.help;
    if (entry.required) {
      help += " (required)";
    } else if (!entry.default_text.empty()) {
      help += " (default: " + entry.default_text + ")";
    }
    const std::string value = entry.placeholder.empty() ? "" : " " + entry.placeholder;
    options += help_row((entry.name == "help" ? "-h, --" : "--") + entry.name + value, help);
  }
  std::string text =
      wrapped(about.name + ": " + about.summary, 0) + "\n\n" + usage + " [OPTIONS]\n";
  if (!positionals.empty()) text += '\n' + positionals;
  text += "\nOptions:\n" + options;
  text +=
      "\nA bare number is in the unit in brackets; 45deg, 5cm, 50mm are understood as well. One "
      "FILE "
      "that\nis read may be -, standard input.\n";
  if (!about.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : about.examples) {
    text += "  " + example.command + "\n      " + wrapped(example.meaning, 6) + '\n';
  }
  std::string codes =
      "Exit codes: 0 done; 1 internal error, or not enough memory; 2 wrong usage; 3 a file cannot "
      "be read or written, or has the wrong format or content, or a simulator fails";
  if (about.can_be_untrustworthy) codes += "; 4 result not trustworthy, with --strict";
  if (about.can_stop_early) codes += "; 75 stopped early, can be resumed";
  return text + '\n' + wrapped(codes + ".", 0) + '\n';
}

// ---- Parsing ----------------------------------------------------------------------------------

struct Common {
  bool help = false;
  bool version = false;
  bool json = false;
  bool quiet = false;
  bool strict = false;
  std::optional<std::string> config;
};

void declare_common(Arguments& arguments, const About& about, Common& common) {
  arguments.flag("json", common.json, "print only one JSON object on standard output");
  if (about.can_be_untrustworthy) {
    arguments.flag("strict", common.strict, "exit with 4 if the result is not trustworthy");
  }
  arguments.file("config", common.config,
                 "file of settings for options that are not given: keys as options, [" +
                     about.name + "] for this tool alone (TOML)");
  arguments.flag("quiet", common.quiet,
                 "print no summary, notes, progress or warnings, only errors");
  arguments.flag("version", common.version, "print the version and exit");
  arguments.flag("help", common.help, "print this help and exit");
}

/// Words of the command line by the entry they belong to.
struct ParsedWords {
  struct Given {
    std::string text;  ///< the last one
    std::vector<std::string> texts;
    std::string place = {};  ///< in the file of settings; empty: on the command line
  };
  std::vector<Given> of_entry;
  std::vector<std::string> left_over;  ///< also the first "--", behind which all words are names
};

/// CLI11 only sorts the words. Conversion and missing options come after the check for unknown
/// ones, so that "--denisty 40" is reported as misspelt rather than --density as missing.
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

/// Takes from --config what the command line does not give. @return what was taken, as a line for
/// the user; empty without --config
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

/// Runs `work`; an error about the value of an option then says where in the file it stands.
template <typename Work>
auto naming_settings(const std::vector<Arguments::Entry>& entries, const ParsedWords& words,
                     const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string message = error.what();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::string option = "--" + entries[i].name;
      const std::size_t end = option.size();
      const bool is_about = message.compare(0, end, option) == 0 && message.size() > end &&
                            (message[end] == ':' || message[end] == ' ');
      if (is_about && !words.of_entry[i].place.empty()) {
        throw Error(ErrorKind::bad_file, words.of_entry[i].place + message);
      }
    }
    throw;
  }
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

/// Standard output holds one thing.
void refuse_beside_json(const std::vector<Arguments::Entry>& entries, const ParsedWords& words) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& texts = words.of_entry[i].texts;
    if (!entries[i].standard_output || texts.empty() || texts.front() != "-") continue;
    usage_error("--json and " + shown_name(entries[i]) +
                " - are both for standard output: write one of them to a file");
  }
}

/// One for each reason why options that were given have no effect.
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
  for (const auto& [reason, names] : names_of_reason) {
    warnings.push_back({WarningCode::options_ignored, "without effect: " + names + "; " + reason});
  }
  return warnings;
}

// ---- Running ----------------------------------------------------------------------------------

/// Opens what is closed of the standard streams, so that no file takes its place. To read or write
/// them still fails.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// On standard output, to its end.
void print(const std::string& text) {
  errno = 0;
  std::cout << text << std::flush;
  if (std::cout) return;
  const std::string why = errno == 0 ? "" : ": " + std::generic_category().message(errno);
  throw Error(ErrorKind::bad_file, "standard output: cannot be written" + why);
}

std::string json_text(const About& about, const Outcome& outcome) {
  nlohmann::ordered_json json = {{"tool", about.name}, {"version", EXCAVPLAN_VERSION}};
  json.update(outcome.json);
  json["warnings"] = nlohmann::ordered_json::array();
  for (const Warning& warning : outcome.warnings) {
    json["warnings"].push_back({{"code", code_text(warning.code)}, {"message", warning.message}});
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
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

/// The first `count` options, those of the tool itself, as far as they have a value.
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

void write_report(const About& about, const Outcome& outcome, const StandardInput& input,
                  const std::vector<Setting>& settings) {
  ReportedRun run = {
      about.name,          EXCAVPLAN_VERSION,     input.named(json_text(about, outcome)),
      outcome.lines,       outcome.warnings,      about.can_be_untrustworthy,
      outcome.trustworthy, outcome.stopped_early, settings};
  for (std::string& line : run.lines) line = input.named(line);
  for (Warning& warning : run.warnings) warning.message = input.named(warning.message);
  write_file(outcome.page->file, outcome.page->text(run));
}

void print_outcome(const About& about, const Common& common, const Outcome& outcome,
                   const StandardInput& input) {
  if (!common.quiet) {
    for (const Warning& warning : outcome.warnings) {
      std::cerr << about.name << ": warning: " << shown(input, warning.message) << '\n';
    }
  }
  std::string text;
  if (common.json) {
    text = input.named(json_text(about, outcome));
  } else if (!common.quiet) {
    for (const std::string& line : outcome.lines) text += shown(input, line) + '\n';
  }
  if (outcome.output) std::cerr << text;
  print(outcome.output.value_or(text));
}

/// MachineFile::warnings of machines in a list.
std::vector<Warning> machine_warnings(const std::string& list) {
  std::vector<Warning> warnings;
  for (const std::string& machine : split(list, ',')) {
    for (Warning& each : load_machine_file(machine_path(machine)).warnings) {
      warnings.push_back(std::move(each));
    }
  }
  return warnings;
}

/// What the files of machines are not sure of, in every tool that has --machine.
void add_machine_warnings(const std::vector<Arguments::Entry>& entries, const ParsedWords& words,
                          Outcome& outcome) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].name != "machine") continue;
    for (const std::string& text : words.of_entry[i].texts) {
      for (Warning& each : machine_warnings(text)) outcome.warnings.push_back(std::move(each));
    }
  }
}

int run(int argc, const char* const* argv, const About& about,
        const std::function<void(Arguments&)>& declare,
        const std::function<Outcome(Console&)>& work, StandardInput& input) {
  Arguments arguments;
  Common common;
  declare(arguments);
  const std::size_t own = arguments.entries().size();
  declare_common(arguments, about, common);

  ParsedWords words = sort_words(argc, argv, arguments.entries());
  const auto given = [&](const std::string& name) {
    const auto& entries = arguments.entries();
    const auto at = std::find_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return entry.name == name; });
    return !words.of_entry[static_cast<std::size_t>(at - entries.begin())].texts.empty();
  };
  if (given("help")) {
    print(help_text(about, arguments.entries()));
    return 0;
  }
  if (given("version")) {
    print(about.name + " (excavplan) " + EXCAVPLAN_VERSION + '\n');
    return 0;
  }
  refuse_left_over(words.left_over, arguments.entries());
  const std::string settings = add_settings(arguments.entries(), about, input, words);
  const Signals signals(about.can_stop_early);
  naming_settings(arguments.entries(), words, [&] {
    refuse_excluded(arguments.entries(), words);
    assign(arguments.entries(), words, input);
  });
  if (common.json) refuse_beside_json(arguments.entries(), words);
  Console console(common.quiet, ::isatty(STDERR_FILENO) == 1, signals);
  if (!settings.empty()) console.note("settings from " + input.named(settings));
  Outcome outcome = naming_settings(arguments.entries(), words, [&] { return work(console); });
  for (Warning& each : ignored_options(arguments.entries(), words)) {
    outcome.warnings.push_back(std::move(each));
  }
  const bool has_machine =
      std::any_of(arguments.entries().begin(), arguments.entries().end(),
                  [](const auto& entry) { return entry.name == "machine" && !entry.positional; });
  if (has_machine && given("machine")) add_machine_warnings(arguments.entries(), words, outcome);
  console.clear();
  if (outcome.page) {
    write_report(about, outcome, input, settings_of(arguments.entries(), words, own));
  }
  signals.end_at_closed_pipe();
  print_outcome(about, common, outcome, input);
  if (outcome.stopped_early) return 75;
  return common.strict && !outcome.trustworthy ? 4 : 0;
}

/// Errors of a simulator begin with its name, or with its command until it has told one
/// (simulation/checked_dig.hpp, command_simulator.cpp); those of a built-in one are about its
/// inputs.
bool is_of_users_simulator(const std::string& message) {
  const auto begins = [&](const std::string& start) { return message.rfind(start, 0) == 0; };
  if (begins("simulator command ")) return true;
  const std::vector<SimulatorKind>& own = simulator_kinds();
  return begins("simulator '") && std::none_of(own.begin(), own.end(), [&](const auto& kind) {
           return begins("simulator " + in_quotes(kind.name) + ":");
         });
}

/// Says so where other code, such as a simulator of a shared library, ends a tool that is at work:
/// its exit code would be taken for the tool's.
class EndGuard {
 public:
  EndGuard() {
    static const bool registered = std::atexit(refuse_early_end) == 0;
    at_work = registered;
  }
  ~EndGuard() { at_work = false; }
  EndGuard(const EndGuard&) = delete;
  EndGuard& operator=(const EndGuard&) = delete;

 private:
  static void refuse_early_end() {
    if (!at_work) return;
    constexpr std::string_view message =
        "the program was ended by code that is no part of excavplan\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    std::_Exit(1);
  }
  static inline std::atomic<bool> at_work = false;
};

/// Runs a tool and says what went wrong. @return its exit code
template <typename Run>
int reported(const About& about, const StandardInput& input, const Run& run) {
  const auto report = [&](const std::string& message) {
    std::cerr << about.name << ": " << shown(input, message) << '\n';
  };
  try {
    return run();
  } catch (const Error& error) {
    report(error.what());
    if (error.kind() == ErrorKind::bad_file || is_of_users_simulator(error.what())) return 3;
    std::cerr << "See " << about.name << " --help\n";
    return 2;
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string path = error.path1().string();
    report((path.empty() ? "the working folder" : path) + ": " + error.code().message());
    return 3;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    report(std::string("internal error: ") + error.what());
    return 1;
  }
}

}  // namespace

// ---- Free functions ---------------------------------------------------------------------------

int run_tool(int argc, const char* const* argv, const About& about,
             const std::function<void(Arguments&)>& declare,
             const std::function<Outcome(Console&)>& work) {
  hold_standard_streams();
  if (!hold_stack()) {
    std::cerr << about.name << ": not enough memory for a stack of 1 MiB (ulimit -s or -v)\n";
    return 1;
  }
  const EndGuard guard;
  StandardInput input;
  return reported(about, input, [&] { return run(argc, argv, about, declare, work, input); });
}

int without_memory(const About& about) {
  std::cerr << about.name << ": not enough memory\n";  // and none for another text
  return 1;
}

}  // namespace excavplan::tools
