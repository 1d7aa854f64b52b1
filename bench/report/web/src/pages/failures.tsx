// SPDX-License-Identifier: Apache-2.0
// Queries without a correct answer: by stage, by cause, each a link to its run.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo, useState } from "preact/hooks";
import { type Folder, Table, type WrittenTable } from "../data";
import { linkTo } from "../route";
import { armStyle } from "../view/arm";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Choice, Missing, PerFolder, Piece } from "../view/parts";

function Counts({ table, rows, by, title, about }: { table: Table; rows: number[]; by: string; title: string; about: string }): JSX.Element | null {
  const bars = useMemo(() => {
    const counts = new Map<string, { what: string; system: string; count: number }>();
    for (const row of rows) {
      const what = table.text(by, row).replaceAll("_", " ") || "not reported";
      const system = table.text("system", row);
      const bar = counts.get(`${what} ${system}`) ?? { what, system, count: 0 };
      counts.set(`${what} ${system}`, { ...bar, count: bar.count + 1 });
    }
    return [...counts.values()];
  }, [table, rows, by]);
  const systems = table.words("system");
  const make = useCallback(
    (): Plot.PlotOptions => ({
      height: 80 + 26 * systems.length * new Set(bars.map((b) => b.what)).size,
      marginLeft: 128,
      marginTop: 22,
      fy: { label: null, padding: 0.15 },
      y: { axis: null, domain: systems, padding: 0.08 },
      x: { label: "queries", grid: true, tickFormat: (d: number) => (Number.isInteger(d) ? String(d) : "") },
      marks: [
        Plot.barX(bars, { fy: "what", y: "system", x: "count", fill: (b: { system: string }) => armStyle(systems.indexOf(b.system)).color, className: "m-count" }),
        Plot.text(bars, { fy: "what", y: "system", x: "count", text: "count", dx: 5, textAnchor: "start" }),
        Plot.ruleX([0]),
      ],
    }),
    [bars],
  );
  if (bars.length === 0) return null;
  return <Chart title={title} about={about} legend={systems.map((name, i) => ({ name, color: armStyle(i).color }))} marks={{ count: bars.length }} make={make} />;
}

function FailuresOf({ folder, place, written }: { folder: Folder; place: number; written: WrittenTable }): JSX.Element {
  const table = useMemo(() => new Table(written), [written]);
  const sets = table.words("query_set");
  const [set, setSet] = useState(sets[0] ?? "");
  const rows = useMemo(
    () => table.where({ query_set: set }).filter((row) => ["unanswered", "false positive"].includes(table.text("outcome", row)) && (table.number("point", row) ?? 0) === 0),
    [table, set],
  );
  if (table.rows === 0) return <Missing>No queries were asked: nothing could fail to be answered.</Missing>;
  const unanswered = rows.filter((row) => table.text("outcome", row) === "unanswered");
  const wrong = rows.length - unanswered.length;
  const asked = table.where({ query_set: set }).filter((row) => (table.number("point", row) ?? 0) === 0).length;
  return (
    <>
      <div class="choices">
        <Choice label="Queries" options={sets.map((key) => ({ key, title: key.replaceAll("_", " ") }))} value={set} onPick={setSet} />
      </div>
      <p>
        {unanswered.length} unanswered and {wrong} answered wrongly, of {asked} queries{table.has("point") ? ", at the first parameter point" : ""}.
      </p>
      <div class="charts">
        {table.has("stage") ? (
          <Counts table={table} rows={rows} by="stage" title="Failures by stage" about="Number of queries by the furthest stage that any attempt reached; verified: a wrong pose was returned. Source: results.sqlite." />
        ) : (
          <Missing>No system reported how far its relocalization got.</Missing>
        )}
        {table.has("cause") ? (
          <Counts table={table} rows={rows} by="cause" title="Failures by first cause" about="Number of queries by the first cause that the audit found, by exact truth. Source: audit.csv." />
        ) : (
          <Missing>Causes are not known: the folder holds no audit (modelhouse bench --audit, or modelhouse audit into this folder).</Missing>
        )}
      </div>
      {rows.length === 0 ? (
        <Missing>No query of this set failed.</Missing>
      ) : (
        <DataTable
          id={`fail-${place}`}
          table={table}
          rows={rows}
          link={(row) => ({ column: "frame", href: linkTo(["run", String(place), table.text("run", row)], { query: row }) })}
        />
      )}
      {folder.failed > 0 && <FailedRuns place={place} />}
    </>
  );
}

function FailedRuns({ place }: { place: number }): JSX.Element {
  return (
    <>
      <h2>Failed runs</h2>
      <Piece<WrittenTable> piece={`${place}/runs`}>
        {(written) => {
          const table = new Table(written);
          return <DataTable id={`broken-${place}`} table={table} rows={table.where({ status: "failed" })} usual={["run", "environment", "system", "labels", "error"]} />;
        }}
      </Piece>
    </>
  );
}

export function FailuresPage(): JSX.Element {
  return (
    <>
      <h1>Failures</h1>
      <PerFolder>
        {(folder, place) =>
          folder.suite === null ? null : <Piece<WrittenTable> piece={`${place}/queries`}>{(written) => <FailuresOf folder={folder} place={place} written={written} />}</Piece>
        }
      </PerFolder>
    </>
  );
}
