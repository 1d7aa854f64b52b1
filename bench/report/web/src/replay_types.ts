// SPDX-License-Identifier: Apache-2.0
// What a page and the replay script exchange.
import type { RunPaths } from "./data";

export interface ReplayData {
  run: string;
  same: boolean;
  mesh: {
    low_m: number[];
    step_m: number[];
    vertices: number;
    triangles: number;
    of_triangles: number;
    positions: string;
    colors: string;
    indices: string;
  } | null;
  landmarks: { mm: number[]; class: number[]; classes: Record<string, { name: string; color: string }> };
  keyframes: number[][];
}

type Place3 = [number, number, number];

/** Colors, and where queries are: their true places, right answers, wrong answers. */
export interface Look {
  paper: string;
  text: string;
  estimate: string;
  keyframe: string;
  right: string;
  wrong: string;
  queries: { truths: Place3[]; right: Place3[]; wrong: Place3[] };
}

export interface ReplayView {
  layers: string[];
  show(ms: number): void;
  setLayer(name: string, visible: boolean): void;
  setCut(height_m: number): void;
  setThrough(from: "orbit" | "true" | "estimated"): void;
  close(): void;
}

declare global {
  // eslint-disable-next-line no-var
  var modelhouseReplay:
    | ((canvas: HTMLCanvasElement, run: RunPaths, data: ReplayData | null, look: Look) => ReplayView)
    | undefined;
}
