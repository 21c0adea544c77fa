// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// node write_mcap.mjs SCENE.json ROS1.json FOLDER MESSAGES.json: MCAP files of the scene by @mcap/core,
// and its messages in the CDR of @foxglove/rosmsg2-serialization, in base64. lz4 is the program.
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { McapWriter } from "@mcap/core";
import common from "@foxglove/rosmsg-msgs-common";
import zstd from "@foxglove/wasm-zstd";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";

const [sceneFile, ros1File, folder, messagesFile] = process.argv.slice(2);
const definitions = Object.values(common.ros2humble);
const short = new TextEncoder().encode("# shortened: the readers know the common types");
await zstd.isLoaded;

function cdrOf(type, message) {
  const own = common.ros2humble[type];
  return new MessageWriter([own, ...definitions.filter((other) => other !== own)]).writeMessage(message);
}

const cdr = JSON.parse(readFileSync(sceneFile)).map(([topic, type, time, message]) => ({
  topic, type: type.replace("/", "/msg/"), time: BigInt(time), data: cdrOf(type, message) }));
const ros1 = JSON.parse(readFileSync(ros1File)).map(([topic, type, time, data]) => ({
  topic, type, time: BigInt(time), data: Buffer.from(data, "base64") }));
writeFileSync(messagesFile, JSON.stringify(cdr.map(({ topic, type, time, data }) =>
  [topic, type, time.toString(), Buffer.from(data).toString("base64")])));

class Bytes {
  parts = [];
  length = 0n;
  async write(bytes) {
    this.parts.push(Buffer.from(bytes));
    this.length += BigInt(bytes.byteLength);
  }
  position() { return this.length; }
}

const compressors = {
  none: undefined,
  lz4: (data) => ({ compression: "lz4",
    compressedData: execFileSync("lz4", ["-z", "-c", "--content-size"], { input: data, stdio: ["pipe", "pipe", "ignore"] }) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data, 19) }),
};

async function write(name, messages, encoding, options) {
  const writable = new Bytes();
  const writer = new McapWriter({ writable, chunkSize: 3000, ...options });
  await writer.start({ profile: encoding === "cdr" ? "ros2" : "ros1", library: "excavplan fixture" });
  const channels = new Map();
  let sequence = 0;
  for (const { topic, type, time, data } of messages) {
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema({ name: type,
        encoding: encoding === "cdr" ? "ros2msg" : "ros1msg", data: short });
      channels.set(topic, await writer.registerChannel({ schemaId, topic, messageEncoding: encoding,
        metadata: new Map() }));
    }
    await writer.addMessage({ channelId: channels.get(topic), sequence: sequence++, logTime: time,
      publishTime: time, data });
  }
  if (name === "scene_unchunked") {
    const channelId = await writer.registerChannel({ schemaId: 0, topic: "/status",
      messageEncoding: "json", metadata: new Map([["a", "b"]]) });
    await writer.addMessage({ channelId, sequence: 0, logTime: messages.at(-1).time,
      publishTime: messages.at(-1).time, data: new TextEncoder().encode("{\"ready\": true}") });
    await writer.addAttachment({ logTime: 0n, createTime: 0n, name: "note", mediaType: "text/plain",
      data: short });
  }
  await writer.end();
  writeFileSync(`${folder}/${name}.mcap`, Buffer.concat(writable.parts));
}

for (const [compression, compressChunk] of Object.entries(compressors)) {
  await write(`scene_${compression}`, cdr, "cdr", { compressChunk });
}
await write("scene_unchunked", cdr, "cdr", { useChunks: false });
await write("scene_ros1", ros1, "ros1", { compressChunk: compressors.zstd });
await write("scene_no_summary", cdr, "cdr", { compressChunk: compressors.zstd, useStatistics: false,
  useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false, useChunkIndex: false,
  useMessageIndex: false });
