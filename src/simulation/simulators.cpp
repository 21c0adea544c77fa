// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/simulators.hpp>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "simulation/section_simulator.hpp"

namespace excavplan {
namespace {

template <typename Simulator>
std::unique_ptr<const SoilSimulator> make(const Machine& machine, const SoilKind& soil,
                                          double density_percent) {
  return std::make_unique<const Simulator>(machine, soil, density_percent);
}

}  // namespace

const std::vector<SimulatorKind>& simulator_kinds() {
  static const std::vector<SimulatorKind> kinds = {
      {"height-map", HeightMapSimulator::name(), make<HeightMapSimulator>},
      {"section", SectionSimulator::name(), make<SectionSimulator>},
  };
  return kinds;
}

const SimulatorKind& simulator_of_word(const std::string& word) {
  std::string words;
  for (const SimulatorKind& kind : simulator_kinds()) {
    if (kind.word == word) return kind;
    words += (words.empty() ? "" : ", ") + kind.word;
  }
  throw Error(ErrorKind::bad_input, "simulator '" + word + "' is none of " + words);
}

}  // namespace excavplan
