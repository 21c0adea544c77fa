// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/path_library.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// The library's file without its format and checksum.
Json library_json(const PathLibrary& library);

}  // namespace excavplan
