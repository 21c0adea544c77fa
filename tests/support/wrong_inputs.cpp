// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/wrong_inputs.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "support/cases.hpp"

namespace excavplan::test {

Verdict verdict_of(const std::function<Verdict()>& work) {
  try {
    return work();
  } catch (const Error& error) {
    Verdict refused;
    refused.error = error.what();
    return refused;
  }
}

void expect_no_wrong_answer(const std::vector<WrongInput>& inputs) {
  const std::size_t step = are_all_tried() ? 1 : 5;  // odd, as they alternate between two sensors
  for (std::size_t i = 0; i < inputs.size(); i += step) {
    const WrongInput& input = inputs[i];
    const Verdict verdict = verdict_of(input.made);
    std::cout << input.name << " | " << verdict.text() << std::endl;
    const bool is_silent = verdict.trusted && verdict.right && input.may_be_right;
    const bool is_said =
        !verdict.trusted && std::any_of(input.reasons.begin(), input.reasons.end(),
                                        [&](const auto& reason) { return verdict.says(reason); });
    EXPECT_TRUE(is_silent || is_said) << input.name << ": " << verdict.text();
  }
}

}  // namespace excavplan::test
