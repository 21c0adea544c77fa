// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <variant>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "fuzz/fuzz_target.hpp"
#include "simulation/simulator_protocol.hpp"

namespace excavplan::test {
namespace {

/// A dig whose window is small enough for an answer of some hundred bytes.
struct Asked {
  Machine machine = load_machine(find_data_file("machines/zx120.json"));
  ForeignModel model{machine, load_soil(find_data_file("soils/loam.json")), 40.0};
  Terrain ground = level_planning_ground(machine, 1.0);
  DigPath path = std::get<DigPath>(
      make_dig_path_anywhere(machine, {0.6, 0.3, 1.0}, boom_plane_profile(ground), coarse()));
  DigOptions options;
  ForeignDig dig{model, ground, path, options};

  static DigPathOptions coarse() {
    DigPathOptions options;
    options.step = 0.5;
    return options;
  }
};

void require_printable(const std::string& text) {
  constexpr std::size_t longest = 8000;
  require_that(text.size() <= longest, "a message of " + std::to_string(text.size()) + " bytes");
  for (const char c : text) {
    require_that(static_cast<unsigned char>(c) >= 32 && c != 127, "control characters: " + text);
  }
}

template <typename Read>
void tried(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    require_printable(error.what());
  }
}

}  // namespace

void fuzz_simulator_answer(std::string_view bytes) {
  static const Asked asked;
  const std::string line(bytes);
  tried([&] { read_hello(line); });
  tried([&] { read_ready(line); });
  tried([&] {
    const auto answer = read_dug(line, {1, asked.dig.bank().z.rows(), asked.dig.bank().z.cols()});
    if (!std::holds_alternative<ForeignAnswer>(answer)) return;
    const DigResult result = asked.dig.result(std::get<ForeignAnswer>(answer), 0.01);
    require_that(std::isfinite(result.payload_mass) && result.patch.loose.isFinite().all(),
                 "a result that is not finite");
  });
}

}  // namespace excavplan::test
