// SPDX-License-Identifier: Apache-2.0
// What runs cost: processor time by stage, time per frame, memory.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo } from "preact/hooks";
import { type Folder, Table, type WrittenTable } from "../data";
import { linkTo } from "../route";
import { ink } from "../theme";
import { armStyle, armsOf, nameMargin } from "../view/arm";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Missing, PerFolder, Piece } from "../view/parts";

const kStages: [string, string][] = [
  ["slam_s", "SLAM"],
  ["frames_s", "frames: scene, light, sensors"],
  ["products_s", "maps and images"],
  ["rest", "everything else"],
];

interface Rows {
  folder: Folder;
  table: Table;
  rows: number[];
}

function Stages({ folder, table, rows }: Rows): JSX.Element {
  const arms = useMemo(() => armsOf(folder, table, rows), [table, rows]);
  const bars = useMemo(
    () =>
      arms.names.flatMap((arm) => {
        const own = rows.filter((row) => arms.name(row) === arm && table.number("cpu_s", row) !== null);
        if (own.length === 0) return [];
        const mean = (key: string) => own.reduce((sum, row) => sum + (table.number(key, row) ?? 0), 0) / own.length;
        const parts = { slam_s: mean("slam_s"), frames_s: mean("frames_s"), products_s: mean("products_s") };
        const rest = Math.max(0, mean("cpu_s") - parts.slam_s - parts.frames_s - parts.products_s);
        return kStages.map(([key, stage]) => ({ arm, stage, seconds: key === "rest" ? rest : parts[key as keyof typeof parts] }));
      }),
    [table, rows],
  );
  const make = useCallback(
    (width: number): Plot.PlotOptions => ({
      height: 90 + 52 * arms.names.length,
      marginLeft: nameMargin(arms.names, width).margin,
      marginTop: 22,
      x: { label: "CPU time of a run, s", grid: true },
      y: { label: null, domain: arms.names, tickFormat: nameMargin(arms.names, width).fitted },
      marks: [
        Plot.barX(bars, Plot.stackX({ y: "arm", x: "seconds", z: "stage", order: kStages.map(([, stage]) => stage), fill: (b: { stage: string }) => armStyle(kStages.findIndex(([, s]) => s === b.stage)).color, stroke: ink().paper, className: "m-stage" })),
        Plot.ruleX([0]),
      ],
    }),
    [bars],
  );
  return (
    <Chart
      title="Processor time by stage"
      about="CPU seconds of a run's process, mean over the runs of each system (with its labels and level, where there are several). A scene's light is baked, and images are rendered, by the first run that needs them: the system that stands first in the suite bears that cost for all. Source: results.sqlite, table times."
      legend={kStages.map(([, name], i) => ({ name, color: armStyle(i).color }))}
      marks={{ stage: bars.length }}
      make={make}
    />
  );
}

function Spread({ folder, table, rows, measure, title, unit, about }: Rows & { measure: string; title: string; unit: string; about: string }): JSX.Element | null {
  const arms = useMemo(() => armsOf(folder, table, rows), [table, rows]);
  const dots = useMemo(
    () =>
      rows.flatMap((row) => {
        const value = table.number(measure, row);
        return value === null ? [] : [{ arm: arms.name(row), value }];
      }),
    [table, rows, measure],
  );
  const make = useCallback(
    (width: number): Plot.PlotOptions => ({
      height: 90 + 46 * arms.names.length,
      marginLeft: nameMargin(arms.names, width).margin,
      marginTop: 22,
      x: { label: unit, grid: true, zero: true },
      y: { label: null, domain: arms.names, tickFormat: nameMargin(arms.names, width).fitted },
      marks: [
        Plot.boxX(dots, { x: "value", y: "arm", fill: ink().grid, stroke: ink().faint, r: 0 }),
        Plot.dot(dots, { x: "value", y: "arm", fill: (d: { arm: string }) => arms.style(d.arm).color, fillOpacity: 0.7, r: 3, className: "m-run" }),
      ],
    }),
    [dots],
  );
  if (dots.length === 0) return null;
  return <Chart title={title} about={about} marks={{ run: dots.length }} make={make} />;
}

const kCostColumns = ["run", "wall_s", "cpu_s", "slam_s", "max_rss_mb", "track_ms.median", "relocalize_ms.median", "host", "jobs"];

export function SpeedPage(): JSX.Element {
  return (
    <>
      <h1>Speed and memory</h1>
      <PerFolder>
        {(folder, place) =>
          folder.suite === null ? null : (
            <Piece<WrittenTable> piece={`${place}/runs`}>
              {(written) => {
                const table = new Table(written);
                const rows = Array.from({ length: table.rows }, (_, row) => row).filter((row) => table.text("status", row) !== "failed");
                if (!table.has("wall_s") && !table.has("track_ms.median")) return <Missing>These results state no times.</Missing>;
                return (
                  <>
                    <p class="note">Times differ from one execution to the next; those of different machines or loads do not compare.</p>
                    <div class="charts">
                      {table.has("cpu_s") && <Stages folder={folder} table={table} rows={rows} />}
                      <Spread folder={folder} table={table} rows={rows} measure="track_ms.median" title="Time to track a frame" unit="ms, median of a run" about="Wall time of a call, ms; a dot per run, boxes over runs. Source: results.sqlite, table times." />
                      <Spread folder={folder} table={table} rows={rows} measure="relocalize_ms.median" title="Time to relocalize" unit="ms, median of a run" about="Wall time of a call with a query's frame, ms; a dot per run. Source: results.sqlite, table times." />
                      <Spread folder={folder} table={table} rows={rows} measure="max_rss_mb" title="Memory" unit="MB, largest resident set" about="Largest resident set of a run's process, MB; a dot per run. Source: results.sqlite, table times." />
                    </div>
                    <h2>By run</h2>
                    <DataTable id={`cost-${place}`} table={table} rows={rows} usual={kCostColumns} link={(row) => ({ column: "run", href: linkTo(["run", String(place), table.text("run", row)]) })} />
                  </>
                );
              }}
            </Piece>
          )
        }
      </PerFolder>
    </>
  );
}
