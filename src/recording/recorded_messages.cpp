// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/recorded_messages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/check.hpp"

namespace excavplan {
namespace {

// Ours.
constexpr double longest_time = 1e9;                     // [s]
constexpr std::int64_t largest_clock_step = one_second;  // of stamps against times of recording

std::string scan_topics_text(const RecordingFile& recording) {
  std::vector<std::string> names = topics_for(recording, MessageUse::points);
  for (const RecordedTopic& topic : recording.topics()) {
    if (holds_images(topic) && holds_scans(topic)) names.push_back(topic.name);
  }
  return "topics that hold clouds or images: " + name_list(names);
}

const RecordedTopic& only_scan_topic(RecordingFile& recording) {
  const auto& topics = recording.topics();
  const auto found = std::find_if(topics.begin(), topics.end(), holds_scans);
  const auto count = std::count_if(found, topics.end(), holds_scans);
  if (count != 1) {
    refuse_recording(recording, "found " + std::to_string(count) +
                                    " topics to choose from, expected one or the name of one; " +
                                    scan_topics_text(recording) + damage_text(recording));
  }
  return *found;
}

/// The last message of a topic before a time, looked for in steps that grow, so that little of a
/// long recording is read.
std::optional<std::int64_t> last_before(RecordingFile& recording, const RecordedTopic& topic,
                                        std::int64_t time) {
  if (topic.first >= time) return std::nullopt;
  std::optional<std::int64_t> last;
  std::int64_t step = one_second;
  for (std::int64_t to = later(time, -1); !last && to >= topic.first;
       step = step < latest / 4 ? 4 * step : latest) {
    const std::int64_t from = std::max(topic.first, later(to, -step));
    recording.visit({topic.name}, from, to, [&](const RecordedMessage& message) {
      last = message.time;
      return true;
    });
    if (from == topic.first) break;
    to = later(from, -1);
  }
  return last;
}

/// Of one message alone also what it holds, as nothing takes the place of its points.
MessageHead read_head(const std::string& file, const RecordedMessage& message, bool is_alone) {
  if (is_alone && holds_images(message.topic)) decode_depths(file, message);
  if (is_alone && use_of(message.topic.type) == MessageUse::points) decode_points(file, message);
  return {message.time, decode_header(file, message), decode_size(file, message)};
}

[[noreturn]] void refuse_gap(RecordingFile& recording, const RecordedTopic& topic,
                             std::int64_t from, std::int64_t to) {
  std::string near;
  const auto before = last_before(recording, topic, from);
  if (before) near = "the last one before is at " + time_text(topic, *before);
  if (to < latest) {
    recording.visit({topic.name}, to, latest, [&](const RecordedMessage& message) {
      near += (near.empty() ? "" : ", ");
      near += "the next one after at " + time_text(topic, message.time);
      return false;
    });
  }
  refuse_recording(recording,
                   "found no message of " + topic.name + " at " + time_text(topic, from) +
                       (to < latest ? " to " + time_text(topic, to) : " or later") + ": " +
                       (near.empty() ? "the recording holds none" : near) + damage_text(recording));
}

}  // namespace

double seconds_of(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e9; }

std::int64_t nanoseconds_of(double seconds, const char* what) {
  require(seconds >= 0.0 && seconds <= longest_time, what, seconds, "0 to 1e9 s");
  return std::llround(seconds * 1e9);
}

std::string time_text(const RecordedTopic& topic, std::int64_t time) {
  return decimals(seconds_of(time_between(topic.first, time)), 3) + " s";
}

std::string damage_text(RecordingFile& recording) {
  const std::string text = recording.skipped().text();
  return text.empty() ? "" : "; " + text;
}

[[noreturn]] void refuse_recording(const RecordingFile& recording, const std::string& why) {
  throw Error(ErrorKind::bad_file, recording.path() + ": " + why);
}

bool holds_scans(const RecordedTopic& topic) {
  constexpr std::string_view depth = "/compressedDepth";
  const MessageUse use = use_of(topic.type);
  const std::string& name = topic.name;
  return use == MessageUse::points || use == MessageUse::depth ||
         (use == MessageUse::compressed && name.size() > depth.size() &&
          name.compare(name.size() - depth.size(), depth.size(), depth) == 0);
}

bool holds_images(const RecordedTopic& topic) {
  const MessageUse use = use_of(topic.type);
  return use == MessageUse::depth || use == MessageUse::compressed;
}

std::vector<std::string> topics_for(const RecordingFile& recording, MessageUse use) {
  std::vector<std::string> names;
  for (const RecordedTopic& topic : recording.topics()) {
    if (use_of(topic.type) == use) names.push_back(topic.name);
  }
  return names;
}

std::string name_list(const std::vector<std::string>& names) {
  constexpr std::size_t most = 20;
  if (names.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
    text += (i == 0 ? "" : ", ") + in_quotes(names[i]);
  }
  return text + (names.size() > most ? ", ..." : "");
}

const RecordedTopic* find_topic(const RecordingFile& recording, const std::string& name) {
  const auto& topics = recording.topics();
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const RecordedTopic& topic) { return topic.name == name; });
  return found == topics.end() ? nullptr : &*found;
}

const RecordedTopic& scan_topic(RecordingFile& recording, const std::string& name) {
  if (name.empty()) return only_scan_topic(recording);
  const RecordedTopic* const topic = find_topic(recording, name);
  if (topic == nullptr) {
    std::vector<std::string> names;
    for (const RecordedTopic& known : recording.topics()) names.push_back(known.name);
    const auto meant = nearest_word(name, names);
    refuse_recording(recording, "found no topic " + in_quotes(name) +
                                    (meant ? ", did you mean " + in_quotes(*meant) + "? " : "; ") +
                                    scan_topics_text(recording) + damage_text(recording));
  }
  if (!holds_scans(*topic) && !holds_images(*topic)) {
    refuse_recording(recording, in_quotes(name) + ": found messages of type " +
                                    in_quotes(topic->type) + "; " + scan_topics_text(recording));
  }
  return *topic;
}

std::vector<MessageHead> read_heads(RecordingFile& recording, const RecordedTopic& topic,
                                    const RecordingQuery& query) {
  const std::int64_t span = nanoseconds_of(query.span, "span");
  TimeRange range;
  range.from = later(topic.first, query.time ? nanoseconds_of(*query.time, "time") : 0);
  if (span > 0) range.to = later(range.from, span);
  std::vector<MessageHead> heads;
  std::uint64_t points = 0;
  recording.visit({topic.name}, range.from, range.to, [&](const RecordedMessage& message) {
    MessageHead head;
    const auto read = [&] { head = read_head(recording.path(), message, span == 0); };
    if (!recording.skipped().guard(loss_of(message), read)) return true;
    heads.push_back(std::move(head));
    points += std::min<std::uint64_t>(heads.back().size.pixels(), most_recorded_points);
    if (span > 0 && points > most_recorded_points) {
      refuse(recording.path() + ": the span of " + number_text(query.span) + " s holds more than " +
             std::to_string(most_recorded_points) + " points of " + topic.name +
             ", must be shorter");
    }
    return span > 0;
  });
  if (heads.empty()) refuse_gap(recording, topic, range.from, range.to);
  return heads;
}

void require_steady_clock(const RecordingFile& recording, const RecordedTopic& topic,
                          const std::vector<MessageHead>& heads) {
  for (std::size_t i = 1; i < heads.size(); ++i) {
    const std::int64_t recorded = time_between(heads[i - 1].time, heads[i].time);
    const std::int64_t stamped = time_between(heads[i - 1].header.stamp, heads[i].header.stamp);
    const std::int64_t step = time_between(recorded, stamped);
    if (stamped == 0) continue;  // never set, or the same points once more
    if (step >= -largest_clock_step && step <= largest_clock_step) continue;
    refuse_recording(
        recording, "a clock jumped: the message at " + time_text(topic, heads[i].time) +
                       " was recorded " + decimals(seconds_of(recorded), 3) +
                       " s after the one before, but stamped " + decimals(seconds_of(stamped), 3) +
                       " s after it, expected the same within 1 s; choose a time or span "
                       "without the jump");
  }
}

}  // namespace excavplan
