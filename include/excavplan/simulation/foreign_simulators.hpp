// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <excavplan/simulation/simulators.hpp>

/// @file
/// Simulators that are no part of the program: in a shared library, or in a program of their own
/// (docs/simulators.md). Both get the ground around the path and the poses, and give back the
/// ground, the payload and the loads or the energy; torques, energies, stalls and volumes are
/// computed from these, and the payload is heaped where DigOptions::dump_at says. Beside what is
/// asked of every simulator, the balance of dry mass must hold within the tolerance that they
/// state. Ground with void ratios of its own is refused.

namespace excavplan {

/// The simulator of a shared library, simulator_plugin.h. Its name ends in the digest of the file,
/// so that what was computed with another build of it is refused. The library is never unloaded; a
/// fault in it ends this process.
/// @throws Error (bad_file) naming the file: not readable, not loadable, without the entry, of
///         another version, or with a description that breaks a rule
SimulatorKind plugin_simulator(const std::string& file);

/// How a program is run.
struct SimulatorCommand {
  /// The program and its arguments. Spaces part them, '..' and ".." hold them together; no shell
  /// is in between.
  std::string command;
  double timeout = 60.0;  ///< for each answer [s], 0.001 .. 1e6
  /// Gets each line that the program writes on standard error, fit for a terminal; may be called
  /// from any thread. Without it only errors show the last of them.
  std::function<void(const std::string& line)> on_note = {};
};

/// The simulator of a program that answers on its standard output, line by line. Started now, and
/// once for every thread that digs at the same time. One that fails to answer is ended with all
/// that it started; the next dig starts another, until three in a row (ours) have failed.
/// @throws Error (bad_input) naming the program: it cannot be started, or its first answer breaks a
///         rule
SimulatorKind command_simulator(const SimulatorCommand& command);

/// Ends the programs of all simulators and lets no more start: for a program that is about to be
/// ended by a signal. They also see the end of their standard input, however it ends.
void end_simulator_programs();

}  // namespace excavplan
