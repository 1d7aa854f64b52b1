// SPDX-License-Identifier: Apache-2.0
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo } from "preact/hooks";
import { type Audit, Table, type WrittenTable } from "../data";
import { colorOf, ink } from "../theme";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Missing, PerFolder, Piece } from "../view/parts";

const kCauses = ["wrong_candidates", "nothing_in_sight", "few_matches", "false_answer", "few_inliers"];
const kUsual = ["level", "system", "labels", "settings", "query_set", "set", "environment", "queries", "correct", "first_correct", ...kCauses, "by_any", "by_nearest", "without_false", "with_true_pose", "average_precision"];

/** The fifth color is too near the first for parts of one bar. */
const colorOfCause = (i: number) => colorOf(i === 4 ? 5 : i);

/** Keys of audit.json's rows: plain, or within an object. */
function keyOf(table: Table, name: string): string | undefined {
  return table.columns.find((c) => c.key === name || c.key.endsWith(`.${name}`))?.key;
}

function Causes({ table }: { table: Table }): JSX.Element | null {
  const bars = useMemo(
    () =>
      Array.from({ length: table.rows }, (_, row) => row).flatMap((row) => {
        const of = ["system", "labels", "level", "query_set", "set", "queries", "settings"]
          .map((key) => table.text(key, row))
          .filter((text) => text !== "" && !/^\d/.test(text))
          .join(", ");
        return kCauses.flatMap((cause) => {
          const key = keyOf(table, cause);
          const share = key ? table.number(key, row) : null;
          return share === null ? [] : [{ of, cause: cause.replaceAll("_", " "), share: 100 * share }];
        });
      }),
    [table],
  );
  const names = [...new Set(bars.map((b) => b.of))];
  const causes = kCauses.map((c) => c.replaceAll("_", " "));
  const make = useCallback(
    (width: number): Plot.PlotOptions => ({
      height: 80 + (width > 600 ? 40 : 64) * names.length,
      marginLeft: width > 600 ? 260 : 20,
      marginTop: 24,
      x: { label: "share of queries, %", grid: true },
      y: { label: null, domain: names, axis: width > 600 ? "left" : null, padding: width > 600 ? 0.15 : 0.5 },
      marks: [
        Plot.barX(bars, Plot.stackX({ y: "of", x: "share", z: "cause", order: causes, fill: (b: { cause: string }) => colorOfCause(causes.indexOf(b.cause)), stroke: ink().paper, className: "m-cause" })),
        ...(width > 600 ? [] : [Plot.text(names, { x: 0, y: (n: string) => n, text: (n: string) => n, textAnchor: "start", dy: -24, lineWidth: Math.floor((width - 40) / 8), textOverflow: "ellipsis" })]),
      ],
    }),
    [bars],
  );
  if (bars.length === 0 || names.length > 40) return null;
  return (
    <Chart
      title="First causes of failures"
      about="Share of queries (%) by the first cause that holds, exact truth. Source: audit.json."
      legend={causes.map((name, i) => ({ name, color: colorOfCause(i) }))}
      marks={{ cause: bars.filter((b) => b.share >= 0).length }}
      make={make}
    />
  );
}

function AuditTable({ written, id }: { written: WrittenTable; id: string }): JSX.Element {
  const table = useMemo(() => new Table(written), [written]);
  const usual = kUsual.flatMap((name) => keyOf(table, name) ?? []);
  return (
    <>
      <h2>{table.title}</h2>
      {id.endsWith("-0") && <Causes table={table} />}
      <DataTable id={id} table={table} usual={usual} />
    </>
  );
}

export function AuditPage(): JSX.Element {
  return (
    <>
      <h1>Audit</h1>
      <PerFolder>
        {(folder, place) =>
          !folder.audit ? (
            <Missing>{folder.damaged.includes("audit.json") ? "audit.json is damaged." : "This folder holds no audit.json."} The command modelhouse audit SUITE --out FOLDER writes one, modelhouse bench SUITE --audit beside the results.</Missing>
          ) : (
            <Piece<Audit> piece={`${place}/audit`}>
              {(audit) => <>{audit.tables.map((written, i) => <AuditTable key={i} written={written} id={`audit-${place}-${i}`} />)}</>}
            </Piece>
          )
        }
      </PerFolder>
    </>
  );
}
