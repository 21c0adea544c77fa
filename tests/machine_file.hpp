// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <excavplan/error.hpp>
#include <excavplan/machine/machine.hpp>

namespace excavplan::test {

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
