// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <excavplan/kit/machine_kit.hpp>
#include <excavplan/machine/machine_file.hpp>

#include "base/files.hpp"
#include "frame/tool.hpp"

/// @file
/// What machine-kit writes and prints.

namespace excavplan::tools {

/// What the file says of the machine, checked; `folder` is that of its kit.
Outcome examined(const MachineFile& file, const std::string& folder);

/// Runs `work`, which writes into a folder that is made now; one that it leaves empty is removed.
template <typename Work>
void in_folder(const std::string& folder, const Work& work) {
  std::error_code unknown;
  const bool is_new = !std::filesystem::exists(folder, unknown);
  make_folder(folder);
  try {
    work();
  } catch (const Error&) {
    if (is_new) std::filesystem::remove(folder, unknown);
    throw;
  }
}

/// Names and files between commas. @throws Error (bad_input) or (bad_file)
std::vector<SoilKind> soils_named(const std::string& list);

/// Writes law and library of a soil to the folder.
void add_kit(const KitSoil& kit, const Machine& machine, const SoilKind& soil,
             const std::string& folder, Outcome& outcome);

}  // namespace excavplan::tools
