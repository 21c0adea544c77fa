// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "bad_files/run_bad_files.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include <excavplan/base/error.hpp>

namespace excavplan::test {
namespace {

namespace fs = std::filesystem;
using std::string;

/// What a reader did with a file.
enum class Outcome : char { refused, bad_message, same, differs, threw };

/// Seen by parent and child.
struct Shared {
  Outcome outcome;
  std::size_t step;  ///< of a sweep: what is being read
  int counts[5];     ///< of a sweep, by Outcome
  char note[400];
};

/// A folder in memory, where the system has one for files.
class Folder {
 public:
  Folder() {
    for (const string& place : {string("/dev/shm"), fs::temp_directory_path().string()}) {
      string name = place + "/excavplan-bad-XXXXXX";
      if (::mkdtemp(name.data()) == nullptr) continue;
      path_ = name;
      return;
    }
    throw std::runtime_error("no temporary folder can be made");
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const string& path() const { return path_; }
  string write(const string& bytes) const {
    string path = path_ + "/file";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

 private:
  string path_;
};

class SharedMemory {
 public:
  SharedMemory()
      : shared_(static_cast<Shared*>(::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE,
                                            MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {}
  ~SharedMemory() { ::munmap(shared_, sizeof(Shared)); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  Shared* operator->() const { return shared_; }

 private:
  Shared* shared_;
};

void note(Shared& shared, const string& text) {
  std::snprintf(shared.note, sizeof shared.note, "%s", text.c_str());
}

/// Reads a file in this process.
Outcome outcome_of(const FileReader& reader, const string& path, string& said, Shared& shared) {
  try {
    said = reader.read(path);
    return Outcome::differs;
  } catch (const Error& error) {
    const string text = error.what();
    const bool good = text.find(path) != text.npos && text.size() <= 4000 &&
                      std::none_of(text.begin(), text.end(), [](char c) {
                        return static_cast<unsigned char>(c) < 32 || c == 127;
                      });
    if (!good) note(shared, text);
    return good ? Outcome::refused : Outcome::bad_message;
  } catch (const std::exception& error) {
    note(shared, error.what());
    return Outcome::threw;
  }
}

/// How a child ended.
struct Ending {
  int status = 0;
  double seconds = 0.0;
  double bytes = 0.0;  ///< largest resident memory
};

constexpr unsigned longest_wait = 20;  // for one file, or 1000 of a sweep [s]

Ending run_child(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::alarm(longest_wait);
#ifndef __SANITIZE_ADDRESS__
    constexpr rlim_t most = rlim_t{6} << 30;
    const rlimit limit{most, most};
    ::setrlimit(RLIMIT_AS, &limit);
#endif
    work();
    ::_exit(0);
  }
  Ending ending;
  rusage usage{};
  ::wait4(child, &ending.status, 0, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  ending.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  ending.bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  return ending;
}

void add_finding(BadFileTally& tally, int BadFileTally::*count, const string& text) {
  ++(tally.*count);
  tally.findings.push_back(tally.format + ": " + text);
}

/// @return false if it did not end by itself
bool ended_well(const Ending& ending, BadFileTally& tally, const string& name) {
  if (WIFEXITED(ending.status) && WEXITSTATUS(ending.status) == 0) return true;
  const bool hung = WIFSIGNALED(ending.status) && WTERMSIG(ending.status) == SIGALRM;
  const string how = WIFSIGNALED(ending.status)
                         ? "signal " + std::to_string(WTERMSIG(ending.status))
                         : "exit code " + std::to_string(WEXITSTATUS(ending.status));
  add_finding(tally, hung ? &BadFileTally::hangs : &BadFileTally::crashes, name + ": " + how);
  return false;
}

void judge(const BadFile& file, const Shared& shared, BadFileTally& tally) {
  switch (shared.outcome) {
    case Outcome::refused:
      ++tally.refused;
      if (file.expected != Expected::same) return;
      return add_finding(tally, &BadFileTally::wrong_refusal, file.name + ": refused");
    case Outcome::bad_message:
      return add_finding(tally, &BadFileTally::wrong_refusal, file.name + ": " + shared.note);
    case Outcome::threw:
      return add_finding(tally, &BadFileTally::crashes, file.name + ": threw " + shared.note);
    case Outcome::same:
    case Outcome::differs:
      const bool same = shared.outcome == Outcome::same;
      ++(same ? tally.same : tally.other);
      if (file.expected == Expected::either || (same && file.expected == Expected::same)) return;
      return add_finding(tally, &BadFileTally::garbage,
                         file.name + (same ? ": read" : ": read as something else"));
  }
}

/// What a valid file says, and the memory that takes.
struct Valid {
  string said;
  double bytes = 0.0;
};

Valid read_valid(const FileReader& reader, const string& bytes, const Folder& folder) {
  const string path = folder.write(bytes);
  Valid valid;
  valid.bytes = run_child([&] { reader.read(path); }).bytes;
  valid.said = reader.read(path);
  return valid;
}

/// The valid file that one is compared with: with two of a format either will do.
bool is_same(const BadFile& file, const std::vector<Valid>& valid, const string& said) {
  if (!file.said.empty()) return said == file.said;
  return std::any_of(valid.begin(), valid.end(), [&](const Valid& v) { return v.said == said; });
}

// ---- Sweeps -------------------------------------------------------------------------------------

std::vector<string> lines_of(const string& said) {
  std::vector<string> lines;
  for (std::size_t at = 0; at < said.size();) {
    const std::size_t end = std::min(said.find('\n', at), said.size());
    const string line = said.substr(at, end - at);
    if (line.rfind("sensor", 0) != 0) lines.push_back(line);
    at = end + 1;
  }
  return lines;
}

bool differ_in_one(const string& a, const string& b) {
  const std::vector<string> one = lines_of(a), other = lines_of(b);
  int differences = 0;
  for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) {
    if (one[i] != other[i]) ++differences;
  }
  return one.size() == other.size() && differences <= 1;
}

bool lacks_one(const string& a, const string& b) {
  const std::vector<string> one = lines_of(a), other = lines_of(b);
  if (other.size() + 1 != one.size()) return false;
  const auto [first, place] = std::mismatch(one.begin(), one.end() - 1, other.begin());
  return std::equal(first + 1, one.end(), place);
}

bool differ_in_one_leaf(const string& a, const string& b) {
  const auto one = nlohmann::json::parse(a).flatten();
  const auto changed = nlohmann::json::parse(b, nullptr, false);
  if (changed.is_discarded()) return false;
  const auto other = changed.flatten();
  int differences = 0;
  for (const auto& [key, value] : one.items()) {
    if (!other.contains(key)) return false;
    if (other.at(key) != value) ++differences;
  }
  return one.size() == other.size() && differences <= 1;
}

bool starts_alike(const string& whole, const string& cut, bool same_length) {
  const std::vector<string> all = lines_of(whole), some = lines_of(cut);
  if (some.size() > all.size() || (same_length && some.size() != all.size())) return false;
  for (std::size_t i = 0; i + 1 < some.size(); ++i) {
    if (some[i] != all[i]) return false;
  }
  return true;
}

/// One way to damage a file: cut, or one bit flipped.
struct Damage {
  std::size_t at = 0;
  int bit = -1;  ///< -1: cut
};

std::vector<Damage> damages_of(const string& bytes, std::size_t every) {
  constexpr std::size_t all_bits_up_to = 3000;
  std::vector<Damage> damages;
  for (std::size_t at = 0; at < bytes.size(); at += every) damages.push_back({at});
  for (std::size_t at = 0; at < bytes.size(); at += every) {
    const int first = bytes.size() <= all_bits_up_to ? 0 : static_cast<int>(at % 8);
    const int last = bytes.size() <= all_bits_up_to ? 8 : first + 1;
    for (int bit = first; bit < last; ++bit) damages.push_back({at, bit});
  }
  return damages;
}

string damaged(const string& bytes, const Damage& damage) {
  if (damage.bit < 0) return bytes.substr(0, damage.at);
  string changed = bytes;
  changed[damage.at] = static_cast<char>(changed[damage.at] ^ (1 << damage.bit));
  return changed;
}

string text_of(const Damage& damage) {
  return (damage.bit < 0 ? "cut at byte " : "bit " + std::to_string(damage.bit) + " of byte ") +
         std::to_string(damage.at);
}

/// What was read of a damaged file, and what was written.
struct Comparison {
  const string& valid;
  const string& valid_said;
  const string& bytes;
  const string& said;
};

bool may_say(const Tolerance& tolerance, const Damage& damage, const Comparison& read) {
  if (damage.bit < 0) {
    return tolerance.cuts == Cuts::any ||
           (tolerance.cuts != Cuts::none &&
            starts_alike(read.valid_said, read.said, tolerance.cuts == Cuts::last));
  }
  return tolerance.flips == Flips::any ||
         (tolerance.flips == Flips::one_line && differ_in_one(read.valid_said, read.said)) ||
         (tolerance.flips == Flips::one_row &&
          (differ_in_one(read.valid_said, read.said) || lacks_one(read.valid_said, read.said))) ||
         (tolerance.flips == Flips::one_leaf && differ_in_one_leaf(read.valid, read.bytes));
}

/// All damages of one file, by children that each go on where the one before ended.
class FileSweep {
 public:
  FileSweep(const FileReader& reader, const string& valid, std::size_t every)
      : reader_(reader), valid_(valid), damages_(damages_of(valid, every)) {}

  void run(BadFileTally& tally) {
    said_ = read_valid(reader_, valid_, folder_).said;
    shared_->step = 0;
    while (shared_->step < damages_.size()) {
      shared_->note[0] = '\0';
      const Ending ending = run_child([&] { sweep(); });
      const string name =
          shared_->step < damages_.size() ? text_of(damages_[shared_->step]) : "the end";
      if (ended_well(ending, tally, name)) {
        if (shared_->note[0] == '\0') continue;
        const bool bad = shared_->outcome == Outcome::bad_message;
        add_finding(tally,
                    shared_->outcome == Outcome::threw ? &BadFileTally::crashes
                    : bad                              ? &BadFileTally::wrong_refusal
                                                       : &BadFileTally::garbage,
                    name + ": " + shared_->note);
      }
      ++shared_->step;
    }
    tally.files += static_cast<int>(damages_.size());
    tally.refused += shared_->counts[static_cast<int>(Outcome::refused)];
    tally.same += shared_->counts[static_cast<int>(Outcome::same)];
    tally.other += shared_->counts[static_cast<int>(Outcome::differs)];
  }

 private:
  /// Goes on up to the next finding, or for a thousand files.
  void sweep() {
    const Tolerance tolerance = tolerance_of(reader_.name);
    const std::size_t end = std::min(shared_->step + 1000, damages_.size());
    for (; shared_->step < end; ++shared_->step) {
      const Damage& damage = damages_[shared_->step];
      const string bytes = damaged(valid_, damage);
      string said;
      Outcome outcome = outcome_of(reader_, folder_.write(bytes), said, *shared_.operator->());
      if (outcome == Outcome::differs && said == said_) outcome = Outcome::same;
      shared_->outcome = outcome;
      if (outcome == Outcome::bad_message || outcome == Outcome::threw) return;
      if (outcome == Outcome::differs &&
          !may_say(tolerance, damage, {valid_, said_, bytes, said})) {
        return note(*shared_.operator->(), "read as something else");
      }
      ++shared_->counts[static_cast<int>(outcome)];
    }
  }

  const FileReader& reader_;
  const string& valid_;
  std::vector<Damage> damages_;
  string said_;
  Folder folder_;
  SharedMemory shared_;
};

}  // namespace

BadFileTally run_bad_files(const FileReader& reader, std::size_t every) {
  constexpr double most_seconds = 1.0, most_files = 4.0, most_bytes = 64 << 20;
  BadFileTally tally;
  tally.format = reader.name;
  const SharedMemory shared;
  std::vector<Valid> valid;
  const Folder common;
  const BadFiles files = bad_files(reader.name);
  for (const string& bytes : valid_files(reader.name)) {
    valid.push_back(read_valid(reader, bytes, common));
  }
  for (std::size_t i = 0; i < files.size(); i += every) {
    const BadFile& file = files[i];
    const Folder folder;
    const string path = file.make ? file.make(folder.path()) : folder.write(file.bytes);
    const Ending ending = run_child([&] {
      string said;
      shared->outcome = outcome_of(reader, path, said, *shared.operator->());
      if (shared->outcome == Outcome::differs && is_same(file, valid, said)) {
        shared->outcome = Outcome::same;
      }
    });
    ++tally.files;
    if (!ended_well(ending, tally, file.name)) continue;
    judge(file, *shared.operator->(), tally);
    const double bytes = ending.bytes - valid.front().bytes;
    if (ending.seconds > most_seconds) {
      add_finding(tally, &BadFileTally::slow,
                  file.name + ": " + std::to_string(ending.seconds) + " s");
    }
    if (bytes > most_files * static_cast<double>(file.bytes.size()) + most_bytes) {
      add_finding(tally, &BadFileTally::large,
                  file.name + ": " + std::to_string(static_cast<long>(bytes) >> 20) + " MiB");
    }
  }
  return tally;
}

BadFileTally run_sweeps(const FileReader& reader, std::size_t every) {
  BadFileTally tally;
  tally.format = reader.name;
  for (const string& valid : valid_files(reader.name)) FileSweep(reader, valid, every).run(tally);
  return tally;
}

string report_of(const std::vector<BadFileTally>& tallies) {
  string text =
      "| format | files | refused | same | other | crash | hang | garbage | wrong refusal | > 1 s "
      "| "
      "> 4 x file + 64 MiB |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const BadFileTally& t : tallies) {
    text += "| " + t.format;
    for (const int count : {t.files, t.refused, t.same, t.other, t.crashes, t.hangs, t.garbage,
                            t.wrong_refusal, t.slow, t.large}) {
      text += " | " + std::to_string(count);
    }
    text += " |\n";
  }
  for (const BadFileTally& t : tallies) {
    for (const string& finding : t.findings) text += finding + "\n";
  }
  return text;
}

}  // namespace excavplan::test
