// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>

#include "support/errors.hpp"
#include "support/run_program.hpp"

/// @file
/// What is found before long work to be a place that cannot be written to.

namespace excavplan::test {
namespace {

namespace fs = std::filesystem;

class Writable : public testing::Test {
 protected:
  std::string reason(const std::string& path) const {
    return error_about([&] { require_writable(path); }, path);
  }
  std::size_t files() const {
    const fs::directory_iterator all(folder_.file(""));
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  const TemporaryFolder folder_;
};

TEST_F(Writable, PlacesAreLeftAsTheyAre) {
  const std::string file = folder_.write("file", "mine");
  fs::create_symlink(file, folder_.file("link"));
  fs::create_symlink(folder_.file("none"), folder_.file("to be made"));
  ASSERT_EQ(::mkfifo(folder_.file("pipe").c_str(), 0600), 0);
  for (const char* name : {"file", "link", "to be made", "pipe", "fresh"}) {
    EXPECT_EQ(reason(folder_.file(name)), "no error");
  }
  EXPECT_EQ(reason("/dev/null"), "no error");
  EXPECT_EQ(content_of(file), "mine");
  EXPECT_EQ(files(), 4U);
}

TEST_F(Writable, PlacesWithoutAFolderOrRoomAreRefused) {
  fs::create_symlink("/nowhere/file", folder_.file("dangling"));
  fs::create_symlink("loop", folder_.file("loop"));
  const std::string failed = "cannot be written: ";
  EXPECT_EQ(reason(folder_.file("dangling")), failed + "No such file or directory");
  EXPECT_EQ(reason(folder_.file("loop")), failed + "Too many levels of symbolic links");
  EXPECT_EQ(reason(folder_.file("")), failed + "Is a directory");
  EXPECT_EQ(reason(folder_.file(std::string(300, 'a'))), failed + "File name too long");
  EXPECT_EQ(reason(folder_.file("none/file")), "there is no folder " + folder_.file("none"));
  EXPECT_EQ(reason(folder_.file("loop/file")), "there is no folder " + folder_.file("loop"));
  EXPECT_EQ(reason("/dev/full"), failed + "No space left on device");
  EXPECT_EQ(files(), 2U);
}

TEST_F(Writable, AWorkingFolderThatWasDeletedIsRefused) {
  const fs::path before = fs::current_path();
  fs::create_directory(folder_.file("gone"));
  fs::current_path(folder_.file("gone"));
  fs::remove(folder_.file("gone"));
  EXPECT_EQ(reason("file"), "cannot be written: No such file or directory");
  fs::current_path(before);
}

}  // namespace
}  // namespace excavplan::test
