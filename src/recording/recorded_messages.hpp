// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <excavplan/recording/recording.hpp>

#include "recording/recording_file.hpp"
#include "recording/ros_messages.hpp"
#include "recording/times.hpp"

/// @file Which messages of a recording are meant: by topic and time. Private to the library.

namespace excavplan {

double seconds_of(std::int64_t nanoseconds);
/// @throws Error (bad_input) naming `what` unless they are 0 to 1e9
std::int64_t nanoseconds_of(double seconds, const char* what);
/// "12.500 s", from the first message of a topic.
std::string time_text(const RecordedTopic& topic, std::int64_t time);

/// @throws Error (bad_file): "file: why"
[[noreturn]] void refuse_recording(const RecordingFile& recording, const std::string& why);

/// Names in quotes, "none" if there are none.
std::string name_list(const std::vector<std::string>& names);

/// "; 3 parts are damaged ...", as the end of an error; empty if none are.
std::string damage_text(RecordingFile& recording);

/// Clouds, depth images, or by their name compressed depth images.
bool holds_scans(const RecordedTopic& topic);
/// Raw or compressed.
bool holds_images(const RecordedTopic& topic);
std::vector<std::string> topics_for(const RecordingFile& recording, MessageUse use);
const RecordedTopic* find_topic(const RecordingFile& recording, const std::string& name);
/// The topic of that name or, without one, the only one that holds scans.
/// @throws Error (bad_file) naming those that do
const RecordedTopic& scan_topic(RecordingFile& recording, const std::string& name);

/// What is known of a message before its points are read.
struct MessageHead {
  std::int64_t time = 0;
  MessageHeader header;
  FrameSize size;
};

/// Of the first message at or after the time of the query, or of all in its span.
/// @throws Error (bad_file) naming the nearest messages if there is none; (bad_input) if the time
/// or span is out of range, or the span holds too much
std::vector<MessageHead> read_heads(RecordingFile& recording, const RecordedTopic& topic,
                                    const RecordingQuery& query);

/// @throws Error (bad_file) if the sensor's clock, or that of the recording, jumped by over 1 s
/// (ours) between two messages; not where both bear the same stamp
void require_steady_clock(const RecordingFile& recording, const RecordedTopic& topic,
                          const std::vector<MessageHead>& heads);

}  // namespace excavplan
