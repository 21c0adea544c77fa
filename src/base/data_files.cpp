// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>

#include <dlfcn.h>
#include <sys/auxv.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <system_error>
#include <vector>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

/// The file of the running program; empty if the system does not provide it.
fs::path program_file() {
  std::error_code none;
  fs::path file = fs::read_symlink("/proc/self/exe", none);
  if (!none) return file;
  // A root without /proc: as the program was called, the folder of PATH included.
  // NOLINTNEXTLINE(performance-no-int-to-ptr): an address, as the kernel gives it
  const auto* const called = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  return called == nullptr ? fs::path() : fs::canonical(called, none);
}

/// The shared library or Python module that this code is part of; empty if it is part of the
/// program itself.
fs::path shared_library_file() {
  static const char here = 0;
  Dl_info info;
  if (::dladdr(&here, &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code none;
  const fs::path file = fs::canonical(info.dli_fname, none);
  return none || file == program_file() ? fs::path() : file;
}

/// The folder of the environment variable, if it is set. @throws Error (bad_file) if there is none
fs::path named_folder() {
  const char* const named = std::getenv("EXCAVPLAN_DATA");
  if (named == nullptr || *named == '\0') return {};
  std::error_code none;
  if (fs::is_directory(named, none)) return named;
  throw Error(ErrorKind::bad_file, "the environment variable EXCAVPLAN_DATA: found " +
                                       in_quotes(named) + ", expected a folder");
}

std::vector<fs::path> data_folders(const std::string& package_folder) {
  std::vector<fs::path> folders;
  if (const fs::path named = named_folder(); !named.empty()) folders.push_back(named);
  if (const fs::path library = shared_library_file(); !library.empty()) {
    folders.push_back(library.parent_path() / EXCAVPLAN_DATA_FROM_LIBRARY);
    const fs::path of_module = library.parent_path() / EXCAVPLAN_DATA_FROM_MODULE;
    if (of_module != folders.back()) folders.push_back(of_module);
  }
  if (!package_folder.empty()) folders.emplace_back(package_folder);
  if (const fs::path program = program_file(); !program.empty()) {
    folders.push_back(program.parent_path() / EXCAVPLAN_DATA_FROM_PROGRAM);
  }
  return folders;
}

}  // namespace

std::string find_data_file(const std::string& relative_path, const std::string& package_folder) {
  const fs::path relative = relative_path;
  if (relative.is_absolute() || std::count(relative.begin(), relative.end(), "..") > 0) {
    throw Error(ErrorKind::bad_input,
                in_quotes(relative_path) +
                    ": found a path out of the folder of the data, expected one in it");
  }
  std::string searched;
  for (const fs::path& place : data_folders(package_folder)) {
    std::error_code none;
    const fs::path folder = place.lexically_normal();
    const fs::path file = folder / relative;
    if (fs::is_regular_file(file, none)) return file.string();
    searched += (searched.empty() ? " " : ", ") + folder.string();
  }
  throw Error(ErrorKind::bad_file, relative_path + ": not found in any of" + searched);
}

bool has_data_folder(const std::string& folder, const std::string& package_folder) {
  const std::vector<fs::path> places = data_folders(package_folder);
  return std::any_of(places.begin(), places.end(), [&](const fs::path& place) {
    std::error_code none;
    return fs::is_directory(place / folder, none);
  });
}

namespace {

/// ": clay, loam", of the JSON files there.
std::string names_in(const std::string& folder, const std::string& package_folder) {
  std::set<std::string> names;
  for (const fs::path& place : data_folders(package_folder)) {
    std::error_code none;
    for (const fs::directory_entry& each : fs::directory_iterator(place / folder, none)) {
      if (each.path().extension() == ".json") names.insert(each.path().stem().string());
    }
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? ": " : ", ") + name;
  return text;
}

}  // namespace

std::string shipped_or_file(const std::string& folder, const std::string& name_or_path,
                            const std::string& package_folder) {
  std::error_code none;
  if (name_or_path.find_first_of("/.") != std::string::npos ||
      fs::exists(fs::symlink_status(name_or_path, none))) {
    return name_or_path;
  }
  try {
    return find_data_file(folder + "/" + name_or_path + ".json", package_folder);
  } catch (const Error&) {
    if (!has_data_folder(folder, package_folder)) throw;
    throw Error(ErrorKind::bad_input, "'" + name_or_path + "' is neither a file nor one of the " +
                                          folder + " that excavplan ships" +
                                          names_in(folder, package_folder));
  }
}

}  // namespace excavplan
