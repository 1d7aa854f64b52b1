// SPDX-License-Identifier: Apache-2.0
// Tables as text for other programs.
import { type Column, type Table, heading } from "../data";

export type Format = "CSV" | "Markdown" | "LaTeX";

function csvCell(text: string): string {
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
const kLatex: Record<string, string> = {
  "\\": "\\textbackslash{}",
  "~": "\\textasciitilde{}",
  "^": "\\textasciicircum{}",
  "<": "\\textless{}",
  ">": "\\textgreater{}",
  "|": "\\textbar{}",
  "²": "$^2$",
  "°": "$^\\circ$",
};
/** Like latex_cell() of bench/report/export.cpp. */
function latexCell(text: string): string {
  return text
    .replace(/[\\~^<>|²°&%$#_{}]/gu, (c) => kLatex[c] ?? `\\${c}`)
    .replace(/[^\0-\x7f\u00c0-\u017f]/gu, (c) => `[U+${c.codePointAt(0)?.toString(16).toUpperCase().padStart(4, "0")}]`);
}
function markdownCell(text: string): string {
  return text.replace(/[\\|<>*_`]/g, "\\$&").replaceAll("\n", " ");
}

/** The text of some rows and columns, as they are shown. */
export function written(table: Table, columns: Column[], rows: number[], format: Format): string {
  const heads = columns.map(heading);
  const lines = rows.map((row) => columns.map((column) => table.shown(column, row)));
  if (format === "CSV")
    return [heads, ...lines].map((cells) => `${cells.map(csvCell).join(",")}\n`).join("");
  if (format === "Markdown") {
    const line = (cells: string[]) => `| ${cells.map(markdownCell).join(" | ")} |\n`;
    const rule = `|${columns.map((c) => (c.isText ? "---" : "--:")).join("|")}|\n`;
    return line(heads) + rule + lines.map(line).join("");
  }
  const line = (cells: string[]) => `${cells.map(latexCell).join(" & ")} \\\\\n`;
  return (
    `\\begin{tabular}{${columns.map((c) => (c.isText ? "l" : "r")).join("")}}\n\\toprule\n` +
    `${line(heads)}\\midrule\n${lines.map(line).join("")}\\bottomrule\n\\end{tabular}\n`
  );
}

export async function putOnClipboard(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
}

export function tableText(table: Table, columns: Column[], rows: number[], format: Format): Promise<boolean> {
  return putOnClipboard(written(table, columns, rows, format));
}
