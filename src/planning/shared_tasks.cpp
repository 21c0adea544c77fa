// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared_tasks.hpp"

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>
#include <vector>

#include <excavplan/error.hpp>

#include "../json_file.hpp"
#include "../parallel.hpp"

namespace excavplan {
namespace {

/// Results by task of one process, on their way to the others.
struct Parcel {
  std::map<std::size_t, std::string> results;
  std::string error;
  bool bad_file = false;
  bool stopped = false;

  std::string text() const {
    return nlohmann::json{
        {"results", results}, {"error", error}, {"bad_file", bad_file}, {"stopped", stopped}}
        .dump();
  }
  void add(const std::string& text) {
    const auto json = nlohmann::json::parse(text);
    results.merge(json.at("results").get<std::map<std::size_t, std::string>>());
    stopped = stopped || json.at("stopped").get<bool>();
    if (error.empty()) {
      error = json.at("error").get<std::string>();
      bad_file = json.at("bad_file").get<bool>();
    }
  }
};

}  // namespace

void LibraryWatch::tell() {
  if (!callback_ || stopped_) return;
  now_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const auto left = static_cast<double>(now_.cells - std::min(now_.cells, now_.cells_done));
  now_.seconds_left = computed_ > 0 ? now_.seconds * left / static_cast<double>(computed_)
                                    : std::numeric_limits<double>::quiet_NaN();
  if (!callback_(now_)) stopped_ = true;
}

SharedTasks::SharedTasks(const LibraryBuildOptions& options)
    : sharing_(options.sharing != nullptr ? *options.sharing : alone_),
      threads_(options.threads > 0 ? options.threads
                                   : std::max(1u, std::thread::hardware_concurrency())),
      watch_(options) {}

std::map<std::size_t, std::string> SharedTasks::run(
    std::size_t count, const std::function<std::string(std::size_t)>& task) {
  if (count == 0 || stopped_) return {};
  Parcel mine;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = sharing_.next(); i < count && !watch_.stopped(); i = sharing_.next()) {
      std::string text = task(i);
      const std::lock_guard<std::mutex> lock(mutex);
      if (!text.empty()) mine.results[i] = std::move(text);
    }
  };
  try {
    parallel_for(std::min<std::size_t>(threads_, count), threads_, [&](std::size_t) { work(); });
  } catch (const Error& e) {
    mine.error = e.what();
    mine.bad_file = e.kind() == ErrorKind::bad_file;
  }
  mine.stopped = watch_.stopped();
  Parcel all;
  for (const std::string& text : sharing_.exchange(mine.text())) all.add(text);
  if (!all.error.empty()) {
    throw Error(all.bad_file ? ErrorKind::bad_file : ErrorKind::bad_input, all.error);
  }
  stopped_ = stopped_ || all.stopped;
  return all.results;
}

}  // namespace excavplan
