// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/base/error.hpp>

/// @file
/// Reading what another process goes on writing. Private to the project.

namespace excavplan {

/// Reads some files that are replaced one after the other, the last of them last; again if it
/// failed and that one was replaced meanwhile, as the files were of two states.
/// @param stamp  of the last file: another one has another
/// @param read  takes the stamp of before
/// @throws Error as `read`, of files that stay as they are or change again and again
template <typename Stamp, typename Read>
void read_settled(Stamp stamp, Read read) {
  constexpr int most_readings = 20;  // ours
  for (int readings = 1;; ++readings) {
    const auto before = stamp();
    try {
      return read(before);
    } catch (const Error&) {
      if (readings == most_readings || stamp() == before) throw;
    }
  }
}

}  // namespace excavplan
