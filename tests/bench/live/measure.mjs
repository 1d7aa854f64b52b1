// SPDX-License-Identifier: Apache-2.0
// node measure.mjs NODE_MODULES URL [SECONDS]: measures `modelhouse live` as a viewer sees it while the robot drives and
// maps: images per second, and the time from a command to the first picture that was taken under it.
import { createRequire } from "node:module";

const [modules, url, seconds] = process.argv.slice(2);
const WebSocket = createRequire(modules + "/x.js")("ws");
const socket = new WebSocket(url.replace("http", "ws") + "ws");
socket.binaryType = "nodebuffer";
let sent = null, obeyed = false, turn = 0.5;
let state = null, images = 0, begun = null;
const latencies_ms = [];
const command = () => {
  turn = -turn;
  sent = performance.now();
  obeyed = false;
  socket.send(JSON.stringify({ drive: [0.1, 0, turn] }));
};
socket.on("message", (data, isBinary) => {
  if (!isBinary) {
    state = JSON.parse(data);
    if (sent !== null && state.command?.[2] === turn) obeyed = true;
    return;
  }
  if (data[0] !== 0) return;   // color
  begun ??= performance.now();
  ++images;
  if (obeyed) {
    latencies_ms.push(performance.now() - sent);
    sent = null;
    obeyed = false;
    setTimeout(command, 50 + 37 * (latencies_ms.length % 5));   // not in step with the frames
  }
});
socket.on("open", () => setTimeout(command, 1000));
setTimeout(() => {
  const passed_s = (performance.now() - begun) / 1000;
  latencies_ms.sort((a, b) => a - b);
  const at = (share) => latencies_ms[Math.min(latencies_ms.length - 1, Math.floor(share * latencies_ms.length))].toFixed(0);
  console.log(`${((images - 1) / passed_s).toFixed(1)} images/s over ${passed_s.toFixed(0)} s; ${latencies_ms.length} commands, ` +
    `latency median ${at(0.5)} ms, 95 % ${at(0.95)} ms; ${state.keyframes} keyframes, ${state.landmarks} landmarks`);
  process.exit(0);
}, 1000 * Number(seconds ?? 60));
