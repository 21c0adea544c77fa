// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/warning.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace excavplan {
namespace {

/// Of a result with a warning.
enum class Trust {
  kept,
  depends,  ///< on the case: where it is made
  ended,
};

struct CodeRow {
  const char* text;
  Trust trust;
};

/// In the order of the codes.
constexpr std::array code_rows = {
#define EXCAVPLAN_WARNING(code, trust) CodeRow{#code, Trust::trust},
#include <excavplan/base/warning_codes.def>
};

const CodeRow& row_of(WarningCode code) { return code_rows.at(static_cast<std::size_t>(code)); }

}  // namespace

std::string code_text(WarningCode code) { return row_of(code).text; }

Warning::Warning(WarningCode doubt, std::string text)
    : Warning(doubt, std::move(text), row_of(doubt).trust == Trust::ended) {}

Warning::Warning(WarningCode doubt, std::string text, bool is_end)
    : code(doubt), message(std::move(text)), ends_trust(is_end) {}

bool any_ends_trust(const std::vector<Warning>& warnings) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [](const Warning& each) { return each.ends_trust; });
}

void add_new(const std::vector<Warning>& more, std::vector<Warning>& warnings) {
  for (const Warning& warning : more) {
    const auto same = [&](const Warning& each) {
      return each.code == warning.code && each.message == warning.message;
    };
    if (std::none_of(warnings.begin(), warnings.end(), same)) warnings.push_back(warning);
  }
}

}  // namespace excavplan
