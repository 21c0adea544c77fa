// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/simulator_inputs.hpp"

#include <excavplan/simulation/foreign_simulators.hpp>

#include "base/text.hpp"

namespace excavplan::tools {
namespace {

/// "mine.so", "libmine.so.2", "./mine"
bool names_library(const std::string& text) {
  const std::size_t ending = text.rfind(".so");
  const bool is_shared =
      ending != text.npos && (ending + 3 == text.size() || text[ending + 3] == '.');
  return is_shared || text.find('/') != text.npos;
}

std::string words_and_file() {
  std::string words;
  for (const SimulatorKind& kind : simulator_kinds()) words += kind.word + "|";
  return words + "FILE.so";
}

void require_built_in(const std::string& text) {
  std::string words;
  for (const SimulatorKind& kind : simulator_kinds()) {
    if (text == kind.word) return;
    words += (words.empty() ? "" : " or ") + kind.word;
  }
  usage_error("--simulator: " + in_quotes(text) + " in a file, expected " + words +
              "; a shared library is named on the command line alone");
}

}  // namespace

void declare_simulator(Arguments& arguments, SimulatorInputs& inputs) {
  Arguments::Entry simulator;
  simulator.name = "simulator";
  simulator.placeholder = words_and_file();
  simulator.help =
      "simulator; section: faster, only in the vertical plane of the boom; FILE.so: a shared "
      "library, whose code is run (docs/simulators.md)";
  simulator.default_text = inputs.simulator;
  simulator.assign = [&inputs](const std::string& text) { inputs.simulator = text; };
  simulator.check_in_file = require_built_in;
  arguments.add(simulator);
  Arguments::Entry command;
  command.name = "simulator-command";
  command.placeholder = "COMMAND";
  command.help =
      "run this program as the simulator, without a shell, and ask it line by line "
      "(docs/simulators.md)";
  command.assign = [&inputs](const std::string& text) { inputs.command = text; };
  command.check_in_file = [](const std::string&) {
    usage_error("--simulator-command is of the command line alone: a file names no program to run");
  };
  arguments.add(command);
  arguments.exclude("simulator-command", {"simulator"});
  arguments.only_if(
      {[&inputs] { return inputs.command.has_value(); }, "there is no --simulator-command"}, [&] {
        arguments.option("simulator-timeout", inputs.timeout, Quantity::time,
                         "time limit for each answer of that program");
      });
}

bool is_default(const SimulatorInputs& inputs) {
  return !inputs.command && inputs.simulator == default_simulator().word;
}

SimulatorKind simulator_of(const SimulatorInputs& inputs, Console& console) {
  if (inputs.command) {
    const SimulatorCommand command = {
        *inputs.command, inputs.timeout,
        [&console](const std::string& line) { console.note("simulator: " + line); }};
    const OptionNames names = {{"the time limit of a simulator", "--simulator-timeout"}};
    return naming_options(names, [&] { return command_simulator(command); });
  }
  if (names_library(inputs.simulator)) return plugin_simulator(inputs.simulator);
  try {
    return simulator_of_word(inputs.simulator);
  } catch (const Error& error) {
    usage_error(std::string("--simulator: ") + error.what() + ", nor a shared library FILE.so");
  }
}

}  // namespace excavplan::tools
