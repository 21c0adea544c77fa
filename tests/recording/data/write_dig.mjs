// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// node write_dig.mjs QUICKSTART: dig.mcap there, a recording of its two scans by @mcap/core: half of the
// points of before.pcd on /merged/points in four messages from 0 s on, half of those of after.pcd from
// 60 s on, in the frame site.
import { readFileSync, writeFileSync } from "node:fs";
import { McapWriter } from "@mcap/core";
import common from "@foxglove/rosmsg-msgs-common";
import zstd from "@foxglove/wasm-zstd";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";

const folder = process.argv[2];
const type = "sensor_msgs/PointCloud2";
const cloud = common.ros2humble[type];
const definitions = [cloud, ...Object.values(common.ros2humble).filter((other) => other !== cloud)];
const parts = 4;
const start = 1700000000n * 1000000000n;
await zstd.isLoaded;

/// The float32 x y z of a binary PCD file, every second point.
function pointsOf(name) {
  const file = readFileSync(`${folder}/${name}.pcd`);
  const points = file.subarray(file.indexOf("DATA binary\n") + 12);
  const kept = [];
  for (let at = 0; at + 12 <= points.length; at += 24) kept.push(points.subarray(at, at + 12));
  return kept;
}

const messages = [];
for (const [name, second] of [["before", 0n], ["after", 60n]]) {
  const points = pointsOf(name);
  for (let part = 0; part < parts; ++part) {
    const time = start + second * 1000000000n + BigInt(part) * 100000000n;
    const own = points.filter((_, i) => i % parts === part);
    messages.push({ time, data: new MessageWriter(definitions).writeMessage({
      header: { stamp: { sec: Number(time / 1000000000n), nanosec: Number(time % 1000000000n) }, frame_id: "site" },
      height: 1, width: own.length, is_bigendian: false, is_dense: true, point_step: 12,
      row_step: 12 * own.length, data: Buffer.concat(own),
      fields: ["x", "y", "z"].map((axis, i) => ({ name: axis, offset: 4 * i, datatype: 7, count: 1 })) }) });
  }
}

class Bytes {
  parts = [];
  length = 0n;
  async write(bytes) {
    this.parts.push(Buffer.from(bytes));
    this.length += BigInt(bytes.byteLength);
  }
  position() { return this.length; }
}
const writable = new Bytes();
const writer = new McapWriter({ writable, chunkSize: 100000,
  compressChunk: (data) => ({ compression: "zstd", compressedData: zstd.compress(data, 19) }) });
await writer.start({ profile: "ros2", library: "excavplan fixture" });
const schemaId = await writer.registerSchema({ name: "sensor_msgs/msg/PointCloud2", encoding: "ros2msg",
  data: new TextEncoder().encode("# shortened: the readers know the common types") });
const channelId = await writer.registerChannel({ schemaId, topic: "/merged/points", messageEncoding: "cdr",
  metadata: new Map() });
for (const [sequence, { time, data }] of messages.entries()) {
  await writer.addMessage({ channelId, sequence, logTime: time, publishTime: time, data });
}
await writer.end();
writeFileSync(`${folder}/dig.mcap`, Buffer.concat(writable.parts));
