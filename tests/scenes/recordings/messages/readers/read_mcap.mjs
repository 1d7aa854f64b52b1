// SPDX-License-Identifier: Apache-2.0
// Reads an MCAP file with @mcap/core, through its index and as a stream, decodes every message with
// @foxglove/rosmsg2-serialization and prints what it found: read_mcap.mjs FILE
import { open, readFile } from "node:fs/promises";

import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";

const file = process.argv[2];
const decompressHandlers = await loadDecompressHandlers();
const handle = await open(file);
const readable = {
  size: async () => BigInt((await handle.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await handle.read(bytes, 0, Number(length), Number(offset));
    return bytes;
  },
};

const nanoseconds = (stamp) => BigInt(stamp.sec) * 1000000000n + BigInt(stamp.nsec ?? stamp.nanosec);

/** The first header in a message, such as that of the first transform in a TFMessage. */
function headerOf(message) {
  return message.header ?? message.transforms?.[0]?.header;
}

const topics = {};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  if (schema.encoding !== "ros2msg" || channel.messageEncoding !== "cdr")
    throw new Error(`${channel.topic}: ${schema.encoding}, ${channel.messageEncoding}`);
  const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
  decoders.set(channel.id, new MessageReader(definition));
  topics[channel.topic] = { type: schema.name, count: 0, stamps: [], frames: [], bytes: 0 };
}
for await (const message of reader.readMessages()) {
  const topic = topics[reader.channelsById.get(message.channelId).topic];
  const decoded = decoders.get(message.channelId).readMessage(message.data);
  const header = headerOf(decoded);
  if (header != undefined) {
    topic.stamps.push(String(nanoseconds(header.stamp)));
    if (!topic.frames.includes(header.frame_id)) topic.frames.push(header.frame_id);
  }
  topic.count += 1;
  if (decoded.data?.length != undefined) topic.bytes += decoded.data.length;
  topic.last = JSON.stringify(decoded, (_, value) =>
    typeof value === "bigint" ? String(value) : ArrayBuffer.isView(value) ? `${value.length} elements` : value);
}
const statistics = reader.statistics;
for (const [id, count] of statistics.channelMessageCounts) {
  const topic = topics[reader.channelsById.get(id).topic];
  if (BigInt(topic.count) !== count) throw new Error(`statistics count ${count} of ${id}`);
}

// Once more as a stream, which verifies all checksums.
let streamed = 0;
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(await readFile(file));
for (let record; (record = stream.nextRecord()); ) if (record.type === "Message") streamed += 1;
if (!stream.done()) throw new Error("the stream is not done");
if (BigInt(streamed) !== statistics.messageCount) throw new Error(`${streamed} in the stream`);
await handle.close();
console.log(JSON.stringify({ messages: streamed, topics }));
