// SPDX-License-Identifier: Apache-2.0
// The page of `modelhouse live`: shows what arrives on the WebSocket and sends commands (docs/live.md).
const $ = (id) => document.getElementById(id);
const held = new Set();      // controls held now: "1,0,0"
let hello = null, state = null, map = { points: [], keyframes: [] }, socket = null;
const trail = { true: [], estimate: [] };
const times = [];

function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

// While a control is held, the command is repeated: the robot stops when its driver is gone.
function velocity() {
  const sum = [0, 0, 0];
  for (const each of held) each.split(",").forEach((n, k) => { sum[k] += Number(n); });
  const speed = hello?.speed_m_per_s ?? 0, turn = Math.min(hello?.turn_rad_per_s ?? 0, 0.8);
  return [sum[0] * speed, sum[1] * speed, sum[2] * turn];
}
let was_driving = false;
setInterval(() => {
  if (held.size > 0 || was_driving) send({ drive: velocity() });
  was_driving = held.size > 0;
}, 100);
function hold(what, on) {
  if (on === held.has(what)) return;
  if (on) held.add(what); else held.delete(what);
  send({ drive: velocity() });
  for (const button of document.querySelectorAll("[data-drive]"))
    button.classList.toggle("held", held.has(button.dataset.drive));
}

const keys = { KeyW: "1,0,0", ArrowUp: "1,0,0", KeyS: "-1,0,0", ArrowDown: "-1,0,0", KeyA: "0,1,0", KeyD: "0,-1,0",
               KeyQ: "0,0,1", ArrowLeft: "0,0,1", KeyE: "0,0,-1", ArrowRight: "0,0,-1" };
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "INPUT") return;
  if (keys[event.code]) { hold(keys[event.code], true); event.preventDefault(); }
  if (event.repeat) return;
  if (event.code === "KeyK") $("kidnap").click();
  if (event.code === "KeyL") $("light").click();
});
addEventListener("keyup", (event) => { if (keys[event.code]) hold(keys[event.code], false); });
addEventListener("blur", () => { for (const what of [...held]) hold(what, false); });
for (const button of document.querySelectorAll("[data-drive]")) {
  button.addEventListener("pointerdown", (event) => { button.setPointerCapture(event.pointerId); hold(button.dataset.drive, true); });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
    button.addEventListener(end, () => hold(button.dataset.drive, false));
  button.addEventListener("contextmenu", (event) => event.preventDefault());
}
$("kidnap").onclick = () => { send({ do: "kidnap" }); trail.true.push(null); trail.estimate.push(null); };
$("restart").onclick = () => { send({ do: "restart" }); map = { points: [], keyframes: [] }; trail.estimate = []; };
for (const what of ["light", "wheels"])
  $(what).onclick = () => {
    const on = $(what).getAttribute("aria-pressed") !== "true";
    $(what).setAttribute("aria-pressed", on);
    send({ [what]: on });
  };
$("errand").onsubmit = (event) => {
  event.preventDefault();
  send({ go: $("goal").value.trim() });
  $("goal").blur();
};
$("scenes").onchange = () => { send({ scene: $("scenes").selectedIndex }); $("scenes").blur(); };
for (const dial of ["gamma", "xi"])
  $(dial).oninput = () => { send({ [dial]: Number($(dial).value) }); };

function show(image, bytes) {
  const old = image.src;
  image.onload = image.onerror = () => URL.revokeObjectURL(old);
  image.src = URL.createObjectURL(new Blob([bytes], { type: "image/jpeg" }));
}

function take(message) {
  if (message.hello) {
    hello = message.hello;
    $("scene").textContent = `${hello.scene}, ${hello.robot}`;
    document.body.classList.toggle("watch", hello.watch === true);
    $("goals").replaceChildren(...hello.classes.slice(1).map(([name]) => new Option(name)));
    $("scenes").replaceChildren(...(hello.scenes ?? []).map((name) => new Option(name)));
    $("scenes").hidden = $("scenes").length < 2;
    map = { points: [], keyframes: [] };
    trail.true = []; trail.estimate = [];
    return;
  }
  if (message.error) { console.warn(message.error); return; }
  state = message;
  if (state.map) map = state.map;
  trail.true.push(state.camera ? state.camera.slice(0, 2) : null);
  trail.estimate.push(state.estimate ? state.estimate.slice(0, 2) : null);
  for (const each of Object.values(trail)) if (each.length > 4000) each.shift();
  const now = performance.now();
  times.push(now);
  while (times[0] < now - 2000) times.shift();
  const lost = state.status === "lost";
  $("status").className = lost ? "lost" : "";
  $("status").textContent = !state.light ? "dark" : lost ? "lost" : state.status;
  $("wheels").setAttribute("aria-pressed", state.wheels);
  if (document.activeElement !== $("scenes")) $("scenes").selectedIndex = state.scene ?? 0;
  for (const dial of ["gamma", "xi"]) {
    if (state[dial] === undefined) continue;
    $(`${dial}_is`).textContent = state[dial].toFixed(2);
    if (document.activeElement !== $(dial)) $(dial).value = state[dial];
  }
  $("errand_is").textContent = state.errand ? `${state.errand.goal}: ${state.errand.state}` : state.note ?? "";
  const facts = { "time": `${state.time_s.toFixed(1)} s`, "error": state.error_m === undefined ? "-" : `${(100 * state.error_m).toFixed(1)} cm`,
                  "keypoints": state.keypoints ?? "-", "inliers": state.inliers ?? "-", "keyframes": state.keyframes };
  if (hello?.watch) Object.assign(facts, { "frame": `${state.frame} of ${state.of}`, "restarts": state.restarts });
  else Object.assign(facts, { "landmarks": state.landmarks, "images": `${(times.length / 2).toFixed(0)} /s` });
  $("facts").replaceChildren(...Object.entries(facts).map(([name, value]) => {
    const div = document.createElement("div"), dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = name; dd.textContent = value; dd.dataset.fact = name;
    div.append(dt, dd);
    return div;
  }));
  requestAnimationFrame(draw);
}

function draw() {
  const canvas = $("map"), ratio = devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  const g = canvas.getContext("2d");
  const ink = (name) => getComputedStyle(document.querySelector(`.key .${name}`) ?? $("scene")).color;
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, width, height);
  if (!hello || !state) return;
  const corners = hello.rooms.flatMap((room) => room.outline);
  if (corners.length === 0) corners.push(...hello.things.flatMap((t) => [[t[0], t[1]], [t[2], t[3]]]));
  if (corners.length === 0) corners.push([-1, -1], [1, 1], ...[...trail.true, ...trail.estimate].filter(Boolean));
  const xs = corners.map((p) => p[0]), ys = corners.map((p) => p[1]);
  const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
  const margin = 14;
  const scale = Math.min((width - 2 * margin) / (high[0] - low[0]), (height - 2 * margin) / (high[1] - low[1]));
  const left = (width - scale * (high[0] - low[0])) / 2, bottom = (height - scale * (high[1] - low[1])) / 2;
  const at = ([x, y]) => [left + scale * (x - low[0]), height - bottom - scale * (y - low[1])];
  g.lineWidth = 1.5;
  g.strokeStyle = ink("faint");
  for (const room of hello.rooms) {
    g.beginPath();
    room.outline.forEach((p, k) => g[k ? "lineTo" : "moveTo"](...at(p)));
    g.closePath();
    g.stroke();
  }
  g.lineWidth = 1;
  for (const [x0, y0, x1, y1, of] of hello.things) {
    const [a, b] = at([x0, y1]);
    g.fillStyle = hello.classes[of][1] + "26";
    g.fillRect(a, b, scale * (x1 - x0), scale * (y1 - y0));
  }
  for (const [x, y, of] of map.points) {
    g.fillStyle = of ? hello.classes[of][1] : ink("faint");
    const [a, b] = at([x, y]);
    g.fillRect(a - 1, b - 1, 2, 2);
  }
  g.fillStyle = ink("keyframe");
  for (const frame of map.keyframes) {
    const [a, b] = at(frame);
    g.fillRect(a - 1.5, b - 1.5, 3, 3);
  }
  g.fillStyle = ink("laser");
  for (const end of state.lasers) {
    const [a, b] = at(end);
    g.beginPath(); g.arc(a, b, 2, 0, 7); g.fill();
  }
  for (const name of ["true", "estimate"]) {
    g.strokeStyle = ink(name);
    g.lineWidth = name === "true" ? 3 : 1.5;
    g.beginPath();
    let up = true;
    for (const p of trail[name]) {
      if (p) g[up ? "moveTo" : "lineTo"](...at(p));
      up = !p;
    }
    g.stroke();
  }
  if (state.errand?.path.length > 0) {
    g.strokeStyle = ink("estimate");
    g.setLineDash([5, 4]);
    g.beginPath();
    state.errand.path.forEach((p, k) => g[k ? "lineTo" : "moveTo"](...at(p)));
    g.stroke();
    g.setLineDash([]);
  }
  const robot = (pose, name, radius) => {
    if (!pose) return;
    const [a, b] = at(pose);
    g.strokeStyle = g.fillStyle = ink(name);
    g.lineWidth = 2;
    g.beginPath(); g.arc(a, b, Math.max(5, scale * radius), 0, 7); g.stroke();
    g.beginPath(); g.moveTo(a, b); g.lineTo(a + 1.5 * scale * radius * Math.cos(pose[2]), b - 1.5 * scale * radius * Math.sin(pose[2])); g.stroke();
  };
  robot(state.base, "true", hello.radius_m);
  robot(state.estimate, "estimate", 0.5 * hello.radius_m);
}
addEventListener("resize", () => requestAnimationFrame(draw));

function connect() {
  socket = new WebSocket(`ws://${location.host}/ws${location.search}`);
  socket.binaryType = "arraybuffer";
  socket.onmessage = ({ data }) => {
    if (typeof data === "string") { take(JSON.parse(data)); return; }
    const kind = new Uint8Array(data, 0, 1)[0];
    show($(["color", "depth", "labels"][kind]), new Uint8Array(data, 1));
  };
  socket.onclose = () => {
    $("status").textContent = "the program has ended; waiting for it ...";
    $("status").className = "lost";
    setTimeout(connect, 1000);
  };
}
connect();
