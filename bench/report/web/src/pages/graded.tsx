// SPDX-License-Identifier: Apache-2.0
// Success as a function of what queries are graded by: distance, angle, share in sight, speed.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback } from "preact/hooks";
import type { Folder } from "../data";
import { styleOf } from "../view/arm";
import { Chart } from "../view/Chart";

interface Curve {
  level: string;
  labels: string;
  category: string;
  by: string;
  unit: string;
  bins: {
    low: number;
    high: number;
    queries: number;
    systems: Record<string, { success: number; low: number; high: number }>;
  }[];
}

function GradedCurve({ folder, curve }: { folder: Folder; curve: Curve }): JSX.Element | null {
  const names = [...new Set(curve.bins.flatMap((bin) => Object.keys(bin.systems)))];
  const style = (name: string) => styleOf(folder, name, curve.labels, curve.level);
  const points = names.flatMap((name, i) =>
    curve.bins.flatMap((bin) => {
      const share = bin.systems[name];
      if (!share) return [];
      const shift = (i - (names.length - 1) / 2) * 0.06 * (bin.high - bin.low || 1);
      return [{ name, at: (bin.low + bin.high) / 2 + shift, success: 100 * share.success, low: 100 * share.low, high: 100 * share.high }];
    }),
  );
  const make = useCallback(
    (): Plot.PlotOptions => ({
      height: 280,
      marginTop: 24,
      x: { label: `${curve.by}${curve.unit ? `, ${curve.unit}` : ""}` },
      y: { label: "success, %", domain: [0, 100], grid: true },
      marks: names.flatMap((name) => {
        const own = points.filter((p) => p.name === name);
        const { color, dash, symbol } = style(name);
        return [
          Plot.ruleX(own, { x: "at", y1: "low", y2: "high", stroke: color, strokeWidth: 1.5, className: "m-interval" }),
          Plot.line(own, { x: "at", y: "success", stroke: color, strokeDasharray: dash, strokeWidth: 2 }),
          Plot.dot(own, { x: "at", y: "success", fill: color, symbol, r: 4, className: "m-bin" }),
        ];
      }),
    }),
    [curve],
  );
  if (points.length === 0) return null;
  return (
    <Chart
      title={`Success by ${curve.by}${curve.category === "all" ? "" : `: ${curve.category}`}`}
      about={`Success in % with Wilson's 95 % intervals, level ${curve.level}, labels ${curve.labels}; ${curve.bins.reduce((sum, bin) => sum + bin.queries, 0)} queries. Source: results.sqlite.`}
      legend={names.map((name) => ({ name, ...style(name) }))}
      marks={{ bin: points.length, interval: points.length }}
      make={make}
    />
  );
}

export function GradedCurves({ folder, graded }: { folder: Folder; graded: unknown }): JSX.Element | null {
  if (!Array.isArray(graded) || graded.length === 0) return null;
  return (
    <>
      <h2>Queries graded by distance and angle</h2>
      <div class="charts">{(graded as Curve[]).map((curve, i) => <GradedCurve key={i} folder={folder} curve={curve} />)}</div>
    </>
  );
}
