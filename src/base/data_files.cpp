// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/data_files.hpp>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#include <excavplan/error.hpp>

namespace excavplan {

std::string find_data_file(const std::string& relative_path) {
  namespace fs = std::filesystem;
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("EXCAVPLAN_DATA")) folders.emplace_back(named);
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (!none) folders.push_back(program.parent_path().parent_path() / "share" / "excavplan");
  folders.emplace_back(EXCAVPLAN_INSTALLED_DATA);
  folders.emplace_back(EXCAVPLAN_SOURCE_DATA);

  std::string searched;
  for (const fs::path& folder : folders) {
    const fs::path file = folder / relative_path;
    if (fs::is_regular_file(file, none)) return file.string();
    searched += "\n  " + folder.string();
  }
  throw Error(ErrorKind::bad_file, relative_path + ": not found in any of" + searched);
}

std::string shipped_or_file(const std::string& folder, const std::string& name_or_path) {
  if (name_or_path.find_first_of("/.") != std::string::npos ||
      std::filesystem::exists(name_or_path)) {
    return name_or_path;
  }
  try {
    return find_data_file(folder + "/" + name_or_path + ".json");
  } catch (const Error&) {
    throw Error(ErrorKind::bad_input, "'" + name_or_path + "' is neither a file nor one of the " +
                                          folder + " that excavplan ships");
  }
}

}  // namespace excavplan
