// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/warning_results.hpp"

#include "base/json.hpp"

namespace excavplan {

Json warnings_json(const std::vector<Warning>& warnings) {
  auto list = Json::array();
  for (const Warning& warning : warnings) {
    list.push_back({{"code", code_text(warning.code)},
                    {"message", warning.message},
                    {"ends_trust", warning.ends_trust}});
  }
  return list;
}

}  // namespace excavplan
