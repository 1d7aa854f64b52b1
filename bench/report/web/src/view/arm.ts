// SPDX-License-Identifier: Apache-2.0
import { type Folder, type Table, folders } from "../data";
import { colorOf, kDashes, kSymbols } from "../theme";

export interface Style {
  color: string;
  dash: string;
  symbol: (typeof kSymbols)[number];
}

/** Color, dash and symbol of the i-th line of a chart. */
export function armStyle(i: number): Style {
  return { color: colorOf(i), dash: kDashes[i % kDashes.length] ?? "0", symbol: kSymbols[i % kSymbols.length] ?? "circle" };
}

const armKey = (system: string, labels: string) => `${system}\n${labels}`;
/** The arms of all folders, each once, in the order of the first folder that has it. */
const kArms = [...new Set(folders.flatMap((folder) => folder.arms.map((arm) => armKey(arm.system, arm.labels))))];

/** The style of a system with its labels: the same on all pages, and in all folders. A folder's
 * levels beyond the first have styles of their own. */
export function styleOf(folder: Folder, system: string, labels: string, level: string): Style {
  const seen = folder.arms.find((arm) => arm.system === system && (arm.labels === labels || arm.labels === "none"));
  const arm = kArms.indexOf(armKey(system, seen?.labels ?? labels));
  return armStyle(Math.max(0, folder.levels.indexOf(level)) * kArms.length + Math.max(0, arm));
}

export interface Arms {
  name: (row: number) => string;
  names: string[]; // in the order of their first rows
  style: (name: string) => Style;
}

/** The arms that a table's rows belong to: the system, with its labels and the level where a table
 * has several of them. Rows of one arm may be counted together. */
export function armsOf(folder: Folder, table: Table, rows: number[]): Arms {
  const different = (key: string) => new Set(rows.map((row) => table.text(key, row)).filter((word) => word !== "none" && word !== "")).size > 1;
  const parts = ["labels", "level"].filter(different);
  const name = (row: number) =>
    [table.text("system", row), ...parts.map((key) => table.text(key, row)).filter((word) => word !== "none" && word !== "")].join(", ");
  const styles = new Map<string, Style>();
  for (const row of rows) {
    const of = name(row);
    if (!styles.has(of)) styles.set(of, styleOf(folder, table.text("system", row), table.text("labels", row), table.text("level", row)));
  }
  return { name, names: [...styles.keys()], style: (of) => styles.get(of) ?? armStyle(0) };
}

/** The margin for names left of a chart, and the part of a name that fits there. */
export function nameMargin(names: string[], width: number): { margin: number; fitted: (name: string) => string } {
  const px = 6.8; // of a letter
  const margin = Math.max(60, Math.min(0.36 * width, 18 + px * Math.max(...names.map((name) => name.length))));
  const letters = Math.floor((margin - 16) / px);
  return { margin, fitted: (name) => (name.length > letters ? `${name.slice(0, letters - 1)}…` : name) };
}
