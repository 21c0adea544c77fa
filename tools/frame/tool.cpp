// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <system_error>

#include <excavplan/base/data_files.hpp>
#include <excavplan/kit/kit_files.hpp>
#include <excavplan/kit/workspace.hpp>
#include <excavplan/machine/machine_file.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/simulators.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "frame/command_line.hpp"
#include "frame/option_names.hpp"
#include "frame/signals.hpp"
#include "frame/stack.hpp"

namespace excavplan::tools {
namespace {

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

/// Opens what is closed of the standard streams, so that no file takes its place. To read or write
/// them still fails.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// A text with foreign names in it, as a terminal may get it.
std::string shown(const StandardInput& input, const std::string& text) {
  return safe_text(input.named(text), longest_line);
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
  json["warnings"] = warnings_json(outcome.warnings);
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
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
      std::cerr << about.name << ": warning (" << code_text(warning.code)
                << (warning.ends_trust ? ", ends trust): " : "): ") << shown(input, warning.message)
                << '\n';
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

/// Of the files of machines in a list: MachineFile::warnings, and what their data sheets
/// contradict.
std::vector<Warning> machine_warnings(const std::string& list) {
  std::vector<Warning> warnings;
  for (const std::string& machine : split(list, ',')) {
    const MachineFile file = load_machine_file(machine_path(machine));
    for (const auto& more : {file.warnings, check_data_sheet(file.machine, file.data_sheet)}) {
      warnings.insert(warnings.end(), more.begin(), more.end());
    }
  }
  return warnings;
}

/// No result outlives a warning that ends trust, whoever added it.
void settle_trust(Outcome& outcome) {
  if (any_ends_trust(outcome.warnings)) outcome.trustworthy = false;
  if (outcome.trustworthy) return;
  if (outcome.json.contains("trustworthy")) outcome.json["trustworthy"] = false;
  const auto says = [](const std::string& line) {
    return line.find("NOT TRUSTWORTHY") != std::string::npos;
  };
  if (std::none_of(outcome.lines.begin(), outcome.lines.end(), says)) {
    outcome.lines.emplace_back("NOT TRUSTWORTHY: the warnings say why");
  }
}

/// Options without effect, and in every tool that has --machine what the files of machines are not
/// sure of. What several parts of the work said alike is told once.
void add_option_warnings(const std::vector<Arguments::Entry>& entries, const ParsedWords& words,
                         Outcome& outcome) {
  std::vector<Warning> told;
  add_new(outcome.warnings, told);
  add_new(ignored_options(entries, words), told);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].name != "machine" || entries[i].positional) continue;
    for (const std::string& text : words.of_entry[i].texts) add_new(machine_warnings(text), told);
  }
  outcome.warnings = std::move(told);
}

/// All texts of a result.
void name_options(const std::vector<Arguments::Entry>& entries, nlohmann::ordered_json& json) {
  if (json.is_string()) json = with_options(json.get<std::string>(), entries);
  if (!json.is_structured()) return;
  for (auto& each : json) name_options(entries, each);
}

/// Runs `work`; what the library says then names the options.
Outcome with_options(const std::vector<Arguments::Entry>& entries,
                     const std::function<Outcome()>& work) {
  try {
    Outcome outcome = work();
    name_options(entries, outcome.json);
    for (std::string& line : outcome.lines) line = with_options(line, entries);
    for (Warning& each : outcome.warnings) each.message = with_options(each.message, entries);
    return outcome;
  } catch (const Error& error) {
    throw Error(error.kind(), with_options(error.what(), entries));
  }
}

struct CommandWords {
  int count;
  const char* const* words;
};

int run(const CommandWords& command, const About& about,
        const std::function<void(Arguments&)>& declare,
        const std::function<Outcome(Console&)>& work, StandardInput& input) {
  Arguments arguments;
  Common common;
  declare(arguments);
  const std::size_t own = arguments.entries().size();
  declare_common(arguments, about, common);

  ParsedWords words = sort_words(command.count, command.words, arguments.entries());
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
  Signals signals(about.can_stop_early);
  naming_settings(arguments.entries(), words, [&] {
    refuse_excluded(arguments.entries(), words);
    assign(arguments.entries(), words, input);
  });
  if (common.json) refuse_beside_json(arguments.entries(), words);
  Console console(common.quiet, ::isatty(STDERR_FILENO) == 1, signals);
  if (!settings.empty()) console.note("settings from " + input.named(settings));
  Outcome outcome = naming_settings(arguments.entries(), words, [&] {
    return with_options(arguments.entries(), [&] { return work(console); });
  });
  add_option_warnings(arguments.entries(), words, outcome);
  if (about.can_be_untrustworthy) settle_trust(outcome);
  console.clear();
  if (outcome.page) {
    write_report(about, outcome, input, settings_of(arguments.entries(), words, own));
  }
  signals.end_at_closed_pipe();
  print_outcome(about, common, outcome, input);
  if (outcome.stopped_early) return 75;
  return common.strict && !outcome.trustworthy ? 4 : outcome.exit_code;
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
  return reported(about, input, [&] { return run({argc, argv}, about, declare, work, input); });
}

int without_memory(const About& about) {
  std::cerr << about.name << ": not enough memory\n";  // and none for another text
  return 1;
}

}  // namespace excavplan::tools
