// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <excavplan/library/path_library.hpp>
#include <excavplan/machine/machine_file.hpp>

#include "shared/goal_inputs.hpp"

/// @file
/// Where the files of machine-kit are: a folder with machine.json, laws and libraries.

namespace excavplan::tools {

/// Of the machine in the folder of a kit.
constexpr const char* kit_machine = "machine.json";

/// The file that --machine means: that of a shipped name, the file itself, or that in the folder of
/// a kit. @throws Error as shipped_or_file()
std::string machine_path(const std::string& machine);

/// Where machine-kit writes by default: NAME-kit beside the file NAME.json or NAME.urdf, in the
/// working folder for a shipped name.
std::string default_kit(const std::string& machine);

/// A file of the kit of a machine, as --machine names it: in the folder that it is or whose
/// machine.json it is, else in default_kit(). Nothing if it is not there.
std::optional<std::string> kit_file(const std::string& machine, const std::string& relative_path);

/// laws/MACHINE-SOIL.json of a kit.
std::optional<std::string> kit_law(const std::string& machine_word, const Machine& machine,
                                   const std::string& soil);

/// The library of a kit for a goal, or null. Numbers of the goal that were not given become those
/// of the library. @throws Error (bad_file)
std::shared_ptr<const PathLibrary> kit_library(const std::string& machine_word,
                                               const Machine& machine, const std::string& soil,
                                               const GoalInputs& given, DigObjective& objective);

/// What there is to say of the files of machines in a list: MachineFile::warnings.
std::vector<Warning> machine_warnings(const std::string& list);

}  // namespace excavplan::tools
