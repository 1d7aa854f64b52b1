// SPDX-License-Identifier: Apache-2.0
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo } from "preact/hooks";
import { type Overview, type Sentence, Table } from "../data";
import { colorOf, ink } from "../theme";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Facts, Missing, PerFolder, Piece } from "../view/parts";

/** Intervals of all comparisons in one unit, around a line at no difference. */
function Differences({ sentences, unit }: { sentences: Sentence[]; unit: string }): JSX.Element | null {
  const shown = useMemo(
    () =>
      sentences
        .filter((s) => s.unit === unit && s.difference !== null)
        .map((s) => {
          const scale = unit === "%" ? 100 : 1000;
          const of = (value: number | null) => (value === null ? null : scale * value);
          return {
            what: `${s.what.replaceAll("_", " ")}${sentences.some((o) => o.level !== s.level) ? `, ${s.level}` : ""}${
              sentences.some((o) => o.first !== s.first || o.second !== s.second)
                ? `: ${s.first} − ${s.second}`
                : ""
            }`,
            difference: of(s.difference) ?? 0,
            low: of(s.low),
            high: of(s.high),
            state: s.decided ? "decided" : s.in_family ? "undecided" : "not judged",
          };
        }),
    [sentences, unit],
  );
  const bounded = shown.filter((d) => d.low !== null && d.high !== null);
  const make = useCallback(
    (width: number): Plot.PlotOptions => {
      const room = 30 + 6.4 * Math.max(...shown.map((d) => d.what.length));
      const beside = room < 0.45 * width; // names; otherwise above their intervals
      const letters = Math.floor((width - 40) / 7);
      const lines = beside ? 1 : Math.max(...shown.map((d) => Math.ceil(d.what.length / letters)));
      const ends = [0, ...shown.map((d) => d.difference), ...bounded.flatMap((d) => [d.low ?? 0, d.high ?? 0])];
      const spare = Math.max(unit === "%" ? 1 : 0.5, 0.05 * (Math.max(...ends) - Math.min(...ends)));
      const color = (d: { state: string }) => (d.state === "decided" ? colorOf(0) : ink().faint);
      return {
        height: 60 + shown.length * (beside ? 28 : 30 + 15 * lines),
        marginLeft: beside ? room : 20,
        marginTop: 24,
        x: { label: unit === "%" ? "difference, percentage points" : "difference, mm", grid: true, domain: [Math.min(...ends) - spare, Math.max(...ends) + spare] },
        y: { label: null, domain: shown.map((d) => d.what), axis: beside ? "left" : null, padding: 0.4 },
        marks: [
          Plot.ruleX([0], { stroke: ink().text }),
          Plot.ruleY(bounded, { y: "what", x1: "low", x2: "high", stroke: color, strokeWidth: 3, className: "m-interval" }),
          Plot.dot(shown, {
            x: "difference",
            y: "what",
            fill: color,
            r: 5,
            symbol: (d: { state: string }) => (d.state === "decided" ? "circle" : d.state === "undecided" ? "diamond" : "times"),
            stroke: color,
            className: "m-difference",
          }),
          ...(beside
            ? []
            : [
                Plot.text(shown, {
                  y: "what",
                  text: "what",
                  frameAnchor: "left",
                  lineAnchor: "bottom",
                  dy: -9,
                  lineWidth: (0.95 * (width - 40)) / 12,
                  stroke: ink().paper,
                  strokeWidth: 5,
                  fill: ink().text,
                }),
              ]),
        ],
      };
    },
    [shown],
  );
  if (shown.length === 0) return null;
  const first = sentences[0];
  const pair = sentences.every((o) => o.first === first?.first && o.second === first?.second);
  return (
    <Chart
      title={unit === "%" ? "Differences of shares" : "Differences of distances"}
      about={`${pair ? `${first?.first} minus ${first?.second}` : "First minus second"}, ${
        unit === "%" ? "percentage points" : "mm"
      }, with 95 % bootstrap intervals; colored circles are decided, gray diamonds are not; gray crosses stand beside the declared family and are not judged. Source: results.sqlite.`}
      marks={{ difference: shown.length, interval: bounded.length }}
      make={make}
    />
  );
}

function Verdict({ verdicts, definitions, systems }: { verdicts: NonNullable<Overview["verdicts"]>; definitions: string; systems: number }): JSX.Element {
  const [first, ...others] = verdicts.sentences;
  if (!first) return <Missing>{systems > 1 ? "Nothing can be compared: no environment has queries or paths of both systems of a pair." : "This suite compares no two systems."}</Missing>;
  const undecided = others.filter((s) => s.in_family && !s.decided);
  const decided = others.filter((s) => s.in_family && s.decided);
  const table = new Table(verdicts.table);
  return (
    <>
      <p class={first.decided ? "verdict decided" : "verdict"}>{first.text}</p>
      <p class="note">{definitions}</p>
      {decided.length > 0 && (
        <>
          <h3>Also decided</h3>
          <ul>{decided.map((s) => <li key={s.text}>{s.text}</li>)}</ul>
        </>
      )}
      {undecided.length > 0 && (
        <>
          <h3>Not decided</h3>
          <ul>{undecided.map((s) => <li key={s.text}>{s.text}</li>)}</ul>
        </>
      )}
      <div class="charts">
        <Differences sentences={verdicts.sentences} unit="%" />
        <Differences sentences={verdicts.sentences} unit="m" />
      </div>
      <details>
        <summary>All comparisons</summary>
        <DataTable id="verdicts" table={table} />
      </details>
    </>
  );
}

export function OverviewPage(): JSX.Element {
  return (
    <>
      <h1>Overview</h1>
      <PerFolder points="first">
        {(folder, place) => (
          <Piece<Overview> piece={`${place}/overview`}>
            {(overview) => (
              <>
                {overview.suite && (
                  <Facts
                    facts={[
                      ["suite", overview.suite.name],
                      ["environments", overview.suite.environments],
                      ["trials", overview.suite.trials],
                      ["systems", overview.suite.systems.join(", ")],
                      ["labels", overview.suite.labels.join(", ")],
                      ["levels", overview.suite.levels.join(", ")],
                      ["runs", `${folder.runs} done, ${folder.failed} failed, ${folder.missing} missing`],
                    ]}
                  />
                )}
                {overview.remarks.length > 0 && folder.problem === null && (
                  <ul class="remarks">{overview.remarks.map((remark) => <li key={remark}>{remark}</li>)}</ul>
                )}
                {overview.verdicts && <Verdict verdicts={overview.verdicts} definitions={overview.definitions ?? ""} systems={overview.suite?.systems.length ?? 0} />}
                {overview.table2 ? (
                  <>
                    <h2>{new Table(overview.table2).title}</h2>
                    <DataTable id={`t2-${place}`} table={new Table(overview.table2)} />
                  </>
                ) : (
                  overview.suite && (
                    <Missing>No queries were asked, so there is no Table 2: a system that reports a trajectory alone, or a suite without test frames.</Missing>
                  )
                )}
                {overview.table1 ? (
                  <>
                    <h2>{new Table(overview.table1).title}</h2>
                    <DataTable
                      id={`t1-${place}`}
                      table={new Table(overview.table1)}
                      usual={[
                        "category",
                        "system",
                        "labels",
                        "scenes",
                        "ate_rmse_m",
                        "rpe_frame_rmse_m",
                        "completeness",
                        "held_out.success",
                        "held_out.distance_mean_m",
                        "remark",
                      ]}
                    />
                  </>
                ) : (
                  overview.suite && <Missing>One environment: there is no Table 1, which is over many.</Missing>
                )}
              </>
            )}
          </Piece>
        )}
      </PerFolder>
    </>
  );
}
