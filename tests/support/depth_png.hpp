// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/png_bytes.hpp"
#include "support/tool_answers.hpp"

/// @file
/// A depth image and what depth-to-cloud needs with it.

namespace excavplan::test {

inline const char* const intrinsics =
    R"({"format": "excavplan-depth-intrinsics", "version": 1, "fx": 40, "fy": 50, "cx": 8, "cy": 6})";

Words depth_run(const TemporaryFolder& folder);

}  // namespace excavplan::test
