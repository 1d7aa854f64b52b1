// SPDX-License-Identifier: Apache-2.0
// node foxglove.mjs NODE_MODULES URL: Foxglove's own client on `modelhouse live`: every topic is decoded with
// @foxglove/rosmsg2-serialization, and the robot obeys /cmd_vel.
import { createRequire } from "node:module";

const [modules, url] = process.argv.slice(2);
const require = createRequire(modules + "/x.js");
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader, MessageWriter } = require("@foxglove/rosmsg2-serialization");
const WebSocket = require("ws");

const findings = [];
const expect = (is, what) => { if (!is) findings.push(what); };
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
const client = new FoxgloveClient({ ws: new WebSocket(url.replace("http", "ws"), ["foxglove.websocket.v1"]) });
client.on("error", (error) => findings.push(`error: ${error.message}`));
client.on("status", (status) => findings.push(`status: ${status.message}`));
let info;
client.on("serverInfo", (message) => { info = message; });
const channels = new Map();   // by topic
const topics = new Map();     // of subscriptions
const last = {}, count = {};
client.on("advertise", (all) => {
  for (const channel of all) {
    const reader = new MessageReader(parse(channel.schema, { ros2: true }));
    channels.set(channel.topic, channel);
    topics.set(client.subscribe(channel.id), { topic: channel.topic, reader });
  }
});
client.on("message", ({ subscriptionId, data }) => {
  const { topic, reader } = topics.get(subscriptionId);
  last[topic] = reader.readMessage(data);
  count[topic] = (count[topic] ?? 0) + 1;
});
const until = async (is, what) => {
  for (let k = 0; k < 2000; ++k) {
    if (is()) return;
    await sleep(50);
  }
  findings.push(`never: ${what}`);
};

await until(() => channels.size > 0 && [...channels.keys()].every((topic) => count[topic] > 0),
  "a message of every topic");
for (const topic of channels.keys()) if (!count[topic]) findings.push(`no message: ${topic}`);
expect(info?.metadata.ROS_DISTRO === "humble", "a ROS 2 robot");
const image = last["/camera/color/image_raw"];
expect(image?.encoding === "rgb8" && image?.data.length === image?.step * image?.height, "a whole image");
expect(last["/slam/landmarks"]?.width > 100, "landmarks");
expect(last["/map"]?.data.includes(0), "free floor");

const heading = () => {
  const q = last["/ground_truth/pose"].pose.orientation;
  return Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
};
const turned = (from) => Math.abs(Math.atan2(Math.sin(heading() - from), Math.cos(heading() - from)));
const twist = (z) => ({ linear: { x: 0, y: 0, z: 0 }, angular: { x: 0, y: 0, z } });
const kTwist = "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n" + "=".repeat(80) +
  "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
const writer = new MessageWriter(parse(kTwist, { ros2: true }));
for (const [encoding, bytes] of [["cdr", writer.writeMessage(twist(0.8))],
  ["json", new TextEncoder().encode(JSON.stringify(twist(-0.8)))]]) {
  const id = client.advertise({ topic: "/cmd_vel", encoding, schemaName: "geometry_msgs/msg/Twist" });
  const before = heading();
  for (let k = 0; k < 300 && turned(before) < 0.3; ++k) {
    client.sendMessage(id, bytes);
    await sleep(100);
  }
  expect(turned(before) >= 0.3, `the robot does not turn by ${encoding}`);
}
client.close();
for (const finding of findings) console.log(finding);
process.exit(findings.length > 0 ? 1 : 0);
