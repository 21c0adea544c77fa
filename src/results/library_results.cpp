// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/library_results.hpp"

#include "base/json.hpp"

namespace excavplan {

Json library_json(const PathLibrary& library) {
  auto json = parse_ordered_json("the library", to_json(library));
  for (const char* key : {"format", "version", "checksum"}) json.erase(key);
  return json;
}

}  // namespace excavplan
