// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/start_rule.hpp>

#include "base/text.hpp"

namespace excavplan {

const std::vector<StartRuleInfo>& start_rules() {
  using Kind = StartRule::Kind;
  static const std::vector<StartRuleInfo> rules = {
      {Kind::least_work, "work", "least work of the links' own weight"},
      {Kind::largest_margin, "margin", "largest margin to joint limits and heel contact"},
      {Kind::searched, "search", "searched with the path"},
  };
  return rules;
}

std::optional<StartRule> start_rule_of_word(const std::string& word) {
  for (const StartRuleInfo& rule : start_rules()) {
    if (rule.word == word) return StartRule(rule.kind);
  }
  return std::nullopt;
}

std::string describe(const StartRule& rule) {
  for (const StartRuleInfo& info : start_rules()) {
    if (info.kind == rule.kind) return info.description;
  }
  return "given, x = " + number_text(rule.x) + " m";
}

}  // namespace excavplan
