// SPDX-License-Identifier: Apache-2.0
// A run in three dimensions: scene, paths, cameras, keyframes, landmarks, queries. A script of its
// own, which a page loads when a reader opens a replay.
import {
  AxesHelper, BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, Group, Line, LineBasicMaterial,
  LineDashedMaterial, LineSegments, Mesh, MeshBasicMaterial, Object3D, PerspectiveCamera, Plane, PlaneGeometry, Points,
  PointsMaterial, Quaternion, Scene, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Path, RunPaths } from "./data";
import type { Look, ReplayData, ReplayView } from "./replay_types";

function bytes(text: string): Uint8Array {
  const raw = atob(text);
  const made = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) made[i] = raw.charCodeAt(i);
  return made;
}

function meshOf(mesh: NonNullable<ReplayData["mesh"]>, clip: Plane): Mesh {
  const geometry = new BufferGeometry();
  const packed = new Uint16Array(bytes(mesh.positions).buffer);
  const positions = new Float32Array(packed.length);
  for (let i = 0; i < packed.length; ++i) positions[i] = mesh.low_m[i % 3]! + packed[i]! * mesh.step_m[i % 3]!;
  const shades = bytes(mesh.colors);
  const colors = new Float32Array(shades.length);
  const color = new Color();
  for (let i = 0; i < shades.length; i += 3) {
    color.setRGB(shades[i]! / 255, shades[i + 1]! / 255, shades[i + 2]! / 255, "srgb");
    colors.set([color.r, color.g, color.b], i);
  }
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(bytes(mesh.indices).buffer), 1));
  return new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, clippingPlanes: [clip] }));
}

function points(path: Path): Vector3[] {
  return path.ms.map((_, i) => new Vector3(path.mm[3 * i]! / 1e3, path.mm[3 * i + 1]! / 1e3, path.mm[3 * i + 2]! / 1e3));
}

function lineOf(path: Path, color: string, dashed: boolean): Line {
  const geometry = new BufferGeometry().setFromPoints(points(path));
  const line = new Line(geometry, dashed ? new LineDashedMaterial({ color, dashSize: 0.12, gapSize: 0.06 }) : new LineBasicMaterial({ color }));
  if (dashed) line.computeLineDistances();
  return line;
}

/** The outline of a camera that looks along z, as wide as a view of 60 degrees. */
function cameraShape(size: number, color: string): LineSegments {
  const [w, h, d] = [0.58 * size, 0.43 * size, size];
  const corners = [[-w, -h], [w, -h], [w, h], [-w, h]].map(([x, y]) => new Vector3(x, y, d));
  const parts: Vector3[] = [];
  corners.forEach((corner, i) => parts.push(new Vector3(), corner, corner, corners[(i + 1) % 4]!));
  return new LineSegments(new BufferGeometry().setFromPoints(parts), new LineBasicMaterial({ color }));
}

/** Places an object on a path at a time, between the poses before and after it. */
function place(object: Object3D, path: Path, ms: number): void {
  let after = path.ms.findIndex((t) => t >= ms);
  if (after < 0) after = path.ms.length - 1;
  const before = Math.max(0, after - 1);
  const gap = path.ms[after]! - path.ms[before]!;
  const share = gap > 0 ? Math.min(1, Math.max(0, (ms - path.ms[before]!) / gap)) : 0;
  const at = (i: number) => new Vector3(path.mm[3 * i]!, path.mm[3 * i + 1]!, path.mm[3 * i + 2]!).divideScalar(1e3);
  const turn = (i: number) => new Quaternion(path.turn[4 * i]!, path.turn[4 * i + 1]!, path.turn[4 * i + 2]!, path.turn[4 * i + 3]!).normalize();
  object.position.copy(at(before).lerp(at(after), share));
  object.quaternion.copy(turn(before).slerp(turn(after), share));
}

function floorOf(grid: NonNullable<RunPaths["grid"]>): Mesh {
  const canvas = document.createElement("canvas");
  canvas.width = grid.width;
  canvas.height = grid.height;
  const context = canvas.getContext("2d");
  const image = context?.createImageData(grid.width, grid.height);
  let cell = 0;
  for (let i = 0; image && i + 1 < grid.cells.length; i += 2)
    for (let n = grid.cells[i + 1]!; n > 0; --n, ++cell) {
      const value = grid.cells[i]!;
      const y = grid.height - 1 - Math.floor(cell / grid.width);
      const shade = value >= 50 ? 30 : 235;
      image.data.set([shade, shade, shade, value < 0 ? 0 : 190], 4 * (y * grid.width + (cell % grid.width)));
    }
  if (image) context?.putImageData(image, 0, 0);
  const [w, h] = [grid.width * grid.cell_m, grid.height * grid.cell_m];
  const made = new Mesh(new PlaneGeometry(w, h), new MeshBasicMaterial({ map: new CanvasTexture(canvas), transparent: true, side: DoubleSide }));
  made.position.set(grid.x_m + w / 2, grid.y_m + h / 2, 0.03);
  return made;
}

function crosses(places: [number, number, number][], color: string, r: number): LineSegments {
  const parts = places.flatMap(([x, y, z]) => [new Vector3(x - r, y - r, z), new Vector3(x + r, y + r, z), new Vector3(x - r, y + r, z), new Vector3(x + r, y - r, z)]);
  return new LineSegments(new BufferGeometry().setFromPoints(parts), new LineBasicMaterial({ color }));
}
function rings(places: [number, number, number][], color: string, r: number): LineSegments {
  const parts = places.flatMap(([x, y, z]) =>
    Array.from({ length: 16 }, (_, i) => [i, i + 1]).flatMap((ends) => ends.map((i) => new Vector3(x + r * Math.cos((i * Math.PI) / 8), y + r * Math.sin((i * Math.PI) / 8), z))),
  );
  return new LineSegments(new BufferGeometry().setFromPoints(parts), new LineBasicMaterial({ color }));
}

function open(canvas: HTMLCanvasElement, run: RunPaths, data: ReplayData | null, look: Look): ReplayView {
  const renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.localClippingEnabled = true;
  const scene = new Scene();
  scene.background = new Color(look.paper);
  const clip = new Plane(new Vector3(0, 0, -1), 2.0);
  const layers: Record<string, Object3D> = {};
  const add = (name: string, object: Object3D) => {
    const group = layers[name] ?? new Group();
    layers[name] = group;
    group.add(object);
    scene.add(group);
  };
  if (data?.mesh) add("scene", meshOf(data.mesh, clip));
  if (run.grid) add("occupancy", floorOf(run.grid));
  if (run.truth) add("true path", lineOf(run.truth, look.text, false));
  if (run.estimate) add("estimated path", lineOf(run.estimate, look.estimate, true));
  if (data) {
    const { mm, class: of, classes } = data.landmarks;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(Float32Array.from(mm, (v) => v / 1e3), 3));
    const colors = new Float32Array(3 * of.length);
    of.forEach((id, i) => new Color(classes[id]?.color ?? "#888888").toArray(colors, 3 * i));
    geometry.setAttribute("color", new BufferAttribute(colors, 3));
    add("landmarks", new Points(geometry, new PointsMaterial({ size: 0.035, vertexColors: true })));
    for (const k of data.keyframes) {
      const shape = cameraShape(0.12, look.keyframe);
      shape.position.set(k[0]! / 1e3, k[1]! / 1e3, k[2]! / 1e3);
      shape.quaternion.set(k[3]!, k[4]!, k[5]!, k[6]!).normalize();
      add("keyframes", shape);
    }
  }
  const { truths, right, wrong } = look.queries;
  if (truths.length > 0) add("queries", crosses(truths, look.text, 0.07));
  if (right.length > 0) add("queries", rings(right, look.right, 0.08));
  if (wrong.length > 0) add("queries", rings(wrong, look.wrong, 0.1));
  const truth = cameraShape(0.3, look.text);
  const estimate = cameraShape(0.3, look.estimate);
  if (run.truth) scene.add(truth);
  if (run.estimate) scene.add(estimate);
  scene.add(new AxesHelper(0.4));

  const path = points((run.truth ?? run.estimate)!);
  const low = path.reduce((a, p) => a.min(p), path[0]!.clone());
  const high = path.reduce((a, p) => a.max(p), path[0]!.clone());
  const middle = low.clone().add(high).divideScalar(2);
  const size = Math.max(3, high.clone().sub(low).length());
  const camera = new PerspectiveCamera(50, 1, 0.05, 200);
  camera.up.set(0, 0, 1);
  camera.position.copy(middle).add(new Vector3(-0.35 * size, -0.75 * size, 0.95 * size));
  const orbit = new OrbitControls(camera, canvas);
  orbit.target.copy(middle);
  orbit.update();
  let through: "orbit" | "true" | "estimated" = "orbit";

  const draw = () => {
    const from = through === "true" ? truth : through === "estimated" ? estimate : null;
    truth.visible = from !== truth;
    estimate.visible = from !== estimate;
    if (from) {
      const eye = camera.clone();
      eye.position.copy(from.position);
      // A camera of this program looks along z with y down, one of three.js along -z with y up.
      eye.quaternion.copy(from.quaternion).multiply(new Quaternion(1, 0, 0, 0));
      eye.fov = 46;
      eye.updateProjectionMatrix();
      renderer.render(scene, eye);
    } else {
      renderer.render(scene, camera);
    }
  };
  const resize = () => {
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (w === 0 || h === 0) return;
    renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    renderer.setSize(w, h, false);
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    draw();
  };
  orbit.addEventListener("change", draw);
  const watch = new ResizeObserver(resize);
  watch.observe(canvas);
  resize();
  return {
    layers: Object.keys(layers),
    show(ms) {
      if (run.truth) place(truth, run.truth, ms);
      if (run.estimate) place(estimate, run.estimate, ms);
      draw();
    },
    setLayer(name, visible) {
      const layer = layers[name];
      if (layer) layer.visible = visible;
      draw();
    },
    setCut(height_m) {
      clip.constant = height_m;
      draw();
    },
    setThrough(from) {
      through = from;
      orbit.enabled = from === "orbit";
      draw();
    },
    close() {
      watch.disconnect();
      orbit.dispose();
      renderer.dispose();
    },
  };
}

globalThis.modelhouseReplay = open;
