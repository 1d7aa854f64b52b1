// SPDX-License-Identifier: Apache-2.0
// A run from above: paths and queries over the occupancy grid, as the paper's Figures 2 and 5c.
import * as Plot from "@observablehq/plot";
import type { Path, RunPaths, Table } from "../data";
import { colorOf, ink, theme } from "../theme";

interface Place {
  x: number;
  y: number;
}

export function places(path: Path | null): Place[] {
  if (!path) return [];
  return path.ms.map((_, i) => ({ x: (path.mm[3 * i] ?? 0) / 1e3, y: (path.mm[3 * i + 1] ?? 0) / 1e3 }));
}

/** The grid as an image: occupied cells dark, unknown ones empty. */
function gridImage(grid: NonNullable<RunPaths["grid"]>): string {
  const canvas = document.createElement("canvas");
  canvas.width = grid.width;
  canvas.height = grid.height;
  const context = canvas.getContext("2d");
  if (!context) return "";
  const image = context.createImageData(grid.width, grid.height);
  const dark = theme() === "dark";
  let cell = 0;
  for (let i = 0; i + 1 < grid.cells.length; i += 2) {
    const value = grid.cells[i] ?? 0;
    for (let n = grid.cells[i + 1] ?? 0; n > 0; --n, ++cell) {
      const x = cell % grid.width;
      const y = grid.height - 1 - Math.floor(cell / grid.width);
      const at = 4 * (y * grid.width + x);
      const shade = value >= 50 ? (dark ? 190 : 70) : value === 0 ? (dark ? 44 : 238) : 0;
      image.data.set([shade, shade, shade, value < 0 ? 0 : 255], at);
    }
  }
  context.putImageData(image, 0, 0);
  return canvas.toDataURL("image/png");
}

export interface QueryPlaces {
  truths: (Place & { row: number })[];
  answers: (Place & { row: number; wrong: boolean })[];
  errors: { x1: number; y1: number; x2: number; y2: number }[];
}

/** True places of queries, the places that were answered, and a line between the two. */
export function queryPlaces(queries: Table, rows: number[]): QueryPlaces {
  const made: QueryPlaces = { truths: [], answers: [], errors: [] };
  for (const row of rows) {
    const x = queries.number("true_x", row);
    const y = queries.number("true_y", row);
    const ex = queries.number("estimated_x", row);
    const ey = queries.number("estimated_y", row);
    if (x !== null && y !== null) made.truths.push({ x, y, row });
    if (ex !== null && ey !== null)
      made.answers.push({ x: ex, y: ey, row, wrong: queries.text("outcome", row) === "false positive" });
    if (x !== null && y !== null && ex !== null && ey !== null)
      made.errors.push({ x1: x, y1: y, x2: ex, y2: ey });
  }
  return made;
}

/** @param chosen  the row of a query to frame */
export function topView(
  run: RunPaths,
  found: QueryPlaces,
  width: number,
  chosen: number | null = null,
): Plot.PlotOptions {
  const truth = places(run.truth);
  const estimate = places(run.estimate);
  const { grid } = run;
  const shown = [...truth, ...estimate, ...found.truths, ...found.answers];
  const xs = shown.map((p) => p.x);
  const ys = shown.map((p) => p.y);
  if (grid) {
    xs.push(grid.x_m, grid.x_m + grid.width * grid.cell_m);
    ys.push(grid.y_m, grid.y_m + grid.height * grid.cell_m);
  }
  const extent = (all: number[]): [number, number] => [Math.min(...all) - 0.2, Math.max(...all) + 0.2];
  let x = extent(xs);
  const y = extent(ys);
  const inner = width - 70;
  const height = Math.min(640, Math.max(220, (inner * (y[1] - y[0])) / (x[1] - x[0]) + 60));
  // The same scale in both directions: a plan that is too narrow gets margins on both sides.
  const scale = Math.min(inner / (x[1] - x[0]), (height - 60) / (y[1] - y[0]));
  const spare = Math.max(0, inner / scale - (x[1] - x[0])) / 2;
  x = [x[0] - spare, x[1] + spare];
  const { text } = ink();
  const marks: Plot.Markish[] = [];
  if (grid) {
    // An image mark is placed by its middle and sized in px.
    marks.push(
      Plot.image([0], {
        x: grid.x_m + (grid.width * grid.cell_m) / 2,
        y: grid.y_m + (grid.height * grid.cell_m) / 2,
        src: () => gridImage(grid),
        width: grid.width * grid.cell_m * scale,
        height: grid.height * grid.cell_m * scale,
        imageRendering: "pixelated",
        preserveAspectRatio: "none",
      }),
    );
  }
  if (truth.length > 1)
    marks.push(Plot.line(truth, { x: "x", y: "y", stroke: text, strokeWidth: 1.2, className: "m-path" }));
  if (estimate.length > 1)
    marks.push(
      Plot.line(estimate, {
        x: "x",
        y: "y",
        stroke: colorOf(0),
        strokeWidth: 1.6,
        strokeDasharray: "5 3",
        className: "m-path",
      }),
    );
  marks.push(
    Plot.link(found.errors, {
      x1: "x1",
      y1: "y1",
      x2: "x2",
      y2: "y2",
      stroke: colorOf(5),
      strokeOpacity: 0.7,
      className: "m-error",
    }),
    Plot.dot(found.truths, {
      x: "x",
      y: "y",
      symbol: "times",
      stroke: text,
      strokeWidth: 1.6,
      r: 4,
      className: "m-query",
    }),
    Plot.dot(found.answers, {
      x: "x",
      y: "y",
      symbol: (d: { wrong: boolean }) => (d.wrong ? "square" : "circle"),
      stroke: (d: { wrong: boolean }) => (d.wrong ? colorOf(5) : colorOf(2)),
      strokeWidth: 2,
      r: 4.5,
      className: "m-answer",
    }),
    Plot.dot(
      found.truths.filter((p) => p.row === chosen),
      { x: "x", y: "y", r: 11, stroke: colorOf(1), strokeWidth: 3, className: "m-chosen" },
    ),
  );
  return {
    width,
    height,
    marginRight: 12,
    marginTop: 26,
    x: { domain: x, label: "x, m", grid: !grid },
    y: { domain: y, label: "y, m", grid: !grid },
    color: { type: "identity" } as Plot.ScaleOptions,
    symbol: { domain: ["circle", "square"], range: ["circle", "square"] } as Plot.ScaleOptions,
    marks,
  };
}
