// SPDX-License-Identifier: Apache-2.0
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo } from "preact/hooks";
import { type Figures, type Folder, type RunPaths, Table, type WrittenTable, heading, folders } from "../data";
import { linkTo, useNoted } from "../route";
import { ink } from "../theme";
import { armStyle, armsOf } from "../view/arm";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Choice, Missing, PerFolder, Piece } from "../view/parts";
import { queryPlaces, topView } from "../view/topview";
import { GradedCurves } from "./graded";

/** Rows of the level that the reader chose, if there are several. @param noted  key of the choice */
function useArm(table: Table, noted: string): { rows: number[]; picker: JSX.Element | null; arm: string } {
  const arms = [...new Set(Array.from({ length: table.rows }, (_, r) => `${table.text("level", r)}, ${table.text("labels", r)}`))];
  const levels = table.words("level");
  const [level, setLevel] = useNoted(noted, levels[0] ?? "");
  const rows = useMemo(() => table.where({ level }), [table, level]);
  const picker =
    levels.length > 1 ? (
      <Choice label="Level" options={levels.map((key) => ({ key, title: key }))} value={level} onPick={setLevel} />
    ) : null;
  return { rows, picker, arm: arms.length > 1 ? `level ${level}` : (arms[0] ?? "") };
}

function Density({ folder, density }: { folder: Folder; density: NonNullable<Figures["density"]> }): JSX.Element {
  const table = useMemo(() => new Table(density.table), [density]);
  const measures = table.columns.filter((c) => !c.isText && ["ate_rmse_m", "rpe_frame_rmse_m", "held_out.correct", "held_out.success", "held_out.distance_mean_m", "second_tour.correct", "second_tour.success", "graded.correct", "graded.success"].includes(c.key));
  const place = folders.indexOf(folder);
  const [key, setKey] = useNoted(`measure-${place}`, measures[0]?.key ?? "");
  const { rows, picker, arm } = useArm(table, `level3-${place}`);
  const column = table.column(key);
  const { name: armOf, names, style } = useMemo(() => armsOf(folder, table, rows), [table, rows]);
  const values = useMemo(
    () =>
      rows.flatMap((row) => {
        const value = table.number(key, row);
        if (value === null) return [];
        return [{ group: table.text("group", row), arm: armOf(row), value: column?.unit === "%" ? 100 * value : value }];
      }),
    [rows, key],
  );
  const means = useMemo(() => {
    const of = new Map<string, { group: string; arm: string; sum: number; count: number }>();
    for (const v of values) {
      const at = `${v.group} ${v.arm}`;
      const sum = of.get(at) ?? { group: v.group, arm: v.arm, sum: 0, count: 0 };
      of.set(at, { ...sum, sum: sum.sum + v.value, count: sum.count + 1 });
    }
    return [...of.values()].map((m) => ({ ...m, mean: m.sum / m.count }));
  }, [values]);
  const make = useCallback(
    (): Plot.PlotOptions => {
      const color = (d: { arm: string }) => style(d.arm).color;
      // Quartiles of fewer than five values say nothing: only their dots and mean are drawn.
      const boxed = values.filter((v) => (means.find((m) => m.group === v.group && m.arm === v.arm)?.count ?? 0) >= 5);
      // One value far beyond the others would squeeze them against the axis; figures for papers do the same.
      const sorted = values.map((v) => v.value).sort((a, b) => a - b);
      const middle = sorted[Math.floor(sorted.length / 2)] ?? 0;
      const log = column?.unit !== "%" && (sorted[0] ?? 0) > 0 && (sorted.at(-1) ?? 0) > 10 * middle;
      const counted = density.groups.flatMap((group) => {
        const n = means.filter((m) => m.group === group).map((m) => m.count);
        const [least, most] = [Math.min(...n), Math.max(...n)];
        return n.length === 0 ? [] : [{ group, count: least === most ? `n ${most}` : `n ${least}–${most}` }];
      });
      const empty = density.groups.filter((group) => values.every((v) => v.group !== group));
      return {
        height: 340,
        marginTop: 26,
        fx: { domain: density.groups, label: "objects per 10 m² of floor", padding: 0.08, axis: "bottom" },
        x: { domain: names, axis: null, padding: 0.15 },
        y: log ? { type: "log", nice: true, insetTop: 16, axis: null } : { zero: true, nice: true, insetTop: 16, axis: null },
        marginBottom: 46,
        marks: [
          Plot.gridY({ facetAnchor: null }),
          Plot.axisY({ facetAnchor: "left", label: column ? heading(column) : "", ...(log ? { ticks: 4, tickFormat: "~g" } : {}) }),
          Plot.boxY(boxed, { fx: "group", x: "arm", y: "value", fill: color, fillOpacity: 0.35, stroke: color, r: 0 }),
          Plot.dot(values, { fx: "group", x: "arm", y: "value", fill: color, r: 2.2, className: "m-environment" }),
          Plot.dot(means, { fx: "group", x: "arm", y: "mean", symbol: "diamond", fill: ink().paper, stroke: ink().text, strokeWidth: 1.5, r: 5, className: "m-mean" }),
          Plot.text(empty, { fx: (group: string) => group, frameAnchor: "middle", text: () => "none", fill: ink().faint }),
          Plot.text(counted, { fx: "group", frameAnchor: "top", dy: -12, text: "count" }),
        ],
      };
    },
    [values, means, key],
  );
  return (
    <>
      <div class="choices">
        <Choice label="Measure" options={measures.map((m) => ({ key: m.key, title: heading(m) }))} value={key} onPick={setKey} />
        {picker}
      </div>
      {values.length === 0 ? (
        <Missing>No environment has a value of this measure.</Missing>
      ) : (
        <Chart
          title="Figure 3: by density of objects"
          about={`${column ? heading(column) : ""}, ${arm}: a dot per environment (median over trials), boxes with medians from five environments on, diamonds are means, n environments. Source: results.sqlite; objects counted by the grammar of each generated scene.`}
          legend={names.map((name) => ({ name, color: style(name).color }))}
          marks={{ environment: values.length, mean: means.length }}
          make={make}
        />
      )}
    </>
  );
}

function ByFrame({ folder, written }: { folder: Folder; written: WrittenTable }): JSX.Element {
  const table = useMemo(() => new Table(written), [written]);
  const { rows, picker, arm } = useArm(table, `level4-${folders.indexOf(folder)}`);
  const { name: armOf, names, style } = useMemo(() => armsOf(folder, table, rows), [table, rows]);
  const counted = useMemo(
    () =>
      rows.map((row) => ({
        arm: armOf(row),
        frame: table.number("frame", row) ?? 0,
        error: table.number("error_m", row),
        low: table.number("low", row),
        high: table.number("high", row),
        scenes: table.number("scenes", row) ?? 0,
      })),
    [rows],
  );
  const points = counted.filter((p) => p.error !== null);
  const legend = names.map((name) => ({ ...style(name), name }));
  const banded = points.filter((p) => p.low !== null);
  const most = Math.max(0, ...counted.map((p) => p.scenes));
  const make = useCallback(
    (): Plot.PlotOptions => ({
      height: 320,
      marginTop: 24,
      x: { label: "frame of the tour", grid: true },
      y: { label: "mean position error, m", grid: true, zero: true },
      marks: [
        ...names.flatMap((name) => [
          Plot.areaY(banded.filter((p) => p.arm === name), { x: "frame", y1: "low", y2: "high", fill: style(name).color, fillOpacity: 0.18 }),
          Plot.line(points.filter((p) => p.arm === name), { x: "frame", y: "error", stroke: style(name).color, strokeWidth: 2, strokeDasharray: style(name).dash }),
        ]),
        ...names.map((name) =>
          Plot.dot(points.filter((p) => p.arm === name), { x: "frame", y: "error", fill: style(name).color, symbol: style(name).symbol, r: 2.6, className: "m-window" }),
        ),
      ],
    }),
    [points],
  );
  const makeCounts = useCallback(
    (): Plot.PlotOptions => ({
      height: 170,
      marginTop: 24,
      x: { label: "frame of the tour", grid: true },
      // Lines that coincide are drawn beside one another.
      y: { label: "environments still counted", grid: true, domain: [0, most + 1], ticks: Math.min(5, most + 1), tickFormat: (d: number) => (Number.isInteger(d) ? String(d) : "") },
      marks: names.map((name, i) =>
        Plot.line(counted.filter((p) => p.arm === name), { x: "frame", y: "scenes", dy: 3 * (i - (names.length - 1) / 2), curve: "step", className: "m-counted", stroke: style(name).color, strokeWidth: 2, strokeDasharray: style(name).dash }),
      ),
    }),
    [points],
  );
  return (
    <>
      <div class="choices">{picker}</div>
      <Chart
        title="Figure 4: error against frames"
        about={`Mean position error (m) over windows of 30 frames after SE(3) alignment, ${arm}; ${banded.length > 0 ? "bands are 95 % intervals over environments; curves end where fewer than five of them are left" : "too few environments for an interval"}. Source: results.sqlite.`}
        legend={legend}
        marks={{ window: points.length }}
        make={make}
      />
      <Chart
        title="Figure 4: environments still counted"
        about="Number of environments whose tour reaches the frame and is tracked there; lines of equal numbers stand beside one another. Source: results.sqlite."
        legend={legend}
        marks={{ "counted": names.length }}
        make={makeCounts}
      />
    </>
  );
}

/** Figure 2 or 5: one run from above. */
function FromAbove({ place }: { place: number }): JSX.Element {
  const folder = folders[place];
  const [name, setName] = useNoted(`run-${place}`, "");
  if (!folder || folder.runs === 0) return <Missing>No run is finished: there is no path to show.</Missing>;
  return (
    <Piece<WrittenTable> piece={`${place}/runs`}>
      {(runs) => {
        const table = new Table(runs);
        const options = Array.from({ length: folder.runs }, (_, row) => ({ key: String(row), title: table.text("run", row) }));
        const chosen = Math.max(0, options.findIndex((option) => option.title === name));
        const file = Math.floor(chosen / folder.runs_of_file);
        const pick = (row: string) => setName(row === "0" ? "" : (options[Number(row)]?.title ?? ""));
        return (
          <>
            <div class="choices">
              <Choice label="Run" options={options} value={String(chosen)} onPick={pick} />
              <a href={linkTo(["run", String(place), table.text("run", chosen)])}>Its page</a>
            </div>
            <Piece<RunPaths[]> piece={`${place}/paths${file}`}>
              {(paths) => <Piece<WrittenTable> piece={`${place}/queries`}>{(queries) => <RunFromAbove run={paths[chosen % folder.runs_of_file]} queries={new Table(queries)} />}</Piece>}
            </Piece>
          </>
        );
      }}
    </Piece>
  );
}

/** @param brief  without remarks on what is missing */
export function RunFromAbove({ run, queries, chosen = null, brief = false }: { run: RunPaths | undefined; queries: Table; chosen?: number | null; brief?: boolean }): JSX.Element {
  const rows = useMemo(() => (run ? queries.where({ run: run.name }).filter((row) => (queries.number("point", row) ?? 0) === 0) : []), [run, queries]);
  const sets = [...new Set(rows.map((row) => queries.text("query_set", row)))];
  const usual = sets.includes("second_tour") ? "second_tour" : (sets[0] ?? "");
  const [picked, setSet] = useNoted(`set-${run?.name ?? ""}`, chosen === null ? usual : queries.text("query_set", chosen));
  const set = sets.includes(picked) ? picked : usual;
  const found = useMemo(() => queryPlaces(queries, rows.filter((row) => queries.text("query_set", row) === set)), [rows, set]);
  const make = useCallback((width: number) => topView(run as RunPaths, found, width, chosen), [run, found, chosen]);
  if (!run) return <Missing>This run left no path.</Missing>;
  if (!run.truth && !run.estimate) return <Missing>Neither a true nor an estimated path is known: nothing was mapped.</Missing>;
  const missing = [run.truth ? "" : "The true path is unknown.", run.estimate ? "" : "Nothing was mapped.", run.grid ? "" : run.grid_damaged ? "The run's occupancy grid (map.yaml, map.pgm) is damaged." : "The run's folder holds no occupancy grid.", rows.length > 0 ? "" : "No queries were asked."].filter(Boolean);
  const legend = [
    ...(run.truth ? [{ name: "true path", color: ink().text }] : []),
    ...(run.estimate ? [{ name: "estimated path", color: armStyle(0).color, dash: "5 3" }] : []),
    ...(found.truths.length > 0 ? [{ name: "true place of a query; × alone: not answered", color: ink().text, mark: "×" }] : []),
    ...(found.answers.some((a) => !a.wrong) ? [{ name: "its answer, correct", color: armStyle(2).color, mark: "○" }] : []),
    ...(found.answers.some((a) => a.wrong) ? [{ name: "its answer, false", color: armStyle(5).color, mark: "□" }] : []),
  ];
  return (
    <>
      {sets.length > 1 && <Choice label="Queries" options={sets.map((key) => ({ key, title: key.replaceAll("_", " ") }))} value={set} onPick={setSet} />}
      {missing.length > 0 && !brief && <Missing>{missing.join(" ")}</Missing>}
      <Chart
        title={`From above: ${run.name}`}
        about={`x and y in m, in the frame of the truth; the estimate is aligned by its first pose${rows.length > 0 ? "; a line joins a query's true place and its answer, which is drawn as it was scored: relative to the nearest mapped frame" : ""}. Source: results.sqlite${run.grid ? ", map.pgm" : ""}.`}
        legend={legend}
        marks={{ path: Number((run.truth?.ms.length ?? 0) > 1) + Number((run.estimate?.ms.length ?? 0) > 1), query: found.truths.length, answer: found.answers.length }}
        make={make}
        wide
      />
    </>
  );
}


export function FiguresPage(): JSX.Element {
  return (
    <>
      <h1>Figures of the paper</h1>
      <p class="note">The paper: Spatial Perception by Object-Aware Visual Scene Representation. Its figures are drawn here from this bench's own runs.</p>
      <PerFolder points="first">
        {(folder, place) =>
          folder.suite === null ? null : (
            <Piece<Figures> piece={`${place}/figures`}>
              {(figures) => (
                <>
                  <h2>Figures 2 and 5: a run from above</h2>
                  <FromAbove place={place} />
                  <h2>Figure 3: error by density of objects</h2>
                  {figures.density ? <Density folder={folder} density={figures.density} /> : <Missing>No environment of this suite was generated, so that the number of its objects is unknown.</Missing>}
                  <h2>Figure 4: error against frames</h2>
                  {figures.by_frame ? <ByFrame folder={folder} written={figures.by_frame} /> : <Missing>No run has a true and an estimated path at the same moments.</Missing>}
                  <h2>Section 3.3.3: candidates</h2>
                  {figures.candidates ? <DataTable id={`cand-${place}`} table={new Table(figures.candidates)} /> : <Missing>No system reported its candidates: no queries were asked, or the system reports a trajectory alone.</Missing>}
                  <GradedCurves folder={folder} graded={figures.graded} />
                </>
              )}
            </Piece>
          )
        }
      </PerFolder>
    </>
  );
}
