// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "simulation/foreign_dig.hpp"

/// @file
/// The lines that excavplan and the program of a simulator exchange: docs/simulators.md#program.
/// The readers take any text. Private to the project.

namespace excavplan {

inline constexpr int simulator_protocol = 1;
/// Of an answer [byte]; ours, several times that of the largest window.
inline constexpr std::size_t longest_answer = std::size_t{1} << 26;

/// What a program says that it cannot do.
struct ForeignRefusal {
  std::string message;
};

std::string hello_request();
std::string prepare_request(const ForeignModel& model);
std::string dig_request(const ForeignDig& dig, std::uint64_t id);

// Each @throws Error (bad_file) "its answer: PLACE: ..." if the text is none.

std::variant<ForeignSimulator, ForeignRefusal> read_hello(const std::string& line);
/// @return the refusal, with an empty message if there is none
ForeignRefusal read_ready(const std::string& line);

/// What an answer must fit.
struct AnswerSize {
  std::uint64_t id = 0;
  Eigen::Index rows = 0, cols = 0;
};
std::variant<ForeignAnswer, ForeignRefusal> read_dug(const std::string& line,
                                                     const AnswerSize& size);

}  // namespace excavplan
