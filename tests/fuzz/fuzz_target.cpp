// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <excavplan/base/error.hpp>

#include "base/json.hpp"
#include "fuzz/file_readers.hpp"

namespace excavplan::test {
namespace {

/// A file in memory, in a folder of its own for what a reader puts beside it; gone at the end.
class ScratchFile {
 public:
  ScratchFile() : folder_("/dev/shm/excavplan-fuzz-" + std::to_string(::getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& holding(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_;
  }

 private:
  std::string folder_;
  std::string path_ = folder_ + "/file";
};

bool is_control(char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }

void require_good_message(const Error& error, const std::string& path) {
  constexpr std::size_t longest = 4000;
  const std::string text = error.what();
  require_that(text.size() <= longest, "a message of " + std::to_string(text.size()) + " bytes");
  require_that(std::none_of(text.begin(), text.end(), is_control), "control characters: " + text);
  const bool names_file = text.find(path) != text.npos;
  require_that(names_file || error.kind() != ErrorKind::bad_file, "no file named: " + text);
}

void fuzz_reader(const FileReader& reader, std::string_view bytes) {
  static const ScratchFile file;
  const std::string& path =
      file.holding(reader.sealed ? sealed(std::string(bytes)) : std::string(bytes));
  try {
    reader.read(path);
  } catch (const Error& error) {
    require_good_message(error, path);
  }
}

}  // namespace

void require_that(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

std::vector<FuzzTarget> fuzz_targets() {
  std::vector<FuzzTarget> targets = {{"dig", fuzz_dig},
                                     {"volume_change", fuzz_volume_change},
                                     {"simulator_answer", fuzz_simulator_answer}};
  for (const auto& readers : {file_readers(), design_readers(), job_readers()}) {
    for (const FileReader& reader : readers) {
      targets.push_back(
          {reader.name, [reader](std::string_view bytes) { fuzz_reader(reader, bytes); }});
    }
  }
  return targets;
}

FuzzTarget fuzz_target(const std::string& name) {
  for (const FuzzTarget& target : fuzz_targets()) {
    if (target.name == name) return target;
  }
  throw std::out_of_range("no fuzz target " + name);
}

}  // namespace excavplan::test
