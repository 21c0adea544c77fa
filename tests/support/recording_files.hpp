// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recording/recording_file.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {

/// A recording of tests/recording/data.
std::string recording(const std::string& name);

/// What this build is without, "" if it has all that a file of the data needs.
std::string missing_for([[maybe_unused]] const std::string& name);

/// A folder that is gone when the test ends.
class TempFolder {
 public:
  TempFolder() : path_(testing::TempDir() + "excavplan_recordings_" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::string& path() const { return path_; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ + "/" + name, std::ios::binary) << content;
    return path_ + "/" + name;
  }

 private:
  std::string path_;
};

/// A message, copied.
struct KeptMessage {
  std::string topic;
  std::int64_t time;
  Serialization serialization;
  std::string bytes;
  std::string place;
};

constexpr std::int64_t ever = std::numeric_limits<std::int64_t>::max();

std::vector<KeptMessage> messages_of(RecordingFile& file, const std::vector<std::string>& topics,
                                     std::int64_t from = 0, std::int64_t to = ever);

std::vector<KeptMessage> all_messages(RecordingFile& file);

}  // namespace excavplan::test
