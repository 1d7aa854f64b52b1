// SPDX-License-Identifier: Apache-2.0
import type { Table } from "../data";
import { colorOf, kDashes } from "../theme";

/** Color and dash of the i-th line of a chart. */
export function armStyle(i: number): { color: string; dash: string } {
  return { color: colorOf(i), dash: kDashes[i % kDashes.length] ?? "0" };
}

/** What the rows of a table are of: the system, with its labels and the level where a table has
 * several of them. Rows of one arm may be counted together. */
export function armsOf(table: Table, rows: number[]): { name: (row: number) => string; names: string[] } {
  const different = (key: string) => new Set(rows.map((row) => table.text(key, row)).filter((word) => word !== "none" && word !== "")).size > 1;
  const parts = ["labels", "level"].filter(different);
  const name = (row: number) =>
    [table.text("system", row), ...parts.map((key) => table.text(key, row)).filter((word) => word !== "none" && word !== "")].join(", ");
  return { name, names: [...new Set(rows.map(name))] };
}

/** Room for names left of a chart, and what of a name fits there. */
export function nameMargin(names: string[], width: number): { margin: number; fitted: (name: string) => string } {
  const px = 6.8; // of a letter
  const margin = Math.max(60, Math.min(0.36 * width, 18 + px * Math.max(...names.map((name) => name.length))));
  const letters = Math.floor((margin - 16) / px);
  return { margin, fitted: (name) => (name.length > letters ? `${name.slice(0, letters - 1)}…` : name) };
}
