// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <excavplan/sensing/scene.hpp>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// Whether and how hard ground falls as blocks.
struct BlockInputs {
  bool broken = false;
  BlockSettings settings;

  /// --blocks, --block-size and --block-swell.
  void declare(Arguments& arguments);
  std::optional<BlockSettings> with_seed(std::uint64_t seed) const;
};

}  // namespace excavplan::tools
