// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <excavplan/data_files.hpp>
#include <excavplan/error.hpp>
#include <excavplan/machine/machine.hpp>

namespace excavplan::test {

inline std::string zx120_path() { return find_data_file("machines/zx120.json"); }

/// The shipped machine.
inline const Machine& zx120() {
  static const Machine machine = load_machine(zx120_path());
  return machine;
}

/// What load_machine says about a machine file, without the file's name; "accepted" if nothing.
inline std::string complaint_about_file(const nlohmann::json& file) {
  const std::string path = testing::TempDir() + "machine" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  std::string complaint = "accepted";
  try {
    load_machine(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_file);
    complaint = error.what();
    EXPECT_EQ(complaint.rfind(path + ": ", 0), 0u) << complaint;
    complaint.erase(0, path.size() + 2);
  }
  std::remove(path.c_str());
  return complaint;
}

}  // namespace excavplan::test
