// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include <excavplan/recording/recording.hpp>

#include "base/random.hpp"
#include "support/errors.hpp"
#include "support/recording_files.hpp"

namespace excavplan {
namespace {

using std::string;
using test::all_messages;
using test::content_of;
using test::error_about;
using test::recording;
using test::TempFolder;

void put(string& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  ASSERT_LE(at + size, bytes.size());
  for (std::size_t k = 0; k < size; ++k, value >>= 8) bytes[at + k] = static_cast<char>(value);
}

std::uint64_t get(const string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = size; k-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

/// A way to spoil a file, and how the error about it goes on after the place.
struct Damage {
  const char* name;
  std::function<void(string& bytes)> spoil;
  const char* expected;
};

using Messages = std::set<std::tuple<string, std::int64_t, string>>;

/// Of the topics that can be read at all.
Messages readable_messages(RecordingFile& file, string& said) {
  Messages found;
  for (const RecordedTopic& topic : file.topics()) {
    try {
      for (const test::KeptMessage& message : test::messages_of(file, {topic.name})) {
        found.emplace(message.topic, message.time, message.bytes);
      }
    } catch (const Unsupported& error) {
      said += error.what() + string("\n");
    }
  }
  for (const auto& [why, times] : file.skipped().parts()) said += why + "\n";
  return found;
}

/// What is said of a file; messages that it gives must be those of the whole one.
string said_of(const string& path, const Messages& whole) {
  string said;
  try {
    const auto file = open_recording(path);
    const Messages found = readable_messages(*file, said);
    EXPECT_TRUE(std::includes(whole.begin(), whole.end(), found.begin(), found.end())) << said;
    EXPECT_FALSE(found.empty()) << "nothing was left of it, which is an error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_file);
    said = error.what();
  }
  return said;
}

void expect_said(const string& name, const std::vector<Damage>& damages) {
  const TempFolder folder;
  string none;
  const Messages whole = readable_messages(*open_recording(recording(name)), none);
  for (const Damage& damage : damages) {
    SCOPED_TRACE(damage.name);
    string content = content_of(recording(name));
    damage.spoil(content);
    const string said = said_of(folder.write("damaged", content), whole);
    EXPECT_NE(said.find(damage.expected), string::npos) << said;
  }
}

constexpr std::uint64_t huge = std::uint64_t{1} << 62;

// ---- MCAP, by https://mcap.dev/spec

/// Where the k-th record of this opcode begins.
std::size_t mcap_record(const string& bytes, int opcode, int k = 0) {
  for (std::size_t at = 8; at + 9 <= bytes.size(); at += 9 + get(bytes, at + 1, 8)) {
    if (bytes[at] == opcode && k-- == 0) return at;
  }
  ADD_FAILURE() << "no record " << opcode;
  return 0;
}

/// Without the checksum of the summary, so that what follows it is looked at.
void drop_summary_crc(string& bytes) { put(bytes, bytes.size() - 12, 0, 4); }

/// Spoils a field of the k-th record of this opcode.
std::function<void(string&)> in_mcap(int opcode, int k, std::size_t field, std::uint64_t value,
                                     std::size_t size) {
  return [=](string& bytes) {
    drop_summary_crc(bytes);
    put(bytes, mcap_record(bytes, opcode, k) + field, value, size);
  };
}

// Places in a record: 0 opcode, 1 length, 9 the first field.
TEST(DamagedRecordings, OfMcapSayWhatIsWrong) {
  const std::size_t footer = 29 + 8;
  expect_said(
      "scene_none.mcap",
      {{"magic", [](string& b) { b[1] = 'm'; }, "byte 0: found '"},
       {"version", [](string& b) { b[5] = '1'; }, "the magic of MCAP version 0"},
       {"no header", in_mcap(1, 0, 0, 4, 1), "byte 8: found a record of opcode 4"},
       {"header length", in_mcap(1, 0, 1, huge, 8), "expected header (opcode 1) that ends before"},
       {"no footer", in_mcap(2, 0, 0, 3, 1), "expected footer (opcode 2)"},
       {"summary after the end", in_mcap(2, 0, 9, huge, 8), "found a summary from byte 46116860"},
       {"summary in the magic", in_mcap(2, 0, 9, 3, 8), "found a summary from byte 3, expected"},
       {"summary in the data", in_mcap(2, 0, 9, 60, 8), "byte "},
       {"summary CRC", [=](string& b) { b[b.size() - footer - 20] ^= 1; }, "a summary of CRC "},
       {"chunk CRC", in_mcap(6, 0, 9 + 60, 1, 1), "found a chunk of CRC "},
       {"chunk compression",
        [](string& b) {
          const std::size_t chunk = mcap_record(b, 6);
          put(b, chunk + 1, get(b, chunk + 1, 8) + 3, 8);  // as if three bytes longer
          b.insert(chunk + 9 + 28 + 4, "lz5");
          put(b, chunk + 9 + 28, 3, 4);
          const std::size_t magic_and_footer = b.size() - 37;
          put(b, magic_and_footer + 9, 0, 8);  // no summary: scanned
        },
        "a chunk compressed by 'lz5', expected lz4, zstd or none"},
       {"chunk's own size", in_mcap(6, 0, 9 + 16, 5, 8), "expected 5, as it says"},
       {"chunk's data", in_mcap(6, 0, 9 + 32, huge, 8), "found data of 4611686018427387904 bytes"},
       {"chunk's name", in_mcap(6, 0, 9 + 28, 0xFFFFFFFF, 4), "expected 4294967295 of compression"},
       {"no chunk", in_mcap(6, 0, 0, 9, 1), "expected chunk (opcode 6)"},
       {"chunk length", in_mcap(6, 0, 1, huge, 8), "expected chunk (opcode 6) that ends before"}});
}

TEST(DamagedRecordings, OfMcapWithWrongIndexesSayWhatIsWrong) {
  expect_said(
      "scene_none.mcap",
      {{"index of a chunk: start", in_mcap(8, 0, 9, ~std::uint64_t{0}, 8),
        "found a chunk from 9223372036854775807 to "},
       {"index of a chunk: end", in_mcap(8, 0, 17, 5, 8), "expected one that ends after its start"},
       {"index of a chunk: early end", in_mcap(8, 0, 17, 1'700'000'000'300'000'000, 8),
        "as the index of the file says"},
       {"index of a chunk: place", in_mcap(8, 0, 25, huge, 8), "none above the size of the file"},
       {"index of a chunk: length", in_mcap(8, 0, 33, huge, 8), "none above the size of the file"},
       {"index of a chunk: map", in_mcap(8, 0, 41, 0xFFFFFFF0, 4),
        "expected 4294967280 of offsets of message indexes"},
       {"two indexes of one chunk",
        [](string& b) {
          drop_summary_crc(b);
          const std::size_t first = mcap_record(b, 8, 0), second = mcap_record(b, 8, 1);
          const std::size_t count = get(b, first + 41, 4);
          if (count == get(b, second + 41, 4)) {
            b.replace(second, 9 + 44 + count, b.substr(first, 9 + 44 + count));
          }
          put(b, second + 25, get(b, first + 25, 8), 8);
        },
        "by"},
       {"channel twice", in_mcap(8, 0, 55, 0, 2), "two message indexes of channel 0"},
       {"message index elsewhere", in_mcap(8, 0, 47, 8, 8),
        "found a message index at byte 8, expected one in the"},
       {"no message index", in_mcap(7, 0, 0, 5, 1), "expected message index (opcode 7)"},
       {"message index length", in_mcap(7, 0, 1, huge, 8), "expected message index (opcode 7)"},
       {"message index channel", in_mcap(7, 0, 9, 77, 2), "found a message index of channel 77"},
       {"message index entries", in_mcap(7, 0, 11, 17, 4), "bytes left, expected "},
       {"message index time", in_mcap(7, 0, 15, 4, 8), "found a chunk with a message at 4 ns"},
       {"message index offset", in_mcap(7, 0, 23, huge, 8),
        "byte 4611686018427387904 of the chunk at byte"},
       {"message index offset of another record", in_mcap(7, 0, 23, 0, 8), "as the index says"},
       {"statistics", in_mcap(11, 0, 9 + 42, 0xFFFFFF, 4),
        "expected 16777215 of counts of messages"},
       {"record of the summary", in_mcap(8, 1, 1, huge, 8),
        "bytes left, expected 4611686018427387904 of record"},
       {"opcode 0", in_mcap(8, 1, 0, 0, 1), "a record of opcode 0, expected one of 1 to 255"}});
}

// Behind the data a file is not scanned: a summary that is damaged is told once.
TEST(DamagedRecordings, OfMcapWithADamagedSummaryAreScannedUpToTheEndOfTheirData) {
  const TempFolder folder;
  string content = content_of(recording("scene_none.mcap"));
  in_mcap(8, 1, 1, huge, 8)(content);
  const auto file = open_recording(folder.write("summary.mcap", content));
  EXPECT_EQ(all_messages(*file).size(), 38u);
  EXPECT_EQ(file->skipped().parts().size(), 1u);
}

/// Spoils the first message index of each chunk between two times [s of the scene].
/// @return how many
int spoil_indexes_between(string& bytes, double from, double to) {
  const auto time = [&](std::size_t at) {
    return 1e-9 * static_cast<double>(get(bytes, at, 8)) - 1.7e9;
  };
  int spoilt = 0;
  for (std::size_t at = mcap_record(bytes, 8); bytes[at] == 8; at += 9 + get(bytes, at + 1, 8)) {
    if (time(at + 9) < from || time(at + 17) > to) continue;
    put(bytes, get(bytes, at + 25, 8) + get(bytes, at + 33, 8), 5, 1);  // its opcode
    ++spoilt;
  }
  return spoilt;
}

// docs/formats.md: of a recording only what is asked for is read. The first messages of all topics
// are from 0 to 0.3 s, the last ones of those that go on from 4.3 s on.
TEST(DamagedRecordings, OfMcapInTheMiddleAreListedByTheirFirstAndLastChunks) {
  const TempFolder folder;
  string content = content_of(recording("scene_none.mcap"));
  ASSERT_GT(spoil_indexes_between(content, 0.4, 4.2), 0);
  const string path = folder.write("middle.mcap", content);
  const auto whole = open_recording(recording("scene_none.mcap"));
  const auto file = open_recording(path);
  ASSERT_EQ(file->topics().size(), whole->topics().size());
  for (std::size_t i = 0; i < file->topics().size(); ++i) {
    EXPECT_EQ(file->topics()[i].first, whole->topics()[i].first);
    EXPECT_EQ(file->topics()[i].last, whole->topics()[i].last);
  }
  string said;
  EXPECT_EQ(readable_messages(*file, said), readable_messages(*whole, said)) << "by the chunks";
  EXPECT_NE(said.find("expected message index"), string::npos) << said;
}

TEST(DamagedRecordings, OfMcapWithoutAnIndexSayWhatIsWrong) {
  expect_said(
      "scene_unchunked.mcap",
      {{"opcode 0", in_mcap(5, 0, 0, 0, 1), "a record of opcode 0"},
       {"length", in_mcap(5, 0, 1, huge, 8), "a record of opcode 5 and 4611686018427387904 bytes"},
       {"channel", in_mcap(5, 0, 9, 900, 2), "a message of channel 900, expected a channel that"},
       {"time", in_mcap(5, 0, 15, ~std::uint64_t{0}, 8), "time of a message 18446744073709551615"},
       {"short message", in_mcap(5, 0, 1, 5, 8), "bytes"},
       {"schema of a channel", in_mcap(4, 0, 11, 900, 2), "of schema 900, expected a schema that"},
       {"channel twice", in_mcap(4, 1, 9, 0, 2), "expected one topic and one type a channel"},
       {"schema twice", in_mcap(3, 2, 9, 1, 2), "found schema 1 of "},
       {"topic", in_mcap(4, 0, 13, 0xFFFFFFFF, 4), "expected 4294967295 of topic"}});
}

// ---- ROS 1 bags, by http://wiki.ros.org/Bags/Format/2.0

/// Where the value of the k-th field of this name begins.
std::size_t bag_field(const string& bytes, const string& name, int k = 0) {
  std::size_t at = bytes.find(name + "=");
  for (; k > 0 && at != bytes.npos; --k) at = bytes.find(name + "=", at + 1);
  EXPECT_NE(at, bytes.npos) << name;
  return at + name.size() + 1;
}

std::function<void(string&)> in_bag(const string& name, int k, std::uint64_t value,
                                    std::size_t size) {
  return [=](string& bytes) { put(bytes, bag_field(bytes, name, k), value, size); };
}

/// The same counted from the index at the end, of which the fields are the last ones.
std::function<void(string&)> in_bag_index(const string& name, int k, std::uint64_t value,
                                          std::size_t size) {
  return [=](string& bytes) {
    string index = bytes.substr(get(bytes, bag_field(bytes, "index_pos"), 8));
    const std::size_t start = bytes.size() - index.size();
    put(index, bag_field(index, name, k), value, size);
    bytes.replace(start, index.size(), index);
  };
}

TEST(DamagedRecordings, OfRos1SayWhatIsWrong) {
  const std::size_t chunk = 13 + 8 + 4096;  // after the bag's header, which is padded
  expect_said(
      "scene_none.bag",
      {{"version", [](string& b) { b[9] = '1'; }, "'rosbag fix' converts"},
       {"header length", [](string& b) { put(b, 13, 0xFFFFFFFF, 4); },
        "a header of 4294967295 bytes"},
       {"field length", [](string& b) { put(b, 17, 0xFFFFFF, 4); },
        "expected 16777215 of field of a header"},
       {"field without =", [](string& b) { b[23] = ' '; }, "expected one with '='"},
       {"op of the header", in_bag("op", 0, 9, 1), "a record of op 9, expected op 3"},
       {"index at the header", in_bag("index_pos", 0, 13, 8), "a record of op 3, expected op 7"},
       {"index at a chunk", in_bag("index_pos", 0, chunk, 8), "expected op 7"},
       {"too many connections", in_bag("conn_count", 0, 0xFFFFFFFF, 4),
        "a record of op 6, expected op 7"},
       {"too many chunks", in_bag("chunk_count", 0, 0xFFFFFFFF, 4),
        "found 0 bytes left, expected 4 of header of"},
       {"too few connections", in_bag("conn_count", 0, 1, 4), "a record of op 7, expected op 6"}});
}

TEST(DamagedRecordings, OfRos1WithWrongChunksSayWhatIsWrong) {
  expect_said(
      "scene_none.bag",
      {{"chunk in the index", in_bag_index("chunk_pos", 0, huge, 8),
        "found a chunk at byte 4611686018427387904, expected one before"},
       {"chunk in the magic", in_bag_index("chunk_pos", 0, 3, 8), "found a chunk at byte 3"},
       {"two chunks in one place",
        [](string& b) {
          const std::uint64_t index = get(b, bag_field(b, "index_pos"), 8);
          const string end = b.substr(index);
          const std::uint64_t second = get(end, bag_field(end, "chunk_pos", 1), 8);
          in_bag_index("chunk_pos", 0, second, 8)(b);
        },
        "found two chunks at this place"},
       {"chunk elsewhere", in_bag_index("chunk_pos", 1, 4200, 8), "byte 4"},
       {"counts", in_bag_index("count", 0, 0xFFFFFFFF, 4),
        "found 0 bytes left, expected 4 of connection"},
       {"times of a chunk", in_bag_index("end_time", 0, 0, 8), "expected one that ends after its"},
       {"start of a chunk", in_bag_index("start_time", 0, ~std::uint64_t{0}, 8),
        "expected one that ends after its start"},
       {"size of a time",
        [](string& b) {
          const std::size_t field = b.rfind("start_time=");
          b.replace(field, 11, "start=ime0=");
        },
        "a header without 'start_time'"},
       {"op of a chunk", in_bag("op", 1, 2, 1), "a record of op 2, expected op 5"},
       {"compression", [](string& b) { b.replace(b.find("=none"), 5, "=zstd"); },
        "compression 'zstd'"},
       {"size of a chunk", in_bag("size", 0, 0xFFFFFFFF, 4),
        "4294967295 uncompressed, expected compression lz4"},
       {"length of a chunk", [](string& b) { put(b, b.find("size=") + 9, 0x7FFFFFFF, 4); },
        "a chunk of 2147483647 bytes, expected one that ends"}});
}

TEST(DamagedRecordings, OfRos1WithWrongIndexesSayWhatIsWrong) {
  // The first index record of the first chunk: its header, 12 bytes an entry.
  const auto first_index = [](const string& b) { return b.find("ver=\1"); };
  const auto entry = [=](const string& b) {
    const std::size_t header_end = std::max(b.find("count=", first_index(b) - 60), first_index(b));
    for (std::size_t at = header_end - 80; at < b.size(); ++at) {
      if (get(b, at, 4) == 1'700'000'000 && at > header_end) return at;
    }
    return b.size();
  };
  expect_said(
      "scene_none.bag",
      {{"time", [=](string& b) { put(b, entry(b), 5, 4); }, "as the index of the file says"},
       {"place beyond the chunk", [=](string& b) { put(b, entry(b) + 8, 0xFFFFFFF0, 4); },
        "byte 4294967280 of the chunk at byte"},
       {"place of another record", [=](string& b) { put(b, entry(b) + 8, 0, 4); },
        "a record of op 7, expected op 2"},
       {"place between records",
        [=](string& b) { put(b, entry(b) + 8, get(b, entry(b) + 8, 4) + 2, 4); },
        "of the chunk at byte"},
       {"too many entries", [=](string& b) { put(b, b.find("count=", 4300) + 6, 0xFFFFFF, 4); },
        "bytes left, expected 4 of"}});
}

TEST(DamagedRecordings, ABagWithoutAnIndexIsReadFromFrontToBack) {
  const TempFolder folder;
  for (const char* name : {"scene_none.bag", "scene_lz4.bag", "scene_bz2.bag"}) {
    if (!test::missing_for(name).empty()) continue;
    string said;
    const Messages whole = readable_messages(*open_recording(recording(name)), said);
    for (const std::uint64_t index : {std::uint64_t{0}, huge}) {
      string content = content_of(recording(name));
      in_bag("index_pos", 0, index, 8)(content);
      const auto file = open_recording(folder.write("cut.bag", content));
      EXPECT_TRUE(file->is_cut_off());
      EXPECT_EQ(readable_messages(*file, said), whole);
      EXPECT_EQ(said, "") << name;
    }
  }
}

TEST(DamagedRecordings, AreReadUpToWhereTheyAreCutOff) {
  const TempFolder folder;
  for (const char* name : {"scene_none.mcap", "scene_none.bag"}) {
    SCOPED_TRACE(name);
    const string content = content_of(recording(name));
    string said;
    const Messages whole = readable_messages(*open_recording(recording(name)), said);
    std::size_t read = 0;
    for (std::size_t part = 1; part < 40; ++part) {
      const string path = folder.write("cut", content.substr(0, content.size() * part / 40));
      try {
        const auto file = open_recording(path);
        const Messages found = readable_messages(*file, said);
        EXPECT_TRUE(file->is_cut_off() || file->skipped().count() > 0) << part;
        EXPECT_TRUE(std::includes(whole.begin(), whole.end(), found.begin(), found.end())) << part;
        EXPECT_GE(found.size(), read) << part;
        read = found.size();
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_file);
        EXPECT_EQ(read, 0U) << part << ": " << error.what();
      }
    }
    EXPECT_GT(2 * read, whole.size());
  }
}

// SQLite would fill it with zeros.
TEST(DamagedRecordings, OfSqliteThatAreCutOffNameTheProgramThatSavesThem) {
  if (!test::missing_for("scene.db3").empty()) GTEST_SKIP();
  const TempFolder folder;
  const string content = content_of(recording("scene.db3"));
  for (std::size_t part = 1; part < 40; ++part) {
    const string path = folder.write("cut", content.substr(0, content.size() * part / 40));
    EXPECT_NE(error_about([&] { open_recording(path); }, path).find(".recover | sqlite3"),
              string::npos)
        << part;
  }
}

// What is changed at random is read, left out or refused, and nothing else.
TEST(DamagedRecordings, OfAnyKindAreReadOrRefused) {
  const TempFolder folder;
  Random random(7);
  int refused = 0;
  for (const char* name : {"scene.db3", "scene_zstd.db3", "scene_lz4.mcap", "scene_zstd.mcap",
                           "scene_unchunked.mcap", "scene_lz4.bag", "scene_bz2.bag"}) {
    const string content = content_of(recording(name));
    for (int k = 0; k < 40; ++k) {
      string spoilt = content;
      if (string(name).find(".mcap") != string::npos) drop_summary_crc(spoilt);
      const std::size_t at = random.index(spoilt.size() - 8);
      const std::size_t size = std::size_t{1} << random.index(4);
      put(spoilt, at, k % 3 == 0 ? ~std::uint64_t{0} : random.index(huge), size);
      const string path = folder.write("spoilt", spoilt);
      try {
        const auto file = open_recording(path);
        all_messages(*file);
        if (file->skipped().count() > 0) ++refused;
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(error.kind(), ErrorKind::bad_file);
        EXPECT_EQ(string(error.what()).substr(0, path.size() + 2), path + ": ");
      }
    }
  }
  EXPECT_GT(refused, 100);
}

// ---- What is spoilt spoils only itself

/// Of which topics how many messages are lost, "" where none is.
string lost_of(const Messages& whole, const Messages& found) {
  std::map<string, int> lost;
  for (const auto& message : whole) {
    if (found.count(message) == 0) ++lost[std::get<0>(message)];
  }
  string text;
  for (const auto& [topic, count] : lost) text += topic + " " + std::to_string(count) + " ";
  return text;
}

/// A file of which something is spoilt, and what is lost and said of it.
struct Spoilt {
  const char* file;
  std::function<void(string& bytes)> spoil;
  const char* lost;
  const char* said;
};

void expect_lost(const std::vector<Spoilt>& cases) {
  const TempFolder folder;
  for (const Spoilt& spoilt : cases) {
    if (!test::missing_for(spoilt.file).empty()) continue;
    string said;
    const auto good = open_recording(recording(spoilt.file));
    const Messages whole = readable_messages(*good, said);
    said.clear();
    string content = content_of(recording(spoilt.file));
    spoilt.spoil(content);
    const auto file = open_recording(folder.write("spoilt", content));
    const Messages found = readable_messages(*file, said);
    SCOPED_TRACE(spoilt.file + (": " + said));
    EXPECT_EQ(lost_of(whole, found), spoilt.lost);
    EXPECT_NE(said.find(spoilt.said), string::npos);
    EXPECT_GT(file->skipped().count(), 0U);
    // What is left of each topic is dated by itself.
    for (const RecordedTopic& topic : file->topics()) {
      if (topic.messages == 0) continue;
      EXPECT_GT(topic.first, 1'690'000'000'000'000'000) << topic.name;
      EXPECT_LT(topic.last, 1'710'000'000'000'000'000) << topic.name;
    }
  }
}

/// Writes the time of the k-th message of a channel of an MCAP file without chunks.
std::function<void(string&)> mcap_time(std::uint64_t channel, int k, std::uint64_t time) {
  return [=](string& bytes) {
    int found = 0;
    for (int i = 0;; ++i) {
      const std::size_t at = mcap_record(bytes, 5, i);
      if (get(bytes, at + 9, 2) != channel || found++ != k) continue;
      put(bytes, at + 15, time, 8);
      return;
    }
  };
}

/// The same of a connection of an uncompressed bag, whose index is then not looked at; 32 bits each
/// for seconds and nanoseconds.
std::function<void(string&)> bag_time(std::uint64_t connection, int k, std::uint64_t time) {
  return [=](string& bytes) {
    put(bytes, bag_field(bytes, "index_pos"), 0, 8);
    int found = 0;
    for (int i = 0;; ++i) {
      const std::size_t at = bag_field(bytes, "op", i);
      if (bytes[at] != 2) continue;  // a message
      const std::size_t conn = bytes.find("conn=", at - 40) + 5;
      if (get(bytes, conn, 4) != connection || found++ != k) continue;
      put(bytes, bytes.find("time=", at - 40) + 5, time, 8);
      return;
    }
  };
}

TEST(SpoiltRecordings, ABadTimeSpoilsItsMessageAlone) {
  constexpr std::uint64_t late = 3'000'000'000'000'000'000;  // ns: the year 2065
  constexpr std::uint64_t end = ~std::uint64_t{0};
  expect_lost({{"scene_unchunked.mcap", mcap_time(1, 0, end), "/tf 1 ", "below 2^63"},
               {"scene_unchunked.mcap", mcap_time(1, 3, 0), "/tf 1 ", "over a year from"},
               {"scene_unchunked.mcap", mcap_time(1, 3, late), "/tf 1 ", "over a year from"},
               {"scene_none.bag", bag_time(1, 0, 0), "/tf 1 ", "over a year from the others"},
               {"scene_none.bag", bag_time(1, 2, end), "/tf 1 ", "over a year from the others"}});
}

/// The channel of a topic of an MCAP file.
std::uint64_t mcap_channel(const string& bytes, const string& topic) {
  for (int i = 0;; ++i) {
    const std::size_t at = mcap_record(bytes, 4, i);
    if (bytes.substr(at + 17, get(bytes, at + 13, 4)) == topic) return get(bytes, at + 9, 2);
  }
}

TEST(SpoiltRecordings, AMessageWithABadTimeIsLostToItsTopicAlone) {
  const TempFolder folder;
  for (const string topic : {"/tf", "/lidar/points"}) {
    string content = content_of(recording("scene_unchunked.mcap"));
    mcap_time(mcap_channel(content, topic), 1, ~std::uint64_t{0})(content);
    const auto file = open_recording(folder.write("spoilt", content));
    const TimeRange ever;
    EXPECT_TRUE(file->skipped().first_lost(topic, ever)) << topic;
    EXPECT_FALSE(file->skipped().first_lost(topic == "/tf" ? "/lidar/points" : "/tf", ever));
  }
}

/// A chunk with an index is read only if it is asked for.
TEST(SpoiltRecordings, AllDamagedChunksAreToldWhereTheContentsAre) {
  const TempFolder folder;
  string content = content_of(recording("scene_none.mcap"));
  EXPECT_TRUE(describe_recording(recording("scene_none.mcap")).damage.empty());
  for (const int chunk : {1, 2}) {
    const std::size_t at = mcap_record(content, 6, chunk);
    content[at + get(content, at + 1, 8) / 2] ^= 0x55;
  }
  const RecordingContents contents = describe_recording(folder.write("spoilt", content));
  EXPECT_EQ(contents.damaged_parts, 2U);
  ASSERT_EQ(contents.damage.size(), 2U);
  for (const string& each : contents.damage) {
    EXPECT_NE(each.find("found a chunk of CRC"), string::npos) << each;
  }
}

/// Changes bytes in the middle of the k-th chunk of an MCAP file; without its index if so.
std::function<void(string&)> mcap_chunk(int k, bool without_index) {
  return [=](string& bytes) {
    const std::size_t chunk = mcap_record(bytes, 6, k);
    for (std::size_t i = 0; i < 4; ++i) bytes[chunk + get(bytes, chunk + 1, 8) / 2 + i] ^= 0x55;
    if (without_index) put(bytes, mcap_record(bytes, 2) + 9, 0, 8);
  };
}

/// Where the k-th chunk of a bag begins.
std::size_t bag_chunk(const string& bytes, int k) {
  std::size_t at = bytes.find("compression=");
  while (k-- > 0) at = bytes.find("compression=", at + 1);
  return at - 8;
}

TEST(SpoiltRecordings, AChunkSpoilsItsMessagesAlone) {
  const auto in_bag_chunk = [](int k, bool without_index) {
    return [=](string& bytes) {
      const std::size_t chunk = bag_chunk(bytes, k);
      const std::size_t next = bag_chunk(bytes, k + 1);
      for (std::size_t i = 0; i < 40; ++i) bytes[chunk + (next - chunk) / 3 + i] ^= 0x55;
      if (without_index) put(bytes, bag_field(bytes, "index_pos"), 0, 8);
    };
  };
  const TempFolder folder;
  for (const char* name :
       {"scene_lz4.mcap", "scene_zstd.mcap", "scene_none.mcap", "scene_bz2.bag", "scene_lz4.bag"}) {
    if (!test::missing_for(name).empty()) continue;
    for (const bool without_index : {false, true}) {
      for (const int chunk : {1, 2}) {
        SCOPED_TRACE(string(name) + ' ' + std::to_string(chunk));
        string said;
        const Messages whole = readable_messages(*open_recording(recording(name)), said);
        string content = content_of(recording(name));
        const bool is_bag = string(name).find(".bag") != string::npos;
        (is_bag ? std::function<void(string&)>(in_bag_chunk(chunk, without_index))
                : mcap_chunk(chunk, without_index))(content);
        said.clear();
        const auto file = open_recording(folder.write("spoilt", content));
        const Messages found = readable_messages(*file, said);
        EXPECT_TRUE(std::includes(whole.begin(), whole.end(), found.begin(), found.end()));
        EXPECT_LT(found.size(), whole.size());
        EXPECT_GT(found.size(), whole.size() / 2);
        EXPECT_EQ(file->skipped().count(), 1U) << said;
      }
    }
  }
}

TEST(SpoiltRecordings, ARecordWithoutAnEndIsPassedOver) {
  const TempFolder folder;
  string said;
  for (const char* name : {"scene_none.mcap", "scene_none.bag"}) {
    SCOPED_TRACE(name);
    const Messages whole = readable_messages(*open_recording(recording(name)), said);
    string content = content_of(recording(name));
    if (string(name) == "scene_none.bag") {
      put(content, bag_chunk(content, 1), 0xFFFFFF, 4);  // the length of its first field
      put(content, bag_field(content, "index_pos"), 0, 8);
    } else {
      put(content, content.size() - 37 + 9, 0, 8);  // no summary
      put(content, mcap_record(content, 6, 1) + 1, huge, 8);
    }
    const auto file = open_recording(folder.write("endless", content));
    const Messages found = readable_messages(*file, said);
    EXPECT_TRUE(std::includes(whole.begin(), whole.end(), found.begin(), found.end()));
    // A chunk of MCAP tells its length twice.
    const bool is_lost = string(name) == "scene_none.bag";
    EXPECT_EQ(found.size() < whole.size(), is_lost);
    EXPECT_GT(found.size(), whole.size() / 2);
    EXPECT_GT(file->skipped().count(), 0U);
  }
}

// ---- Data that promise or deliver too much

string field(std::uint64_t value, std::size_t size) {
  string bytes(size, '\0');
  put(bytes, 0, value, size);
  return bytes;
}

string record(int opcode, const string& content) {
  return string(1, static_cast<char>(opcode)) + field(content.size(), 8) + content;
}

/// An MCAP file of one chunk without summary.
string mcap_of_chunk(const string& compression, const string& data, std::uint64_t promised) {
  const string magic = "\x89MCAP0\r\n";
  return magic + record(1, field(0, 8)) +
         record(6, field(0, 16) + field(promised, 8) + field(0, 4) + field(compression.size(), 4) +
                       compression + field(data.size(), 8) + data) +
         record(15, field(0, 4)) + record(2, field(0, 20)) + magic;
}

/// A frame of so many blocks of 128 KiB, each of 4 bytes (RFC 8878, 3.1.1).
[[maybe_unused]] string zstd_bomb(std::uint64_t blocks) {
  constexpr std::uint64_t block_size = 1 << 17;
  string frame = "\x28\xB5\x2F\xFD\xE0" + field(blocks * block_size, 8);  // one segment, its size
  for (std::uint64_t k = 1; k <= blocks; ++k) {
    frame += field((k == blocks ? 1 : 0) | 1 << 1 | block_size << 3, 3) + "a";
  }
  return frame;
}

std::uint64_t most_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

TEST(DamagedRecordings, NeverTakeTheMemoryThatTheyPromiseToFill) {
  const TempFolder folder;
  const auto error_of = [&](const string& content) {
    const string path = folder.write("bomb.mcap", content);
    return error_about([&] { open_recording(path); }, path);
  };
  const std::uint64_t before = most_memory();
  constexpr std::uint64_t limit = 1 << 30;
  EXPECT_NE(error_of(mcap_of_chunk("lz4", "abc", limit + 1)).find("expected at most 1073741824"),
            string::npos);
#ifdef EXCAVPLAN_WITH_LZ4
  EXPECT_NE(error_of(mcap_of_chunk("lz4", "abc", limit)).find("damaged compressed data"),
            string::npos);
  EXPECT_NE(error_of(mcap_of_chunk("lz4", "", limit)).find("found "), string::npos);
#endif
#ifdef EXCAVPLAN_WITH_ZSTD
  const string bomb = zstd_bomb(16);  // 2 MiB
  EXPECT_NE(error_of(mcap_of_chunk("zstd", bomb, 1000)).find("damaged compressed data"),
            string::npos);
  EXPECT_NE(error_of(mcap_of_chunk("zstd", bomb, limit))
                .find("hold 2097152 bytes, expected the 1073741824 that it says to hold"),
            string::npos);
  EXPECT_NE(error_of(mcap_of_chunk("zstd", zstd_bomb(100000), 13107200000)).find("at most"),
            string::npos);
  // What it holds are no records: 'a' is an opcode of no meaning, and its length is too large.
  EXPECT_NE(error_of(mcap_of_chunk("zstd", bomb, 2097152)).find("bytes left, expected"),
            string::npos);
#endif
  EXPECT_LT(most_memory() - before, std::uint64_t{1} << 28);
}

}  // namespace
}  // namespace excavplan
