// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>

#include "bad_files/run_bad_files.hpp"

// bad-files [--sweeps] [FORMAT ...]: reads all bad files and prints what became of them.

#ifdef EXCAVPLAN_BAD_FILES_BY_PCL
namespace excavplan::test {
std::vector<FileReader> pcl_readers();
}  // namespace excavplan::test
#endif

int main(int argc, char** argv) {
  using namespace excavplan::test;
  std::vector<std::string> words(argv + 1, argv + argc);
  const auto option = std::find(words.begin(), words.end(), "--sweeps");
  const bool sweeps = option != words.end();
  if (sweeps) words.erase(option);
#ifdef EXCAVPLAN_BAD_FILES_BY_PCL
  const std::vector<FileReader> readers = pcl_readers();
#else
  const std::vector<FileReader> readers = file_readers();
#endif
  std::vector<BadFileTally> tallies;
  for (const FileReader& reader : readers) {
    const bool asked = std::find(words.begin(), words.end(), reader.name) != words.end();
    if (!words.empty() && !asked) continue;
    if (reader.name == "option") continue;  // a text, not a file
    tallies.push_back(sweeps ? run_sweeps(reader) : run_bad_files(reader));
    std::cerr << reader.name << ' ' << std::flush;
  }
  std::cout << '\n' << report_of(tallies);
  return std::any_of(
             tallies.begin(), tallies.end(),
             [](const BadFileTally& tally) { return tally.wrong() + tally.slow + tally.large > 0; })
             ? 1
             : 0;
}
