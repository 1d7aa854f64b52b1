// SPDX-License-Identifier: Apache-2.0
// What `modelhouse report` wrote: pieces of data in script files, which assign to one registry.
// Scripts load from the disk, where a page may not read other files.

/** A column as it was written; each word is written once. */
interface WrittenColumn {
  key: string;
  title: string;
  hidden?: boolean;
  unit?: string;
  decimals?: number;
  words?: string[];
  values: (number | null)[];
}
export interface WrittenTable {
  title: string;
  note: string;
  rows: number;
  columns: WrittenColumn[];
}

export interface Folder {
  name: string;
  problem: string | null;
  suite: string | null;
  runs: number;
  failed: number;
  missing: number;
  audit: boolean;
  runs_of_file: number;
  replays: string[]; // names of runs
  views: string[]; // those of them whose images were recorded
  first_point: string | null; // the point of a sweep that verdicts, tables and figures show
  arms: { system: string; labels: string }[]; // in the suite's order; labels are "none" if it sees none
  levels: string[];
  damaged: string[]; // files next to the results
}
/** One comparison of two systems. */
export interface Difference {
  finding: string; // in figures
  decided: boolean;
  in_family: boolean;
  pooled: boolean;
  measure: string; // "correct"
  what: string;
  level: string;
  unit: string;
  first: string;
  second: string;
  difference: number | null;
  low: number | null;
  high: number | null;
}
/** The verdict on a pair in one plain sentence, and the comparison that it rests on. */
export interface Headline {
  level: string;
  first: string;
  second: string;
  text: string;
  detail: string;
  decided: boolean;
}
export interface Overview {
  warnings: string[];
  notes: string[];
  definitions?: string;
  suite?: {
    name: string;
    trials: number;
    environments: number;
    systems: string[];
    labels: string[];
    levels: string[];
    measure: string; // what the suite is judged by: "correct" or "success"
    settings: unknown;
  };
  verdicts?: { headlines: Headline[]; differences: Difference[]; table: WrittenTable };
  tiles?: WrittenTable;
  table1?: WrittenTable | null;
  table2?: WrittenTable | null;
  published_ate?: WrittenTable | null;
}
/** What the overview shows of a place. */
export interface PlaceImages {
  plans: { run: string; system: string; labels: string; environment: string; png: string }[];
  run: RunPaths | null;
  queries: WrittenTable | null;
  frames: { environment: string; problem: string | null; list: { frame: number; jpeg: string }[] } | null;
}
export interface GradedShare {
  success: number;
  correct: number;
  false_positive: number;
  low?: number;
  high?: number;
}
export interface Figures {
  candidates?: WrittenTable | null;
  density?: { table: WrittenTable; groups: string[] } | null;
  by_frame?: WrittenTable | null;
  sweep?: { table: WrittenTable; varied: string[]; best: string[] } | null;
  graded?: unknown;
}
export interface Path {
  of: number;
  ms: number[];
  mm: number[];
  turn: number[];
}
export interface RunPaths {
  name: string;
  scene: string;
  robot: string;
  length_m: number | null;
  frames: number;
  cut: boolean;
  truth: Path | null;
  estimate: Path | null;
  calls: {
    of: number;
    ms: number[];
    inliers: (number | null)[];
    lost_ms: number[];
    keyframes_ms: number[];
  } | null;
  loops: number;
  grid: { width: number; height: number; cell_m: number; x_m: number; y_m: number; cells: number[] } | null;
  grid_damaged: boolean;
  inputs: Record<string, string>;
  trajectory_digest: string;
  seed: number;
  settings: unknown;
}
export interface Audit {
  tables: WrittenTable[];
  definitions: Record<string, unknown> | null;
}

declare global {
  // eslint-disable-next-line no-var
  var modelhouse: Record<string, unknown> | undefined;
}

const waiting = new Map<string, Promise<unknown>>();

/** Loads a piece ("0/runs") and keeps it once it is loaded. */
export function load<T>(piece: string): Promise<T> {
  const here = globalThis.modelhouse?.[piece];
  if (here !== undefined) return Promise.resolve(here as T);
  let found = waiting.get(piece);
  if (!found) {
    found = new Promise<T>((resolve, reject) => {
      const script = document.createElement("script");
      script.src = `data/${piece.replaceAll("/", "-")}.js`;
      script.onload = () => {
        const value = globalThis.modelhouse?.[piece];
        if (value === undefined) reject(new Error(`${script.getAttribute("src")} is damaged`));
        else resolve(value as T);
      };
      script.onerror = () => reject(new Error(`${script.getAttribute("src")} is missing`));
      document.head.append(script);
    });
    waiting.set(piece, found);
  }
  return found as Promise<T>;
}

export const folders: Folder[] =
  (globalThis.modelhouse?.index as { folders: Folder[] } | undefined)?.folders ?? [];

export interface Column {
  key: string;
  title: string;
  hidden: boolean;
  isText: boolean;
  unit: string;
  decimals: number;
}

/** A table by columns. Cells are read by row; nothing is copied. */
export class Table {
  readonly title: string;
  readonly note: string;
  readonly rows: number;
  readonly columns: Column[];
  private readonly written = new Map<string, WrittenColumn>();

  constructor(table: WrittenTable) {
    this.title = table.title;
    this.note = table.note;
    this.rows = table.rows;
    this.columns = table.columns.map((c) => ({
      key: c.key,
      title: c.title,
      hidden: c.hidden ?? false,
      isText: c.words !== undefined,
      unit: c.unit ?? "",
      decimals: c.decimals ?? 0,
    }));
    for (const c of table.columns) this.written.set(c.key, c);
  }

  has(key: string): boolean {
    return this.written.has(key);
  }
  column(key: string): Column | undefined {
    return this.columns.find((c) => c.key === key);
  }
  text(key: string, row: number): string {
    const column = this.written.get(key);
    const value = column?.values[row];
    return value === null || value === undefined ? "" : (column?.words?.[value] ?? String(value));
  }
  number(key: string, row: number): number | null {
    const column = this.written.get(key);
    if (!column || column.words) return null;
    return column.values[row] ?? null;
  }
  /** What a reader sees: "87.50 %", "0.0123", "" if unknown. */
  shown(column: Column, row: number): string {
    if (column.isText) return this.text(column.key, row);
    return shownNumber(this.number(column.key, row), column.unit, column.decimals);
  }
  /** Rows with all of these texts, in order. */
  where(texts: Record<string, string>): number[] {
    const found: number[] = [];
    for (let row = 0; row < this.rows; ++row)
      if (Object.entries(texts).every(([key, value]) => this.text(key, row) === value))
        found.push(row);
    return found;
  }
  /** The different texts of a column, in the order of their first rows. */
  words(key: string): string[] {
    return [...new Set(Array.from({ length: this.rows }, (_, row) => this.text(key, row)))].filter(
      (word) => word !== "",
    );
  }
}

export function shownNumber(value: number | null, unit: string, decimals: number): string {
  if (value === null) return "";
  const shown = unit === "%" ? 100 * value : value;
  // A value other than zero must not be shown as zero.
  if (shown !== 0 && Math.abs(shown) < 0.5 * 10 ** -decimals) return shown.toPrecision(1);
  return shown.toFixed(decimals);
}

/** A column's heading with its unit. */
export function heading(column: Column): string {
  const has = column.unit === "" || column.title.endsWith(` ${column.unit}`) || column.title.includes(`${column.unit}/`);
  return has ? column.title : `${column.title}, ${column.unit}`;
}
