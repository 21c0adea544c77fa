// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/recorded_scan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/scans/depth_intrinsics.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "recording/frame_average.hpp"
#include "recording/recorded_messages.hpp"
#include "recording/transform_tree.hpp"

namespace excavplan {
namespace {

// Ours.
constexpr std::int64_t transforms_about = one_second;         // before and after the messages, or
constexpr std::int64_t transforms_farther = 10 * one_second;  // where that does not do
constexpr std::int64_t longest_delay = one_second;            // of a recording behind a stamp
constexpr std::int64_t joints_about = one_second / 2;         // before and after the time asked for
constexpr std::int64_t longest_lag = 2 * one_second / 5;      // of a sensor's clock

// ---- Transforms -------------------------------------------------------------------------------

/// True if a topic of transforms is that of a robot whose namespace another topic is in.
bool is_of_robot(const std::string& transforms, const std::string& topic) {
  const std::string space = transforms.substr(0, transforms.rfind('/') + 1);
  return topic.compare(0, space.size(), space) == 0;
}

/// For which scan transforms are read.
struct ForScan {
  std::string topic;           ///< its namespace's transforms, if there are; "": all
  std::int64_t start = 0;      ///< from which times are counted in messages
  std::int64_t time = latest;  ///< static transforms are those that held then
};

/// The static ones, and those recorded in some times: of a chunked file that reads all chunks of
/// these times.
TransformTree read_transforms(RecordingFile& recording, const std::vector<TimeRange>& ranges,
                              const ForScan& scan = {}) {
  std::vector<StampedTransform> transforms;
  const auto is_known = [&](const StampedTransform& one) {
    return std::any_of(transforms.begin(), transforms.end(), [&](const StampedTransform& other) {
      return other.child == one.child && other.parent == one.parent;
    });
  };
  const auto transforms_in = [&](const RecordedMessage& message) {
    std::vector<StampedTransform> found;
    recording.skipped().guard(loss_of(message),
                              [&] { found = decode_transforms(recording.path(), message); });
    return found;
  };
  const auto take_static = [&](const RecordedMessage& message) {
    for (StampedTransform& transform : transforms_in(message)) {
      if (message.time > scan.time && is_known(transform)) continue;
      transforms.push_back(std::move(transform));
    }
    return true;
  };
  const auto take = [&](const RecordedMessage& message) {
    for (StampedTransform& transform : transforms_in(message)) {
      transform.delay = time_between(transform.stamp, message.time);
      transforms.push_back(std::move(transform));
    }
    return true;
  };
  std::vector<std::string> statics;
  std::vector<std::string> others;
  std::vector<std::string> names = topics_for(recording, MessageUse::transforms);
  const auto others_from =
      std::stable_partition(names.begin(), names.end(),
                            [&](const std::string& name) { return is_of_robot(name, scan.topic); });
  if (others_from != names.begin()) names.erase(others_from, names.end());
  for (const std::string& name : names) {
    (holds_static_transforms(name) ? statics : others).push_back(name);
  }
  if (!statics.empty()) recording.visit(statics, earliest, latest, take_static);
  for (const TimeRange& range : ranges) {
    if (!others.empty()) recording.visit(others, range.from, range.to, take);
  }
  return {recording.path(), scan.start, std::move(transforms)};
}

// ---- Points -----------------------------------------------------------------------------------

/// The pinhole of a depth image [pixel].
struct Pinhole {
  FrameSize size;
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
};

bool is_rectified(const std::string& topic) {
  return topic.find("rect", topic.rfind('/')) != topic.npos;
}

/// Of the image that a compressed one stands for, as image_transport names them.
std::string raw_name(const RecordedTopic& image) {
  const bool is_raw = use_of(image.type) == MessageUse::depth;
  const std::size_t slash = image.name.rfind('/');
  return is_raw || slash == 0 || image.name.compare(slash + 1, 10, "compressed") != 0
             ? image.name
             : image.name.substr(0, slash);
}

std::string rectified_beside(const RecordingFile& recording, const std::string& folder) {
  for (const std::string& name : topics_for(recording, MessageUse::depth)) {
    if (name.rfind(folder, 0) == 0 && is_rectified(name)) return "read " + in_quotes(name);
  }
  return "rectify it with image_proc before it is recorded";
}

CameraMessage read_camera(RecordingFile& recording, const std::string& topic, std::int64_t time) {
  std::optional<CameraMessage> camera;
  for (const std::int64_t from : {time, earliest}) {
    if (camera) break;
    recording.visit({topic}, from, latest, [&](const RecordedMessage& message) {
      return !recording.skipped().guard(loss_of(message),
                                        [&] { camera = decode_camera(recording.path(), message); });
    });
  }
  if (!camera)
    refuse_recording(recording, "found no message of " + topic + ", expected the intrinsics" +
                                    damage_text(recording));
  return *camera;
}

/// From the camera info of the same camera: K of a raw image, P of a rectified one.
Pinhole read_pinhole(RecordingFile& recording, const RecordedTopic& image, std::int64_t time) {
  const std::string raw = raw_name(image);
  const std::string folder = raw.substr(0, raw.rfind('/') + 1);
  const std::string topic = folder + "camera_info";
  if (find_topic(recording, topic) == nullptr) {
    refuse_recording(recording, "found no topic " + in_quotes(topic) +
                                    ", expected the intrinsics of " + in_quotes(image.name) +
                                    " there; camera infos: " +
                                    name_list(topics_for(recording, MessageUse::camera)));
  }
  const CameraMessage camera = read_camera(recording, topic, time);
  const bool is_distorted = std::any_of(camera.distortion.begin(), camera.distortion.end(),
                                        [](double value) { return value != 0.0; });
  const bool rectified = is_rectified(raw);
  if (is_distorted && !rectified) {
    refuse_recording(recording,
                     in_quotes(image.name) + ": found a raw image of a lens with distortion, " +
                         "expected a rectified one: " + rectified_beside(recording, folder));
  }
  const auto& k = camera.intrinsics;
  const auto& p = camera.rectified_projection;
  const Pinhole pinhole = rectified && p[0] != 0.0 ? Pinhole{camera.size, p[0], p[5], p[2], p[6]}
                                                   : Pinhole{camera.size, k[0], k[4], k[2], k[5]};
  if (!(pinhole.fx > 0.0 && pinhole.fy > 0.0 && std::isfinite(pinhole.fx + pinhole.fy) &&
        std::isfinite(pinhole.cx + pinhole.cy))) {
    refuse_recording(recording, in_quotes(topic) + ": found focal lengths " +
                                    number_text(pinhole.fx) + ", " + number_text(pinhole.fy) +
                                    " and centre " + number_text(pinhole.cx) + ", " +
                                    number_text(pinhole.cy) + ", expected those of a camera");
  }
  return pinhole;
}

std::vector<Eigen::Vector3d> points_of_depths(const DepthMessage& image, const Pinhole& pinhole) {
  const DepthIntrinsics limits;
  std::vector<Eigen::Vector3d> points;
  points.reserve(image.depths.size());
  for (std::size_t row = 0; row < image.size.height; ++row) {
    const double y = (static_cast<double>(row) - pinhole.cy) / pinhole.fy;
    for (std::size_t column = 0; column < image.size.width; ++column) {
      const double z = image.depths[points.size()];
      const double x = (static_cast<double>(column) - pinhole.cx) / pinhole.fx;
      const bool is_seen = z >= limits.min_depth && z <= limits.max_depth;
      points.push_back(is_seen ? Eigen::Vector3d(x * z, y * z, z) : Eigen::Vector3d::Constant(nan));
    }
  }
  return points;
}

/// Squares of the plan in which points lie.
using SeenPlaces = std::set<std::pair<double, double>>;
constexpr double place_size = 0.5;  // ours [m]
constexpr double alike = 0.9;       // ours: of all places, those of a message that shows all
SeenPlaces places_of(const std::vector<Eigen::Vector3d>& points) {
  SeenPlaces places;
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite()) continue;
    places.emplace(std::floor(point.x() / place_size), std::floor(point.y() / place_size));
  }
  return places;
}

/// Reads the points of one query.
class ScanReader {
 public:
  ScanReader(RecordingFile& recording, const RecordingQuery& query)
      : recording_(recording),
        topic_(scan_topic(recording, query.topic)),
        target_(frame_name(query.frame)),
        heads_(read_heads(recording, topic_, query)),
        tree_(read_transforms(recording,
                              target_.empty() && heads_.size() == 1
                                  ? std::vector<TimeRange>()
                                  : std::vector<TimeRange>{around(transforms_about)},
                              for_scan())),
        asked_{query.time.value_or(0.0) == 0.0
                   ? earliest
                   : later(topic_.first, nanoseconds_of(*query.time, "time")),
               query.span > 0.0
                   ? later(topic_.first, nanoseconds_of(query.time.value_or(0.0), "time") +
                                             nanoseconds_of(query.span, "span"))
                   : heads_.front().time},
        depth_unit_(query.depth_unit) {
    if (!target_.empty() && !is_target_known()) {
      tree_ = read_transforms(recording, farther(), for_scan());
    }
    require_steady_clock(recording, topic_, heads_);
    if (holds_images(topic_)) pinhole_ = read_pinhole(recording, topic_, heads_.front().time);
    require_depth_unit();
  }

  RecordedScan read() {
    RecordedScan scan;
    scan.topic = topic_.name;
    scan.recorded_frame = first().header.frame;
    scan.frame = target_.empty() ? scan.recorded_frame : target_;
    scan.messages = heads_.size();
    scan.first = seconds_of(time_between(topic_.first, first().time));
    scan.last = seconds_of(time_between(topic_.first, heads_.back().time));
    scan.seen_at = seconds_of(seen_at(heads_.back()));
    const bool stood = stood_still();
    const bool averages = heads_.size() > 1 && stood && same_organised_frames();
    if (heads_.size() == 1) {
      read_one(scan);
    } else if (!averages || !average(scan)) {
      join(scan);
    }
    if (scan.cloud.points.empty() && recording_.skipped().count() > 0) {
      refuse_recording(recording_, "found no points of " + topic_.name + damage_text(recording_));
    }
    if (stood && is_sensor_frame()) {
      scan.cloud.sensor_origin = Eigen::Vector3d(pose_of(first()).translation());
    }
    scan.is_counted = is_counted_;
    require_depths_in_range(scan.cloud);
    add_doubts(scan.merge, scan.warnings);
    return scan;
  }

 private:
  static std::string frame_name(const std::string& frame) {
    require(frame != "/", "RecordingQuery: the frame is '/', expected a name or nothing");
    return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
  }
  const MessageHead& first() const { return heads_.front(); }
  static std::int64_t seen_at(const MessageHead& head) {
    const TimeRange usual = about(head.time);
    const std::int64_t stamp = head.header.stamp;
    return stamp >= usual.from && stamp <= usual.to ? stamp : head.time;
  }
  ForScan for_scan() const { return {topic_.name, topic_.first, heads_.back().time}; }
  TimeRange around(std::int64_t margin) const {
    return {later(first().time, -margin), later(heads_.back().time, margin)};
  }
  /// With the start of the transforms, where what is sent once is.
  std::vector<TimeRange> farther() const {
    const TimeRange wide = around(transforms_farther);
    std::int64_t start = latest;
    for (const std::string& name : topics_for(recording_, MessageUse::transforms)) {
      const RecordedTopic& topic = *find_topic(recording_, name);
      if (topic.messages > 0 && !holds_static_transforms(name))
        start = std::min(start, topic.first);
    }
    const TimeRange first = {start, std::min(later(start, transforms_about), later(wide.from, -1))};
    return first.from <= first.to ? std::vector<TimeRange>{first, wide}
                                  : std::vector<TimeRange>{wide};
  }
  bool is_target_known() const {
    try {
      for (const MessageHead& head : heads_) pose_of(head);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  bool same_frame_ids() const {
    return std::all_of(heads_.begin(), heads_.end(), [&](const MessageHead& head) {
      return head.header.frame == first().header.frame;
    });
  }
  bool same_organised_frames() const {
    return first().size.height > 1 &&
           std::all_of(heads_.begin(), heads_.end(),
                       [&](const MessageHead& head) { return head.size == first().size; });
  }
  /// By the stamps and, as a sensor's clock may not be set, by the times of recording.
  bool moved() const {
    const auto [from, to] = std::minmax_element(
        heads_.begin(), heads_.end(),
        [](const auto& a, const auto& b) { return a.header.stamp < b.header.stamp; });
    const std::string& frame = first().header.frame;
    return tree_.moved(target_, frame, from->header.stamp, to->header.stamp) ||
           tree_.moved(target_, frame, first().time, heads_.back().time);
  }
  /// @throws Error (bad_input) if it did not, and no frame is named
  bool stood_still() const {
    if (heads_.size() == 1) return true;
    const bool one_frame = same_frame_ids();
    if (one_frame && !moved()) return true;
    if (!target_.empty()) return false;
    refuse(recording_.path() + ": between " + time_text(topic_, first().time) + " and " +
           time_text(topic_, heads_.back().time) + " frame " + in_quotes(first().header.frame) +
           " of " + topic_.name + (one_frame ? " moved" : " became another") +
           ": name the frame into which the points are put, or a span in which it stood; frames: " +
           name_list(tree_.frames()));
  }
  /// From the true time of a message, by the clock of the transforms, to its stamp [ns].
  std::int64_t lag_of(const MessageHead& head) const {
    const std::int64_t own = time_between(head.header.stamp, head.time);
    const auto others = tree_.delay(target_, head.header.frame, own);
    return others ? time_between(own, *others) : 0;
  }
  bool is_misplaced(const MessageHead& head) const {
    const std::int64_t lag = lag_of(head);
    if (lag >= -longest_lag && lag <= longest_lag) return false;
    const std::int64_t stamp = head.header.stamp;
    const auto [from, to] = std::minmax({stamp, later(stamp, -lag)});
    return tree_.moved(target_, head.header.frame, from, to);
  }
  void add_doubts(ScanMerge merge, std::vector<Warning>& warnings) const {
    const std::string which = topic_.name + " at " + time_text(topic_, first().time) + ": ";
    const auto misplaced = std::find_if(heads_.begin(), heads_.end(), [&](const MessageHead& head) {
      return !target_.empty() && is_misplaced(head);
    });
    if (misplaced != heads_.end()) {
      warnings.emplace_back(
          WarningCode::clocks_differ,
          which + "its stamps are " + decimals(seconds_of(lag_of(*misplaced)), 3) +
              " s later than the clock of the transforms, and " +
              in_quotes(misplaced->header.frame) + " moved in " + in_quotes(target_) +
              " meanwhile: its points may be misplaced; set the clocks of sensor "
              "and transforms alike, or take a time when it stood");
    }
    if (heads_.size() > 1 && !target_.empty() &&
        tree_.moved("", target_, first().header.stamp, heads_.back().header.stamp)) {
      warnings.emplace_back(
          WarningCode::frame_moved,
          which + in_quotes(target_) + " moved in the root of its tree within the " +
              "span, by which the ground in it is smeared: name a frame that stands "
              "on the ground, or a span in which it stood");
    }
    add_missing(merge, warnings);
    const auto unit = doubt_of_unit();
    if (unit) warnings.push_back(*unit);
  }
  /// Where parts of the recording are not there.
  void add_missing(ScanMerge merge, std::vector<Warning>& warnings) const {
    if (recording_.is_cut_off()) {
      warnings.emplace_back(WarningCode::recording_cut_off,
                            recording_.path() +
                                ": its end is missing, as that of a recorder that was "
                                "killed: messages from " +
                                time_text(topic_, topic_.last) + " of " + topic_.name +
                                " on are lost",
                            false);
    }
    if (recording_.skipped().count() == 0) return;
    const std::string missing = missing_of(merge);
    warnings.emplace_back(WarningCode::recording_cut_off,
                          recording_.path() + ": " + recording_.skipped().text() + missing,
                          !missing.empty());
  }
  /// What may be missing of the scan; empty: nothing, as where each message shows all of it.
  std::string missing_of(ScanMerge merge) const {
    constexpr std::int64_t soon = one_second;  // ours
    const auto lost = recording_.skipped().first_lost(topic_.name, asked_);
    if (lost && *lost < first().time && time_between(*lost, first().time) > soon) {
      return "; the message asked for may be among what is lost, for the first one that is left "
             "was "
             "recorded more than a second later";
    }
    const bool is_whole = merge == ScanMerge::averaged || shows_all_;
    if (!lost || is_whole || asked_.to == first().time) return "";
    return "; messages of " + topic_.name +
           " in the span asked for may be among what is lost, and "
           "what they saw be missing";
  }
  /// Of an image whose unit is so wrong that nothing is left of it.
  void require_depths_in_range(const Cloud& cloud) const {
    const auto unit = doubt_of_unit();
    if (!unit || std::any_of(cloud.points.begin(), cloud.points.end(),
                             [](const Eigen::Vector3d& point) { return point.allFinite(); })) {
      return;
    }
    refuse_recording(recording_, unit->message);
  }
  /// Counts that are none of millimetres, by where they would see.
  std::optional<Warning> doubt_of_unit() const {
    constexpr double farthest = 10.0;  // ours: what depth cameras measure [m]
    if (depth_unit_ || !is_counted_ || !(middle_depth_ > farthest)) return std::nullopt;
    std::string units;
    for (const DepthUnit& unit : other_depth_units) {
      units += (units.empty() ? "" : ", or ") + std::string(unit.word) + ", which gives " +
               readable(middle_depth_ * unit.length / millimetre, 2) + " m";
    }
    return Warning(WarningCode::units,
                   topic_.name + " at " + time_text(topic_, first().time) +
                       ": half of its depths lie beyond " + readable(middle_depth_, 3) +
                       " m as counts of 1 mm, farther than depth cameras see: give the unit of its "
                       "counts by `depth_unit`, such as " +
                       units);
  }
  bool is_sensor_frame() const {
    const bool by_type = holds_images(topic_) || topic_.type.find("CustomMsg") != std::string::npos;
    return by_type || tree_.is_leaf(first().header.frame);
  }

  Eigen::Isometry3d pose_of(const MessageHead& head) const {
    if (target_.empty()) return Eigen::Isometry3d::Identity();
    try {
      return tree_.lookup(target_, head.header.frame, head.header.stamp);
    } catch (const Error& error) {
      const std::int64_t off = time_between(head.time, head.header.stamp);
      if (off >= -longest_delay && off <= longest_delay) throw;
      throw Error(error.kind(), std::string(error.what()) + "; the message recorded at " +
                                    time_text(topic_, head.time) + " is stamped " +
                                    decimals(seconds_of(off), 3) +
                                    " s later: the clocks of sensor and transforms differ");
    }
  }

  void require_depth_unit() const {
    if (!depth_unit_) return;
    require(*depth_unit_ > 0.0 && std::isfinite(*depth_unit_), "depth_unit", *depth_unit_,
            "above 0 m and finite");
    require(holds_images(topic_),
            recording_.path() + ": " + topic_.name +
                " holds points in metres, expected depth images where a depth unit is given");
  }
  std::vector<Eigen::Vector3d> points_of(const RecordedMessage& message) {
    if (!pinhole_) return decode_points(recording_.path(), message).points;
    const DepthMessage image =
        decode_depths(recording_.path(), message, depth_unit_.value_or(millimetre));
    require(image.is_counted || !depth_unit_,
            recording_.path() + ": " + topic_.name +
                " holds depths in metres, expected counts where a depth unit is given");
    note_depths(image);
    if (!(image.size == pinhole_->size)) {
      const auto text = [](const FrameSize& size) {
        return std::to_string(size.width) + " x " + std::to_string(size.height);
      };
      throw Unsupported(recording_.path() + ": " + message.place + ": found " + text(image.size) +
                        " pixels, expected " + text(pinhole_->size) + " as in the camera info");
    }
    return points_of_depths(image, *pinhole_);
  }
  void note_depths(const DepthMessage& image) {
    is_counted_ = image.is_counted;
    if (middle_depth_ > 0.0) return;
    std::vector<double> depths;
    for (const float depth : image.depths) {
      if (depth > 0.0F) depths.push_back(static_cast<double>(depth));
    }
    if (!depths.empty()) middle_depth_ = median(depths);
  }
  /// Calls `take(head, points)` message by message until it returns false.
  template <typename Take>
  void each_message(Take take) {
    std::size_t i = 0;
    const auto show = [&](const RecordedMessage& message) {
      while (i < heads_.size() && heads_[i].time < message.time) ++i;  // left out
      if (i == heads_.size()) return false;
      if (heads_[i].time != message.time) return true;
      std::vector<Eigen::Vector3d> points;
      const auto read = [&] { points = points_of(message); };
      if (!recording_.skipped().guard(loss_of(message), read)) return true;
      return take(heads_[i], std::move(points)) && ++i < heads_.size();
    };
    recording_.visit({topic_.name}, first().time, heads_.back().time, show);
  }

  void read_one(RecordedScan& scan) {
    each_message([&](const MessageHead& head, std::vector<Eigen::Vector3d> points) {
      scan.cloud.points = std::move(points);
      scan.cloud.width = head.size.width;
      scan.cloud.height = head.size.height;
      put_in_target(head, scan.cloud.points);
      return false;
    });
  }
  /// @return false if the frames cannot be averaged, for their rays differ
  bool average(RecordedScan& scan) {
    FrameAverage frames;
    bool fits = true;
    each_message([&](const MessageHead&, const std::vector<Eigen::Vector3d>& points) {
      return fits = frames.add(points);
    });
    if (!fits) return false;
    AveragedFrames averaged = frames.result();
    scan.merge = ScanMerge::averaged;
    scan.cloud.points = std::move(averaged.points);
    scan.cloud.width = first().size.width;
    scan.cloud.height = first().size.height;
    scan.variance = std::move(averaged.variance);
    scan.frame_sd = averaged.frame_sd;
    put_in_target(first(), scan.cloud.points);
    return true;
  }
  void join(RecordedScan& scan) {
    scan.merge = ScanMerge::joined;
    std::vector<Eigen::Vector3d>& all = scan.cloud.points;
    const bool is_damaged = recording_.skipped().count() > 0;
    std::vector<std::size_t> seen;  // places of each message
    SeenPlaces together;
    each_message([&](const MessageHead& head, std::vector<Eigen::Vector3d> points) {
      put_in_target(head, points);
      if (is_damaged) {
        SeenPlaces places = places_of(points);
        seen.push_back(places.size());
        together.merge(places);
      }
      std::copy_if(points.begin(), points.end(), std::back_inserter(all),
                   [](const Eigen::Vector3d& point) { return point.allFinite(); });
      return true;
    });
    scan.cloud.width = all.size();
    if (seen.size() < 2) return;
    const std::size_t least = *std::min_element(seen.begin(), seen.end());
    shows_all_ = static_cast<double>(least) >= alike * static_cast<double>(together.size());
  }
  void put_in_target(const MessageHead& head, std::vector<Eigen::Vector3d>& points) const {
    if (target_.empty()) return;
    const Eigen::Isometry3d pose = pose_of(head);
    for (Eigen::Vector3d& point : points) point = pose * point;
  }

  RecordingFile& recording_;
  const RecordedTopic& topic_;
  std::string target_;
  std::vector<MessageHead> heads_;  ///< of the messages to be used, in the order of their times
  TransformTree tree_;
  TimeRange asked_;  ///< times of messages that were asked for
  std::optional<double> depth_unit_;
  std::optional<Pinhole> pinhole_;  ///< of a depth image
  bool shows_all_ = false;          ///< each of the messages that are joined
  bool is_counted_ = false;
  double middle_depth_ = 0.0;  ///< of the first image that saw something [m]
};

std::string first_frame(RecordingFile& recording, const RecordedTopic& topic) {
  const MessageUse use = use_of(topic.type);
  std::string frame;
  if (use == MessageUse::none || use == MessageUse::transforms) return frame;
  recording.visit({topic.name}, topic.first, topic.first, [&](const RecordedMessage& message) {
    recording.skipped().guard(loss_of(message),
                              [&] { frame = decode_header(recording.path(), message).frame; });
    return false;
  });
  return frame;
}

}  // namespace

RecordingContents describe_recording(RecordingFile& recording) {
  RecordingContents contents;
  contents.start = seconds_of(recording.start());
  for (const RecordedTopic& topic : recording.topics()) {
    RecordingTopic entry = {topic.name, topic.type, topic.messages, nan, nan, {}, false};
    entry.is_scan = holds_scans(topic);
    if (topic.messages > 0) {
      entry.first = seconds_of(time_between(recording.start(), topic.first));
      entry.last = seconds_of(time_between(recording.start(), topic.last));
      entry.frame = first_frame(recording, topic);
      const TimeRange usual = about(recording.start());
      if (topic.first >= recording.start() && topic.last <= usual.to) {
        contents.duration = std::max(contents.duration, entry.last);
      }
    }
    contents.topics.push_back(std::move(entry));
  }
  const std::int64_t start = recording.start();
  contents.frames = read_transforms(recording, {{start, later(start, transforms_about)}}).frames();
  contents.is_cut_off = recording.is_cut_off();
  contents.damaged_parts = recording.skipped().count();
  contents.first_damage = recording.skipped().first();
  for (const auto& [why, loss] : recording.skipped().parts()) contents.damage.push_back(why);
  return contents;
}

RecordedScan read_recorded_scan(RecordingFile& recording, const RecordingQuery& query) {
  return ScanReader(recording, query).read();
}

std::map<std::string, double> joint_positions(RecordingFile& recording, double time,
                                              const std::string& topic) {
  const std::vector<std::string> topics = topics_for(recording, MessageUse::joints);
  if (topics.empty()) refuse_recording(recording, "found no topic of sensor_msgs/JointState");
  const std::int64_t start = topic.empty() ? recording.start() : scan_topic(recording, topic).first;
  const std::int64_t at = later(start, nanoseconds_of(time, "time"));
  struct Nearest {
    std::int64_t away = latest;
    double position = 0.0;
  };
  std::map<std::string, Nearest> joints;
  recording.visit(topics, later(at, -joints_about), later(at, joints_about),
                  [&](const RecordedMessage& message) {
                    const std::int64_t away = std::abs(time_between(at, message.time));
                    std::vector<std::pair<std::string, double>> found;
                    recording.skipped().guard(loss_of(message), [&] {
                      found = decode_joints(recording.path(), message);
                    });
                    for (const auto& [name, position] : found) {
                      Nearest& nearest = joints[name];
                      if (away < nearest.away) nearest = {away, position};
                    }
                    return true;
                  });
  if (joints.empty()) {
    refuse_recording(recording, "found no joint positions within 0.5 s of " + decimals(time, 3) +
                                    " s on " + name_list(topics) + damage_text(recording));
  }
  std::map<std::string, double> positions;
  for (const auto& [name, nearest] : joints) positions[name] = nearest.position;
  return positions;
}

RecordingContents describe_recording(const std::string& path) {
  const auto recording = open_recording(path);
  recording->check();
  return describe_recording(*recording);
}

RecordedScan read_recorded_scan(const RecordingQuery& query) {
  return read_recorded_scan(*open_recording(query.path), query);
}

std::map<std::string, double> joint_positions(const std::string& path, double time,
                                              const std::string& topic) {
  return joint_positions(*open_recording(path), time, topic);
}

}  // namespace excavplan
