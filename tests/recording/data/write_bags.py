#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""write_bags.py SCENE.json FOLDER MESSAGES.json: ROS 1 bags of the scene by rosbag, and its messages
as ROS 1 lays them out, in base64."""
import base64
import io
import json
import sys

import genpy
import rosbag
import roslib.message

SHORT = "# shortened: the readers know the common types"


def fill(message, values):
    """Sets the fields of a ROS 1 message from a dict with the names of ROS 2."""
    for slot, kind in zip(message.__slots__, message._slot_types):
        if slot == "seq":
            continue
        value = values[slot if slot in values else slot.lower()]
        if kind == "time":
            value = genpy.Time(value["sec"], value["nanosec"])
        elif kind == "uint8[]":
            value = bytes(value)
        elif isinstance(value, dict):
            value = fill(getattr(message, slot), value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            part = roslib.message.get_message_class(kind.rstrip("[]"))
            value = [fill(part(), item) for item in value]
        setattr(message, slot, value)
    return message


def main(scene_file, folder, messages_file):
    rows = []
    for topic, kind, time, values in json.load(open(scene_file)):
        message = fill(roslib.message.get_message_class(kind)(), values)
        buffer = io.BytesIO()
        message.serialize(buffer)
        rows.append((topic, kind, int(time), message._md5sum, message.__class__, buffer.getvalue()))
    for compression in ("none", "bz2", "lz4"):
        # Chunks of 3 kB, so that a few seconds have several.
        with rosbag.Bag(f"{folder}/scene_{compression}.bag", "w", compression=compression,
                        chunk_threshold=3000) as bag:
            for topic, kind, time, md5sum, maker, data in rows:
                bag.write(topic, (kind, data, md5sum, maker),
                          genpy.Time(time // 10**9, time % 10**9), raw=True,
                          connection_header={"topic": topic, "type": kind, "md5sum": md5sum,
                                             "message_definition": SHORT})
    json.dump([(topic, kind, str(time), base64.b64encode(data).decode())
               for topic, kind, time, _, _, data in rows], open(messages_file, "w"))


main(*sys.argv[1:])
