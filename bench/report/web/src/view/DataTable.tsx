// SPDX-License-Identifier: Apache-2.0
// A table that sorts, filters and copies. Its state is in the address, so that it has a link.
import type { JSX } from "preact";
import { useMemo, useState } from "preact/hooks";
import { type Column, type Table, heading } from "../data";
import { useNoted } from "../route";
import { type Format, tableText } from "./copy";

const kFirst = 60; // rows at first: more are one click away

interface Props {
  id: string; // unique on its page: the name of its state in the address
  table: Table;
  rows?: number[]; // of the table; all by default
  usual?: string[]; // keys of the columns at first, in the table's order; all by default
  link?: (row: number) => { column: string; href: string } | null;
}

interface Sorting {
  key: string;
  down: boolean;
}

function sortingIn(text: string): Sorting | null {
  if (text === "") return null;
  return { key: text.replace(/^-/, ""), down: text.startsWith("-") };
}

function compare(table: Table, column: Column, down: boolean): (a: number, b: number) => number {
  const sign = down ? -1 : 1;
  if (column.isText)
    return (a, b) =>
      sign * table.text(column.key, a).localeCompare(table.text(column.key, b), "en", { numeric: true });
  return (a, b) => {
    const x = table.number(column.key, a);
    const y = table.number(column.key, b);
    if (x === null || y === null) return x === y ? 0 : x === null ? 1 : -1; // unknown last
    return sign * (x - y);
  };
}

/** Words as they are compared: a space in a column's name is written as "_". */
const plain = (text: string) => text.toLowerCase().replaceAll(" ", "_");

/** Rows that hold every word of a filter, in some cell that is shown; "column:word" in that one.
 * A column's name may itself hold a colon. */
function matching(table: Table, columns: Column[], rows: number[], filter: string): number[] {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return rows;
  const named = columns.flatMap((column) =>
    [column.key, column.title, heading(column)].map((name) => ({ column, name: `${plain(name)}:` })),
  );
  const tests = words.map((word) => {
    const asked = named.filter(({ name }) => word.startsWith(name) && word.length > name.length);
    if (asked.length > 0)
      return (row: number) => asked.some(({ column, name }) => plain(table.shown(column, row)).includes(word.slice(name.length)));
    return (row: number) => columns.some((c) => plain(table.shown(c, row)).includes(word));
  });
  return rows.filter((row) => tests.every((test) => test(row)));
}

/** The first word of a filter that names a column which does not exist. */
function unknownColumn(columns: Column[], filter: string): string | null {
  const names = columns.flatMap((c) => [c.key, c.title, heading(c)].map((name) => `${plain(name)}:`));
  const word = filter.toLowerCase().split(/\s+/).find((w) => /^[^:]+:./.test(w) && names.every((name) => !w.startsWith(name)));
  return word ? (word.split(":")[0] ?? null) : null;
}

export function DataTable({ id, table, rows, usual, link }: Props): JSX.Element {
  const [filter, setFilter] = useNoted(`${id}.q`, "");
  const [sorted, setSorted] = useNoted(`${id}.sort`, "");
  const [every, setEvery] = useNoted(`${id}.all`, "");
  const sorting = sortingIn(sorted);
  const all = every === "1";
  const [most, setMost] = useState(kFirst);
  const [said, setSaid] = useState("");

  const open = table.columns.filter((c) => !c.hidden);
  // A text that is the same in all rows is shown once, above them.
  const same = useMemo(() => {
    const shown = rows ?? Array.from({ length: table.rows }, (_, row) => row);
    return shown.length < 3 ? [] : open.slice(1).filter((c) => c.isText && shown.every((row) => table.text(c.key, row) === table.text(c.key, shown[0] ?? 0)));
  }, [table, rows]);
  const saidOnce = same.map((c) => [c.title, table.text(c.key, (rows ?? [0])[0] ?? 0)] as const).filter(([, text]) => text !== "");
  const few = open.filter((c) => (!usual || usual.includes(c.key)) && !same.includes(c));
  const columns = all ? open : few;
  const unknown = unknownColumn(open, filter);
  const found = useMemo(() => {
    const kept = matching(table, open, rows ?? Array.from({ length: table.rows }, (_, row) => row), filter);
    const by = sorting && table.column(sorting.key);
    return by ? [...kept].sort(compare(table, by, sorting.down)) : kept;
  }, [table, rows, filter, sorted]);

  const sortBy = (column: Column) => {
    const same = sorting?.key === column.key;
    // Numbers are sorted first from the largest; a third click ends the sorting.
    const first = !column.isText;
    const next = !same ? { key: column.key, down: first } : sorting.down === first ? { key: column.key, down: !first } : null;
    setSorted(next ? `${next.down ? "-" : ""}${next.key}` : "");
  };
  // Names in the first column do not wrap unless one of them is very long.
  const first = columns[0];
  const longest = useMemo(() => (first?.isText ? Math.max(0, ...table.words(first.key).map((word) => word.length)) : 0), [table, first]);
  const copy = async (format: Format) => {
    const done = await tableText(table, columns, found, format);
    setSaid(done ? `${found.length} rows are copied as ${format}.` : "The browser denied the clipboard.");
  };

  return (
    <section class="table" data-rows={table.rows} data-found={found.length}>
      <div class="tools">
        <label>
          Filter{" "}
          <input
            type="search"
            value={filter}
            placeholder="words, or column:word"
            title="Rows with all of these words. A word for one column: ate_m:0.01, with _ for a blank in its name."
            onInput={(event) => {
              setFilter(event.currentTarget.value);
              setMost(kFirst);
              setSaid("");
            }}
          />
        </label>
        <span class="count" role="status">
          {found.length} of {rows?.length ?? table.rows} rows{unknown !== null && `. No column is named '${unknown}'`}{said && `. ${said}`}
        </span>
        {few.length < open.length && (
          <label class="check">
            <input
              type="checkbox"
              checked={all}
              onChange={(event) => setEvery(event.currentTarget.checked ? "1" : "")}
            />
            all {open.length} columns
          </label>
        )}
        <span class="copies">
          Copy as{" "}
          {(["CSV", "Markdown", "LaTeX"] as const).map((format) => (
            <button type="button" key={format} onClick={() => void copy(format)}>
              {format}
            </button>
          ))}
        </span>
      </div>
      {!all && saidOnce.length > 0 && <p class="note">In every row: {saidOnce.map(([title, text]) => `${title} ${text}`).join("; ")}.</p>}
      <div class="scroll" tabIndex={0} role="region" aria-label={table.title}>
        <table class={longest <= 34 ? "whole-names" : undefined}>
          <caption class="unseen">{table.title}</caption>
          <thead>
            <tr>
              {columns.map((column) => {
                const here = sorting?.key === column.key;
                return (
                  <th
                    key={column.key}
                    scope="col"
                    class={column.isText ? "text" : "number"}
                    aria-sort={here ? (sorting.down ? "descending" : "ascending") : undefined}
                  >
                    <button type="button" onClick={() => sortBy(column)}>
                      {heading(column)}
                      <span aria-hidden="true">{here ? (sorting.down ? " ▾" : " ▴") : ""}</span>
                    </button>
                  </th>
                );
              })}
            </tr>
          </thead>
          <tbody>
            {found.slice(0, most).map((row) => {
              const linked = link?.(row);
              return (
                <tr key={row}>
                  {columns.map((column) => {
                    const shown = table.shown(column, row);
                    return (
                      <td key={column.key} class={column.isText ? "text" : "number"}>
                        {linked?.column === column.key ? <a href={linked.href}>{shown}</a> : shown}
                      </td>
                    );
                  })}
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      {found.length > most && (
        <p>
          <button type="button" onClick={() => setMost(most + 500)}>
            Show {Math.min(500, found.length - most)} more of {found.length - most}
          </button>
        </p>
      )}
      {table.note && <p class="note">{table.note}</p>}
    </section>
  );
}
