// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iostream>

#include "bad_files/bad_file.hpp"
#include "base/json.hpp"
#include "base/random.hpp"
#include "fuzz/file_readers.hpp"

// write-corpus FOLDER: a folder for each fuzz target with what fuzzing starts from: the small valid
// files of its format, without the checksum, which the target adds; drawn bytes where it takes
// numbers.

namespace {

void write(const std::string& folder, int number, const std::string& bytes) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/valid-" + std::to_string(number), std::ios::binary) << bytes;
}

std::string drawn(std::uint64_t seed) {
  excavplan::Random random(seed);
  std::string bytes;
  for (int i = 0; i < 120; ++i) bytes += static_cast<char>(random.index(256));
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace excavplan;
  if (argc != 2) {
    std::cerr << "usage: write-corpus FOLDER\n";
    return 2;
  }
  for (const test::FileReader& reader : test::file_readers()) {
    const std::string folder = std::string(argv[1]) + "/" + reader.name;
    int number = 0;
    for (std::string bytes : test::valid_files(reader.name)) {
      if (reader.sealed) bytes.resize(bytes.size() - sealed("").size());
      write(folder, ++number, bytes);
    }
  }
  for (const char* target : {"dig", "volume_change"}) {
    for (int seed = 1; seed <= 8; ++seed) {
      write(std::string(argv[1]) + "/" + target, seed, drawn(static_cast<std::uint64_t>(seed)));
    }
  }
}
