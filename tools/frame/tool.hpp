// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

#include "frame/arguments.hpp"
#include "frame/signals.hpp"

/// @file
/// How a command line tool runs: help, output, exit codes. A tool is a struct of inputs with their
/// defaults, a function that binds the options to it, one that does the work, and
///
///     int main(int argc, char** argv) {
///       using namespace excavplan::tools;
///       return tool_main(argc, argv, about, declare, work);
///     }
///
/// Exit codes: 0 done; 1 internal, not enough memory, or ended by other code; 2 usage, Error
/// bad_input; 3 Error bad_file, or a user's simulator fails; 4 not trustworthy, with --strict; 75
/// stopped early. How signals end a tool: signals.hpp.

namespace excavplan::tools {

struct Example {
  std::string command;
  std::string meaning;
};

struct About {
  std::string name;
  std::string summary;  ///< a sentence or a few; wrapped in the help
  std::vector<Example> examples;
  bool can_be_untrustworthy = false;  ///< adds --strict
  bool can_stop_early = false;        ///< an interrupt sets Console::stop_requested() instead
};

struct Report;  // shared/report.hpp

/// Result of a tool.
struct Outcome {
  /// Printed with --json, "tool" and "version" before it, "warnings" after it, those of options
  /// without effect (Arguments::only_if()) too. NaN becomes null.
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  std::vector<std::string> lines;  ///< printed without --json
  /// Printed in their place, which is then standard error: Entry::standard_output.
  std::optional<std::string> output = std::nullopt;
  std::vector<Warning> warnings;
  bool trustworthy = true;
  bool stopped_early = false;
  std::shared_ptr<const Report> report = nullptr;  ///< written by run_tool(), if asked for
};

/// Progress and notes on standard error while a tool works.
class Console {
 public:
  Console(bool quiet, bool terminal, const Signals& signals)
      : quiet_(quiet), terminal_(terminal), signals_(signals) {}

  /// One line that is overwritten by the next; only on a terminal. `done` is in 0 .. 1.
  void progress(double done, const std::string& what);
  /// One line of text, from any thread. Warnings belong in the outcome.
  void note(const std::string& line);
  /// True once the user or the system asked a tool that can stop early to stop.
  bool stop_requested() const { return signals_.stop_requested(); }
  /// Removes the progress line.
  void clear();

 private:
  void remove_line();

  bool quiet_;
  bool terminal_;
  const Signals& signals_;
  std::mutex mutex_;  ///< of standard error and of
  bool line_open_ = false;
};

/// Runs a tool: parses, works, prints. @return the exit code @throws std::bad_alloc
int run_tool(int argc, const char* const* argv, const About& about,
             const std::function<void(Arguments&)>& declare,
             const std::function<Outcome(Console&)>& work);

/// Says so. @return the exit code
int without_memory(const About& about);

/// The whole main() of a tool: `declare(arguments, inputs)` binds the options to a struct of
/// inputs, which `work(inputs)` or `work(inputs, console)` then gets.
template <typename Inputs, typename Work>
int tool_main(int argc, const char* const* argv, const About& about,
              void (*declare)(Arguments&, Inputs&), const Work& work) {
  try {
    Inputs inputs;
    return run_tool(
        argc, argv, about, [&](Arguments& arguments) { declare(arguments, inputs); },
        [&](Console& console) -> Outcome {
          if constexpr (std::is_invocable_v<Work, const Inputs&, Console&>) {
            return work(inputs, console);
          } else {
            return work(inputs);
          }
        });
  } catch (const std::bad_alloc&) {
    return without_memory(about);
  }
}

/// Reads the soil or machine that a name or path means. @throws Error (bad_input) or (bad_file)
SoilKind soil_named(const std::string& name_or_path);
Machine machine_named(const std::string& name_or_path);

}  // namespace excavplan::tools
