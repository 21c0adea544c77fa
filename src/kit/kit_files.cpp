// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/kit_files.hpp>

#include <filesystem>
#include <system_error>

#include <excavplan/base/data_files.hpp>

#include "base/files.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& path) {
  std::error_code none;
  return fs::is_directory(path, none);
}

}  // namespace

std::string machine_path(const std::string& machine_word) {
  if (is_folder(machine_word)) return (fs::path(machine_word) / kit_machine).string();
  return shipped_or_file("machines", machine_word);
}

std::string default_kit(const std::string& machine_word) {
  const fs::path path(machine_word);
  return (path.parent_path() / path.stem()).string() + "-kit";
}

std::optional<std::string> kit_file(const std::string& machine_word,
                                    const std::string& relative_path) {
  const fs::path path(machine_word);
  fs::path folder = default_kit(machine_word);
  if (is_folder(machine_word)) folder = path;
  if (path.filename() == kit_machine) folder = path.parent_path();
  std::error_code none;
  const fs::path file = folder / relative_path;
  return fs::is_regular_file(file, none) ? std::optional(file.string()) : std::nullopt;
}

std::string law_file(const std::string& machine, const std::string& soil) {
  return "laws/" + file_name_part(machine) + "-" + file_name_part(soil) + ".json";
}

std::optional<std::string> kit_law(const std::string& machine_word, const Machine& machine,
                                   const std::string& soil) {
  return kit_file(machine_word, law_file(machine.name, soil));
}

std::shared_ptr<const PathLibrary> kit_library(const std::string& machine_word,
                                               const Machine& machine, const std::string& soil,
                                               const GoalNumbers& given, DigObjective& objective) {
  PathLibrary wanted;
  wanted.machine = machine.name;
  wanted.soil = soil;
  wanted.objective = objective;
  const auto file = kit_file(machine_word, "libraries/" + file_name(wanted));
  if (!file) return nullptr;
  auto library = std::make_shared<PathLibrary>(load_path_library(*file));
  const auto& parameters = objective_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto field = parameters[i].field;
    const bool told = given[i] || field == info_of(objective.goal).parameter;
    if (!told) objective.*field = library->objective.*field;
  }
  return library;
}

}  // namespace excavplan
