// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>

#include "frame/arguments.hpp"
#include "frame/console.hpp"
#include "frame/help.hpp"
#include "frame/page.hpp"

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
  std::optional<Page> page = std::nullopt;  ///< written by run_tool()
  int exit_code = 0;                        ///< About::own_codes
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

}  // namespace excavplan::tools
