// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "support/png_bytes.hpp"
#include "support/tool_answers.hpp"

/// @file
/// A depth image and what depth-to-cloud needs with it.

namespace excavplan::test {

inline const char* const intrinsics =
    R"({"format": "excavplan-depth-intrinsics", "version": 1, "fx": 40, "fy": 50, "cx": 8, "cy": 6})";

inline Words depth_run(const TemporaryFolder& folder) {
  return {folder.write("depth.png", png_of(16, std::vector<std::uint16_t>(16 * 12, 2000))),
          "--intrinsics", folder.write("camera.json", intrinsics), "--out",
          folder.file("cloud.xyz")};
}

}  // namespace excavplan::test
