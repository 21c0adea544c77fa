// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#ifdef EXCAVPLAN_WITH_SQLITE3
#include <sqlite3.h>
#endif

#include "recording/compression.hpp"
#include "support/errors.hpp"
#include "support/recording_files.hpp"

namespace excavplan {
namespace {

using std::string;
using test::all_messages;
using test::content_of;
using test::error_about;
using test::messages_of;
using test::missing_for;
using test::recording;
using test::TempFolder;

constexpr std::int64_t second = 1'000'000'000;
constexpr std::int64_t scene_start = 1'700'000'000 * second;  // data/README.md

/// The messages of the scene as another container has them, or in the other serialization.
std::vector<test::KeptMessage> reference(Serialization serialization) {
  const bool is_cdr = serialization == Serialization::cdr;
  return all_messages(*open_recording(recording(is_cdr ? "scene_none.mcap" : "scene_none.bag")));
}

/// Every file of tests/recording/data; what it holds is in the README there.
class SceneFile : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const string missing = missing_for(GetParam());
    if (missing.empty()) return;
    EXPECT_NE(test::error_of([&] { all_messages(*open_recording(path())); }, ErrorKind::bad_file)
                  .find(missing),
              string::npos);
    GTEST_SKIP() << "built without " << missing;
  }
  static string path() { return recording(GetParam()); }
};

TEST_P(SceneFile, ListsTheTopics) {
  struct Expected {
    const char* name;
    const char* type;
    std::uint64_t messages;
    double first, last;  // [s]
  };
  constexpr Expected expected[] = {
      {"/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", 5, 0.3, 4.3},
      {"/camera/depth/image_raw", "sensor_msgs/msg/Image", 5, 0.3, 4.3},
      {"/joint_states", "sensor_msgs/msg/JointState", 10, 0.1, 4.6},
      {"/lidar/points", "sensor_msgs/msg/PointCloud2", 6, 0.25, 4.75},
      {"/tf", "tf2_msgs/msg/TFMessage", 11, 0.0, 5.0},
      {"/tf_static", "tf2_msgs/msg/TFMessage", 1, 0.0, 0.0},
  };
  EXPECT_TRUE(is_recording(path()));
  const auto file = open_recording(path());
  EXPECT_EQ(file->path(), path());
  EXPECT_EQ(file->start(), scene_start);
  std::vector<RecordedTopic> topics = file->topics();
  topics.erase(std::remove_if(topics.begin(), topics.end(),
                              [](const RecordedTopic& topic) { return topic.name == "/status"; }),
               topics.end());
  ASSERT_EQ(topics.size(), std::size(expected));
  for (std::size_t i = 0; i < topics.size(); ++i) {
    EXPECT_EQ(topics[i].name, expected[i].name);
    EXPECT_EQ(topics[i].type, expected[i].type);
    EXPECT_EQ(topics[i].messages, expected[i].messages) << topics[i].name;
    EXPECT_EQ(topics[i].first, scene_start + std::llround(expected[i].first * 1e9));
    EXPECT_EQ(topics[i].last, scene_start + std::llround(expected[i].last * 1e9));
  }
}

TEST_P(SceneFile, HoldsTheSameMessagesAsTheOthers) {
  const auto file = open_recording(path());
  const std::vector<string> topics = {"/tf_static",
                                      "/tf",
                                      "/joint_states",
                                      "/lidar/points",
                                      "/camera/depth/image_raw",
                                      "/camera/depth/camera_info"};
  const auto messages = messages_of(*file, topics);
  ASSERT_EQ(messages.size(), 38u);
  const auto expected = reference(messages[0].serialization);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_GE(messages[i].time, i == 0 ? 0 : messages[i - 1].time);
    // Messages of one time come in the order in which each container has them.
    const auto found = std::find_if(expected.begin(), expected.end(), [&](const auto& other) {
      return other.topic == messages[i].topic && other.time == messages[i].time;
    });
    ASSERT_NE(found, expected.end()) << messages[i].place;
    EXPECT_EQ(messages[i].bytes, found->bytes) << messages[i].place;
  }
}

TEST_P(SceneFile, ShowsTheMessagesOfAnInterval) {
  const auto file = open_recording(path());
  const auto at = [](double seconds) { return scene_start + std::llround(seconds * 1e9); };
  const auto messages = messages_of(*file, {"/lidar/points", "/tf", "/absent"}, at(1.15), at(2.0));
  std::vector<string> found;
  for (const auto& message : messages) found.push_back(message.place);
  EXPECT_EQ(found, (std::vector<string>{"message of /lidar/points at 0.900 s",
                                        "message of /tf at 1.500 s", "message of /tf at 2.000 s"}));
  EXPECT_TRUE(messages_of(*file, {"/tf"}, at(5.0) + 1).empty());
  EXPECT_TRUE(messages_of(*file, {"/tf"}, at(2.0), at(1.0)).empty());
  EXPECT_TRUE(messages_of(*file, {}).empty());
  int shown = 0;
  file->visit({"/tf"}, 0, test::ever, [&](const RecordedMessage&) { return ++shown < 3; });
  EXPECT_EQ(shown, 3);
}

TEST_P(SceneFile, IsReadWhereItCannotBeWritten) {
  // Nothing is left beside it.
  const auto entries = [] {
    std::set<string> names;
    for (const auto& entry : std::filesystem::directory_iterator(recording(""))) {
      names.insert(entry.path().string());
    }
    return names;
  };
  const auto before = entries();
  all_messages(*open_recording(recording("scene_none.mcap")));
  messages_of(*open_recording(path()), {"/tf"});
  EXPECT_EQ(entries(), before);
}

INSTANTIATE_TEST_SUITE_P(Data, SceneFile,
                         testing::Values("scene.db3", "scene_zstd.db3", "scene_split",
                                         "scene_none.mcap", "scene_lz4.mcap", "scene_zstd.mcap",
                                         "scene_unchunked.mcap", "scene_no_summary.mcap",
                                         "scene_ros1.mcap", "scene_none.bag", "scene_bz2.bag",
                                         "scene_lz4.bag"),
                         [](const auto& param) {
                           string name = param.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

// The encapsulation of CDR and the stamp of the header are known: OMG DDSI-RTPS 2.3, 10.2.
TEST(Containers, GiveMessagesAsTheyWereRecorded) {
  const auto file = open_recording(recording("scene_none.mcap"));
  const auto messages = messages_of(*file, {"/lidar/points"});
  ASSERT_EQ(messages.size(), 6u);
  EXPECT_EQ(messages[0].serialization, Serialization::cdr);
  EXPECT_EQ(messages[0].bytes.substr(0, 4), string("\0\1\0\0", 4));
  std::uint32_t stamp[2];
  std::memcpy(stamp, messages[1].bytes.data() + 4, 8);
  EXPECT_EQ(stamp[0] * second + stamp[1], messages[1].time);
  const auto bag = open_recording(recording("scene_none.bag"));
  const auto ros1 = messages_of(*bag, {"/lidar/points"});
  EXPECT_EQ(ros1[0].serialization, Serialization::ros1);
  std::memcpy(stamp, ros1[1].bytes.data() + 4, 8);  // after the sequence number
  EXPECT_EQ(stamp[0] * second + stamp[1], ros1[1].time);
}

TEST(Containers, ListOtherEncodingsAndRefuseToReadThem) {
  const string path = recording("scene_unchunked.mcap");
  const auto file = open_recording(path);
  EXPECT_EQ(messages_of(*file, {"/tf"}).size(), 11u);
  EXPECT_EQ(file->topics()[4].name, "/status");
  EXPECT_EQ(file->topics()[4].messages, 1u);
  EXPECT_EQ(error_about([&] { messages_of(*file, {"/status"}); }, path),
            "topic /status: found messages in the encoding 'json', expected 'cdr' (ROS 2) or "
            "'ros1'");
}

#ifdef EXCAVPLAN_WITH_SQLITE3
TEST(Containers, ReadARealRecording) {
  const string folder = EXCAVPLAN_SHARED_DATA "/site-terrain";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const string& path : {folder, folder + "/rosbag2_static_terrain_0.db3"}) {
    EXPECT_TRUE(is_recording(path));
    const auto file = open_recording(path);
    const auto messages = all_messages(*file);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0].topic, "/demo2/terrain/static");
    EXPECT_EQ(file->topics()[0].type, "sensor_msgs/msg/PointCloud2");
    EXPECT_EQ(file->start(), 1693016027559865219);  // metadata.yaml
    EXPECT_EQ(messages[0].bytes.size(), 1362365u);  // by Python's sqlite3
  }
}
#endif

TEST(Containers, AreKnownByTheirContent) {
  const TempFolder folder;
  const string bag = content_of(recording("scene_none.bag"));
  EXPECT_TRUE(is_recording(folder.write("bag.txt", bag)));
  EXPECT_FALSE(is_recording(folder.write("text.bag", "# .PCD v0.7\n")));
  EXPECT_FALSE(is_recording(folder.write("empty.db3", "")));
  EXPECT_FALSE(is_recording(folder.path() + "/absent"));
  EXPECT_FALSE(is_recording(folder.path())) << "no metadata.yaml";
  const string pipe = folder.path() + "/pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(is_recording(pipe));
  EXPECT_EQ(error_about([&] { open_recording(pipe); }, pipe), "is not a regular file");
  EXPECT_EQ(error_about([&] { open_recording(folder.path() + "/text.bag"); },
                        folder.path() + "/text.bag"),
            "byte 0: found '# .PCD v0.7?', expected the start of a rosbag2 SQLite file, an MCAP "
            "file or a ROS 1 bag");
}

TEST(Containers, OfAFolderAreOneKind) {
  const TempFolder folder;
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_TRUE(is_recording(folder.path()));
  EXPECT_EQ(error_about([&] { open_recording(folder.path()); }, folder.path()),
            "the folder: found 0 files of .db3 or .mcap, expected 1 to 500");
  folder.write("a.mcap", content_of(recording("scene_none.mcap")));
  EXPECT_EQ(all_messages(*open_recording(folder.path())).size(), 38u);
  folder.write("a.db3", content_of(recording("scene.db3")));
  EXPECT_EQ(error_about([&] { open_recording(folder.path()); }, folder.path()),
            "the folder: found files of both .db3 and .mcap, expected one kind; name the file "
            "that is meant");
  const string named_so = folder.path() + "/run.mcap";
  std::filesystem::create_directory(named_so);
  folder.write("run.mcap/metadata.yaml", "rosbag2_bagfile_information:\n");
  folder.write("run.mcap/a.mcap", content_of(recording("scene_none.mcap")));
  folder.write("run.mcap/a.db3", content_of(recording("scene.db3")));
  EXPECT_THROW(open_recording(named_so), Error);
}

// Two files of overlapping times count as one recording.
TEST(Containers, OfAFolderAreReadInTheOrderOfTime) {
  const TempFolder folder;
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n");
  folder.write("b.mcap", content_of(recording("scene_none.mcap")));
  folder.write("a.mcap", content_of(recording("scene_none.mcap")));
  const auto file = open_recording(folder.path());
  const auto messages = messages_of(*file, {"/tf"});
  ASSERT_EQ(messages.size(), 22u);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(messages[i].time, scene_start + static_cast<std::int64_t>(i / 2) * second / 2);
  }
  EXPECT_EQ(file->topics()[4].messages, 22u);
}

TEST(Containers, CompressedAsAWholeNameTheCommand) {
  const TempFolder folder;
  const string path = folder.write("run_0.db3.zstd", "\x28\xB5\x2F\xFD rest");
  EXPECT_TRUE(is_recording(path));
  EXPECT_EQ(error_about([&] { open_recording(path); }, path),
            "is compressed as a whole; uncompress it by 'zstd -d " + path +
                "' and name the file or folder again");
  folder.write("metadata.yaml", "");
  EXPECT_NE(error_about([&] { open_recording(folder.path()); }, path).find("'zstd -d "),
            string::npos);
}

// A recorder that was killed: all that is whole is read, wherever the file ends.
TEST(Containers, CutOffMcapFilesAreReadAsFarAsTheyGo) {
  const TempFolder folder;
  for (const char* name : {"scene_unchunked.mcap", "scene_none.mcap"}) {
    const string content = content_of(recording(name));
    std::size_t most = 0;
    for (std::size_t size = 100; size < content.size(); size += 211) {
      const auto file = open_recording(folder.write("cut.mcap", content.substr(0, size)));
      const std::size_t count =
          messages_of(*file, {"/tf", "/lidar/points", "/joint_states"}).size();
      EXPECT_GE(count, most) << size;
      most = std::max(most, count);
    }
    EXPECT_EQ(most, 27u) << name;
  }
}

// A file system may leave zeros where a record was to be written.
TEST(Containers, McapFilesMayEndInZeros) {
  const TempFolder folder;
  string content = content_of(recording("scene_unchunked.mcap"));
  content.resize(content.find("/status") - 17);
  const std::size_t messages = all_messages(*open_recording(folder.write("a", content))).size();
  content.append(5000, '\0');
  EXPECT_EQ(all_messages(*open_recording(folder.write("a", content))).size(), messages);
}

TEST(Containers, McapFilesWithoutAnIndexAreScanned) {
  string content = content_of(recording("scene_none.mcap"));
  const std::size_t footer = content.size() - 8 - 29;
  std::memset(&content[footer + 9], 0, 20);
  const TempFolder folder;
  const auto file = open_recording(folder.write("scan.mcap", content));
  EXPECT_EQ(all_messages(*file).size(), 38u);
}

#ifdef EXCAVPLAN_WITH_SQLITE3
/// A database that SQLite itself writes.
class Database {
 public:
  explicit Database(const string& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &made_), SQLITE_OK);
    run("PRAGMA synchronous = OFF;");
  }
  ~Database() { sqlite3_close(made_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  void run(const string& sql) const {
    EXPECT_EQ(sqlite3_exec(made_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(made_);
  }

 private:
  sqlite3* made_ = nullptr;
};

constexpr auto topics_table =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
    "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);";
constexpr auto messages_table =
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER "
    "NOT NULL, data BLOB);";
constexpr auto one_message =
    "INSERT INTO topics VALUES(1, '/a', 'std_msgs/msg/Empty', 'cdr', '');"
    "INSERT INTO messages VALUES(1, 1, 5, x'00010000');";

// The recorder keeps a log of what it has not yet written to the file itself.
TEST(SqliteRecordings, IncludeTheWriteAheadLog) {
  const TempFolder folder;
  const string path = folder.path() + "/a b?#%41.db3";
  const Database database(path);
  database.run("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0;");
  database.run(string(topics_table) + messages_table + one_message);
  const auto file = open_recording(path);
  EXPECT_EQ(all_messages(*file).size(), 1u);
  EXPECT_EQ(file->start(), 5);
}

TEST(SqliteRecordings, WithoutAnIndexOfTimeAreSorted) {
  const TempFolder folder;
  const string path = folder.path() + "/unordered.db3";
  const Database database(path);
  database.run(string(topics_table) + messages_table + one_message +
               "INSERT INTO messages VALUES(2, 1, 3, x'0001'), (3, 7, 4, x'00'), (9, 1, 4, x'');");
  const auto file = open_recording(path);
  const auto messages = all_messages(*file);
  ASSERT_EQ(messages.size(), 3u) << "the one of topic 7, which is not in the table, left out";
  EXPECT_EQ(messages[0].time, 3);
  EXPECT_EQ(messages[1].bytes, "");
  EXPECT_EQ(messages[2].bytes.size(), 4u);
}

TEST(SqliteRecordings, RunNothingThatAFileBringsAlong) {
  const string topics = topics_table;
  const string messages = messages_table;
  const std::pair<string, string> cases[] = {
      {topics, "table messages: found none or another kind"},
      {topics +
           "CREATE TABLE m(topic_id, timestamp, data); CREATE VIEW messages AS SELECT * FROM m;",
       "table messages: found none or another kind"},
      {messages + "CREATE TABLE t(id); CREATE VIEW topics AS SELECT id, 'a' AS name, 'b' AS type, "
                  "'cdr' AS serialization_format FROM t;",
       "table topics: found none or another kind"},
      {topics + "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data) WITHOUT "
                "ROWID;",
       "table messages: found none or another kind"},
      {topics + "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data AS "
                "(zeroblob(timestamp)));",
       "table messages: found 2 of the columns of rosbag2, expected 3"},
      {topics + "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, data);",
       "table messages: found 2 of the columns of rosbag2, expected 3"},
      {topics + messages + one_message + "UPDATE messages SET timestamp = -5;",
       "column timestamp: found '-5', expected a whole number of at least 0"},
      {topics + messages + one_message + "UPDATE messages SET timestamp = 'now';",
       "column timestamp: found 'now', expected a whole number of at least 0"},
      {topics + messages + one_message + "UPDATE messages SET data = NULL;",
       "row 1 of the table messages: found 'cannot open value of type null'"},
      {topics + messages + one_message + "UPDATE topics SET serialization_format = 'proto';",
       "topic /a: found messages in the format 'proto', expected 'cdr'"},
      {topics + messages + one_message + "UPDATE topics SET name = 'a' || char(27) || '[31m';",
       "a topic's name or type: found 'a?[31m', expected at most 1000 bytes without control"},
      {topics + messages + one_message + "UPDATE topics SET type = hex(zeroblob(5000));",
       "table topics, column type: found 10000 bytes, expected a text of at most 4096"},
      {topics + messages + one_message +
           "INSERT INTO topics VALUES(2, '/a', 'b/msg/C', 'cdr', '');",
       "topic /a: found the type 'b/msg/C', expected 'std_msgs/msg/Empty', as before"},
  };
  for (const auto& [sql, expected] : cases) {
    const TempFolder folder;
    const string path = folder.path() + "/hostile.db3";
    Database(path).run(sql);
    const auto read = [&] {
      const auto file = open_recording(path);
      all_messages(*file);
      if (file->skipped().count() > 0) {
        throw Error(ErrorKind::bad_file, file->skipped().first());
      }
    };
    EXPECT_EQ(error_about(read, path).substr(0, expected.size()), expected) << sql;
  }
}

/// 2000 messages of 300 bytes and more on two topics, a millisecond apart.
string many_messages() {
  return string(topics_table) + messages_table +
         "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
         "INSERT INTO topics VALUES(1, '/a', 'std_msgs/msg/Empty', 'cdr', '');"
         "INSERT INTO topics VALUES(2, '/b', 'std_msgs/msg/Empty', 'cdr', '');"
         "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 2000) "
         "INSERT INTO messages SELECT i, 1 + i % 2, 1700000000000000000 + i * 1000000, "
         "CAST(i AS TEXT) || zeroblob(300) FROM n;";
}

TEST(SqliteRecordings, ABadTimeSpoilsItsMessageAlone) {
  for (const char* time : {"0", "-5", "'now'", "1.7e18", "NULL", "9000000000000000000"}) {
    SCOPED_TRACE(time);
    const TempFolder folder;
    const string path = folder.path() + "/times.db3";
    Database(path).run(many_messages() +
                       "CREATE TABLE copy AS SELECT * FROM messages; DROP TABLE messages; "
                       "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data); "
                       "INSERT INTO messages SELECT * FROM copy; DROP TABLE copy; "
                       "UPDATE messages SET timestamp = " +
                       time + " WHERE id = 7;");
    const auto file = open_recording(path);
    EXPECT_EQ(all_messages(*file).size(), 1999U);
    EXPECT_EQ(messages_of(*file, {"/b"}).size(), 999U);
    EXPECT_EQ(file->skipped().count(), 1U) << file->skipped().first();
    EXPECT_EQ(file->start(), 1700000000001000000);
  }
}

// Every page but the first and those of the schema in turn: of messages, of the index, and inner
// ones.
TEST(SqliteRecordings, APageSpoilsItsMessagesAlone) {
  constexpr std::size_t page = 4096;
  const TempFolder folder;
  const string whole = folder.path() + "/whole.db3";
  Database(whole).run(many_messages());
  std::set<string> expected;
  for (const test::KeptMessage& message : all_messages(*open_recording(whole))) {
    expected.insert(message.bytes);
  }
  const string content = content_of(whole);
  std::size_t least = expected.size();
  for (std::size_t at = 4 * page; at < content.size(); at += 7 * page) {
    SCOPED_TRACE(at / page);
    string spoilt = content;
    std::fill_n(spoilt.begin() + static_cast<std::ptrdiff_t>(at), page, '\xAB');
    const auto file = open_recording(folder.write("spoilt.db3", spoilt));
    std::set<string> found;
    for (const test::KeptMessage& message : all_messages(*file)) found.insert(message.bytes);
    EXPECT_TRUE(std::includes(expected.begin(), expected.end(), found.begin(), found.end()));
    EXPECT_GT(found.size(), 1980U);
    EXPECT_GT(file->skipped().count(), 0U);
    least = std::min(least, found.size());
  }
  EXPECT_LT(least, expected.size());
}

TEST(SqliteRecordings, OfMoreThan16384TopicsAreRefused) {
  const TempFolder folder;
  const string path = folder.path() + "/topics.db3";
  const Database database(path);
  database.run(string(topics_table) + messages_table +
               "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 16384) "
               "INSERT INTO topics SELECT i, '/' || i, 'std_msgs/msg/Empty', 'cdr', '' FROM n;"
               "INSERT INTO messages VALUES(1, 16384, 5, x'00010000');");
  EXPECT_EQ(messages_of(*open_recording(path), {"/16384"}).size(), 1u);
  database.run("INSERT INTO topics VALUES(16385, '/more', 'std_msgs/msg/Empty', 'cdr', '');");
  EXPECT_EQ(error_about([&] { open_recording(path); }, path),
            "table topics: found more rows, expected at most 16384");
}

TEST(SqliteRecordings, OfTwoTopicsOfOneIdAreRefused) {
  const TempFolder folder;
  const string path = folder.path() + "/topics.db3";
  Database(path).run(
      "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, "
      "serialization_format TEXT, offered_qos_profiles TEXT);" +
      string(messages_table) +
      "INSERT INTO topics VALUES(1, '/a', 'std_msgs/msg/Empty', 'cdr', '');"
      "INSERT INTO topics VALUES(1, '/b', 'std_msgs/msg/Empty', 'cdr', '');");
  EXPECT_EQ(error_about([&] { open_recording(path); }, path),
            "table topics: found id 1 twice, expected each id once");
}

// Fifteen pages, each fifty times the next one, would be 50^15 rows (SQLite's file format, 1.6).
TEST(SqliteRecordings, OfPagesThatFanOutWithoutEndAreRefused) {
  constexpr std::size_t page_size = 512;
  const TempFolder folder;
  const string path = folder.path() + "/fan.db3";
  Database(path).run(
      "PRAGMA page_size = 512;" + string(topics_table) + messages_table + one_message +
      "WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < 999) "
      "INSERT INTO messages SELECT i, 1, i, zeroblob(100) FROM n;");
  string content = content_of(path);
  std::vector<std::size_t> chain;  // the root of messages, fifteen leaves of it
  for (std::size_t page = 3 * page_size; page < content.size() && chain.size() < 16;
       page += page_size) {
    if (content[page] == (chain.empty() ? 5 : 13)) chain.push_back(page);
  }
  ASSERT_EQ(chain.size(), 16u);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const auto child = static_cast<std::uint32_t>(chain[i + 1] / page_size + 1);
    string page(page_size, '\0');
    const auto put = [&](std::size_t at, std::uint32_t value, std::size_t size) {
      for (std::size_t k = 0; k < size; ++k)
        page[at + size - 1 - k] = static_cast<char>(value >> 8 * k);
    };
    constexpr std::uint32_t cells = 50;
    put(0, 5, 1);
    put(3, cells, 2);
    put(5, page_size - 5 * cells, 2);
    put(8, child, 4);
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
      const std::uint32_t place = page_size - 5 * (cell + 1);
      put(12 + 2 * cell, place, 2);
      put(place, child, 4);
      put(place + 4, cell + 1, 1);
    }
    content.replace(chain[i], page_size, page);
  }
  folder.write("fan.db3", content);
  const string found = error_about([&] { all_messages(*open_recording(path)); }, path);
  EXPECT_EQ(found,
            "its tables: found more rows than the file has room for, expected pages without "
            "a loop");
}
#endif

// The check value of CRC-32/ISO-HDLC, of the catalogue of parametrised CRC algorithms.
TEST(Compression, ChecksumsAsOthersDo) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926u);
  EXPECT_EQ(crc32(""), 0u);
  EXPECT_EQ(crc32(string(32, '\0')), 0x190A55ADu);  // by Python's zlib
}

}  // namespace
}  // namespace excavplan
