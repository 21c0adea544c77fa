// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/recording/recording.hpp>
#include <excavplan/scans/scan_pose.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

Json cloud_json(const CloudSummary& summary);

/// A pose with its method and what is known of its error.
Json pose_json(const LevelPose& pose);
Json pose_json(const PointPose& pose);

/// "single", "averaged" or "joined"
const char* name(ScanMerge merge);

/// A scan out of a recording. @param text  that named it
Json recorded_scan_json(const std::string& text, const RecordedScan& scan);

/// What a recording holds. @param file  its name
Json recording_json(const std::string& file, const RecordingContents& contents);

}  // namespace excavplan
