// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/site/site.hpp>

#include "site/site_digs.hpp"
#include "site/site_store.hpp"
#include "support/cases.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;
using test::DigsInARow;
using test::error_of;
using test::TemporaryFolder;

using Files = std::map<std::string, std::string>;

/// Names and contents of the files of a site.
Files files_in(const std::string& folder) {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name != "site.lock") files[name] = test::content_of(entry.path());
  }
  return files;
}

/// The state that counts: site.json and what it names but for the state before.
Files state_in(const std::string& folder) {
  Files state;
  const Files files = files_in(folder);
  const std::string& manifest = files.at("site.json");
  for (const auto& [name, content] : files) {
    const bool is_previous = name.rfind("site-", 0) == 0;
    if (name == "site.json" || (!is_previous && manifest.find(name) != std::string::npos)) {
      state[name] = content;
    }
  }
  return state;
}

TEST(SiteFolder, UndoGivesBackEveryByte) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  Site site(path, digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  site.update(digs.dig(6.0));
  const Files before = state_in(path);
  site.update(digs.dig(6.0));
  EXPECT_NE(state_in(path), before);
  site.undo();
  EXPECT_EQ(state_in(path), before);
  EXPECT_EQ(site.updates(), 2);
  EXPECT_EQ(site.digs(), 1);
  EXPECT_NE(error_of([&] { site.undo(); }).find("of all updates the last one is kept"),
            std::string::npos);
}

TEST(SiteFolder, TheFirstUpdateIsUndone) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  {
    Site site(path, digs.settings(), SiteAccess::write);
    site.update(digs.scan());
    site.undo();
    EXPECT_TRUE(site.is_empty());
  }
  Site site(path, digs.settings(), SiteAccess::write);
  EXPECT_TRUE(site.is_empty());
  EXPECT_TRUE(site.update(digs.scan()).taken);
}

TEST(SiteFolder, IsTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  std::vector<Files> states;
  for (const unsigned threads : {1U, 4U}) {
    DigsInARow digs;
    digs.threads = threads;
    const std::string path = folder.file("site" + std::to_string(threads));
    Site site(path, digs.settings(), SiteAccess::write);
    site.update(digs.scan());
    site.update(digs.dig(6.0));
    states.push_back(files_in(path));
  }
  EXPECT_EQ(states[0], states[1]);
}

TEST(SiteFolder, AnOpenedSiteAnswersLikeTheOneThatStayedOpen) {
  const TemporaryFolder folder;
  std::vector<Files> states;
  for (const bool reopened : {false, true}) {
    DigsInARow digs;
    const std::string path = folder.file(reopened ? "b" : "a");
    auto site = std::make_unique<Site>(path, digs.settings(), SiteAccess::write);
    site->update(digs.scan());
    for (const double start : {6.0, 5.8}) {
      if (reopened) {
        site.reset();
        site = std::make_unique<Site>(path, digs.settings(), SiteAccess::write);
      }
      site->update(digs.dig(start));
    }
    states.push_back(files_in(path));
  }
  EXPECT_EQ(states[0], states[1]);
}

TEST(SiteFolder, ASecondProcessIsToldWhoHoldsIt) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  Site site(path, digs.settings(), SiteAccess::write);
  site.update(digs.scan());
  const std::string told =
      error_of([&] { Site(path, digs.settings(), SiteAccess::write); }, ErrorKind::bad_file);
  EXPECT_EQ(told.find(path + ": the site is in use by process " + std::to_string(::getpid())), 0U)
      << told;
  EXPECT_EQ(Site(path, digs.settings()).updates(), 1);  // reading goes on
}

TEST(SiteFolder, NoLinkIsFollowed) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  const std::string victim = folder.write("victim", "of others");
  { Site(path, digs.settings(), SiteAccess::write).update(digs.scan()); }
  // Where the next state is to be written.
  fs::create_symlink(victim, path + "/ground-2.tif");
  fs::create_symlink(victim, path + "/belief-2.json");
  { Site(path, digs.settings(), SiteAccess::write).update(digs.scan()); }
  EXPECT_EQ(test::content_of(victim), "of others");
  EXPECT_FALSE(fs::is_symlink(path + "/ground-2.tif"));
  // In the place of what is read.
  for (const std::string name : {"site.json", "ground-2.tif", "site.lock"}) {
    const std::string file = path + "/" + name;
    fs::rename(file, folder.file("elsewhere"));
    fs::create_symlink(folder.file("elsewhere"), file);
    EXPECT_NE(
        error_of([&] { Site(path, digs.settings(), SiteAccess::write); }, ErrorKind::bad_file),
        "no error")
        << name;
    fs::remove(file);
    fs::rename(folder.file("elsewhere"), file);
  }
  EXPECT_EQ(Site(path, digs.settings()).updates(), 2);
}

TEST(SiteFolder, APathOutOfItIsNoNameOfIts) {
  const TemporaryFolder folder;
  const std::string path = folder.file("site");
  const SiteFolder site(path, true);
  for (const std::string name : {"../victim", "/etc/passwd", "ground-1.tif/x", "ground-.tif", ""}) {
    EXPECT_NE(error_of(
                  [&] {
                    site.read(StoredFile{name, "0"});
                  },
                  ErrorKind::bad_file)
                  .find("is no file of a site"),
              std::string::npos)
        << name;
  }
}

TEST(SiteFolder, DamageIsTold) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  { Site(path, digs.settings(), SiteAccess::write).update(digs.scan()); }
  for (const auto& [name, content] : files_in(path)) {
    if (name.rfind("site-", 0) == 0) continue;
    for (const bool cut : {false, true}) {
      std::string damaged = cut ? content.substr(0, content.size() / 2) : content;
      if (!cut) damaged[content.size() / 2] = static_cast<char>(damaged[content.size() / 2] ^ 1);
      folder.write("site/" + name, damaged);
      const std::string told = error_of([&] { Site(path, digs.settings()); }, ErrorKind::bad_file);
      EXPECT_EQ(told.find(path + "/" + name), 0U) << told;
    }
    folder.write("site/" + name, content);
  }
  EXPECT_EQ(Site(path, digs.settings()).updates(), 1);
}

TEST(SiteFolder, StaysAsLargeOverManyUpdates) {
  const TemporaryFolder folder;
  const std::string path = folder.file("site");
  SiteStore store(path, true);
  StoredSite now;
  now.manifest.cell_size = 0.05;
  now.ground.terrain = undisturbed(flat_ground({0.0, 0.0, 1.0, 1.0}, 0.05));
  now.first = now.ground;
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
  const int most = test::are_all_tried() ? 10000 : 200;
  for (int i = 0; i < most; ++i) {
    StoredSite next = now;
    next.manifest.latest.push_back({"0123456789abcdef", 1000.0 + i, true});
    store.save(now, next);
    now = std::move(next);
    if (i != 100 && i != most - 1) continue;
    std::size_t count = 0;
    std::uintmax_t sum = 0;
    for (const auto& [name, content] : files_in(path)) {
      ++count;
      sum += content.size();
    }
    if (i == 100) files = count, bytes = sum;
    EXPECT_EQ(count, files);
    EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(bytes), 2000.0);
  }
  EXPECT_EQ(now.manifest.latest.size(), most_records);
}

// ---- Killed at any moment ---------------------------------------------------------------------

/// Stores a next state in a process of its own.
pid_t storing(const std::string& path, const StoredSite& now) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const SiteStore store(path, true);
  StoredSite next = now;
  next.manifest.latest.push_back({"0123456789abcdef", 2000.0, true});
  next.ground.seen.setConstant(2000.0);
  next.first.terrain.bank.z += 1.0;
  store.save(now, next);
  ::_exit(0);
}

/// @return seconds that it took
double stored(const std::string& path, const StoredSite& now) {
  const auto start = std::chrono::steady_clock::now();
  int status = -1;
  ::waitpid(storing(path, now), &status, 0);
  EXPECT_EQ(status, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// @return whether it was killed: it may have been over before
bool stored_by_killed(const std::string& path, const StoredSite& now, double after) {
  const pid_t child = storing(path, now);
  ::usleep(static_cast<useconds_t>(1e6 * after));
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

TEST(SiteFolder, KilledAtAnyMomentIsAsBeforeOrAfter) {
  const TemporaryFolder folder;
  DigsInARow digs;
  const std::string path = folder.file("site");
  StoredSite now;
  now.manifest.cell_size = 0.05;
  now.ground.terrain = digs.ground();
  now.ground.seen.setConstant(now.ground.terrain.loose.rows(), now.ground.terrain.loose.cols(),
                              1000.0);
  now.first = now.ground;
  {
    StoredSite empty = now;
    empty.manifest.generation = 0;
    SiteStore(path, true).save(empty, now);
  }
  const Files before = state_in(path);
  const Files all_before = files_in(path);
  const double whole = stored(path, now);
  const Files after = state_in(path);
  const Files all_after = files_in(path);
  const int moments = test::are_all_tried() ? 500 : 100;
  int killed = 0;
  int were_before = 0;
  for (int i = 0; i < moments; ++i) {
    SCOPED_TRACE("moment " + std::to_string(i));
    fs::remove_all(path);
    fs::create_directory(path);
    for (const auto& [name, content] : all_before) folder.write("site/" + name, content);
    killed += stored_by_killed(path, now, 1.2 * whole * i / moments) ? 1 : 0;
    const SiteStore store(path, true);  // removes what is left over
    store.load();
    const Files found = state_in(path);
    ASSERT_TRUE(found == before || found == after);
    ASSERT_EQ(files_in(path), found == before ? all_before : all_after);
    were_before += found == before ? 1 : 0;
  }
  EXPECT_GT(killed, moments / 10);
  EXPECT_GT(were_before, 0);
}

}  // namespace
}  // namespace excavplan
