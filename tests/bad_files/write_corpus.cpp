// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iostream>

#include "bad_files/bad_file.hpp"
#include "base/json.hpp"
#include "base/random.hpp"
#include "design/design_files.hpp"
#include "fuzz/file_readers.hpp"

// write-corpus FOLDER: a folder for each fuzz target with what fuzzing starts from: the small valid
// files of its format, without the checksum, which the target adds; drawn bytes where it takes
// numbers.

namespace {

void write(const std::string& folder, int number, const std::string& bytes) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/valid-" + std::to_string(number), std::ios::binary) << bytes;
}

void write(const std::string& folder, const excavplan::test::FileReader& reader,
           const std::vector<std::string>& files) {
  int number = 0;
  for (std::string bytes : files) {
    if (reader.sealed) bytes.resize(bytes.size() - excavplan::sealed("").size());
    write(folder + "/" + reader.name, ++number, bytes);
  }
}

std::string drawn(std::uint64_t seed) {
  excavplan::Random random(seed);
  std::string bytes;
  for (int i = 0; i < 120; ++i) bytes += static_cast<char>(random.index(256));
  return bytes;
}

/// In each format whose content tells it; the rasters are those of other targets.
std::vector<std::string> designs() {
  using namespace excavplan::test;
  const PlainMesh mesh = battered_trench({0.0, 0.0});
  return {land_xml(mesh, file_units[0]),
          dxf(dxf_faces(mesh), file_units[0].dxf),
          dxf(dxf_polyface(mesh), file_units[0].dxf),
          ply_text(mesh),
          ply_binary(mesh),
          obj(mesh),
          stl_text(mesh),
          stl_binary(mesh).replace(0, 5, "solid")};
}

constexpr const char* plain_site = R"({"format": "plain-site", "version": 1, "id": "T",
 "tolerance_m": 0.05, "design": {"kind": "trench", "length_m": 15, "floor_width_m": 1, "depth_m": 0.5,
 "origin_m": [1, 2], "heading_rad": 0.5}, "start_pose": {"x": 1, "y": 2, "heading_rad": 3},
 "keep_out": [{"kind": "cable", "polygon": [[0, 0], [1, 0], [1, 1]], "depth_m": 0.8}],
 "obstacles": [{"kind": "pole", "polygon": [[0, 0], [1, 0], [1, 1]], "height_m": 6}],
 "dump_areas": [{"kind": "heap", "polygon": [[0, 0], [1, 0], [1, 1]]}],
 "truck": {"bed_polygon": [[0, 0], [1, 0], [1, 1]], "bed_height_m": 2.4, "target_kg": 4000},
 "sensor": {"noise_sd_at_1m_m": 0.001, "pattern_sd_at_1m_m": 0.002, "range_power": 2}}
)";

}  // namespace

int main(int argc, char** argv) {
  using namespace excavplan;
  if (argc != 2) {
    std::cerr << "usage: write-corpus FOLDER\n";
    return 2;
  }
  const std::string folder = argv[1];
  for (const test::FileReader& reader : test::file_readers()) {
    write(folder, reader, test::valid_files(reader.name));
  }
  for (const test::FileReader& reader : test::job_readers()) {
    write(folder, reader, test::valid_job_files(reader.name));
  }
  write(folder + "/plain_site", 1, plain_site);
  int number = 0;
  for (const std::string& bytes : designs()) write(folder + "/design", ++number, bytes);
  for (const char* target : {"dig", "volume_change"}) {
    for (int seed = 1; seed <= 8; ++seed) {
      write(folder + "/" + target, seed, drawn(static_cast<std::uint64_t>(seed)));
    }
  }
}
