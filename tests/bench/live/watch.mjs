// SPDX-License-Identifier: Apache-2.0
// node watch.mjs NODE_MODULES PROGRAM ROOT: `bench --live` shows its runs while they map, and no result depends on it.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [modules, program, root] = process.argv.slice(2);
const WebSocket = createRequire(modules + "/x.js")("ws");
const folder = mkdtempSync(join(tmpdir(), "mh_watch_"));
writeFileSync(join(folder, "s.yaml"), `environments:
- {category: room, scene: ${root}/bench/scenarios/room.yaml, mapping_tour: ${root}/bench/scenarios/tours/room.yaml}
robot: ${root}/bench/scenarios/robot.yaml
vocabulary: vocabulary
levels: [ideal]
systems: [plain, semantic]
labels: [exact]
`);
const port = await new Promise((done) => {
  const free = createServer().listen(0, "127.0.0.1", () => { const { port } = free.address(); free.close(() => done(port)); });
});
const bench = (out, more) => spawn(program, ["bench", join(folder, "s.yaml"), "--frames", "150", "--out", join(folder, out), ...more],
  { stdio: ["ignore", "ignore", "inherit"] });
const ended = (child) => new Promise((done) => child.on("exit", done));

const findings = [];
const runs = new Map();   // by name: { frames, images }
let run = null, at_work = true;
const connect = () => {
  if (!at_work) return;
  const socket = new WebSocket(`ws://127.0.0.1:${port}/ws`);
  socket.on("error", () => {});
  socket.on("close", () => setTimeout(connect, 20));
  socket.on("message", (data, isBinary) => {
    if (isBinary) { if (run) ++run.images; return; }
    const message = JSON.parse(data);
    if (message.hello) {
      if (!message.hello.watch) findings.push("the page would offer controls");
      if (!runs.has(message.hello.scene)) runs.set(message.hello.scene, { frames: [], images: 0, rooms: 0 });
      run = runs.get(message.hello.scene);
      run.rooms = message.hello.rooms.length;
    } else if (run) run.frames.push(message.frame);
  });
};
const watched = bench("watched", ["--live", String(port)]);
connect();
if (await ended(watched) !== 0) findings.push("bench --live fails");
at_work = false;
if (await ended(bench("alone", [])) !== 0) findings.push("bench fails");
for (const name of ["plain-ideal-0", "semantic-exact-ideal-0"]) {
  const { frames, images, rooms } = runs.get(name) ?? { frames: [], images: 0, rooms: 0 };
  if (frames.length < 3 || images < 9) findings.push(`${name}: ${frames.length} states, ${images} images`);
  if (frames.some((frame, k) => k > 0 && frame <= frames[k - 1])) findings.push(`${name}: frames ${frames}`);
  if (rooms !== 1) findings.push(`${name}: ${rooms} rooms`);
}
const table = (out) => readFileSync(join(folder, out, "table.txt"), "utf8");
if (table("watched") !== table("alone")) findings.push("the tables differ");
rmSync(folder, { recursive: true });
for (const finding of findings) console.log(finding);
process.exit(findings.length > 0 ? 1 : 0);
