// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/depth_png.hpp"

#include <cstdint>
#include <vector>

namespace excavplan::test {

Words depth_run(const TemporaryFolder& folder) {
  return {folder.write("depth.png", png_of(16, std::vector<std::uint16_t>(16 * 12, 2000))),
          "--intrinsics", folder.write("camera.json", intrinsics), "--out",
          folder.file("cloud.xyz")};
}

}  // namespace excavplan::test
