// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_log.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/files.hpp"
#include "base/input_file.hpp"
#include "base/json.hpp"
#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"
#include "job/step_json.hpp"
#include "site/cell_codes.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;
using Eigen::Index;
using Json = nlohmann::ordered_json;

constexpr const char* log_file = "job-log.jsonl";
constexpr std::uint64_t most_log_bytes = std::uint64_t{1} << 28;  // ours
constexpr std::size_t most_code_bytes = std::size_t{1} << 26;     // of one patch; ours
constexpr std::size_t most_message_bytes = 900;                   // so that it can be read; ours
// Of a cell in a patch of JobEvent::seen_at.
constexpr int seen_now = 1;
constexpr int never_seen = 2;

std::string path_in(const std::string& folder) { return folder + "/" + log_file; }

ArrayXXd block_of(const ArrayXXd& layer, const CellPatch& patch) {
  return layer.block(patch.row, patch.col, patch.z.rows(), patch.z.cols());
}

Json patch_json(const CellPatch& patch, const ArrayXXi& numbers) {
  return {{"row", patch.row},
          {"col", patch.col},
          {"rows", patch.z.rows()},
          {"cols", patch.z.cols()},
          {"codes", codes_of(numbers)}};
}

/// What a patch makes of the layer before it.
Json heights_json(const CellPatch& patch, const ArrayXXd& before) {
  return patch_json(patch, millimetres_of(patch.z) - millimetres_of(block_of(before, patch)));
}

Json seen_json(const CellPatch& patch, const ArrayXXd& before) {
  const ArrayXXd old = block_of(before, patch);
  ArrayXXi numbers = ArrayXXi::Zero(old.rows(), old.cols());
  for_each_cell(old, [&](Cell at) {
    const double now = patch.z(at.row, at.col), was = old(at.row, at.col);
    if (now == was || (std::isnan(now) && std::isnan(was))) return;
    numbers(at.row, at.col) = std::isnan(now) ? never_seen : seen_now;
  });
  return patch_json(patch, steps_of(numbers));
}

struct ReadPatch {
  CellPatch patch;  ///< of the layer before
  ArrayXXi numbers;
};
ReadPatch read_patch(JsonObject object, const ArrayXXd& before) {
  const auto count = [&](const char* key, Index most) {
    return static_cast<Index>(object.number(key, 0, static_cast<double>(most)));
  };
  ReadPatch read;
  read.patch.row = count("row", before.rows());
  read.patch.col = count("col", before.cols());
  const Index rows = count("rows", before.rows() - read.patch.row);
  const Index cols = count("cols", before.cols() - read.patch.col);
  const auto numbers = numbers_of(object.text("codes", most_code_bytes), rows, cols);
  if (!numbers) object.fail("codes", "is not the code of so many cells");
  read.numbers = *numbers;
  read.patch.z = before.block(read.patch.row, read.patch.col, rows, cols);
  return read;
}

CellPatch read_heights(JsonObject object, const ArrayXXd& before) {
  ReadPatch read = read_patch(std::move(object), before);
  const auto millimetres = [](int was, int change) {
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    return static_cast<int>(
        std::clamp<std::int64_t>(std::int64_t{was} + change, unknown_height, most));
  };
  read.patch.z =
      heights_of(millimetres_of(read.patch.z).binaryExpr(read.numbers, millimetres).eval());
  return read.patch;
}

CellPatch read_seen(JsonObject object, const ArrayXXd& before, double now) {
  ReadPatch read = read_patch(std::move(object), before);
  const ArrayXXi news = sums_of(read.numbers);
  for_each_cell(news, [&](Cell at) {
    const int number = news(at.row, at.col);
    if (number != 0) read.patch.z(at.row, at.col) = number == seen_now ? now : nan;
  });
  return read.patch;
}

Json event_json(const JobEvent& event) {
  const bool finishes = event.what == JobAction::finish;
  Json line = {{"type", event.digs() ? "dig" : name(event.what)},
               {"step", event.step},
               {"at_s", event.at},
               {"time_s", event.time}};
  if (event.energy) line["energy_j"] = *event.energy;
  if (event.payload_mass) line["payload_kg"] = *event.payload_mass;
  line["base"] = log_base_json(event.base);
  if (event.digs()) {
    line["stall"] = event.stalled;
    line["pass"] = finishes ? "finish" : "bulk";
    line["predicted"] = log_foretold_json(event.predicted);
    line["keeps_load"] = event.keeps_load;
    line["dump"] = {{"x", event.dump.x()}, {"y", event.dump.y()}, {"z", event.dump.z()}};
  }
  if (event.truck) line["truck"] = *event.truck;
  if (!event.reason.empty()) line["reason"] = event.reason;
  line["scanned"] = event.scanned;
  line["trustworthy"] = event.trustworthy;
  line["warnings"] = warnings_json(event.warnings);
  line["left_m3"] = event.left_volume;
  return line;
}

void read_dig(JsonObject& object, JobEvent& event) {
  event.what = object.text("pass") == "finish" ? JobAction::finish : JobAction::dig;
  event.stalled = object.flag("stall");
  JsonObject foretold = object.object("predicted");
  event.predicted.payload_mass = foretold.number("payload_kg");
  event.predicted.energy = foretold.number("energy_j");
  event.predicted.time = foretold.number("time_s");
  const std::vector<double> payloads = foretold.numbers("payload_kg_interval", 2);
  event.predicted.payload_interval = {payloads[0], payloads[1]};
  const std::vector<double> energies = foretold.numbers("energy_j_interval", 2);
  event.predicted.energy_interval = {energies[0], energies[1]};
  event.keeps_load = object.flag("keeps_load");
  JsonObject dump = object.object("dump");
  event.dump = {dump.number("x"), dump.number("y"), dump.number("z")};
}

BasePose read_log_base(JsonObject object) {
  return {object.number("x"), object.number("y"), object.number("z"), object.number("heading_rad")};
}

JobEvent read_event(JsonObject& object) {
  JobEvent event;
  if (object.text("type") == "dig") {
    read_dig(object, event);
  } else {
    event.what = of_word(object, "type", actions);
  }
  event.step = static_cast<long long>(object.number("step", 0, 1e12));
  event.at = object.number("at_s");
  event.time = object.number("time_s", 0);
  if (object.has("energy_j")) event.energy = object.number("energy_j");
  if (object.has("payload_kg")) event.payload_mass = object.number("payload_kg");
  event.base = read_log_base(object.object("base"));
  if (object.has("truck")) event.truck = static_cast<int>(object.number("truck", 1, 1e9));
  event.reason = object.text_or("reason", "");
  event.scanned = object.flag("scanned");
  event.trustworthy = object.flag("trustworthy");
  event.warnings = read_warnings(object.objects("warnings"));
  event.left_volume = object.number("left_m3");
  return event;
}

/// The whole lines of a file from the byte of one of them on; others may write it meanwhile.
std::string lines_from(const std::string& path, std::uint64_t from) {
  const InputFile file(path, false);
  if (file.size() < from) return {};
  if (file.size() > most_log_bytes) {
    file.refuse("found " + std::to_string(file.size()) + " bytes, expected at most " +
                std::to_string(most_log_bytes));
  }
  std::string text(file.size() - from, '\0');
  file.read(from, text.data(), text.size());
  text.resize(text.rfind('\n') + 1);
  return text;
}

}  // namespace

JobLog::JobLog(const std::string& folder, JobHistory start)
    : path_(path_in(folder)), start_(std::move(start)), recorder_(start_) {}

void JobLog::begin() {
  const std::string line = json_text(Json{{"type", "begin"},
                                          {"at_s", start_.begin},
                                          {"design_m3", start_.design_volume},
                                          {"base", log_base_json(*start_.design.start)}}) +
                           '\n';
  write_own_file(path_, line);
  begun_ = line.size();
}

void JobLog::read_begin(const std::string& name, const std::string& line) {
  JsonObject object = JsonObject::of_others(name, line);
  if (object.text("type") != "begin") object.fail("type", "is not 'begin' in the first line");
  start_.begin = object.number("at_s");
  recorder_ = JobRecorder(start_);
}

JobLog::LoggedEvent JobLog::read_line(const std::string& name, const std::string& line,
                                      std::uint64_t end) const {
  JsonObject object = JsonObject::of_others(name, line);
  JobEvent event = read_event(object);
  const JobHistory::Ground& now = recorder_.now();
  if (object.has("ground")) event.surface = read_heights(object.object("ground"), now.surface.z);
  if (object.has("seen")) event.seen_at = read_seen(object.object("seen"), now.seen_at, event.at);
  return {std::move(event),
          {static_cast<long long>(object.number("last_step", 0, 1e12)),
           static_cast<int>(object.number("scans", 0, 1e9)), end}};
}

void JobLog::add(LoggedEvent logged) {
  recorder_.add(std::move(logged.event));
  marks_.push_back(logged.mark);
}

bool JobLog::follow(const JobRecord& record) {
  if (!marks_.empty() && !marks_.back().is_within(record)) return false;
  const bool is_there = std::filesystem::exists(std::filesystem::symlink_status(path_));
  const std::string text = is_there ? lines_from(path_, last_line_.from) : "";
  if (text.compare(0, last_line_.text.size(), last_line_.text) != 0) return false;
  for (std::size_t at = last_line_.text.size(); at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    const std::uint64_t from = last_line_.from + last_line_.text.size();
    const std::string name = path_ + ", byte " + std::to_string(from);
    if (begun_ == 0) {
      read_begin(name, line);
      begun_ = line.size() + 1;
    } else {
      LoggedEvent logged = read_line(name, line, from + line.size() + 1);
      if (!logged.mark.is_within(record)) break;
      add(std::move(logged));
    }
    last_line_ = {from, line + '\n'};
    at = end + 1;
  }
  return true;
}

void JobLog::resume(const JobRecord& record) {
  if (!std::filesystem::exists(std::filesystem::symlink_status(path_))) return begin();
  const std::string text = read_own_file(path_, most_log_bytes);
  std::size_t from = 0;
  for (int number = 1; from < text.size(); ++number) {
    const std::size_t end = text.find('\n', from);
    if (end == std::string::npos) break;  // killed while it was written
    const std::string name = path_ + ", line " + std::to_string(number);
    const std::string line = text.substr(from, end - from);
    from = end + 1;
    if (number == 1) {
      read_begin(name, line);
      begun_ = from;
    } else {
      add(read_line(name, line, from));
    }
  }
  if (begun_ == 0) return begin();
  cut(record);
  if (const std::uint64_t end = marks_.empty() ? begun_ : marks_.back().end; end < text.size()) {
    write_own_tail(path_, end, {});
  }
}

void JobLog::append(JobEvent event, const JobHistory::Ground& after, const JobRecord& record) {
  const JobHistory::Ground before = recorder_.now();
  JobHistory::Ground now = after;
  const ArrayXXd& seen = after.seen_at.size() > 0 ? after.seen_at : before.seen_at;
  now.seen_at = (seen == before.seen_at || seen.isNaN()).select(seen, event.at);
  for (Warning& each : event.warnings) each.message = safe_text(each.message, most_message_bytes);
  event.reason = safe_text(event.reason, most_message_bytes);
  recorder_.add(std::move(event), now);
  const JobEvent& added = recorder_.history().events.back();
  Json line = event_json(added);
  if (added.surface.z.size() > 0) line["ground"] = heights_json(added.surface, before.surface.z);
  if (added.seen_at.z.size() > 0) line["seen"] = seen_json(added.seen_at, before.seen_at);
  line["last_step"] = record.last_step;
  line["scans"] = record.progress.scans;
  const std::string text = json_text(line) + '\n';
  const std::uint64_t from = marks_.empty() ? begun_ : marks_.back().end;
  write_own_tail(path_, from, text);
  marks_.push_back({record.last_step, record.progress.scans, from + text.size()});
}

void JobLog::cut(const JobRecord& record) {
  std::size_t kept = marks_.size();
  while (kept > 0 && !marks_[kept - 1].is_within(record)) --kept;
  if (kept == recorder_.history().events.size()) return;
  marks_.resize(kept);
  recorder_.cut(kept);
  write_own_tail(path_, marks_.empty() ? begun_ : marks_.back().end, {});
}

JobHistory history_start(const JobDesign& design, const HeightMap& target, const GroundState& first,
                         double design_volume) {
  JobHistory history;
  history.design = design;
  history.design_volume = design_volume;
  history.target = target;
  history.before = first.terrain.surface();
  history.seen_at = first.seen;
  if (first.seen.size() == 0) {
    history.seen_at = ArrayXXd::Constant(target.z.rows(), target.z.cols(), nan);
  }
  const auto known = history.seen_at.isFinite();
  if (known.any()) history.begin = known.select(history.seen_at, 0.0).maxCoeff();
  return history;
}

JobEvent timed(JobEvent event, const JobHistory& earlier) {
  const double last = earlier.events.empty() ? earlier.begin : earlier.events.back().at;
  if (last > 0.0 && event.at >= last) event.time = event.at - last;
  return event;
}

}  // namespace excavplan
