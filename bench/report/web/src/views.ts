// SPDX-License-Identifier: Apache-2.0
// What was recorded of what a run saw: pictures, keypoints, matches.

interface WrittenView {
  frame: number;
  jpeg: string;
  keypoints: string;
}
export interface WrittenViews {
  width_px: number;
  height_px: number;
  keyframes: (WrittenView & { ms: number })[];
  queries: (WrittenView & { set: string; stage: string; candidates: { keyframe: number; pairs: string }[] })[];
}

export interface Keypoint {
  x: number;
  y: number;
  class: number;
  hasLandmark: boolean;
}
export interface Pair {
  from: [number, number]; // in the query's picture
  to: [number, number]; // in the keyframe's
  truth: "right" | "wrong" | "unknown";
  isPenalized: boolean;
}

function bytesOf(text: string): DataView {
  return new DataView(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
}

/** Records of `size` bytes each. */
function records<T>(text: string, size: number, read: (data: DataView, at: number) => T): T[] {
  const data = bytesOf(text);
  return Array.from({ length: Math.floor(data.byteLength / size) }, (_, i) => read(data, i * size));
}
const pixel = (data: DataView, at: number): number => data.getUint16(at, true) / 10;

export function keypointsOf(text: string): Keypoint[] {
  return records(text, 6, (data, at) => ({
    x: pixel(data, at),
    y: pixel(data, at + 2),
    class: data.getUint8(at + 4),
    hasLandmark: (data.getUint8(at + 5) & 1) !== 0,
  }));
}

export function pairsOf(text: string): Pair[] {
  return records(text, 9, (data, at) => {
    const flags = data.getUint8(at + 8);
    return {
      from: [pixel(data, at), pixel(data, at + 2)],
      to: [pixel(data, at + 4), pixel(data, at + 6)],
      truth: flags & 1 ? "right" : flags & 2 ? "wrong" : "unknown",
      isPenalized: (flags & 4) !== 0,
    };
  });
}
