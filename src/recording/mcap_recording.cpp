// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>

#include "base/scalar.hpp"
#include "base/text.hpp"
#include "recording/chunked_container.hpp"
#include "recording/compression.hpp"

// The format is that of https://mcap.dev/spec, major version 0.

namespace excavplan {
namespace {

constexpr std::string_view magic_of_mcap = "\x89MCAP0\r\n";
constexpr std::uint64_t record_head = 9;                 // opcode and length [byte]
constexpr std::uint64_t footer_size = record_head + 20;  // [byte]
constexpr std::uint64_t message_head = 22;               // before the data of a message [byte]
constexpr std::uint64_t chunk_head = 32;                 // before the name of its compression
constexpr std::uint64_t longest_compression_name = 64;   // ours [byte]
constexpr unsigned first_unknown = 16;                   // opcode that version 0 does not have
constexpr unsigned first_private = 128;                  // and of those that others may use

enum Opcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  data_end = 15,
};

struct Record {
  std::uint8_t opcode;
  ByteReader content;
};

std::uint64_t load_u64(std::string_view bytes) { return load<std::uint64_t>(bytes.data(), false); }

Record next_record(ByteReader& reader) {
  const std::uint8_t opcode = reader.u8("opcode");
  const std::uint64_t length = reader.u64("length of a record");
  if (opcode == 0) reader.fail("a record of opcode 0", "one of 1 to 255");
  return {opcode, reader.part(length, "record")};
}

/// The fields of a Chunk record that come before its data.
struct McapChunkHead {
  TimeRange times;
  std::uint64_t uncompressed = 0;  // [byte]
  std::uint32_t crc = 0;           // 0: none
  std::string compression;
  std::uint64_t data = 0;    // where in the file
  std::uint64_t length = 0;  // [byte]
};

/// Both ways in: by the summary at the end of the file where it has all that is needed, else by a
/// scan of the whole.
class McapRecording : public ChunkedContainer {
 public:
  McapRecording(const std::string& path, SkippedParts& skipped) : ChunkedContainer(path, skipped) {
    const std::uint64_t data_start = read_header();
    bool has_index = false;
    skipped_.guard(no_time, [&] { has_index = read_summary(data_start); });
    if (!has_index) {
      chunks_.clear();
      for (RecordedChannel& channel : channels_) channel.messages = 0;
      scan(data_start);
    }
    finish();
  }

  bool is_cut_off() const override { return !is_closed_; }

 private:
  void list(std::uint32_t chunk, const std::vector<bool>& wanted,
            std::vector<MessagePlace>& places) const override;
  void scan_content(const RecordedChunk& chunk, std::string_view content,
                    std::vector<MessagePlace>& places) override;
  bool begins_chunk(std::string_view bytes, std::uint64_t left) const override;
  Bytes load(const RecordedChunk& chunk) const override;
  std::string_view message_at(const MessagePlace& place) override;

  std::uint64_t read_header();
  std::uint64_t content_length(std::uint64_t offset, std::uint64_t end, Opcode kind,
                               const char* name) const;
  bool read_summary(std::uint64_t data_start);
  void read_summary_records(std::uint64_t start, std::uint64_t end);
  void require_apart(std::uint64_t data_start, std::uint64_t data_end);
  void read_schema(ByteReader record);
  void read_channel(ByteReader record);
  void read_chunk_index(ByteReader record);
  void require_once_each(RecordedChunk& chunk, const ByteReader& record) const;
  void read_statistics(ByteReader record);

  void scan(std::uint64_t data_start);
  std::int64_t last_scanned() const;
  void scan_record(std::uint8_t opcode, std::uint64_t offset, std::uint64_t length);
  void scan_chunk(std::uint64_t offset, std::uint64_t length, bool is_endless = false);
  struct ScannedPlace {
    std::uint64_t offset;
    TimeRange times;  // that the message may bear
  };
  void scan_message(const ScannedPlace& place, ByteReader fields,
                    std::vector<MessagePlace>& places);
  std::optional<std::uint64_t> scan_endless_chunk(std::uint64_t offset, std::uint64_t end);
  void take_channels_of_damaged(std::uint64_t offset, std::uint64_t length);

  ByteReader reader_at(const MessagePlace& place);
  McapChunkHead head_of(std::uint64_t offset, std::uint64_t length) const;
  Bytes unpack(std::uint64_t offset, const McapChunkHead& head) const;
  Bytes load(std::uint64_t offset, std::uint64_t length) const;
  ByteReader reader(std::uint64_t offset, const Bytes& bytes) const {
    return {{file_, offset}, bytes.view()};
  }

  bool is_closed_ = false;   // ends as a complete file does
  bool is_damaged_ = false;  // the chunk that is read
  bool has_statistics_ = false;
  bool lacks_index_ = false;  // has a chunk whose messages are not listed
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint32_t, std::uint64_t> counts_;  // messages by channel
  RecordedChunk loose_;                            // messages outside chunks; offset 0
  std::size_t places_ = 0;                         // how many were listed by scan()
  Bytes message_;                                  // the last one outside chunks
};

std::uint64_t McapRecording::read_header() {
  const Bytes start =
      file_.read(0, std::min<std::uint64_t>(file_.size(), magic_of_mcap.size()), "magic");
  if (start.view() != magic_of_mcap) {
    file_.fail(0, in_quotes(start.view()), "the magic of MCAP version 0, '\\x89MCAP0\\r\\n'");
  }
  std::uint64_t end = magic_of_mcap.size();
  skipped_.guard(no_time, [&] {
    end += record_head + content_length(end, file_.size(), Opcode::header, "header");
  });
  is_closed_ =
      file_.size() - end >= footer_size + magic_of_mcap.size() &&
      file_.read(file_.size() - magic_of_mcap.size(), magic_of_mcap.size(), "magic").view() ==
          magic_of_mcap;
  return end;
}

/// The length of what a record holds that must be of this kind and end before `end`.
std::uint64_t McapRecording::content_length(std::uint64_t offset, std::uint64_t end, Opcode kind,
                                            const char* name) const {
  const Bytes bytes = file_.read(offset, record_head, name);
  ByteReader head = reader(offset, bytes);
  const std::uint8_t opcode = head.u8("opcode");
  const std::uint64_t length = head.u64("length of a record");
  if (opcode == kind && end - offset >= record_head && length <= end - offset - record_head) {
    return length;
  }
  file_.fail(
      offset,
      "a record of opcode " + std::to_string(opcode) + " and " + std::to_string(length) + " bytes",
      std::string(name) + " (opcode " + std::to_string(kind) + ") that ends before byte " +
          std::to_string(end));
}

/// @return false if the file has to be scanned: it has no summary, or one that lacks channels,
/// counts or indexes, all of which are optional
bool McapRecording::read_summary(std::uint64_t data_start) {
  if (!is_closed_) return false;
  const std::uint64_t footer_start = file_.size() - magic_of_mcap.size() - footer_size;
  const Bytes bytes = file_.read(footer_start, footer_size, "footer");
  content_length(footer_start, footer_start + footer_size, Opcode::footer, "footer");
  ByteReader fields = reader(footer_start, bytes);
  fields.take(record_head, "footer");
  const std::uint64_t start = fields.u64("start of the summary");
  const std::uint64_t offsets = fields.u64("start of the summary offsets");
  const std::uint32_t crc = fields.u32("CRC of the summary");
  if (start == 0) return false;
  if (start < data_start || start > footer_start || footer_start - start > most_index_bytes) {
    file_.fail(footer_start, "a summary from byte " + std::to_string(start),
               "one of at most " + std::to_string(most_index_bytes) + " bytes from " +
                   std::to_string(data_start) + " to " + std::to_string(footer_start));
  }
  const Bytes summary = file_.read(start, footer_start - start + footer_size - 4, "summary");
  if (crc != 0 && crc32(summary.view()) != crc) {
    file_.fail(start, "a summary of CRC " + std::to_string(crc32(summary.view())),
               std::to_string(crc) + ", as the footer says");
  }
  const bool has_offsets = offsets >= start && offsets <= footer_start;
  read_summary_records(start, has_offsets ? offsets : footer_start);
  if (!has_statistics_ || lacks_index_ || chunks_.empty()) return false;
  require_apart(data_start, start);
  return true;
}

void McapRecording::read_summary_records(std::uint64_t start, std::uint64_t end) {
  const Bytes bytes = file_.read(start, end - start, "summary");
  std::vector<ByteReader> later;
  for (ByteReader all = reader(start, bytes); all.left() > 0;) {
    const Record record = next_record(all);
    if (record.opcode == Opcode::schema) read_schema(record.content);
    if (record.opcode == Opcode::channel) read_channel(record.content);
    if (record.opcode == Opcode::statistics) read_statistics(record.content);
    if (record.opcode == Opcode::chunk_index) later.push_back(record.content);
  }
  for (const ByteReader& index : later) read_chunk_index(index);
  for (RecordedChannel& channel : channels_) channel.messages = counts_[channel.id];
}

/// Each chunk and its message indexes lie by themselves, so that no part of a file is read twice.
void McapRecording::require_apart(std::uint64_t data_start, std::uint64_t data_end) {
  std::vector<const RecordedChunk*> by_place;
  for (const RecordedChunk& chunk : chunks_) by_place.push_back(&chunk);
  std::sort(by_place.begin(), by_place.end(),
            [](const auto* a, const auto* b) { return a->offset < b->offset; });
  std::uint64_t free = data_start;
  for (const RecordedChunk* chunk : by_place) {
    std::uint64_t end = chunk->offset;
    if (chunk->offset >= free && chunk->offset <= data_end &&
        chunk->length <= data_end - chunk->offset) {
      end += chunk->length;
    } else {
      file_.fail(chunk->offset,
                 "a chunk of " + std::to_string(chunk->length) + " bytes, by its index",
                 "one between byte " + std::to_string(free) + " and " + std::to_string(data_end));
    }
    free = end;
  }
}

void McapRecording::read_schema(ByteReader record) {
  const std::uint16_t id = record.u16("schema");
  const std::string name(record.text("name of a schema"));
  const auto [entry, is_new] = schemas_.try_emplace(id, name);
  if (!is_new && entry->second != name) {
    record.fail("schema " + std::to_string(id) + " of " + in_quotes(name) + " and of " +
                    in_quotes(entry->second),
                "one");
  }
}

void McapRecording::read_channel(ByteReader record) {
  RecordedChannel channel;
  channel.id = record.u16("channel");
  const std::uint16_t schema = record.u16("schema of a channel");
  channel.topic = record.text("topic");
  const std::string_view encoding = record.text("encoding of messages");
  if (schema != 0) {
    const auto found = schemas_.find(schema);
    if (found == schemas_.end()) {
      record.fail("channel " + std::to_string(channel.id) + " of schema " + std::to_string(schema),
                  "a schema that comes before");
    }
    channel.type = ros2_type(found->second);
  }
  if (encoding == "ros1") {
    channel.serialization = Serialization::ros1;
  } else if (encoding != "cdr") {
    channel.unreadable = "found messages in the encoding " + in_quotes(encoding) +
                         ", expected 'cdr' (ROS 2) or 'ros1'";
  }
  channel.is_doubtful = is_damaged_;
  add_channel(std::move(channel), record);
}

void McapRecording::read_statistics(ByteReader record) {
  record.take(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8, "statistics");
  for (ByteReader counts = record.part("counts of messages"); counts.left() > 0;) {
    const std::uint16_t id = counts.u16("channel");
    counts_[id] = counts.u64("count of messages");
  }
  has_statistics_ = true;
}

void McapRecording::read_chunk_index(ByteReader record) {
  RecordedChunk chunk;
  ByteReader times = record.part(16, "times of a chunk");
  chunk.offset = record.u64("offset of a chunk");
  const std::uint64_t length = record.u64("length of a chunk");
  ByteReader indexes = record.part("offsets of message indexes");
  const std::uint64_t index_length = record.u64("length of the message indexes");
  const std::uint64_t most = file_.size();
  if (chunk.offset > most || length > most || index_length > most) {
    record.fail("a chunk of " + std::to_string(length) + " bytes at byte " +
                    std::to_string(chunk.offset) + ", its index of " + std::to_string(index_length),
                "none above the size of the file, " + std::to_string(most));
  }
  chunk.length = length + index_length;
  const std::uint64_t end = chunk.offset + length;
  while (indexes.left() > 0) {
    const std::uint32_t number = channel_of(indexes.u16("channel"));
    const std::uint64_t offset = indexes.u64("offset of a message index");
    if (offset < end || offset - end >= index_length) {
      indexes.fail("a message index at byte " + std::to_string(offset),
                   "one in the " + std::to_string(index_length) + " bytes after its chunk, from " +
                       std::to_string(end));
    }
    if (number == channels_.size()) lacks_index_ = true;
    if (number < channels_.size()) chunk.channels.emplace_back(number, offset);
  }
  if (chunk.channels.empty()) {
    lacks_index_ = lacks_index_ || times.u64("start of a chunk") != 0;
    return;
  }
  require_once_each(chunk, record);
  chunk.start = times.nanoseconds_at_most("start of a chunk");
  chunk.end = times.nanoseconds_at_most("end of a chunk");
  require_order(chunk, record);
  chunks_.push_back(std::move(chunk));
}

/// No message index is read twice.
void McapRecording::require_once_each(RecordedChunk& chunk, const ByteReader& record) const {
  std::sort(chunk.channels.begin(), chunk.channels.end());
  for (std::size_t i = 1; i < chunk.channels.size(); ++i) {
    if (chunk.channels[i].first != chunk.channels[i - 1].first) continue;
    record.fail("two message indexes of channel " +
                    std::to_string(channels_[chunk.channels[i].first].id) + " in a chunk",
                "one");
  }
}

void McapRecording::list(std::uint32_t chunk, const std::vector<bool>& wanted,
                         std::vector<MessagePlace>& places) const {
  for (const auto& index_of_channel : chunks_[chunk].channels) {
    const auto number = index_of_channel.first;
    const auto offset = index_of_channel.second;
    if (!wanted[number]) continue;
    const std::uint64_t end = chunks_[chunk].offset + chunks_[chunk].length;
    const std::uint64_t length =
        content_length(offset, end, Opcode::message_index, "message index");
    if (length / 16 > most_places - places.size()) {
      file_.fail(offset, "a message index of " + std::to_string(length) + " bytes",
                 "at most " + std::to_string(most_places) + " messages a chunk");
    }
    const Bytes bytes = file_.read(offset + record_head, length, "message index");
    ByteReader index = reader(offset + record_head, bytes);
    const std::uint16_t id = index.u16("channel");
    if (id != channels_[number].id) {
      index.fail("a message index of channel " + std::to_string(id),
                 "one of channel " + std::to_string(channels_[number].id));
    }
    const Loss loss = {chunks_[chunk].times(), {channels_[number].topic}};
    for (ByteReader entries = index.part("entries of a message index"); entries.left() > 0;) {
      ByteReader entry = entries.part(16, "entry of a message index");
      skipped_.guard(loss, [&, channel = number] {
        const std::int64_t time = entry.nanoseconds("time of a message");
        places.push_back({time, entry.u64("offset of a message"), chunk, channel});
      });
    }
  }
}

McapChunkHead McapRecording::head_of(std::uint64_t offset, std::uint64_t length) const {
  const std::uint64_t count = std::min(length, chunk_head + longest_compression_name + 8);
  const Bytes bytes = file_.read(offset, count, "chunk");
  ByteReader fields = reader(offset, bytes);
  McapChunkHead head;
  head.times.from = fields.nanoseconds_at_most("start of a chunk");
  head.times.to = fields.nanoseconds_at_most("end of a chunk");
  head.uncompressed = fields.u64("size of a chunk");
  head.crc = fields.u32("CRC of a chunk");
  head.compression = fields.text("compression of a chunk");
  head.length = fields.u64("length of the data of a chunk");
  head.data = fields.offset();
  if (head.length > length - (head.data - offset)) {
    fields.fail("data of " + std::to_string(head.length) + " bytes in a chunk",
                "at most " + std::to_string(length - (head.data - offset)));
  }
  return head;
}

Bytes McapRecording::load(const RecordedChunk& chunk) const {
  const std::uint64_t content = chunk.offset + record_head;
  if (chunk.is_endless) return load(content, chunk.length - record_head);
  return load(content,
              content_length(chunk.offset, chunk.offset + chunk.length, Opcode::chunk, "chunk"));
}

Bytes McapRecording::unpack(std::uint64_t offset, const McapChunkHead& head) const {
  Bytes bytes = file_.read(head.data, head.length, "a chunk");
  const std::string place = "byte " + std::to_string(head.data);
  if (head.compression == "lz4" || head.compression == "zstd") {
    const auto compression = head.compression == "lz4" ? Compression::lz4 : Compression::zstd;
    bytes = decompress({compression, bytes.view(), head.uncompressed, file_.path(), place});
  } else if (!head.compression.empty()) {
    file_.fail(offset, "a chunk compressed by " + in_quotes(head.compression), "lz4, zstd or none");
  } else if (head.length != head.uncompressed) {
    file_.fail(offset, "a chunk of " + std::to_string(head.length) + " bytes",
               std::to_string(head.uncompressed) + ", as it says");
  }
  return bytes;
}

Bytes McapRecording::load(std::uint64_t offset, std::uint64_t length) const {
  const McapChunkHead head = head_of(offset, length);
  Bytes bytes = unpack(offset, head);
  if (head.crc != 0 && crc32(bytes.view()) != head.crc) {
    file_.fail(offset, "a chunk of CRC " + std::to_string(crc32(bytes.view())),
               std::to_string(head.crc) + ", as it says");
  }
  return bytes;
}

/// The record of a message outside chunks, or the rest of its chunk.
ByteReader McapRecording::reader_at(const MessagePlace& place) {
  const RecordedChunk& chunk = chunks_[place.chunk];
  if (chunk.offset == 0) {
    const std::uint64_t length =
        content_length(place.offset, file_.size(), Opcode::message, "message");
    message_ = file_.read(place.offset, record_head + length, "message");
    return reader(place.offset, message_);
  }
  std::string_view bytes = chunk_of(place);
  bytes.remove_prefix(std::min<std::uint64_t>(place.offset, bytes.size()));
  return {{file_, place.offset, chunk.offset}, bytes};
}

std::string_view McapRecording::message_at(const MessagePlace& place) {
  ByteReader reader = reader_at(place);
  const Record whole = next_record(reader);
  ByteReader fields = whole.content;
  const std::uint32_t channel = channel_of(fields.u16("channel"));
  fields.u32("sequence of a message");
  const std::int64_t time = fields.nanoseconds("time of a message");
  if (whole.opcode != Opcode::message || channel != place.channel || time != place.time) {
    whole.content.fail("a record of opcode " + std::to_string(whole.opcode) + " at " +
                           std::to_string(time) + " ns",
                       "a message (opcode 5) of " + channels_[place.channel].topic + " at " +
                           std::to_string(place.time) + " ns, as the index says");
  }
  fields.u64("time of a message");
  return fields.take(fields.left(), "message");
}

/// Reads what is whole, and looks for the next chunk behind what is no record. The end of a file
/// that is not complete is just missing.
void McapRecording::scan(std::uint64_t data_start) {
  const std::uint64_t end = file_.size() - (is_closed_ ? magic_of_mcap.size() + footer_size : 0);
  for (std::uint64_t offset = data_start; end - offset >= record_head;) {
    const Bytes bytes = file_.read(offset, record_head, "record");
    ByteReader head = reader(offset, bytes);
    const std::uint8_t opcode = head.u8("opcode");
    const std::uint64_t length = head.u64("length of a record");
    const std::uint64_t room = end - offset - record_head;
    if (opcode == Opcode::data_end) break;
    const bool is_whole = opcode != 0 && length <= room;
    const bool is_known = opcode < first_unknown || opcode >= first_private;
    std::uint64_t next = offset + record_head + length;
    const std::int64_t last = last_scanned();
    bool is_lost = true;
    if (is_whole && is_known) {
      scan_record(opcode, offset, length);
      if (last_scanned() > last) skipped_.close(last_scanned());
    } else if (!is_whole) {
      const auto behind = opcode == Opcode::chunk ? scan_endless_chunk(offset, end) : std::nullopt;
      is_lost = !behind;
      next = behind ? *behind : next_chunk(offset + 1, end);
    }
    if (!(is_whole && is_known) && (is_closed_ || next < end)) {
      const auto fail = [&] {
        file_.fail(offset,
                   "a record of opcode " + std::to_string(opcode) + " and " +
                       std::to_string(length) + " bytes",
                   "one of opcode 1 to 15, or 128 to 255, and at most " + std::to_string(room));
      };
      is_lost ? skipped_.guard_open(last, fail) : skipped_.guard(no_time, fail);
    }
    offset = next;
  }
  keep_chunk(std::move(loose_));
}

/// Of the messages that scan() found so far.
std::int64_t McapRecording::last_scanned() const {
  const std::int64_t loose = loose_.places.empty() ? earliest : loose_.places.back().time;
  return chunks_.empty() ? loose : std::max(loose, chunks_.back().end);
}

void McapRecording::scan_record(std::uint8_t opcode, std::uint64_t offset, std::uint64_t length) {
  const std::uint64_t content = offset + record_head;
  if (opcode == Opcode::schema || opcode == Opcode::channel) {
    skipped_.guard(no_time, [&] {
      const Bytes bytes = file_.read(content, length, "record");
      opcode == Opcode::schema ? read_schema(reader(content, bytes))
                               : read_channel(reader(content, bytes));
    });
  } else if (opcode == Opcode::message) {
    const Bytes bytes = file_.read(content, std::min(length, message_head), "message");
    scan_message({offset, {last_scanned(), latest}}, reader(content, bytes), loose_.places);
  } else if (opcode == Opcode::chunk) {
    scan_chunk(offset, length);
  }
}

void McapRecording::scan_chunk(std::uint64_t offset, std::uint64_t length, bool is_endless) {
  RecordedChunk chunk;
  chunk.is_endless = is_endless;
  chunk.offset = offset;
  chunk.length = record_head + length;
  chunk.start = earliest;
  chunk.end = latest;
  const auto read_times = [&] {
    const TimeRange times = head_of(offset + record_head, length).times;
    chunk.start = times.from;
    chunk.end = times.to;
  };
  Bytes content;
  if (skipped_.guard_open(last_scanned(), read_times) &&
      skipped_.guard(chunk.times(), [&] { content = load(offset + record_head, length); })) {
    scan_content(chunk, content.view(), chunk.places);
    keep_chunk(std::move(chunk));
  } else {
    take_channels_of_damaged(offset + record_head, length);
  }
}

/// A chunk of which the record's length is damaged, by the lengths in it. @return where the next
/// record begins; nothing if it is no chunk
std::optional<std::uint64_t> McapRecording::scan_endless_chunk(std::uint64_t offset,
                                                               std::uint64_t end) {
  try {
    const std::uint64_t content = offset + record_head;
    const McapChunkHead head = head_of(content, end - content);
    scan_chunk(offset, head.data + head.length - content, true);
    return head.data + head.length;
  } catch (const Unsupported&) {
    throw;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// What topics its messages and those of later chunks are of, as far as it is whole.
void McapRecording::take_channels_of_damaged(std::uint64_t offset, std::uint64_t length) {
  is_damaged_ = true;
  try {
    const Bytes content = unpack(offset, head_of(offset, length));
    for (ByteReader all({file_, 0, offset}, content.view()); all.left() > 0;) {
      const Record record = next_record(all);
      if (record.opcode == Opcode::schema) read_schema(record.content);
      if (record.opcode == Opcode::channel) read_channel(record.content);
    }
  } catch (const Unsupported&) {
    throw;
  } catch (const Error&) {
    // the damage is noted already
  }
  is_damaged_ = false;
}

void McapRecording::scan_content(const RecordedChunk& chunk, std::string_view content,
                                 std::vector<MessagePlace>& places) {
  skipped_.guard(chunk.times(), [&] {
    for (ByteReader all({file_, 0, chunk.offset}, content); all.left() > 0;) {
      const std::uint64_t place = all.offset();
      const Record record = next_record(all);
      if (record.opcode == Opcode::message) {
        scan_message({place, chunk.times()}, record.content, places);
      }
      if (record.opcode != Opcode::schema && record.opcode != Opcode::channel) continue;
      skipped_.guard(no_time, [&] {
        record.opcode == Opcode::schema ? read_schema(record.content)
                                        : read_channel(record.content);
      });
    }
  });
}

void McapRecording::scan_message(const ScannedPlace& place, ByteReader fields,
                                 std::vector<MessagePlace>& places) {
  Loss loss{place.times};
  skipped_.guard(loss, [&] {
    const std::uint16_t id = fields.u16("channel");
    const std::uint32_t channel = channel_of(id);
    if (channel < channels_.size()) loss.topics = {channels_[channel].topic};
    if (channel == channels_.size()) {
      fields.fail("a message of channel " + std::to_string(id), "a channel that comes before");
    }
    fields.u32("sequence of a message");
    const std::int64_t time = fields.nanoseconds("time of a message");
    places.push_back({time, place.offset, 0, channel});
  });
  if (++places_ > most_places) {
    file_.refuse("has no index and more than " + std::to_string(most_places) +
                 " messages; 'mcap recover' writes one with an index");
  }
}

/// By the lengths of the record, of the name of its compression and of its data, which must agree.
bool McapRecording::begins_chunk(std::string_view bytes, std::uint64_t left) const {
  if (bytes.size() < record_head + chunk_head + 8 || bytes[0] != Opcode::chunk) return false;
  const auto number = [&](std::size_t at) { return load_u64(bytes.substr(at)); };
  const std::uint64_t length = number(1);
  const std::uint64_t name = number(record_head + 28) & 0xFFFFFFFF;
  if (length > left - record_head || (name != 0 && name != 3 && name != 4)) return false;
  if (bytes.size() < record_head + chunk_head + name + 8) return false;
  return number(record_head + chunk_head + name) == length - chunk_head - name - 8;
}

}  // namespace

std::unique_ptr<Container> open_mcap_recording(const std::string& path, SkippedParts& skipped) {
  return std::make_unique<McapRecording>(path, skipped);
}

}  // namespace excavplan
