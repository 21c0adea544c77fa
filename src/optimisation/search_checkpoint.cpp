// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "optimisation/search_checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/input_file.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "optimisation/sound_evaluation.hpp"

namespace excavplan {
namespace {

using nlohmann::ordered_json;

constexpr const char* format = "excavplan-search";
constexpr std::size_t longest_identity = 65536;  // of a problem or a method [byte]; ours
constexpr std::size_t longest_shown = 400;       // of one in a message [byte]
constexpr std::size_t most_values = 100000000;   // of a file that is itself bounded; ours

std::string text_of(const Eigen::VectorXd& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + number_text(number);
  return text;
}

std::string describe(const MemeticSearch& method) {
  std::string text = "memetic, first generation " + std::to_string(method.first_generation) +
                     ", generations " + std::to_string(method.generations) + " of " +
                     std::to_string(method.generation_size) + ", immigrants " +
                     number_text(method.immigrants) + ", basins " + std::to_string(method.basins) +
                     " of radius " + number_text(method.basin_radius) + ", polish " +
                     std::to_string(method.polish_evaluations);
  if (method.polishing == Polishing::evolution) text += " by evolution";
  if (method.restarts != 1) text += ", restarts " + std::to_string(method.restarts);
  return text;
}

/// All that decides the course of a search, stop rules and given points apart.
std::string describe(const SearchOptions& options) {
  return std::visit([](const auto& method) { return describe(method); }, options.method) +
         ", seed " + std::to_string(options.seed);
}

std::string describe(const SearchProblem& problem) {
  std::string text = problem.fingerprint + ", box " + text_of(problem.box.lower) + " to " +
                     text_of(problem.box.upper);
  if (problem.step.size() > 0) text += ", step " + text_of(problem.step);
  return text;
}

ordered_json to_json(const PointKey& point, const Evaluation& outcome) {
  ordered_json entry = {{"point", point}, {"status", name(outcome.status)}};
  if (outcome.ok()) entry["fitness"] = outcome.fitness;
  if (outcome.violation > 0.0) entry["violation"] = outcome.violation;
  if (!outcome.reason.empty()) entry["reason"] = outcome.reason;
  return entry;
}

Evaluation read_outcome(JsonObject& entry) {
  using Status = Evaluation::Status;
  const std::string status = entry.text("status");
  if (status == name(Status::ok)) return {entry.number("fitness")};
  const std::string reason = entry.text_or("reason", "");
  if (status == name(Status::infeasible)) {
    return Evaluation::infeasible(entry.number_or("violation", 0.0, 0.0), reason);
  }
  if (status == name(Status::failed)) return Evaluation::failed(reason);
  if (status == name(Status::timed_out)) return Evaluation::timed_out(reason);
  entry.fail("status",
             "is " + in_quotes(status) + ", expected ok, infeasible, failed or timed out");
}

std::string described(const Evaluation& outcome) {
  if (outcome.ok()) return "ok with fitness " + number_text(outcome.fitness);
  return name(outcome.status) + (" with violation " + number_text(outcome.violation));
}

/// But for the rounding of another compiler.
bool is_same(const Evaluation& a, const Evaluation& b) {
  constexpr double close = 1e-9;  // ours
  const auto is_close = [](double x, double y) {
    return std::abs(x - y) <= close * std::max(std::abs(x), std::abs(y));
  };
  return a.status == b.status && (!a.ok() || is_close(a.fitness, b.fitness)) &&
         is_close(a.violation, b.violation);
}

/// Else a file that is written could not be resumed from.
void require_readable(const char* what, const std::string& text) {
  const auto fault = fault_of_line(text, longest_identity);
  if (!fault) return;
  throw Error(ErrorKind::bad_input,
              std::string("search: a checkpoint holds ") + what + ", which is " + *fault);
}

}  // namespace

std::string describe(const GeneticAlgorithm& method) {
  return "genetic algorithm: population " + std::to_string(method.population) + ", generations " +
         std::to_string(method.generations) + ", tournament " + std::to_string(method.tournament) +
         ", crossover " + number_text(method.crossover) + ", mutation " +
         number_text(method.mutation) + ", elites " + std::to_string(method.elites);
}

void require_checkpoint_place(const std::string& file) {
  std::error_code unknown;  // of a file that is there but out of reach, which reading it tells
  const auto status = std::filesystem::status(file, unknown);
  if (status.type() != std::filesystem::file_type::regular) return;
  constexpr std::uint64_t beginning = 100;  // which names the format, however it is spaced
  const InputFile bytes(file);
  if (bytes.size() == 0) return;
  std::string found(std::min(bytes.size(), beginning), ' ');
  bytes.read(0, found.data(), found.size());
  if (found.find(std::string("\"") + format + '"') != std::string::npos) return;
  throw Error(ErrorKind::bad_file,
              file + ": is no checkpoint of a search; name another file, or remove this one");
}

SearchCheckpoint::SearchCheckpoint(const SearchProblem& problem, const SearchOptions& options)
    : file_(options.checkpoint), problem_(describe(problem)), search_(describe(options)) {
  if (file_.empty()) return;
  if (problem.fingerprint.empty()) {
    throw Error(ErrorKind::bad_input,
                "search: a checkpoint needs the fingerprint of the problem, it is empty");
  }
  require_readable("the fingerprint and the box of the problem", problem_);
  require_readable("the method", search_);
  require_checkpoint_place(file_);
  require_writable(file_);
  std::error_code unknown;
  const auto status = std::filesystem::status(file_, unknown);
  if (options.resume && status.type() != std::filesystem::file_type::not_found) {
    load(problem.box);
  }
}

void SearchCheckpoint::verify_best(const Objective& objective) const {
  const auto best =
      std::max_element(earlier_.begin(), earlier_.end(),
                       [](const auto& a, const auto& b) { return better(b.second, a.second); });
  if (best == earlier_.end()) return;
  const Eigen::VectorXd point = point_of(best->first);
  const Evaluation now = sound(caught([&]() -> Evaluation { return objective(point); }));
  if (now.status == Evaluation::Status::timed_out || is_same(best->second, now)) return;
  throw Error(ErrorKind::bad_file, file_ + ": evaluations: the best point, " + text_of(point) +
                                       ", is " + described(best->second) +
                                       ", but evaluated again it is " + described(now));
}

const Evaluation* SearchCheckpoint::find(const Eigen::VectorXd& point) const {
  if (earlier_.empty()) return nullptr;
  const auto found = earlier_.find(key_of(point));
  return found == earlier_.end() ? nullptr : &found->second;
}

void SearchCheckpoint::add(const Eigen::VectorXd& point, const Evaluation& outcome) {
  if (file_.empty()) return;
  fresh_.insert_or_assign(key_of(point), outcome);
  changed_ = true;
}

void SearchCheckpoint::save() {
  if (!changed_) return;
  write_journal(file_, text());
  changed_ = false;
}

std::string SearchCheckpoint::text() const {
  const ordered_json head = {
      {"format", format}, {"version", 1}, {"problem", problem_}, {"search", search_}};
  std::string text = json_text(head, 0);
  text.resize(text.size() - 2);  // reopen the object
  text += ",\n\"evaluations\": [";
  Outcomes all = earlier_;
  all.insert(fresh_.begin(), fresh_.end());
  bool first = true;
  for (const auto& [point, outcome] : all) {
    text += (first ? "\n" : ",\n") + json_text(to_json(point, outcome));
    first = false;
  }
  return sealed(text + "\n]");
}

void SearchCheckpoint::load(const SearchBox& box) {
  JsonObject file =
      JsonObject::open_sealed(file_, read_file(file_, most_journal_bytes), format, 1, most_values);
  const auto check = [&file](const char* key, const std::string& own) {
    if (const std::string text = file.text(key, longest_identity); text != own) {
      file.fail(key, "is '" + safe_text(text, longest_shown) + "', which differs from '" +
                         safe_text(own, longest_shown) + "'");
    }
  };
  check("problem", problem_);
  check("search", search_);
  const auto dimensions = static_cast<std::size_t>(box.lower.size());
  for (JsonObject& entry : file.objects("evaluations")) {
    const Eigen::VectorXd point = point_of(entry.numbers("point", dimensions));
    if (point != point.cwiseMax(box.lower).cwiseMin(box.upper)) {
      entry.fail("point", "is " + text_of(point) + ", outside the box of the search");
    }
    earlier_.emplace(key_of(point), read_outcome(entry));
    entry.done();
  }
  file.done();
}

}  // namespace excavplan
