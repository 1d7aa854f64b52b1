// SPDX-License-Identifier: Apache-2.0
// All runs as a table, and the page of one.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo } from "preact/hooks";
import { type Folder, type RunPaths, Table, type WrittenTable, folders, heading } from "../data";
import { type Route, linkTo } from "../route";
import { colorOf, ink } from "../theme";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Facts, Missing, PerFolder, Piece } from "../view/parts";
import { Replay } from "../view/Replay";
import { QueryViews } from "../view/Views";
import type { WrittenViews } from "../views";
import { RunFromAbove } from "./figures";

const kUsual = [
  "run",
  "status",
  "environment",
  "system",
  "labels",
  "trial",
  "ate_rmse_m",
  "completeness",
  "held_out.queries",
  "held_out.success",
  "held_out.correct",
  "held_out.distance_mean_m",
  "second_tour.success",
  "second_tour.correct",
  "graded.success",
  "wall_s",
  "max_rss_mb",
];

export function RunsPage(): JSX.Element {
  return (
    <>
      <h1>Runs</h1>
      <PerFolder>
        {(folder, place) =>
          folder.suite === null ? null : (
            <Piece<WrittenTable> piece={`${place}/runs`}>
              {(written) => {
                const table = new Table(written);
                if (table.rows === 0) return <Missing>No run was made yet.</Missing>;
                return <DataTable id={`runs-${place}`} table={table} usual={kUsual} link={(row) => ({ column: "run", href: linkTo(["run", String(place), table.text("run", row)]) })} />;
              }}
            </Piece>
          )
        }
      </PerFolder>
    </>
  );
}

/** Inliers of each tracked frame; where tracking was lost. */
function Tracking({ run }: { run: RunPaths }): JSX.Element {
  const calls = run.calls;
  const points = useMemo(
    () => (calls?.ms ?? []).flatMap((ms, i) => (calls?.inliers[i] === null || calls?.inliers[i] === undefined ? [] : [{ s: ms / 1e3, inliers: calls.inliers[i] as number }])),
    [run],
  );
  const lost = (calls?.lost_ms ?? []).map((ms) => ms / 1e3);
  const keyframes = (calls?.keyframes_ms ?? []).map((ms) => ms / 1e3);
  const make = useCallback(
    (): Plot.PlotOptions => ({
      height: 230,
      marginTop: 22,
      x: { label: "time on the tour, s", grid: true },
      y: { label: "inliers", grid: true, zero: true },
      marks: [
        Plot.ruleX(lost, { stroke: colorOf(5), strokeOpacity: 0.8, className: "m-lost" }),
        Plot.lineY(points, { x: "s", y: "inliers", stroke: colorOf(0), strokeWidth: 1.2 }),
        Plot.dot(keyframes, { x: (s: number) => s, y: () => 0, symbol: "triangle", fill: ink().text, r: 2.5, className: "m-keyframe" }),
      ],
    }),
    [run],
  );
  if (points.length === 0) return <Missing>The system reported no inliers: it returned a trajectory alone.</Missing>;
  return (
    <Chart
      title="Tracking"
      about={`Inliers of a frame over time (s); triangles are the ${keyframes.length} frames that became keyframes when they were tracked${lost.length > 0 ? `, orange lines the ${lost.length} where tracking was lost` : ""}. Source: results.sqlite, table calls.`}
      legend={[{ name: "inliers", color: colorOf(0) }, ...(lost.length > 0 ? [{ name: "lost", color: colorOf(5) }] : [])]}
      marks={{ keyframe: keyframes.length, lost: lost.length }}
      make={make}
      wide
    />
  );
}

/** Everything that is known about one query. */
function Query({ queries, row, place, views }: { queries: Table; row: number; place: number; views: string | null }): JSX.Element {
  const run = queries.text("run", row);
  const own = queries.where({ run });
  const i = own.indexOf(row);
  const near = (step: number) => own[i + step];
  const go = (to: number | undefined, text: string) => (to === undefined ? null : <a href={linkTo(["run", String(place), run], { query: to })}>{text}</a>);
  return (
    <section class="query" aria-label="Query">
      <h2>
        Query: frame {queries.number("frame", row)}, {queries.text("query_set", row).replaceAll("_", " ")}: {queries.text("outcome", row)}
      </h2>
      <p class="steps">
        {go(near(-1), "← the one before")} {go(near(1), "the next →")}
      </p>
      <Facts facts={queries.columns.filter((c) => !c.hidden && c.key !== "run" && queries.shown(c, row) !== "").map((c): [string, string] => [heading(c), queries.shown(c, row)])} />
      {views && (queries.number("point", row) ?? 0) === 0 ? (
        <Piece<WrittenViews> piece={views}>{(seen) => <QueryViews key={row} views={seen} set={queries.text("query_set", row)} frame={queries.number("frame", row) ?? -1} />}</Piece>
      ) : (
        <p class="note">
          {views ? "Images are recorded of the first parameter point alone." : `Its image beside those of its candidates is not in this report: modelhouse report --replay ${run} adds it.`}
        </p>
      )}
    </section>
  );
}

function RunBody({ folder, place, row, runs, chosen }: { folder: Folder; place: number; row: number; runs: Table; chosen: number | null }): JSX.Element {
  const name = runs.text("run", row);
  if (runs.text("status", row) === "failed")
    return (
      <>
        <Missing>This run failed, so that there is nothing to show: {runs.text("error", row)}</Missing>
        <Facts facts={runs.columns.filter((c) => c.isText && c.key !== "error" && runs.text(c.key, row) !== "").map((c): [string, string] => [c.title, runs.text(c.key, row)])} />
      </>
    );
  const file = Math.floor(row / folder.runs_of_file);
  const replay = folder.replays.indexOf(name);
  const views = folder.views.includes(name) ? `${place}/views${replay}` : null;
  return (
    <Piece<RunPaths[]> piece={`${place}/paths${file}`}>
      {(paths) => {
        const run = paths.find((p) => p.name === name);
        if (!run) return <Missing>The paths of this run are missing.</Missing>;
        return (
          <Piece<WrittenTable> piece={`${place}/queries`}>
            {(written) => {
              const queries = new Table(written);
              const own = queries.where({ run: name });
              const at = chosen !== null && own.includes(chosen) ? chosen : null;
              return (
                <>
                  <Facts
                    facts={[
                      ["environment", runs.text("environment", row)],
                      ["system", runs.text("system", row)],
                      ["labels", runs.text("labels", row)],
                      ["level", runs.text("level", row)],
                      ["trial and seed", `${runs.number("trial", row)}, ${run.seed}`],
                      ["tour", `${run.frames} frames${run.length_m === null ? "" : `, ${run.length_m.toFixed(1)} m`}${run.cut ? ", shortened" : ""}`],
                    ]}
                  />
                  {at !== null && <Query queries={queries} row={at} place={place} views={views} />}
                  <RunFromAbove key={`${name} ${at}`} run={run} queries={queries} chosen={at} />
                  <h2>Replay</h2>
                  <Replay run={run} queries={queries} rows={own.filter((r) => (queries.number("point", r) ?? 0) === 0)} piece={replay >= 0 ? `${place}/replay${replay}` : null} views={views} />
                  <Tracking run={run} />
                  <h2>Queries</h2>
                  {own.length === 0 ? (
                    <Missing>No queries were asked of this run.</Missing>
                  ) : (
                    <DataTable
                      id="queries"
                      table={queries}
                      rows={own}
                      usual={["point", "query_set", "frame", "outcome", "stage", "cause", "distance_m", "angle_deg", "attempts", "final"]}
                      link={(query) => ({ column: "frame", href: linkTo(["run", String(place), name], { query }) })}
                    />
                  )}
                  <h2>All figures</h2>
                  <Facts facts={runs.columns.filter((c) => !c.isText && runs.number(c.key, row) !== null).map((c): [string, string] => [heading(c), runs.shown(c, row)])} />
                  <details>
                    <summary>Digests and settings</summary>
                    <Facts facts={[["estimated trajectory", run.trajectory_digest], ...Object.entries(run.inputs)]} />
                    <pre tabIndex={0}>{JSON.stringify(run.settings, null, 2)}</pre>
                  </details>
                </>
              );
            }}
          </Piece>
        );
      }}
    </Piece>
  );
}

export function RunPage({ route }: { route: Route }): JSX.Element {
  const place = Number(route.page[1] ?? 0);
  const name = route.page[2] ?? "";
  const folder = folders[place];
  const query = route.at.get("query");
  if (!folder) return <Missing>There is no such results folder in this report.</Missing>;
  return (
    <>
      <p class="crumbs">
        <a href={linkTo(["runs"])}>Runs</a> of {folder.name}
      </p>
      <h1>{name}</h1>
      <Piece<WrittenTable> piece={`${place}/runs`}>
        {(written) => {
          const runs = new Table(written);
          const row = runs.where({ run: name })[0];
          return row === undefined ? <Missing>There is no run of this name.</Missing> : <RunBody folder={folder} place={place} row={row} runs={runs} chosen={query === null ? null : Number(query)} />;
        }}
      </Piece>
    </>
  );
}
