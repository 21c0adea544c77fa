// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/recording_file.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "recording/byte_file.hpp"
#include "recording/compression.hpp"
#include "recording/container.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view older_bag_magic = "#ROSRECORD V";
constexpr std::size_t longest_word = 1000;  // of a topic or type; ours [byte]
constexpr std::size_t most_files = 500;     // of a folder; ours

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

std::string start_of(const std::string& path) {
  const ByteFile file(path);
  return std::string(file.read(0, std::min<std::uint64_t>(file.size(), 16), "file").view());
}

bool is_bag(std::string_view start) {
  return starts_with(start, bag_magic) || starts_with(start, older_bag_magic);
}

/// rosbag2's compression mode FILE.
bool is_compressed_file(const std::string& path, std::string_view start) {
  return is_zstd_frame(start) && (ends_with(path, ".db3.zstd") || ends_with(path, ".mcap.zstd"));
}

std::unique_ptr<Container> open_file(const std::string& path, SkippedParts& skipped) {
  const std::string start = start_of(path);
  if (starts_with(start, sqlite_magic)) return open_sqlite_recording(path, skipped);
  if (starts_with(start, mcap_magic)) return open_mcap_recording(path, skipped);
  if (is_bag(start)) return open_bag_recording(path, skipped);
  if (is_compressed_file(path, start)) {
    throw Unsupported(path + ": is compressed as a whole; uncompress it by 'zstd -d " + path +
                      "' and name the file or folder again");
  }
  fail_at(path, "byte 0", in_quotes(start),
          "the start of a rosbag2 SQLite file, an MCAP file or a ROS 1 bag");
}

/// The files of a rosbag2 folder, in the order of their names. They are those that lie there, not
/// those that metadata.yaml names: recordings are renamed and cut, and a path in it may lead
/// anywhere. The order in time comes from the messages.
std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::string> files;
  std::vector<std::string> compressed;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().string();
    if (ends_with(name, ".db3") || ends_with(name, ".mcap")) files.push_back(name);
    if (ends_with(name, ".db3.zstd") || ends_with(name, ".mcap.zstd")) compressed.push_back(name);
    if (files.size() + compressed.size() > most_files) break;
  }
  if (error) throw Error(ErrorKind::bad_file, folder + ": cannot be read: " + error.message());
  for (const std::string& name : compressed) {
    const std::string plain = name.substr(0, name.size() - std::string(".zstd").size());
    if (std::find(files.begin(), files.end(), plain) == files.end()) files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  const auto is_mcap = [](const std::string& name) {
    return ends_with(name, ".mcap") || ends_with(name, ".mcap.zstd");
  };
  const auto mcap_files = std::count_if(files.begin(), files.end(), is_mcap);
  const bool is_mixed = mcap_files > 0 && mcap_files < static_cast<std::ptrdiff_t>(files.size());
  if (files.empty() || files.size() > most_files || is_mixed) {
    fail_at(
        folder, "the folder",
        is_mixed ? "files of both .db3 and .mcap"
                 : std::to_string(files.size()) + " files of .db3 or .mcap",
        is_mixed ? "one kind; name the file that is meant" : "1 to " + std::to_string(most_files));
  }
  return files;
}

class Recording : public RecordingFile {
 public:
  explicit Recording(const std::string& path) : path_(path) {
    std::error_code none;
    const auto files =
        fs::is_directory(path, none) ? files_of(path) : std::vector<std::string>{path};
    for (const std::string& file : files) {
      const bool is_empty = ByteFile(file).size() == 0;  // its recorder was killed
      skipped().guard(is_empty ? no_time : TimeRange(),
                      [&] { add(file, open_file(file, skipped())); });
    }
    if (parts_.empty() && skipped().count() > 0) {
      throw Error(ErrorKind::bad_file, skipped().first());
    }
    sort_topics();
    const auto starts_earlier = [](const Part& a, const Part& b) { return a.start < b.start; };
    std::stable_sort(parts_.begin(), parts_.end(), starts_earlier);
    set_start();
  }

  const std::string& path() const override { return path_; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }
  std::int64_t start() const override { return start_; }
  bool is_cut_off() const override { return is_cut_off_; }
  void visit(const std::vector<std::string>& topics, std::int64_t from, std::int64_t to,
             const MessageVisitor& visitor) override;
  void check() override {
    for (const Part& part : parts_) part.container->check();
  }

 private:
  /// A file that holds messages.
  struct Part {
    std::string path;
    std::unique_ptr<Container> container;
    std::int64_t start = 0;
    std::vector<std::size_t> topics;  // of the recording, by that of the file; or no_topic
  };
  static constexpr std::size_t no_topic = static_cast<std::size_t>(-1);
  struct Open {
    const Part* part;
    std::unique_ptr<MessageCursor> cursor;
  };

  void add(const std::string& file, std::unique_ptr<Container> container);
  std::size_t add_topic(const std::string& file, const RecordedTopic& topic);
  void sort_topics();
  void set_start();
  bool show(const Open& open, const std::vector<std::string>& topics,
            const MessageVisitor& visitor);

  std::string path_;
  std::vector<RecordedTopic> topics_;
  std::map<std::string, std::size_t> topic_of_name_;
  std::vector<Part> parts_;  // in the order of their starts
  std::int64_t start_ = 0;
  bool is_cut_off_ = false;
};

void Recording::add(const std::string& file, std::unique_ptr<Container> container) {
  Part part{file, std::move(container), std::numeric_limits<std::int64_t>::max(), {}};
  is_cut_off_ = is_cut_off_ || part.container->is_cut_off();
  bool is_empty = true;
  for (const RecordedTopic& topic : part.container->topics()) {
    std::size_t number = no_topic;
    const TimeRange times = topic.messages > 0 ? TimeRange{topic.first, topic.last} : no_time;
    skipped().guard(Loss{times, {topic.name}}, [&] { number = add_topic(file, topic); });
    part.topics.push_back(number);
    if (topic.messages == 0 || number == no_topic) continue;
    is_empty = false;
    part.start = std::min(part.start, topic.first);
  }
  if (!is_empty) parts_.push_back(std::move(part));
}

std::size_t Recording::add_topic(const std::string& file, const RecordedTopic& topic) {
  for (const std::string& name : {topic.name, topic.type}) {
    if (name.size() <= longest_word && safe_text(name, longest_word) == name) continue;
    fail_at(file, "a topic's name or type", in_quotes(name),
            "at most " + std::to_string(longest_word) + " bytes without control characters");
  }
  const auto [entry, is_new] = topic_of_name_.try_emplace(topic.name, topics_.size());
  if (is_new) {
    topics_.push_back(topic);
    return entry->second;
  }
  RecordedTopic& whole = topics_[entry->second];
  if (whole.type != topic.type) {
    fail_at(file, "topic " + topic.name, "the type " + in_quotes(topic.type),
            in_quotes(whole.type) + ", as before");
  }
  if (topic.messages == 0) return entry->second;
  whole.first = whole.messages == 0 ? topic.first : std::min(whole.first, topic.first);
  whole.last = whole.messages == 0 ? topic.last : std::max(whole.last, topic.last);
  whole.messages += topic.messages;
  return entry->second;
}

void Recording::sort_topics() {
  std::vector<RecordedTopic> sorted;
  std::vector<std::size_t> places(topics_.size());
  for (auto& [name, number] : topic_of_name_) {
    places[number] = sorted.size();
    sorted.push_back(topics_[number]);
    number = places[number];
  }
  topics_ = std::move(sorted);
  for (Part& part : parts_) {
    for (std::size_t& topic : part.topics) {
      if (topic != no_topic) topic = places[topic];
    }
  }
}

/// By the topics of the same time as the one of most messages: others have another clock.
void Recording::set_start() {
  const auto has_fewer = [](const RecordedTopic& a, const RecordedTopic& b) {
    return a.messages < b.messages;
  };
  const auto most = std::max_element(topics_.begin(), topics_.end(), has_fewer);
  if (most == topics_.end() || most->messages == 0) return;
  const TimeRange usual = about(most->first);
  start_ = most->first;
  for (const RecordedTopic& topic : topics_) {
    if (topic.messages > 0 && topic.first >= usual.from) start_ = std::min(start_, topic.first);
  }
}

void Recording::visit(const std::vector<std::string>& topics, std::int64_t from, std::int64_t to,
                      const MessageVisitor& visitor) {
  std::vector<bool> is_asked_for(topics_.size());
  for (const std::string& name : topics) {
    const auto found = topic_of_name_.find(name);
    if (found != topic_of_name_.end()) is_asked_for[found->second] = true;
  }
  std::vector<Open> open;
  const auto is_earlier = [](const Open& a, const Open& b) {
    return a.cursor->time() < b.cursor->time();
  };
  for (auto part = parts_.begin();;) {
    auto first = std::min_element(open.begin(), open.end(), is_earlier);
    if (part != parts_.end() && part->start <= to &&
        (first == open.end() || part->start <= first->cursor->time())) {
      std::vector<std::size_t> wanted;
      for (std::size_t i = 0; i < part->topics.size(); ++i) {
        if (part->topics[i] == no_topic || !is_asked_for[part->topics[i]]) continue;
        wanted.push_back(i);
      }
      Open opened{&*part, part->container->messages(wanted, from, to)};
      if (opened.cursor->next()) open.push_back(std::move(opened));
      ++part;
      continue;
    }
    if (first == open.end() || !show(*first, topics, visitor)) return;
    if (!first->cursor->next()) open.erase(first);
  }
}

/// Shows a message, unless it is damaged. @return false if no more are wanted
bool Recording::show(const Open& open, const std::vector<std::string>& topics,
                     const MessageVisitor& visitor) {
  const std::int64_t time = open.cursor->time();
  StoredMessage stored;
  Bytes uncompressed;
  std::string place;
  const Loss loss = {{time, time}, {topics.begin(), topics.end()}};
  const bool is_whole = skipped().guard(loss, [&] {
    stored = open.cursor->read();
    const RecordedTopic& topic = topics_[open.part->topics[stored.topic]];
    place = "message of " + topic.name + " at " +
            decimals((static_cast<double>(time) - static_cast<double>(topic.first)) * 1e-9, 3) +
            " s";
    if (stored.serialization != Serialization::cdr || !is_zstd_frame(stored.bytes)) return;
    // rosbag2's compression mode MESSAGE
    const std::uint64_t size = zstd_content_size(stored.bytes, open.part->path, place);
    uncompressed = decompress({Compression::zstd, stored.bytes, size, open.part->path, place});
    stored.bytes = uncompressed.view();
  });
  if (!is_whole) return true;
  return visitor(
      {topics_[open.part->topics[stored.topic]], time, stored.serialization, stored.bytes, place});
}

}  // namespace

bool is_recording(const std::string& path) {
  std::error_code none;
  if (fs::is_directory(path, none)) {
    return fs::is_regular_file(fs::path(path) / "metadata.yaml", none);
  }
  try {
    const std::string start = start_of(path);
    return starts_with(start, sqlite_magic) || starts_with(start, mcap_magic) || is_bag(start) ||
           is_compressed_file(path, start);
  } catch (const Error&) {
    return false;
  }
}

std::unique_ptr<RecordingFile> open_recording(const std::string& path) {
  return std::make_unique<Recording>(path);
}

}  // namespace excavplan
