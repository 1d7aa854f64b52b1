// SPDX-License-Identifier: Apache-2.0
// Queries without a correct answer: by stage, by cause, each a link to its run.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo } from "preact/hooks";
import { type Folder, Table, type WrittenTable } from "../data";
import { linkTo, useNoted } from "../route";
import { armsOf, nameMargin } from "../view/arm";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Choice, Missing, PerFolder, Piece } from "../view/parts";

/** In the order in which a query reaches them: results.sqlite's stages, audit.csv's causes. */
const kOrder = ["none", "no candidate", "matches", "pnp", "inliers", "verified", "nothing in sight", "wrong candidates", "few matches", "few inliers", "false answer"];

interface CountsProps {
  folder: Folder;
  table: Table;
  asked: number[]; // rows of all queries
  rows: number[]; // of those that failed
  by: string;
  title: string;
  about: string;
}
function Counts({ folder, table, asked, rows, by, title, about }: CountsProps): JSX.Element | null {
  const arms = useMemo(() => armsOf(folder, table, asked), [table, asked]);
  const bars = useMemo(() => {
    const counts = new Map<string, { what: string; arm: string; count: number; of: number }>();
    const askedOf = new Map<string, number>();
    for (const row of asked) askedOf.set(arms.name(row), (askedOf.get(arms.name(row)) ?? 0) + 1);
    for (const row of rows) {
      const what = table.text(by, row).replaceAll("_", " ") || "not reported";
      const arm = arms.name(row);
      const bar = counts.get(`${what} ${arm}`) ?? { what, arm, count: 0, of: askedOf.get(arm) ?? 0 };
      counts.set(`${what} ${arm}`, { ...bar, count: bar.count + 1 });
    }
    return [...counts.values()].map((bar) => ({ ...bar, share: (100 * bar.count) / bar.of }));
  }, [table, rows, by]);
  const whats = [...new Set(bars.map((b) => b.what))].sort((a, b) => kOrder.indexOf(a) - kOrder.indexOf(b));
  const make = useCallback(
    (width: number): Plot.PlotOptions => {
      const { margin, fitted } = nameMargin(whats, width);
      return {
        height: 80 + 26 * arms.names.length * whats.length,
        marginLeft: margin,
        marginTop: 22,
        marginRight: 96,
        fy: { label: null, padding: 0.15, domain: whats, tickFormat: fitted },
        y: { axis: null, domain: arms.names, padding: 0.08 },
        x: { label: "share of the queries asked, %", grid: true },
        marks: [
          Plot.barX(bars, { fy: "what", y: "arm", x: "share", fill: (b: { arm: string }) => arms.style(b.arm).color, className: "m-count" }),
          Plot.text(bars, { fy: "what", y: "arm", x: "share", text: (b: { count: number; of: number }) => `${b.count} of ${b.of}`, dx: 5, textAnchor: "start" }),
          Plot.ruleX([0]),
        ],
      };
    },
    [bars],
  );
  if (bars.length === 0) return null;
  return <Chart title={title} about={about} legend={arms.names.map((name) => ({ name, color: arms.style(name).color }))} marks={{ count: bars.length }} make={make} />;
}

const kFailed = ["unanswered", "false positive"];

function FailuresOf({ folder, place, written }: { folder: Folder; place: number; written: WrittenTable }): JSX.Element {
  const table = useMemo(() => new Table(written), [written]);
  const sets = table.words("query_set");
  // The set with the most failures is shown first.
  const failures = (key: string) => table.where({ query_set: key }).filter((row) => kFailed.includes(table.text("outcome", row))).length;
  const usual = useMemo(() => [...sets].sort((a, b) => failures(b) - failures(a))[0] ?? "", [table]);
  const [picked, setSet] = useNoted(`set-${place}`, usual);
  const set = sets.includes(picked) ? picked : usual;
  const asked = useMemo(() => table.where({ query_set: set }).filter((row) => (table.number("point", row) ?? 0) === 0), [table, set]);
  const rows = useMemo(() => asked.filter((row) => kFailed.includes(table.text("outcome", row))), [asked]);
  if (table.rows === 0) return <Missing>No queries were asked: nothing could fail to be answered.</Missing>;
  const unanswered = rows.filter((row) => table.text("outcome", row) === "unanswered");
  const wrong = rows.length - unanswered.length;
  return (
    <>
      <div class="choices">
        <Choice label="Queries" options={sets.map((key) => ({ key, title: key.replaceAll("_", " ") }))} value={set} onPick={setSet} />
      </div>
      <p>
        {unanswered.length} unanswered and {wrong} answered wrongly, of {asked.length} queries.
      </p>
      <div class="charts">
        {table.has("stage") ? (
          <Counts folder={folder} table={table} asked={asked} rows={rows} by="stage" title="Failures by stage" about="Share of queries (%), and their number, by the furthest stage that any attempt reached; verified: a wrong pose was returned. Source: results.sqlite." />
        ) : (
          <Missing>No system reported how far its relocalization got.</Missing>
        )}
        {table.has("cause") ? (
          <Counts folder={folder} table={table} asked={asked} rows={rows} by="cause" title="Failures by first cause" about="Share of queries (%), and their number, by the first cause that the audit found, by exact truth. Source: audit.csv." />
        ) : (
          <Missing>
            {folder.audit ? (
              <>
                audit.csv is missing or names no cause for these queries: shares by cause are on the page <a href={linkTo(["audit"])}>Audit</a>.
              </>
            ) : (
              `Causes are not known: ${folder.damaged.includes("audit.json") ? "audit.json is damaged" : "the folder holds no audit"} (modelhouse bench --audit, or modelhouse audit into this folder).`
            )}
          </Missing>
        )}
      </div>
      {rows.length === 0 ? (
        <Missing>No query of this set failed.</Missing>
      ) : (
        <DataTable
          id={`fail-${place}`}
          table={table}
          rows={rows}
          usual={["run", "frame", "outcome", "stage", "cause", "distance_m", "angle_deg", "attempts", "final"]}
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
