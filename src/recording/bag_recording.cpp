// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "base/text.hpp"
#include "recording/chunked_container.hpp"
#include "recording/compression.hpp"

// The format is that of http://wiki.ros.org/Bags/Format/2.0.

namespace excavplan {
namespace {

constexpr std::string_view bag_2_magic = "#ROSBAG V2.0\n";
constexpr std::uint64_t longest_header = 1 << 16;  // of a chunk or a bag; ours [byte]

constexpr std::size_t most_fields = 100;  // of a header; ours

/// What kind a record is of.
struct Op {
  enum : std::uint64_t {
    message = 2,
    bag = 3,
    index = 4,
    chunk = 5,
    chunk_info = 6,
    connection = 7
  };
};

/// The fields "name=value" of a header.
class Fields {
 public:
  explicit Fields(ByteReader reader) : before_(reader) {
    while (reader.left() > 0) {
      ByteReader field = reader.part("field of a header");
      const std::string_view text = field.take(field.left(), "field");
      const std::size_t equals = text.find('=');
      if (equals == text.npos) reader.fail("the field " + in_quotes(text), "one with '='");
      values_.emplace_back(text.substr(0, equals), text.substr(equals + 1));
      if (values_.size() > most_fields) before_.fail("a header of more fields", "at most 100");
    }
  }

  bool has(std::string_view name) const { return find(name).has_value(); }
  std::string_view text(std::string_view name) const {
    const auto value = find(name);
    if (!value) before_.fail("a header without " + in_quotes(name), "one with it");
    return *value;
  }
  std::uint64_t number(std::string_view name, std::size_t size) const {
    const std::string_view value = text(name);
    if (value.size() != size) {
      before_.fail(in_quotes(name) + " of " + std::to_string(value.size()) + " bytes",
                   std::to_string(size));
    }
    std::uint64_t out = 0;
    for (std::size_t i = size; i-- > 0;) out = out << 8 | static_cast<unsigned char>(value[i]);
    return out;
  }
  std::uint32_t u32(std::string_view name) const {
    return static_cast<std::uint32_t>(number(name, 4));
  }
  void require_op(std::uint64_t op) const {
    const std::uint64_t found = number("op", 1);
    if (found == op) return;
    before_.fail("a record of op " + std::to_string(found), "op " + std::to_string(op));
  }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    before_.fail(found, expected);
  }

 private:
  std::optional<std::string_view> find(std::string_view name) const {
    for (const auto& [field, value] : values_) {
      if (field == name) return value;
    }
    return std::nullopt;
  }

  ByteReader before_;
  std::vector<std::pair<std::string_view, std::string_view>> values_;
};

constexpr std::int64_t time_of(std::uint64_t seconds, std::uint64_t nanoseconds) {
  return static_cast<std::int64_t>(seconds * 1'000'000'000 + nanoseconds);
}

/// A time as a header has it, the seconds first.
std::int64_t time_field(const Fields& fields, std::string_view name) {
  const std::uint64_t both = fields.number(name, 8);
  return time_of(both & 0xFFFFFFFF, both >> 32);
}

/// The header of a Chunk record and where its data lie.
struct BagChunkHead {
  std::string compression;
  std::uint64_t uncompressed = 0;  // [byte]
  std::uint64_t data = 0;          // where in the file
  std::uint64_t length = 0;        // [byte]
};

class BagRecording : public ChunkedContainer {
 public:
  BagRecording(const std::string& path, SkippedParts& skipped) : ChunkedContainer(path, skipped) {
    require_version();
    bool has_index = false;
    skipped_.guard(no_time, [&] { has_index = read_index(); });
    if (!has_index) {
      forget_index();
      scan();
    }
    finish();
  }

  bool is_cut_off() const override { return is_cut_off_; }

 private:
  void list(std::uint32_t chunk, const std::vector<bool>& wanted,
            std::vector<MessagePlace>& places) const override;
  void scan_content(const RecordedChunk& chunk, std::string_view content,
                    std::vector<MessagePlace>& places) override;
  bool begins_chunk(std::string_view bytes, std::uint64_t left) const override;
  Bytes load(const RecordedChunk& chunk) const override;
  std::string_view message_at(const MessagePlace& place) override;

  void require_version() const;
  bool read_index();
  void read_records(std::uint64_t start, const Fields& bag);
  void take_connection(const Fields& fields, ByteReader content, const ByteReader& place);
  void read_chunk_info(ByteReader& records, std::uint64_t end);
  void bound_chunks(std::uint64_t end);
  void scan();
  std::uint64_t scan_record(std::uint64_t offset);
  std::int64_t last_scanned() const;
  void scan_chunk(std::uint64_t offset, std::uint64_t length);
  Bytes header_at(std::uint64_t offset) const;
  BagChunkHead head_of(const RecordedChunk& chunk) const;

  bool is_cut_off_ = false;
};

void BagRecording::require_version() const {
  const Bytes start =
      file_.read(0, std::min<std::uint64_t>(file_.size(), bag_2_magic.size()), "magic");
  if (start.view() != bag_2_magic) {
    file_.fail(0, in_quotes(start.view()),
               "'#ROSBAG V2.0'; 'rosbag fix' converts bags of earlier versions");
  }
}

/// @return false if the bag has none, as its recording was cut off
bool BagRecording::read_index() {
  const Bytes bytes = header_at(bag_2_magic.size());
  const Fields fields(ByteReader({file_, bag_2_magic.size() + 4}, bytes.view()));
  fields.require_op(Op::bag);
  if (fields.has("encryptor") && !fields.text("encryptor").empty()) {
    file_.refuse("is encrypted by " + in_quotes(fields.text("encryptor")) +
                 ", which is not supported");
  }
  const std::uint64_t index = fields.number("index_pos", 8);
  is_cut_off_ = index == 0 || index >= file_.size();
  if (is_cut_off_) return false;
  read_records(index, fields);
  return true;
}

/// The header of a record, without its length before it.
Bytes BagRecording::header_at(std::uint64_t offset) const {
  const Bytes bytes = file_.read(offset, 4, "length of a header");
  const std::uint32_t length = ByteReader({file_, offset}, bytes.view()).u32("length of a header");
  if (length > longest_header) {
    file_.fail(offset, "a header of " + std::to_string(length) + " bytes",
               "at most " + std::to_string(longest_header));
  }
  return file_.read(offset + 4, length, "header of a record");
}

/// @param bag the header that says how many records the index has
void BagRecording::read_records(std::uint64_t start, const Fields& bag) {
  const std::uint32_t connections = bag.u32("conn_count");
  const std::uint32_t chunks = bag.u32("chunk_count");
  if (file_.size() - start > most_index_bytes) {
    file_.fail(bag_2_magic.size(), "an index at byte " + std::to_string(start),
               "one of at most " + std::to_string(most_index_bytes) + " bytes in the " +
                   std::to_string(file_.size()) + " of the file");
  }
  const Bytes bytes = file_.read(start, file_.size() - start, "index");
  ByteReader records({file_, start}, bytes.view());
  for (std::uint32_t i = 0; i < connections; ++i) {
    const Fields fields(records.part("header of a connection"));
    fields.require_op(Op::connection);
    take_connection(fields, records.part("connection"), records);
  }
  for (std::uint32_t i = 0; i < chunks; ++i) read_chunk_info(records, start);
  bound_chunks(start);
}

/// A bag without an index from front to back: chunks and what connects their messages with topics.
/// The last record of one that was cut off is just not whole.
void BagRecording::scan() {
  for (std::uint64_t offset = bag_2_magic.size(); offset < file_.size();) {
    try {
      offset = scan_record(offset);
    } catch (const Unsupported&) {
      throw;
    } catch (const Error& error) {
      offset = next_chunk(offset + 1, file_.size());
      if (!is_cut_off_ || offset < file_.size()) skipped_.add_open(error.what(), last_scanned());
    }
  }
}

/// @return where the next one begins
std::uint64_t BagRecording::scan_record(std::uint64_t offset) {
  const Bytes bytes = header_at(offset);
  const Fields fields(ByteReader({file_, offset + 4}, bytes.view()));
  const std::uint64_t op = fields.number("op", 1);
  const std::uint64_t after = offset + 4 + bytes.size();
  const Bytes four = file_.read(after, 4, "length of a record");
  const std::uint64_t length = ByteReader({file_, after}, four.view()).u32("length of a record");
  const std::uint64_t end = after + 4 + length;
  if (end > file_.size()) {
    file_.fail(after, "a record of " + std::to_string(length) + " bytes",
               "one that ends before byte " + std::to_string(file_.size()));
  }
  if (op == Op::chunk) scan_chunk(offset, end - offset);
  if (op == Op::connection) {
    const Bytes content = file_.read(after + 4, length, "connection");
    const ByteReader reader({file_, after + 4}, content.view());
    take_connection(fields, reader, reader);
  }
  return end;
}

/// Of the messages that scan() found so far.
std::int64_t BagRecording::last_scanned() const {
  return chunks_.empty() ? earliest : chunks_.back().end;
}

void BagRecording::scan_chunk(std::uint64_t offset, std::uint64_t length) {
  RecordedChunk chunk;
  chunk.offset = offset;
  chunk.length = length;
  chunk.start = last_scanned();
  chunk.end = latest;
  Bytes content;
  if (!skipped_.guard_open(chunk.start, [&] { content = load(chunk); })) return;
  scan_content(chunk, content.view(), chunk.places);
  keep_chunk(std::move(chunk));
  if (last_scanned() > earliest) skipped_.close(last_scanned());
}

void BagRecording::scan_content(const RecordedChunk& chunk, std::string_view content,
                                std::vector<MessagePlace>& places) {
  skipped_.guard(chunk.times(), [&] {
    for (ByteReader all({file_, 0, chunk.offset}, content); all.left() > 0;) {
      const std::uint64_t place = all.offset();
      const Fields fields(all.part("header of a record"));
      const std::uint64_t op = fields.number("op", 1);
      const ByteReader inside = all.part("record");
      Loss loss{op == Op::message ? chunk.times() : no_time};
      skipped_.guard(loss, [&] {
        if (op == Op::connection) take_connection(fields, inside, all);
        if (op != Op::message) return;
        const std::uint32_t id = fields.u32("conn");
        const std::uint32_t channel = channel_of(id);
        if (channel < channels_.size()) loss.topics = {channels_[channel].topic};
        if (channel == channels_.size()) {
          fields.fail("a message of connection " + std::to_string(id), "one that comes before");
        }
        places.push_back({time_field(fields, "time"), place, 0, channel});
      });
      if (places.size() > most_places) {
        file_.refuse("has a chunk of more than " + std::to_string(most_places) + " messages");
      }
    }
  });
}

/// By its header: a few short fields, one of them "op=" of a chunk.
bool BagRecording::begins_chunk(std::string_view bytes, std::uint64_t /*left*/) const {
  constexpr std::string_view op_of_chunk = "op=\x05";
  if (bytes.size() < 40 || bytes[1] != 0 || bytes[2] != 0 || bytes[3] != 0) return false;
  const std::size_t size = static_cast<unsigned char>(bytes[0]);
  const std::string_view header = bytes.substr(4, size);
  return size >= 40 && header.size() == size && bytes[5] == 0 && bytes[6] == 0 && bytes[7] == 0 &&
         header.find(op_of_chunk) != header.npos && header.find("compression=") != header.npos;
}

void BagRecording::take_connection(const Fields& fields, ByteReader content,
                                   const ByteReader& place) {
  const Fields about(content);
  RecordedChannel channel;
  channel.id = fields.u32("conn");
  channel.topic = fields.text("topic");
  channel.type = ros2_type(about.text("type"));
  channel.serialization = Serialization::ros1;
  add_channel(std::move(channel), place);
}

void BagRecording::read_chunk_info(ByteReader& records, std::uint64_t end) {
  const Fields fields(records.part("header of a chunk's info"));
  fields.require_op(Op::chunk_info);
  RecordedChunk chunk;
  chunk.offset = fields.number("chunk_pos", 8);
  chunk.start = time_field(fields, "start_time");
  chunk.end = time_field(fields, "end_time");
  if (chunk.offset < bag_2_magic.size() || chunk.offset >= end) {
    fields.fail("a chunk at byte " + std::to_string(chunk.offset),
                "one before the index at byte " + std::to_string(end));
  }
  ByteReader counts = records.part("counts of a chunk");
  for (std::uint32_t i = fields.u32("count"); i > 0; --i) {
    const std::uint32_t id = counts.u32("connection");
    const std::uint32_t number = channel_of(id);
    if (number == channels_.size()) {
      counts.fail("messages of connection " + std::to_string(id), "a connection of the index");
    }
    channels_[number].messages += counts.u32("count of messages");
    chunk.channels.emplace_back(number, 0);
  }
  require_order(chunk, records);
  chunks_.push_back(std::move(chunk));
}

/// A chunk and its index end where the next one begins, so that no part of a file is read twice.
void BagRecording::bound_chunks(std::uint64_t end) {
  std::sort(chunks_.begin(), chunks_.end(),
            [](const RecordedChunk& a, const RecordedChunk& b) { return a.offset < b.offset; });
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const std::uint64_t next = i + 1 < chunks_.size() ? chunks_[i + 1].offset : end;
    chunks_[i].length = next - chunks_[i].offset;
    if (chunks_[i].length > 0) continue;
    file_.fail(next, "two chunks at this place, by the index", "one");
  }
}

BagChunkHead BagRecording::head_of(const RecordedChunk& chunk) const {
  const Bytes bytes = header_at(chunk.offset);
  const Fields fields(ByteReader({file_, chunk.offset + 4}, bytes.view()));
  fields.require_op(Op::chunk);
  const std::uint64_t after = chunk.offset + 4 + bytes.size();
  const Bytes length = file_.read(after, 4, "length of a chunk");
  BagChunkHead head;
  head.compression = fields.text("compression");
  head.uncompressed = fields.u32("size");
  head.length = ByteReader({file_, after}, length.view()).u32("length of a chunk");
  head.data = after + 4;
  const std::uint64_t end = chunk.offset + chunk.length;
  if (head.data > end || head.length > end - head.data) {
    file_.fail(after, "a chunk of " + std::to_string(head.length) + " bytes",
               "one that ends before byte " + std::to_string(end) + ", where the next one begins");
  }
  return head;
}

void BagRecording::list(std::uint32_t chunk, const std::vector<bool>& wanted,
                        std::vector<MessagePlace>& places) const {
  const RecordedChunk& listed = chunks_[chunk];
  const BagChunkHead head = head_of(listed);
  const std::uint64_t start = head.data + head.length;
  const std::uint64_t length = listed.offset + listed.length - start;
  if (length > most_index_bytes) {
    file_.fail(start, "an index of " + std::to_string(length) + " bytes",
               "at most " + std::to_string(most_index_bytes));
  }
  const Bytes bytes = file_.read(start, length, "index of a chunk");
  ByteReader records({file_, start}, bytes.view());
  for (std::size_t i = 0; i < listed.channels.size(); ++i) {
    const Fields fields(records.part("header of an index"));
    fields.require_op(Op::index);
    const std::uint32_t channel = channel_of(fields.u32("conn"));
    ByteReader entries = records.part("index of a chunk");
    if (channel == channels_.size())
      fields.fail("an index of no connection", "one of a connection");
    if (!wanted[channel]) continue;
    for (std::uint32_t k = fields.u32("count"); k > 0; --k) {
      const std::uint32_t seconds = entries.u32("time of a message");
      const std::uint32_t nanoseconds = entries.u32("time of a message");
      const std::uint32_t offset = entries.u32("offset of a message");
      places.push_back({time_of(seconds, nanoseconds), offset, chunk, channel});
    }
  }
}

Bytes BagRecording::load(const RecordedChunk& chunk) const {
  const BagChunkHead head = head_of(chunk);
  Bytes bytes = file_.read(head.data, head.length, "a chunk");
  if (head.compression == "lz4" || head.compression == "bz2") {
    const auto compression = head.compression == "lz4" ? Compression::lz4 : Compression::bz2;
    bytes = decompress({compression, bytes.view(), head.uncompressed, file_.path(),
                        "byte " + std::to_string(head.data)});
  } else if (head.compression != "none" || head.length != head.uncompressed) {
    file_.fail(chunk.offset,
               "a chunk of compression " + in_quotes(head.compression) + ", " +
                   std::to_string(head.length) + " bytes and " + std::to_string(head.uncompressed) +
                   " uncompressed",
               "compression lz4, bz2, or none and as many bytes");
  }
  return bytes;
}

std::string_view BagRecording::message_at(const MessagePlace& place) {
  std::string_view bytes = chunk_of(place);
  bytes.remove_prefix(std::min<std::uint64_t>(place.offset, bytes.size()));
  ByteReader record({file_, place.offset, chunks_[place.chunk].offset}, bytes);
  const Fields fields(record.part("header of a message"));
  fields.require_op(Op::message);
  const std::int64_t time = time_field(fields, "time");
  if (channel_of(fields.u32("conn")) != place.channel || time != place.time) {
    fields.fail("a message of connection " + std::to_string(fields.u32("conn")) + " at " +
                    std::to_string(time) + " ns",
                "one of " + channels_[place.channel].topic + " at " + std::to_string(place.time) +
                    " ns, as the index says");
  }
  return record.text("message");
}

}  // namespace

std::unique_ptr<Container> open_bag_recording(const std::string& path, SkippedParts& skipped) {
  return std::make_unique<BagRecording>(path, skipped);
}

}  // namespace excavplan
