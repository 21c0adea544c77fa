// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "measure_efficiency/run_sets.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/table.hpp"

namespace excavplan::tools {
namespace {

namespace fs = std::filesystem;

using Number = std::optional<double> RunInputs::*;
using Text = std::optional<std::string> RunInputs::*;

constexpr std::array<std::pair<const char*, Number>, 8> number_columns = {
    {{"volume_m3", &RunInputs::volume},
     {"volume_sd_m3", &RunInputs::volume_sd},
     {"bank_volume_m3", &RunInputs::bank_volume},
     {"bank_volume_sd_m3", &RunInputs::bank_volume_sd},
     {"mass_kg", &RunInputs::mass},
     {"mass_sd_kg", &RunInputs::mass_sd},
     {"from_s", &RunInputs::from},
     {"to_s", &RunInputs::to}}};
constexpr std::array<std::pair<const char*, Text>, 6> file_columns = {
    {{"dump_before", &RunInputs::dump_before},
     {"dump_after", &RunInputs::dump_after},
     {"pit_before", &RunInputs::pit_before},
     {"pit_after", &RunInputs::pit_after},
     {"bucket_before", &RunInputs::bucket_before},
     {"bucket_after", &RunInputs::bucket_after}}};

/// Names of columns that are none of a run's are mistakes or remarks; remarks are "note".
void require_known(const Table& table) {
  std::vector<std::string> known = {"file", "note", "bulking_factor"};
  for (const auto& column : number_columns) known.emplace_back(column.first);
  for (const auto& column : file_columns) known.emplace_back(column.first);
  for (const std::string& name : table.names()) {
    if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string all;
    for (const std::string& word : known) all += (all.empty() ? "" : ", ") + word;
    throw Error(ErrorKind::bad_file, table.path() + ": column " + in_quotes(name) +
                                         " is none of a table of runs, expected of: " + all);
  }
}

/// "--volume-sd" is "volume_sd_m3".
OptionNames columns_of(const Table& table) {
  static const OptionNames all = {{"--bank-volume-sd", "bank_volume_sd_m3"},
                                  {"--bank-volume", "bank_volume_m3"},
                                  {"--volume-sd", "volume_sd_m3"},
                                  {"--volume", "volume_m3"},
                                  {"--mass-sd", "mass_sd_kg"},
                                  {"--mass", "mass_kg"},
                                  {"--from", "from_s"},
                                  {"--to", "to_s"},
                                  {"--bulking-factor", "bulking_factor"}};
  OptionNames names;
  std::copy_if(all.begin(), all.end(), std::back_inserter(names),
               [&](const auto& name) { return table.has(name.second); });
  return names;
}

std::vector<SetRun> runs_of_table(const std::string& path, const RunInputs& common) {
  const Table table = Table::read(path);
  require_known(table);
  const fs::path folder = fs::path(path).parent_path();
  const std::vector<std::string> files = table.texts("file");
  const OptionNames columns = columns_of(table);
  std::vector<SetRun> runs;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    SetRun run{common, path + ": line " + std::to_string(table.line(i)) + ": ", columns};
    if (files[i].empty()) {
      throw Error(ErrorKind::bad_file, run.place + "file is '', expected the name of a log");
    }
    run.inputs.log = (folder / files[i]).string();
    runs.push_back(std::move(run));
  }
  for (const auto& [name, member] : number_columns) {
    if (!table.has(name)) continue;
    const std::vector<double>& values = table.column(name);
    for (std::size_t i = 0; i < values.size(); ++i) runs[i].inputs.*member = values[i];
  }
  for (const auto& [name, member] : file_columns) {
    if (!table.has(name)) continue;
    const std::vector<std::string> names = table.texts(name);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!names[i].empty()) runs[i].inputs.*member = (folder / names[i]).string();
    }
  }
  if (table.has("bulking_factor")) {
    const std::vector<double>& factors = table.column("bulking_factor");
    for (std::size_t i = 0; i < factors.size(); ++i) {
      runs[i].inputs.bulking_factor = number_text(factors[i]);
    }
  }
  return runs;
}

std::vector<SetRun> runs_of_folder(const std::string& folder, const RunInputs& common) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".csv") names.push_back(entry.path().string());
  }
  if (names.empty()) throw Error(ErrorKind::bad_file, folder + ": holds no log NAME.csv");
  std::sort(names.begin(), names.end());
  std::vector<SetRun> runs;
  for (const std::string& name : names) {
    runs.push_back({common, "", {}});
    runs.back().inputs.log = name;
  }
  return runs;
}

}  // namespace

std::vector<SetRun> runs_of(const std::string& table_or_folder, const RunInputs& common) {
  std::error_code unread;
  if (!fs::is_directory(table_or_folder, unread)) return runs_of_table(table_or_folder, common);
  const std::string table = (fs::path(table_or_folder) / "runs.csv").string();
  if (fs::exists(table, unread)) return runs_of_table(table, common);
  return runs_of_folder(table_or_folder, common);
}

}  // namespace excavplan::tools
