// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/used_files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <system_error>

#include "base/files.hpp"
#include "frame/arguments.hpp"

namespace excavplan::tools {
namespace {

namespace fs = std::filesystem;

/// Where a file is, or will be; empty of what is no file.
std::string place_of(const fs::path& name) {
  std::error_code error;
  if (fs::exists(name, error) && !fs::is_regular_file(name, error)) return {};
  fs::path path = fs::absolute(name, error);
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    path = path.parent_path() / fs::read_symlink(path, error);  // also of one that leads nowhere
  }
  const fs::path folder = fs::weakly_canonical(path.parent_path(), error);
  return error ? std::string() : (folder / path.filename()).string();
}

bool is_folder(const UsedFile& file) {
  std::error_code none;
  return fs::is_directory(file.text, none);
}

/// What a folder of a site, a job or a plain site holds of it.
std::vector<std::string> kept_in(const std::string& folder) {
  static const std::regex form(
      "(site|job|order|design|scan)[-.0-9].*|(job|order)-[a-z].*|(ground|first|belief)-[0-9]+[.]."
      "*");
  std::vector<std::string> places;
  std::error_code error;
  for (const fs::directory_entry& each : fs::directory_iterator(folder, error)) {
    if (std::regex_match(each.path().filename().string(), form))
      places.push_back(place_of(each.path()));
  }
  return places;
}

/// The files that a text names: it is one, a list of some, FILE:PLACE, or a folder with some.
std::vector<std::string> places_of(const UsedFile& file) {
  if (is_folder(file)) return kept_in(file.text);
  if (file.output) return {place_of(file.text)};
  std::vector<std::string> names = split(file.text, ',');
  names.push_back(file.text);
  names.push_back(file.text.substr(0, file.text.find(':')));
  std::vector<std::string> places;
  for (const std::string& name : names) {
    std::error_code error;
    if (fs::is_regular_file(name, error)) places.push_back(place_of(name));
  }
  return places;
}

/// What would be printed is lost where its file is replaced.
void refuse_file_of_standard_output(const UsedFile& output) {
  struct stat file {};
  struct stat printed {};
  const bool are_files = ::stat(output.text.c_str(), &file) == 0 && S_ISREG(file.st_mode) &&
                         ::fstat(STDOUT_FILENO, &printed) == 0;
  if (!are_files || file.st_dev != printed.st_dev || file.st_ino != printed.st_ino) return;
  if (open_descriptor(output.text)) return;  // which adds to it
  usage_error(output.option + " names the file of standard output, " + output.text +
              "; /dev/stdout adds to it");
}

}  // namespace

void refuse_shared_files(const std::vector<UsedFile>& files) {
  std::vector<std::vector<std::string>> places(files.size());
  std::transform(files.begin(), files.end(), places.begin(), places_of);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!files[i].output || is_folder(files[i])) continue;
    refuse_file_of_standard_output(files[i]);
    const std::string& place = places[i].front();
    for (std::size_t j = 0; j < files.size(); ++j) {
      const bool is_there = std::count(places[j].begin(), places[j].end(), place) > 0;
      if (j == i || place.empty() || !is_there) continue;
      const auto [first, second] = std::minmax(i, j);  // in the order of the options
      usage_error(files[first].option + " and " + files[second].option + " name the same file, " +
                  files[i].text);
    }
  }
}

}  // namespace excavplan::tools
