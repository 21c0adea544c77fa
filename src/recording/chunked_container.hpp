// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "recording/byte_file.hpp"
#include "recording/container.hpp"

/// @file What MCAP files and ROS 1 bags have in common: messages of channels in compressed chunks,
/// and an index of each chunk. Private to the library.

namespace excavplan {

/// A stream of messages of one type; a topic may have several.
struct RecordedChannel {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;
  Serialization serialization = Serialization::cdr;
  std::string unreadable;       ///< why its messages cannot be read; empty if they can
  std::uint64_t messages = 0;   ///< how many the index of the file counts
  std::size_t topic_index = 0;  ///< of Container::topics, set by finish()
  bool is_doubtful = false;     ///< out of a damaged chunk: another one of this id replaces it
};

/// Where a message lies.
struct MessagePlace {
  std::int64_t time = 0;
  std::uint64_t offset = 0;  ///< in the uncompressed chunk
  std::uint32_t chunk = 0;
  std::uint32_t channel = 0;  ///< of ChunkedContainer's channels
};

/// A group of messages.
struct RecordedChunk {
  std::int64_t start = 0;    ///< no message is earlier
  std::int64_t end = 0;      ///< no message is later
  std::uint64_t offset = 0;  ///< in the file
  std::uint64_t length = 0;  ///< up to its index [byte]; 0: not known before it is read
  /// The channels that it has messages of, and where the file lists them (0: not told).
  std::vector<std::pair<std::uint32_t, std::uint64_t>> channels;
  std::vector<MessagePlace> places;  ///< where there was no index; else empty
  bool is_endless = false;           ///< its record tells a wrong length
  std::string lost;                  ///< why nothing of it can be read; empty if it can

  TimeRange times() const { return {start, end}; }
};

/// So many messages may be listed at once, and so many chunks in all; ours.
constexpr std::size_t most_places = std::size_t{1} << 23;

/// A file of chunks.
class ChunkedContainer : public Container {
 public:
  ChunkedContainer(const std::string& path, SkippedParts& skipped)
      : Container(skipped), file_(path) {}
  std::unique_ptr<MessageCursor> messages(const std::vector<std::size_t>& topics, std::int64_t from,
                                          std::int64_t to) override;
  void check() override;

 protected:
  /// Appends the places of a chunk's messages, of wanted channels at least, by the file's index.
  virtual void list(std::uint32_t chunk, const std::vector<bool>& wanted,
                    std::vector<MessagePlace>& places) const = 0;
  /// Appends the places of all messages in an uncompressed chunk, and takes the channels in it;
  /// notes what is damaged.
  virtual void scan_content(const RecordedChunk& chunk, std::string_view content,
                            std::vector<MessagePlace>& places) = 0;
  /// True if the record of a chunk may begin so, of which longest_chunk_head bytes are enough.
  virtual bool begins_chunk(std::string_view bytes, std::uint64_t left) const = 0;
  static constexpr std::size_t longest_chunk_head = 256;  ///< ours [byte]
  /// The uncompressed chunk.
  virtual Bytes load(const RecordedChunk& chunk) const = 0;
  /// The message at a place, whose record must agree with the index; good until the next call.
  virtual std::string_view message_at(const MessagePlace& place) = 0;

  /// Of a chunk: of its topics, where they are known.
  Loss loss_of(const RecordedChunk& chunk) const;
  /// The channel with this id. @return channels_.size() if there is none
  std::uint32_t channel_of(std::uint32_t id) const;
  void add_channel(RecordedChannel channel, const ByteReader& reader);
  /// That a chunk does not end before it starts.
  static void require_order(const RecordedChunk& chunk, const ByteReader& reader);
  void forget_index();  ///< channels_ and chunks_
  /// Where the next chunk may begin after what is no record; `end` if there is none.
  std::uint64_t next_chunk(std::uint64_t offset, std::uint64_t end) const;
  /// Takes a chunk that was scanned, if it has messages.
  void keep_chunk(RecordedChunk chunk);
  /// The chunk of a message uncompressed, kept for the next messages; good until the next call.
  std::string_view chunk_of(const MessagePlace& place);
  /// Makes the topics from channels_ and chunks_, and puts the chunks in the order of their starts.
  void finish();

  ByteFile file_;
  std::vector<RecordedChannel> channels_;
  std::vector<RecordedChunk> chunks_;

 private:
  friend class ChunkedCursor;
  void make_topics();
  void date_topics();
  void leave_out_strays(std::size_t topic);
  struct Dating;
  void date_by(std::uint32_t chunk, Dating& dating);
  std::vector<MessagePlace> places_of(std::uint32_t chunk, const std::vector<bool>& wanted);
  std::vector<MessagePlace> listed_places(std::uint32_t chunk, const std::vector<bool>& wanted);

  bool is_finished_ = false;            // the topics are made: no channel is taken any more
  std::vector<TimeRange> usual_times_;  // by topic; others bear a wrong time
  std::map<std::uint32_t, std::uint32_t> channel_of_id_;
  std::list<std::pair<std::uint32_t, Bytes>> kept_;  // the last one used first
  std::map<std::uint32_t, int> loads_;               // of a chunk, by the last cursor
};

}  // namespace excavplan
