// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/machine/machine.hpp>
#include <excavplan/planning/path_library.hpp>

/// @file
/// Where the files of machine-kit are (docs/machines.md): a folder with machine.json, laws and
/// libraries. A machine is told by a word: a shipped name, a file of ours or a URDF, or the folder
/// of a kit.

namespace excavplan {

/// The file of the machine in the folder of a kit.
constexpr const char* kit_machine = "machine.json";

/// The file of a machine: that of a shipped name, the file itself, or that in the folder of a kit.
/// @throws Error as shipped_or_file()
std::string machine_path(const std::string& machine_word);

/// Where machine-kit writes by default: NAME-kit beside the file NAME.json or NAME.urdf, in the
/// working folder for a shipped name.
std::string default_kit(const std::string& machine_word);

/// A file of the kit of a machine: in the folder that the word is, or whose machine.json it is,
/// else in default_kit(). Nothing if it is not there.
std::optional<std::string> kit_file(const std::string& machine_word,
                                    const std::string& relative_path);

/// "laws/MACHINE-SOIL.json": of a density law in a kit, and among the shipped files.
std::string law_file(const std::string& machine, const std::string& soil);

/// The law_file() of a kit, if it is there.
std::optional<std::string> kit_law(const std::string& machine_word, const Machine& machine,
                                   const std::string& soil);

/// Numbers of a goal: one for each row of objective_parameters(), nothing where it is left open.
using GoalNumbers = std::vector<std::optional<double>>;

/// The library of a kit for the goal of an objective, or null.
/// @param given      numbers that were asked for
/// @param objective  what is planned for; numbers that were not given become those of the library,
/// but for the one that is told with the goal
/// @throws Error (bad_file) as load_path_library()
std::shared_ptr<const PathLibrary> kit_library(const std::string& machine_word,
                                               const Machine& machine, const std::string& soil,
                                               const GoalNumbers& given, DigObjective& objective);

}  // namespace excavplan
