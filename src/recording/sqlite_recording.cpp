// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "recording/byte_file.hpp"
#include "recording/container.hpp"

#ifdef EXCAVPLAN_WITH_SQLITE3

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

// The tables are those of rosbag2_storage_sqlite3: topics (id, name, type, serialization_format)
// and messages (id, topic_id, timestamp, data), indexed by timestamp.

namespace excavplan {
namespace {

constexpr int longest_name = 4096;            // of a topic or type, and of other texts; ours [byte]
constexpr std::size_t most_topics = 1 << 14;  // ours
constexpr int steps_between_checks = 1000;    // of SQLite's virtual machine

using Connection = std::unique_ptr<sqlite3, decltype(&sqlite3_close_v2)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

bool has_bytes(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && status.st_size > 0;
}

std::string absolute(const std::string& path) {
  std::error_code error;
  const std::string whole = std::filesystem::absolute(path, error).string();
  if (error) throw Error(ErrorKind::bad_file, path + ": cannot be opened: " + error.message());
  return whole;
}

/// The path as a URI for SQLite: every byte that has a meaning there escaped.
std::string uri_of(const std::string& path, const std::string& query) {
  constexpr char digits[] = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : absolute(path)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '_' || c == '-';
    if (is_plain) {
      uri += c;
    } else {
      uri += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return uri + query;
}

class SqliteRecording : public Container {
 public:
  explicit SqliteRecording(const std::string& path);
  std::unique_ptr<MessageCursor> messages(const std::vector<std::size_t>& topics, std::int64_t from,
                                          std::int64_t to) override;

  Statement prepare(const std::string& sql);
  /// @return false at the end
  bool step(sqlite3_stmt* statement);
  std::int64_t integer(sqlite3_stmt* statement, int column, const std::string& name);
  Bytes blob(std::int64_t row);
  std::size_t topic_of(std::int64_t id) const { return topic_of_id_.at(id); }
  void require_readable(std::size_t topic) const;

 private:
  void open();
  void harden();
  void require_table(const std::string& name, const std::vector<std::string>& columns);
  void read_topics();
  void count_messages();
  std::string text(sqlite3_stmt* statement, int column, const std::string& name);
  [[noreturn]] void fail(const std::string& what);

  std::string path_;
  std::uint64_t size_ = 0;  // [byte]
  Connection connection_{nullptr, &sqlite3_close_v2};
  std::uint64_t steps_left_ = 0;  // thousands of them, that a statement may still take
  std::map<std::int64_t, std::size_t> topic_of_id_;
  std::vector<std::string> formats_;  // by topic
};

class SqliteCursor : public MessageCursor {
 public:
  SqliteCursor(SqliteRecording& recording, Statement statement)
      : recording_(recording), statement_(std::move(statement)) {}
  bool next() override {
    if (!recording_.step(statement_.get())) return false;
    time_ = recording_.integer(statement_.get(), 0, "timestamp");
    return true;
  }
  std::int64_t time() const override { return time_; }
  StoredMessage read() override {
    const auto topic = recording_.topic_of(recording_.integer(statement_.get(), 2, "topic_id"));
    recording_.require_readable(topic);
    message_ = recording_.blob(sqlite3_column_int64(statement_.get(), 1));
    return {topic, Serialization::cdr, message_.view()};
  }

 private:
  SqliteRecording& recording_;
  Statement statement_;
  std::int64_t time_ = 0;
  Bytes message_;
};

SqliteRecording::SqliteRecording(const std::string& path) : path_(path) {
  size_ = ByteFile(path).size();
  open();
  harden();
  require_table("topics", {"id", "name", "type", "serialization_format"});
  require_table("messages", {"topic_id", "timestamp", "data"});
  read_topics();
  count_messages();
}

/// Leaves nothing beside the file, and loses nothing that a recorder left there.
void SqliteRecording::open() {
  if (has_bytes(path_ + "-journal")) {
    throw Error(ErrorKind::bad_file, path_ + ": its recording was cut off and left " + path_ +
                                         "-journal; repair it by 'sqlite3 " + path_ + " .schema'");
  }
  const bool has_log = has_bytes(path_ + "-wal");
  const auto folder = std::filesystem::path(absolute(path_)).parent_path().string();
  const bool may_write = ::access(folder.c_str(), W_OK) == 0;
  if (has_log && !may_write && !has_bytes(path_ + "-shm")) {
    throw Error(ErrorKind::bad_file,
                path_ + ": messages in " + path_ +
                    "-wal cannot be read in a folder that cannot be written; copy both files");
  }
  // Who writes to a file that keeps a log has left one; without one SQLite would make its own.
  const Bytes head = ByteFile(path_).read(0, 20, "header");
  const bool keeps_log = head.view()[18] == 2;
  const bool is_final = !has_log && (keeps_log || !may_write);
  const std::string uri = uri_of(path_, is_final ? "?mode=ro&immutable=1" : "?mode=ro");
  sqlite3* made = nullptr;
  const int result = sqlite3_open_v2(
      uri.c_str(), &made, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  connection_.reset(made);
  if (result != SQLITE_OK) fail("the file");
}

/// Nothing that a file brings along is run, and its size bounds memory and time.
void SqliteRecording::harden() {
  sqlite3* const db = connection_.get();
  for (const auto& [setting, value] : {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                       {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                       {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                       {SQLITE_DBCONFIG_ENABLE_VIEW, 0}}) {
    sqlite3_db_config(db, setting, value, nullptr);
  }
  const auto most = std::min<std::uint64_t>(most_bytes, std::max<std::uint64_t>(size_, 1 << 20));
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, static_cast<int>(most));
  sqlite3_limit(db, SQLITE_LIMIT_SQL_LENGTH, 1 << 20);
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_limit(db, SQLITE_LIMIT_COLUMN, 100);
  sqlite3_limit(db, SQLITE_LIMIT_EXPR_DEPTH, 50);
  sqlite3_busy_timeout(db, 1000);
  const auto count_down = [](void* left) {
    auto& steps = *static_cast<std::uint64_t*>(left);
    return steps == 0 ? 1 : (--steps, 0);
  };
  sqlite3_progress_handler(db, steps_between_checks, count_down, &steps_left_);
  for (const char* setting : {"PRAGMA cell_size_check = ON", "PRAGMA query_only = ON",
                              "PRAGMA temp_store = MEMORY", "PRAGMA mmap_size = 0"}) {
    step(prepare(setting).get());
  }
}

Statement SqliteRecording::prepare(const std::string& sql) {
  // Pages that form a loop have no end: a row takes at least 4 bytes and fewer than 40 steps; ours.
  steps_left_ = 1000 + size_ * 10 / steps_between_checks;
  sqlite3_stmt* made = nullptr;
  const int result = sqlite3_prepare_v2(connection_.get(), sql.c_str(), -1, &made, nullptr);
  Statement statement(made, &sqlite3_finalize);
  if (result != SQLITE_OK) fail("its tables");
  return statement;
}

bool SqliteRecording::step(sqlite3_stmt* statement) {
  const int result = sqlite3_step(statement);
  if (result == SQLITE_INTERRUPT) {
    fail_at(path_, "its tables", "more rows than the file has room for", "pages without a loop");
  }
  if (result != SQLITE_ROW && result != SQLITE_DONE) fail("its tables");
  return result == SQLITE_ROW;
}

void SqliteRecording::fail(const std::string& what) {
  const int code = sqlite3_errcode(connection_.get());
  const char* const text = connection_ ? sqlite3_errmsg(connection_.get()) : "out of memory";
  fail_at(path_, what, in_quotes(text) + " (SQLite " + std::to_string(code) + ")",
          "a whole file of rosbag2");
}

std::int64_t SqliteRecording::integer(sqlite3_stmt* statement, int column,
                                      const std::string& name) {
  const std::int64_t value = sqlite3_column_int64(statement, column);
  if (sqlite3_column_type(statement, column) == SQLITE_INTEGER && value >= 0) return value;
  const auto* const found = sqlite3_column_text(statement, column);
  fail_at(path_, "column " + name,
          found == nullptr ? "nothing" : in_quotes(reinterpret_cast<const char*>(found)),
          "a whole number of at least 0");
}

std::string SqliteRecording::text(sqlite3_stmt* statement, int column, const std::string& name) {
  const auto* const found = sqlite3_column_text(statement, column);
  const int size = sqlite3_column_bytes(statement, column);
  if (found == nullptr || size > longest_name) {
    fail_at(path_, "table topics, column " + name,
            found == nullptr ? "nothing" : std::to_string(size) + " bytes",
            "a text of at most " + std::to_string(longest_name) + " bytes");
  }
  return {reinterpret_cast<const char*>(found), static_cast<std::size_t>(size)};
}

/// A view, a virtual table or a computed column would run what the file says.
void SqliteRecording::require_table(const std::string& name,
                                    const std::vector<std::string>& columns) {
  const Statement schema = prepare(
      "SELECT type = 'table' AND sql NOT LIKE 'CREATE VIRTUAL%' "
      "AND sql NOT LIKE '%WITHOUT%ROWID%' FROM sqlite_master WHERE name = '" +
      name + "'");
  if (!step(schema.get()) || sqlite3_column_int(schema.get(), 0) != 1) {
    fail_at(path_, "table " + name, "none or another kind of table", "an ordinary one of rosbag2");
  }
  std::size_t found = 0;
  const Statement list = prepare("PRAGMA table_xinfo(" + name + ")");
  while (step(list.get())) {
    const auto* const column = reinterpret_cast<const char*>(sqlite3_column_text(list.get(), 1));
    const bool is_known =
        std::find(columns.begin(), columns.end(), column == nullptr ? "" : column) != columns.end();
    if (is_known && sqlite3_column_int(list.get(), 6) == 0) ++found;
  }
  if (found != columns.size()) {
    fail_at(path_, "table " + name, std::to_string(found) + " of the columns of rosbag2",
            std::to_string(columns.size()));
  }
}

void SqliteRecording::read_topics() {
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  while (step(rows.get())) {
    if (topics_.size() == most_topics) {
      fail_at(path_, "table topics", "more rows", "at most " + std::to_string(most_topics));
    }
    const std::int64_t id = integer(rows.get(), 0, "id of topics");
    if (!topic_of_id_.emplace(id, topics_.size()).second) {
      fail_at(path_, "table topics", "id " + std::to_string(id) + " twice", "each id once");
    }
    topics_.push_back({text(rows.get(), 1, "name"), ros2_type(text(rows.get(), 2, "type"))});
    formats_.push_back(text(rows.get(), 3, "serialization_format"));
  }
}

/// Reads the first page of each message, as rosbag2 does.
void SqliteRecording::count_messages() {
  const Statement rows = prepare("SELECT topic_id, timestamp FROM messages");
  while (step(rows.get())) {
    const auto found = topic_of_id_.find(integer(rows.get(), 0, "topic_id"));
    if (found == topic_of_id_.end()) continue;
    const std::int64_t time = integer(rows.get(), 1, "timestamp");
    RecordedTopic& topic = topics_[found->second];
    topic.first = topic.messages == 0 ? time : std::min(topic.first, time);
    topic.last = std::max(topic.last, time);
    ++topic.messages;
  }
}

void SqliteRecording::require_readable(std::size_t topic) const {
  if (formats_[topic] == "cdr") return;
  fail_at(path_, "topic " + topics_[topic].name,
          "messages in the format " + in_quotes(formats_[topic]), "'cdr'");
}

std::unique_ptr<MessageCursor> SqliteRecording::messages(const std::vector<std::size_t>& topics,
                                                         std::int64_t from, std::int64_t to) {
  std::vector<bool> is_asked_for(topics_.size());
  for (const std::size_t topic : topics) is_asked_for[topic] = true;
  std::string ids;
  for (const auto& [id, topic] : topic_of_id_) {
    if (is_asked_for[topic]) ids += (ids.empty() ? "" : ",") + std::to_string(id);
  }
  // Blobs are read by themselves, so that no sorting ever holds them.
  Statement statement = prepare(
      "SELECT timestamp, rowid, topic_id FROM messages WHERE timestamp BETWEEN ? AND ? "
      "AND topic_id IN (" +
      ids + ") ORDER BY timestamp, rowid");
  sqlite3_bind_int64(statement.get(), 1, from);
  sqlite3_bind_int64(statement.get(), 2, to);
  return std::make_unique<SqliteCursor>(*this, std::move(statement));
}

Bytes SqliteRecording::blob(std::int64_t row) {
  sqlite3_blob* made = nullptr;
  const int opened =
      sqlite3_blob_open(connection_.get(), "main", "messages", "data", row, 0, &made);
  const std::unique_ptr<sqlite3_blob, decltype(&sqlite3_blob_close)> blob(made,
                                                                          &sqlite3_blob_close);
  const std::string place = "row " + std::to_string(row) + " of the table messages";
  if (opened != SQLITE_OK) fail(place);
  const auto size = static_cast<std::uint64_t>(sqlite3_blob_bytes(made));
  if (size > size_ || size > most_bytes) {
    fail_at(path_, place, "a message of " + std::to_string(size) + " bytes",
            "at most the size of the file and " + std::to_string(most_bytes));
  }
  Bytes bytes(size);
  if (sqlite3_blob_read(made, bytes.data(), static_cast<int>(size), 0) != SQLITE_OK) fail(place);
  return bytes;
}

}  // namespace

std::unique_ptr<Container> open_sqlite_recording(const std::string& path) {
  return std::make_unique<SqliteRecording>(path);
}

}  // namespace excavplan

#else

namespace excavplan {

std::unique_ptr<Container> open_sqlite_recording(const std::string& path) {
  throw Error(ErrorKind::bad_file, path +
                                       ": is a rosbag2 recording of SQLite, which this build is "
                                       "without; build it anew with Debian's libsqlite3-dev");
}

}  // namespace excavplan

#endif
