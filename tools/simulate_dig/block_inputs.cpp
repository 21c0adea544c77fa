// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_dig/block_inputs.hpp"

namespace excavplan::tools {

void BlockInputs::declare(Arguments& arguments) {
  arguments.flag(
      "blocks", broken,
      "ground of 80 % relative density and more falls as blocks with voids between them");
  arguments.only_if({[this] { return broken; }, "there are no blocks without --blocks"}, [&] {
    arguments.option("block-size", settings.size, Quantity::length, "mean edge of the blocks");
    arguments.option("block-swell", settings.swell, Quantity::ratio,
                     "0: the blocks are undisturbed soil, 1: soil as loose as other dumped soil");
  });
}

std::optional<BlockSettings> BlockInputs::with_seed(std::uint64_t seed) const {
  if (!broken) return std::nullopt;
  BlockSettings seeded = settings;
  seeded.seed = seed;
  return seeded;
}

}  // namespace excavplan::tools
