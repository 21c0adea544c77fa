#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""What every recording of this folder holds, as JSON with the field names of ROS 2: a list of
[topic, type, time since 1970 in ns as text, message]. README.md describes it."""
import json
import math
import struct

START = 1_700_000_000_000_000_000  # ns


def header(time, frame):
    return {"stamp": {"sec": time // 10**9, "nanosec": time % 10**9}, "frame_id": frame}


def turn(yaw):
    return {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}


def transform(time, parent, child, translation, rotation):
    x, y, z = translation
    return {"header": header(time, parent), "child_frame_id": child,
            "transform": {"translation": {"x": x, "y": y, "z": z}, "rotation": rotation}}


def cloud(time, k):
    """6 x 5 points, the last one without a return; the ground rises by 1 mm a frame."""
    data = b""
    for j in range(5):
        for i in range(6):
            z = -1.5 + 0.02 * i + 0.001 * k
            if (i, j) == (5, 4):
                z = math.nan
            data += struct.pack("<4f", 3.0 + 0.25 * i, -0.5 + 0.25 * j, z, 10.0 * j + i)
    fields = [{"name": name, "offset": 4 * n, "datatype": 7, "count": 1}
              for n, name in enumerate(["x", "y", "z", "intensity"])]
    return {"header": header(time, "lidar"), "height": 5, "width": 6, "fields": fields,
            "is_bigendian": False, "point_step": 16, "row_step": 96, "data": list(data),
            "is_dense": False}


def depth(time, k):
    """16 x 12 depths [mm], the upper left one without a return."""
    values = [1500 + 10 * row + column + k for row in range(12) for column in range(16)]
    values[0] = 0
    return {"header": header(time, "camera"), "height": 12, "width": 16, "encoding": "16UC1",
            "is_bigendian": 0, "step": 32, "data": list(struct.pack("<192H", *values))}


def camera(time):
    return {"header": header(time, "camera"), "height": 12, "width": 16,
            "distortion_model": "plumb_bob", "d": [0.0] * 5,
            "k": [20.0, 0.0, 7.5, 0.0, 20.0, 5.5, 0.0, 0.0, 1.0],
            "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            "p": [20.0, 0.0, 7.5, 0.0, 0.0, 20.0, 5.5, 0.0, 0.0, 0.0, 1.0, 0.0],
            "binning_x": 0, "binning_y": 0,
            "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}}


def joints(time, k):
    return {"header": header(time, ""), "name": ["swing", "boom", "stick", "bucket"],
            "position": [0.0, 0.5 + 0.01 * k, -1.2, 0.3], "velocity": [], "effort": []}


def scene():
    messages = []

    def add(seconds, topic, kind, make, *more):
        time = START + round(seconds * 10**9)
        messages.append([topic, kind, str(time), make(time, *more)])

    half = math.sqrt(0.5)
    down = {"x": -half, "y": half, "z": 0.0, "w": 0.0}  # a camera that looks straight down
    add(0.0, "/tf_static", "tf2_msgs/TFMessage", lambda time: {"transforms": [
        transform(time, "base_link", "lidar", (0.4, 0.0, 1.8), turn(math.pi / 2)),
        transform(time, "base_link", "camera", (0.0, 0.2, 2.0), down)]})
    for k in range(11):
        s = 0.5 * k
        add(s, "/tf", "tf2_msgs/TFMessage", lambda time: {"transforms": [
            transform(time, "map", "base_link", (0.2 * s, 0.0, 0.0), turn(0.05 * s))]})
    for k in range(6):
        add(0.25 + 0.9 * k, "/lidar/points", "sensor_msgs/PointCloud2", cloud, k)
    for k in range(5):
        add(0.3 + k, "/camera/depth/image_raw", "sensor_msgs/Image", depth, k)
        add(0.3 + k, "/camera/depth/camera_info", "sensor_msgs/CameraInfo", camera)
    for k in range(10):
        add(0.1 + 0.5 * k, "/joint_states", "sensor_msgs/JointState", joints, k)
    return sorted(messages, key=lambda message: int(message[2]))


if __name__ == "__main__":
    print(json.dumps(scene()))
