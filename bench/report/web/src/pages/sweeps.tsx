// SPDX-License-Identifier: Apache-2.0
// Answers over the points of a sweep: a heat map over two settings, response curves over each.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo, useState } from "preact/hooks";
import { type Column, type Figures, Table, heading } from "../data";
import { kSymbols, theme } from "../theme";
import { armStyle } from "../view/arm";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Choice, Missing, PerFolder, Piece } from "../view/parts";

type Sweep = NonNullable<Figures["sweep"]>;

const kMeasures = ["success", "correct", "false_positive", "distance_mean_m", "final"];

interface View {
  table: Table;
  rows: number[];
  measure: Column;
  about: string;
}

function inUnit(column: Column, value: number): number {
  return column.unit === "%" ? 100 * value : value;
}

function HeatMap({ view, across, down }: { view: View; across: Column; down: Column }): JSX.Element | null {
  const { table, rows, measure } = view;
  const cells = useMemo(
    () =>
      rows.flatMap((row) => {
        const value = table.number(measure.key, row);
        return value === null ? [] : [{ x: table.text(across.key, row), y: table.text(down.key, row), value: inUnit(measure, value) }];
      }),
    [view],
  );
  const make = useCallback(
    (width: number): Plot.PlotOptions => {
      const numeric = (a: string, b: string) => Number(a) - Number(b) || a.localeCompare(b);
      const ys = [...new Set(cells.map((c) => c.y))].sort(numeric);
      const values = cells.map((c) => c.value);
      const middle = (Math.min(...values) + Math.max(...values)) / 2;
      return {
        height: 90 + 46 * ys.length,
        marginTop: 26,
        marginLeft: 70,
        padding: 0.04,
        x: { type: "band", domain: [...new Set(cells.map((c) => c.x))].sort(numeric), label: across.title },
        y: { type: "band", domain: ys.reverse(), label: down.title },
        color: { scheme: "cividis", type: "linear" },
        marks: [
          Plot.cell(cells, { x: "x", y: "y", fill: "value", className: "m-cell" }),
          Plot.text(cells, {
            x: "x",
            y: "y",
            text: (c: { value: number }) => c.value.toFixed(measure.unit === "%" ? 1 : measure.decimals),
            fill: (c: { value: number }) => (c.value > middle ? "#111111" : "#ffffff"),
            fontSize: width < 480 ? 9 : 12,
          }),
        ],
      };
    },
    [cells],
  );
  if (cells.length === 0) return null;
  return <Chart title={`Heat map: ${heading(measure)}`} about={`${heading(measure)} over ${across.title} and ${down.title}. ${view.about}`} marks={{ cell: cells.length }} make={make} />;
}

/** One curve per value of the other setting, if there are few; else only points. */
function Response({ view, across, other }: { view: View; across: Column; other: Column | undefined }): JSX.Element | null {
  const { table, rows, measure } = view;
  const points = useMemo(
    () =>
      rows.flatMap((row) => {
        const value = table.number(measure.key, row);
        if (value === null) return [];
        const bound = (end: string) => {
          const v = table.number(`${measure.key}.${end}`, row);
          return v === null ? null : inUnit(measure, v);
        };
        const name = other ? `${other.title} ${table.text(other.key, row)}` : "all";
        return [{ x: Number(table.text(across.key, row)), value: inUnit(measure, value), low: bound("low"), high: bound("high"), other: name }];
      }),
    [view, across],
  );
  const names = [...new Set(points.map((p) => p.other))];
  const lines = names.length <= 6;
  const bounded = points.filter((p) => p.low !== null);
  // Curves that coincide are drawn beside one another.
  const xs = points.map((p) => p.x);
  const apart = lines ? 0.012 * (Math.max(...xs) - Math.min(...xs)) : 0;
  const shift = (name: string) => (names.indexOf(name) - (names.length - 1) / 2) * apart;
  const make = useCallback(
    (): Plot.PlotOptions => ({
      height: 300,
      marginTop: 24,
      x: { label: across.title, grid: true, nice: true },
      y: { label: heading(measure), grid: true, nice: true },
      marks: names.flatMap((name, i) => {
        const own = points.filter((p) => p.other === name).map((p) => ({ ...p, x: p.x + shift(name) })).sort((a, b) => a.x - b.x);
        const { color, dash } = lines ? armStyle(i) : armStyle(0);
        return [
          Plot.ruleX(own.filter((p) => p.low !== null), { x: "x", y1: "low", y2: "high", stroke: color, strokeOpacity: 0.5, className: "m-interval" }),
          ...(lines ? [Plot.line(own, { x: "x", y: "value", stroke: color, strokeDasharray: dash, strokeWidth: 2 })] : []),
          Plot.dot(own, { x: "x", y: "value", fill: color, symbol: lines ? kSymbols[i % kSymbols.length] : "circle", r: 3.5, className: "m-point" }),
        ];
      }),
    }),
    [points],
  );
  if (points.length === 0 || points.some((p) => !Number.isFinite(p.x))) return null;
  return (
    <Chart
      title={`Response to ${across.title}`}
      about={`${heading(measure)}${bounded.length > 0 ? " with Wilson's 95 % intervals" : ""}${lines && names.length > 1 ? "; curves are drawn slightly apart, so that equal ones are seen" : ""}. ${view.about}`}
      legend={lines && other ? names.map((name, i) => ({ name, ...armStyle(i) })) : []}
      marks={{ point: points.length, interval: bounded.length }}
      make={make}
    />
  );
}

function SweepView({ sweep, place }: { sweep: Sweep; place: number }): JSX.Element {
  const table = useMemo(() => new Table(sweep.table), [sweep]);
  const arms = useMemo(() => {
    const found = new Map<string, number[]>();
    for (let row = 0; row < table.rows; ++row) {
      const name = ["system", "labels", "level", "query_set"].map((key) => table.text(key, row)).join(", ").replaceAll("_", " ");
      found.set(name, [...(found.get(name) ?? []), row]);
    }
    return found;
  }, [table]);
  const [arm, setArm] = useState([...arms.keys()][0] ?? "");
  const measures = table.columns.filter((c) => kMeasures.includes(c.key));
  const [key, setKey] = useState(measures.some((m) => m.key === "correct") ? "correct" : (measures[0]?.key ?? ""));
  const varied = sweep.varied.flatMap((name) => table.column(name) ?? []);
  const measure = table.column(key);
  const rows = arms.get(arm) ?? [];
  const view = useMemo(() => (measure ? { table, rows, measure, about: `${arm}. ${table.note} Source: results.sqlite.` } : null), [table, arm, key, theme()]);
  const [first, second] = varied;
  const isGrid = varied.length === 2 && first && second && rows.length > new Set(rows.map((row) => table.text(first.key, row))).size;
  return (
    <>
      {sweep.best.length > 0 && <ul class="remarks">{sweep.best.map((text) => <li key={text}>{text.replaceAll("_", " ")}</li>)}</ul>}
      <div class="choices">
        <Choice label="Answers" options={[...arms.keys()].map((name) => ({ key: name, title: name }))} value={arm} onPick={setArm} />
        <Choice label="Measure" options={measures.map((m) => ({ key: m.key, title: heading(m) }))} value={key} onPick={setKey} />
      </div>
      {view && (
        <div class="charts">
          {isGrid && first && second && <HeatMap view={view} across={first} down={second} />}
          {varied.map((across, i) => (
            <Response key={across.key} view={view} across={across} other={varied.length === 2 ? varied[1 - i] : undefined} />
          ))}
        </div>
      )}
      <h2>All points</h2>
      <DataTable id={`sweep-${place}`} table={table} />
    </>
  );
}

export function SweepsPage(): JSX.Element {
  return (
    <>
      <h1>Sweeps</h1>
      <PerFolder points="all">
        {(folder, place) =>
          folder.suite === null ? null : (
            <Piece<Figures> piece={`${place}/figures`}>
              {(figures) => (figures.sweep ? <SweepView sweep={figures.sweep} place={place} /> : <Missing>The suite {folder.suite} varies no settings: it has no sweep.</Missing>)}
            </Piece>
          )
        }
      </PerFolder>
    </>
  );
}
