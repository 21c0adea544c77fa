// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <excavplan/job/job_step.hpp>

#include "base/json.hpp"

/// @file
/// What the record of a job and its log write alike. Private to the project.

namespace excavplan {

/// The value of that name. @throws Error (bad_file) if none has it
template <typename Value, std::size_t size>
Value of_word(JsonObject& object, const char* key, const std::array<Value, size>& values) {
  const std::string word = object.text(key);
  for (const Value value : values) {
    if (word == name(value)) return value;
  }
  object.fail(key, "is not a known word");
}

inline constexpr std::array actions = {JobAction::dig,  JobAction::finish, JobAction::move,
                                       JobAction::scan, JobAction::wait,   JobAction::stop};

/// Of a log, whose bases are without units in their keys, as other programs read them.
nlohmann::ordered_json log_base_json(const BasePose& base);
nlohmann::ordered_json log_foretold_json(const ForetoldStep& foretold);

}  // namespace excavplan
