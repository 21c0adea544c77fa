// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <excavplan/recording/recording.hpp>

#include "recording/recording_file.hpp"

/// @file The functions of recording.hpp for a recording that is open. Private to the library.

namespace excavplan {

RecordingContents describe_recording(RecordingFile& recording);
/// The path of the query is not used.
RecordedScan read_recorded_scan(RecordingFile& recording, const RecordingQuery& query);
std::map<std::string, double> joint_positions(RecordingFile& recording, double time,
                                              const std::string& topic = "");

}  // namespace excavplan
