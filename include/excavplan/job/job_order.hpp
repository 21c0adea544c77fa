// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/job/job_settings.hpp>

/// @file
/// What a job was ordered with, kept in its folder: it goes on when the files it came from are
/// gone (docs/formats.md#job-folder).

namespace excavplan {

/// Files that an order is copied from.
struct OrderFiles {
  std::string machine;  ///< as load_machine() reads it
  std::string law;      ///< as load_density_law() reads it; empty: density_law_of() the soil
};

/// Writes an order into a folder, which is made if it is not there. Of the design its surface is
/// kept, not its words or its file.
/// @throws Error (bad_input) as require_job_settings(); (bad_file) if a file cannot be read or
/// written
void save_order(const std::string& folder, const JobSettings& settings, const OrderFiles& files);

/// Reads it back: the same settings. @throws Error (bad_file) naming file, key, value and rule
JobSettings load_order(const std::string& folder);

}  // namespace excavplan
