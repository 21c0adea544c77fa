#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""write_db3.py MESSAGES.json FOLDER: rosbag2's SQLite files of the scene by Python's sqlite3, with the
tables that rosbag2 makes (schema version 4, ROS 2 Jazzy). scene.db3 is one file; the folder scene_split
has two with metadata.yaml; in scene_zstd.db3 each message is compressed, by the program zstd, as
rosbag2's compression mode MESSAGE does."""
import base64
import json
import os
import sqlite3
import subprocess
import sys

TABLES = """
PRAGMA page_size = 1024;
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
  encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
  data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema VALUES (4, 'jazzy');
"""


def write(path, rows, topics):
    if os.path.exists(path):
        os.remove(path)
    base = sqlite3.connect(path)
    base.executescript(TABLES)
    for number, (name, kind) in enumerate(topics, 1):
        base.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '', '')", (number, name, kind))
    for topic, kind, time, data in rows:
        number = topics.index((topic, kind)) + 1
        base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                     (number, time, data))
    base.commit()
    base.close()


def metadata(rows, topics, files):
    """The lines of rosbag2's metadata.yaml, version 9, that say something."""
    lines = ["rosbag2_bagfile_information:", "  version: 9", "  storage_identifier: sqlite3",
             "  duration:", f"    nanoseconds: {rows[-1][2] - rows[0][2]}", "  starting_time:",
             f"    nanoseconds_since_epoch: {rows[0][2]}", f"  message_count: {len(rows)}",
             "  topics_with_message_count:"]
    for name, kind in topics:
        count = sum(row[0] == name for row in rows)
        lines += ["    - topic_metadata:", f"        name: {name}", f"        type: {kind}",
                  "        serialization_format: cdr", f"      message_count: {count}"]
    lines += ["  compression_format: \"\"", "  compression_mode: \"\"", "  relative_file_paths:"]
    return "\n".join(lines + [f"    - {file}" for file in files]) + "\n"


def main(messages_file, folder):
    rows = [(topic, kind, int(time), base64.b64decode(data))
            for topic, kind, time, data in json.load(open(messages_file))]
    topics = sorted({row[:2] for row in rows})
    write(f"{folder}/scene.db3", rows, topics)
    compressed = [row[:3] + (with_size(row[3]),) for row in rows]
    write(f"{folder}/scene_zstd.db3", compressed, topics)
    split = f"{folder}/scene_split"
    os.makedirs(split, exist_ok=True)
    half = len(rows) // 2
    write(f"{split}/scene_split_0.db3", rows[:half], topics)
    write(f"{split}/scene_split_1.db3", rows[half:], topics)
    with open(f"{split}/metadata.yaml", "w") as file:
        file.write(metadata(rows, topics, ["scene_split_0.db3", "scene_split_1.db3"]))


def with_size(data):
    """A Zstandard frame that states the size of its content."""
    return subprocess.run(["zstd", "-c", "--no-check", f"--stream-size={len(data)}"], input=data,
                          capture_output=True, check=True).stdout


main(*sys.argv[1:])
