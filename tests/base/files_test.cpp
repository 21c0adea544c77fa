// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>

#include "base/input_file.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

/// @file
/// Files that are read whole or refused, written whole or not at all, and what is found before long
/// work to be a place that cannot be written to.

namespace {
bool folders_fail = false;
}  // namespace

/// In the place of the C library's: fails for folders if it is to.
extern "C" int fsync(int descriptor) {
  struct stat status {};
  if (folders_fail && ::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

namespace excavplan::test {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  std::size_t files() const {
    const fs::directory_iterator all(folder_.file(""));
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  const TemporaryFolder folder_;
};

class Writable : public Files {
 protected:
  std::string reason(const std::string& path) const {
    return error_about([&] { require_writable(path); }, path);
  }
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

class Reading : public Files {
 protected:
  static std::string reason(const std::string& path, std::uint64_t most = most_settings_bytes) {
    return error_about([&] { read_file(path, most); }, path);
  }
};

TEST_F(Reading, WhatIsNoRegularFileIsRefusedWithoutWaiting) {
  ASSERT_EQ(::mkfifo(folder_.file("pipe").c_str(), 0600), 0);
  fs::create_symlink("loop", folder_.file("loop"));
  EXPECT_EQ(reason(folder_.file("pipe")), "is not a regular file");
  EXPECT_EQ(reason(folder_.file("")), "is not a regular file");
  EXPECT_EQ(reason("/dev/zero"), "is not a regular file");
  EXPECT_EQ(reason(folder_.file("none")), "cannot be opened: No such file or directory");
  EXPECT_EQ(reason(folder_.file("loop")), "cannot be opened: Too many levels of symbolic links");
  EXPECT_EQ(reason(std::string(300, 'a')), "cannot be opened: File name too long");
}

TEST_F(Reading, ContentIsWhatWasWritten) {
  const std::string content = std::string("a\0\r\n\xff", 5) + std::string(1000000, 'b');
  EXPECT_EQ(read_file(folder_.write("file", content)), content);
  EXPECT_EQ(read_file(folder_.write("empty", "")), "");
  fs::create_symlink(folder_.file("file"), folder_.file("link"));
  EXPECT_EQ(read_file(folder_.file("link")), content);
}

TEST_F(Reading, AReadErrorIsNoEnd) {
  EXPECT_EQ(reason("/proc/self/mem"), "cannot be read: Input/output error");
}

TEST_F(Reading, AFileThatChangesItsSizeIsRefused) {
  EXPECT_EQ(reason("/proc/self/status"), "became longer while it was read") << "it states 0 bytes";
  const std::string path = folder_.write("file", "0123456789");
  const InputFile file(path);
  std::array<char, 10> bytes{};
  file.read(0, bytes.data(), bytes.size());
  EXPECT_NO_THROW(file.require_end());
  fs::resize_file(path, 11);
  EXPECT_EQ(error_about([&] { file.require_end(); }, path), "became longer while it was read");
  fs::resize_file(path, 9);
  EXPECT_EQ(error_about([&] { file.read(0, bytes.data(), bytes.size()); }, path),
            "became shorter while it was read");
}

TEST_F(Reading, FilesAboveTheCeilingAreRefusedBeforeTheyAreRead) {
  const std::string path = folder_.write("file", "1234");
  EXPECT_EQ(reason(path, 4), "no error");
  EXPECT_EQ(reason(path, 3), "found 4 bytes, expected at most 3");
  fs::resize_file(path, std::uintmax_t{3} << 30);  // with no block on the disk
  EXPECT_EQ(reason(path), "found 3221225472 bytes, expected at most 67108864");
}

class Writing : public Files {
 protected:
  static mode_t mode(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 07777U : 0;
  }
  static ino_t inode(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
  }
};

TEST_F(Writing, AFileIsReplacedWholeAndKeepsItsMode) {
  const std::string path = folder_.write("file", "a longer old content");
  for (const mode_t kept : {0600U, 0664U, 0640U}) {
    ASSERT_EQ(::chmod(path.c_str(), kept), 0);
    const ino_t before = inode(path);
    write_file(path, "new");
    EXPECT_EQ(content_of(path), "new");
    EXPECT_EQ(mode(path), kept);
    EXPECT_NE(inode(path), before);
  }
  const mode_t before = ::umask(027);
  write_file(folder_.file("fresh"), "");
  ::umask(before);
  EXPECT_EQ(mode(folder_.file("fresh")), 0640U);
  EXPECT_EQ(files(), 2U);
}

TEST_F(Writing, AContentInPartsIsWrittenWholeOrNotAtAll) {
  const std::string path = folder_.write("file", "old");
  const auto write_parts = [&path](bool fails) {
    write_file(path, [fails](const auto& append) {
      append("a ");
      append("");
      if (fails) throw Error(ErrorKind::bad_file, "the source fails");
      append("new one");
    });
  };
  EXPECT_THROW(write_parts(true), Error);
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(files(), 1U);
  write_parts(false);
  EXPECT_EQ(content_of(path), "a new one");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Writing, WhatALinkLeadsToIsReplacedWhereItLies) {
  fs::create_directory(folder_.file("data"));
  const std::string target = folder_.write("data/target", "old");
  fs::create_symlink("data/target", folder_.file("near"));
  fs::create_symlink("../near", folder_.file("data/far"));
  const ino_t before = inode(target);
  write_file(folder_.file("data/far"), "new");
  EXPECT_EQ(content_of(target), "new");
  EXPECT_NE(inode(target), before);
  EXPECT_TRUE(fs::is_symlink(folder_.file("near")));
  EXPECT_TRUE(fs::is_symlink(folder_.file("data/far")));
  fs::create_symlink("data/made", folder_.file("dangling"));
  write_file(folder_.file("dangling"), "made");
  EXPECT_EQ(content_of(folder_.file("data/made")), "made");
  EXPECT_TRUE(fs::is_symlink(folder_.file("dangling")));
  EXPECT_EQ(files(), 3U);
}

TEST_F(Writing, AFullDiskLeavesTheOldContentAndNothingElse) {
  const std::string path = folder_.write("file", "old");
  fs::create_symlink("file", folder_.file("link"));
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit limit = before;
  limit.rlim_cur = 8192;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::array<std::string, 2> reasons;
  const std::string content(10000, 'x');
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name = folder_.file(i == 0 ? "file" : "link");
    reasons[i] = error_about([&] { write_file(name, content); }, name);
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  for (const std::string& reason : reasons) EXPECT_EQ(reason, "cannot be written: File too large");
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(files(), 2U);
}

TEST_F(Writing, PlacesThatCannotBeWrittenAreNamedWithTheReason) {
  const auto reason = [](const std::string& path) {
    return error_about([&] { write_file(path, "x"); }, path);
  };
  fs::create_symlink("loop", folder_.file("loop"));
  EXPECT_EQ(reason(folder_.file("none/file")), "cannot be written: No such file or directory");
  EXPECT_EQ(reason(folder_.file("loop")), "cannot be written: Too many levels of symbolic links");
  EXPECT_EQ(reason(folder_.file("")), "cannot be written: Is a directory");
  EXPECT_EQ(reason("/dev/full"), "cannot be written: No space left on device");
  EXPECT_EQ(reason(folder_.file(std::string(300, 'a'))), "cannot be written: File name too long");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Writing, NamesAsLongAsTheyMayBeAreWritten) {
  const std::string path = folder_.file(std::string(255, 'a'));
  write_file(path, "x");
  EXPECT_EQ(content_of(path), "x");
  EXPECT_NO_THROW(require_writable(path));
  EXPECT_EQ(files(), 1U);
}

/// Nor is what a machine of the same name writes in a folder that both share.
TEST_F(Writing, WhatAKilledRunLeftIsNoHindrance) {
  char host[65] = {};
  ASSERT_EQ(::gethostname(host, sizeof host - 1), 0);
  const std::string left = "file.part-" + std::string(host) + "-" + std::to_string(::gettid());
  folder_.write(left, "half of a much longer file");
  folder_.write(left + "-aaaaaaaa", "another's");
  write_file(folder_.file("file"), "whole");
  EXPECT_EQ(content_of(folder_.file("file")), "whole");
  EXPECT_EQ(content_of(folder_.file(left + "-aaaaaaaa")), "another's");
  EXPECT_EQ(files(), 3U);
}

TEST_F(Writing, AFailureBehindTheRenameSaysThatTheFileWasWritten) {
  const std::string path = folder_.write("file", "old");
  folders_fail = true;
  const std::string reason = error_about([&] { write_file(path, "new"); }, path);
  folders_fail = false;
  EXPECT_EQ(reason, "was written, but a loss of power may undo that: Input/output error");
  EXPECT_EQ(content_of(path), "new");
  EXPECT_EQ(files(), 1U);
}

TEST(UnfinishedFiles, AreThoseOfTheirFormAlone) {
  for (const char* path : {"file", "/folder/file", "", "a.part-b", "run.part-3/x.log"}) {
    const std::string name = unfinished_name(path);
    EXPECT_TRUE(is_unfinished(name)) << name;
    EXPECT_NE(unfinished_name(path), name);
  }
  const std::string longest = unfinished_name("folder/" + std::string(255, 'a'));
  EXPECT_TRUE(is_unfinished(longest));
  EXPECT_EQ(longest.size(), 7U + 255U);
  for (const char* path :
       {"", "-", "survey.part-2.log", "run.part-3/survey.log", "run.part-host-1-abcdefgh/log",
        "file.part-host-1-abcdefg", "file.part-host-1-abcdefghi", "file.part-host-1-abcdEfgh",
        "file.part-host--abcdefgh", "file.part-host-x-abcdefgh", "file-host-1-abcdefgh",
        "file.part-host-1-abcdefgh (deleted)", "abcdefgh", "1-abcdefgh"}) {
    EXPECT_FALSE(is_unfinished(path)) << path;
  }
}

TEST_F(Writing, PipesAreWrittenTo) {
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  write_file(pipe, "through");
  std::array<char, 16> bytes{};
  EXPECT_EQ(::read(reader, bytes.data(), bytes.size()), 7);
  ::close(reader);
  EXPECT_STREQ(bytes.data(), "through");
  EXPECT_EQ(files(), 1U);
}

class OpenFiles : public Writing {
 protected:
  ~OpenFiles() override { ::close(open_); }

  const std::string path_ = folder_.write("file", "old content");
  const int open_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
  const std::string name_ = "/dev/fd/" + std::to_string(open_);
};

TEST_F(OpenFiles, AreWrittenToFromWhereTheyStand) {
  const ino_t before = inode(path_);
  ASSERT_EQ(::lseek(open_, 0, SEEK_END), 11);
  fs::create_symlink(name_, folder_.file("link"));
  for (const std::string& name :
       {name_, folder_.file("link"), "/proc/thread-self/fd/" + std::to_string(open_)}) {
    EXPECT_NO_THROW(require_writable(name));
    EXPECT_EQ(open_descriptor(name), open_);
    write_file(name, ", a file");
    ASSERT_EQ(::write(open_, ", more", 6), 6);
  }
  const std::string added = ", a file, more";
  EXPECT_EQ(content_of(path_), "old content" + added + added + added);
  EXPECT_EQ(inode(path_), before);
  EXPECT_EQ(files(), 2U);
}

TEST_F(OpenFiles, ThatCannotBeWrittenToAreRefused) {
  const auto reason = [](const std::string& name) {
    return error_about([&] { require_writable(name); }, name);
  };
  const int read_only = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(reason("/dev/fd/" + std::to_string(read_only)),
            "cannot be written: Bad file descriptor");
  ::close(read_only);
  const pid_t other = ::fork();
  if (other == 0) ::pause();
  const std::string of_other = "/proc/" + std::to_string(other) + "/fd/" + std::to_string(open_);
  EXPECT_EQ(reason(of_other), "is a file that another process has open");
  ::kill(other, SIGKILL);
  ::waitpid(other, nullptr, 0);
  EXPECT_EQ(content_of(path_), "old content");
}

TEST(OwnFiles, GrowFromAByteOnAndFollowNoLink) {
  const TemporaryFolder folder;
  const std::string path = folder.file("log"), link = folder.file("link");
  write_own_tail(path, 0, "one\ntwo");
  write_own_tail(path, 4, "three\n");
  EXPECT_EQ(content_of(path), "one\nthree\n");
  write_own_tail(path, 4, {});
  EXPECT_EQ(content_of(path), "one\n");
  std::filesystem::create_symlink(path, link);
  error_about([&] { write_own_tail(link, 0, "over"); }, link);
  EXPECT_EQ(content_of(path), "one\n");
}

TEST_F(OpenFiles, AreNotThoseOfOtherPaths) {
  for (const std::string& name : {path_, folder_.file("none"), std::string("/proc/self/exe"),
                                  std::string("/dev/null"), std::string("/proc/self/fd")}) {
    EXPECT_EQ(open_descriptor(name), std::nullopt) << name;
  }
}

}  // namespace
}  // namespace excavplan::test
