// SPDX-License-Identifier: Apache-2.0
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useCallback, useMemo, useState } from "preact/hooks";
import { type Difference, type Folder, type Headline, type Overview, type PlaceImages, Table, shownNumber } from "../data";
import { linkTo, useNoted } from "../route";
import { colorOf, ink } from "../theme";
import { styleOf } from "../view/arm";
import { Chart } from "../view/Chart";
import { DataTable } from "../view/DataTable";
import { Choice, Missing, PerFolder, Piece } from "../view/parts";
import { RunFromAbove } from "./figures";

/** Intervals of comparisons in one unit, around a line at no difference. */
function Differences({ all, unit }: { all: Difference[]; unit: string }): JSX.Element | null {
  const shown = useMemo(
    () =>
      all
        .filter((s) => s.unit === unit && s.difference !== null)
        .map((s) => {
          const scale = unit === "%" ? 100 : 1000;
          const of = (value: number | null) => (value === null ? null : scale * value);
          return {
            what: `${s.what.replaceAll("_", " ")}${all.some((o) => o.level !== s.level) ? `, ${s.level}` : ""}${
              all.some((o) => o.first !== s.first || o.second !== s.second)
                ? `: ${s.first} − ${s.second}`
                : ""
            }`,
            difference: of(s.difference) ?? 0,
            low: of(s.low),
            high: of(s.high),
            state: s.decided ? "decided" : s.in_family ? "undecided" : "not judged",
          };
        }),
    [all, unit],
  );
  const bounded = shown.filter((d) => d.low !== null && d.high !== null);
  const make = useCallback(
    (width: number): Plot.PlotOptions => {
      const room = 30 + 6.4 * Math.max(...shown.map((d) => d.what.length));
      const beside = room < 0.45 * width; // names next to their intervals; otherwise above them
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
  const first = all[0];
  const pair = all.every((o) => o.first === first?.first && o.second === first?.second);
  return (
    <Chart
      title={unit === "%" ? "Differences in answers" : "Differences in distances"}
      about={`${pair ? `${first?.first} minus ${first?.second}` : "First minus second"}, ${
        unit === "%" ? "percentage points" : "mm"
      }, with 95 % bootstrap intervals; colored circles are decided, gray diamonds are not; gray crosses stand beside the declared family and are not judged. Source: results.sqlite.`}
      marks={{ difference: shown.length, interval: bounded.length }}
      make={make}
    />
  );
}

/** Who is better, by how much; or that no difference was shown. */
function Headlines({ headlines, alone }: { headlines: Headline[]; alone: string }): JSX.Element {
  if (headlines.length === 0) return <p class="verdict">{alone}</p>;
  return (
    <>
      {headlines.map((h, i) => (
        <div key={i} class={`verdict${h.decided ? " decided" : ""}${headlines.length > 2 ? " one-of-many" : ""}`}>
          <p>{h.text}</p>
          {h.detail !== "" && <p class="note">{h.detail}</p>}
        </div>
      ))}
    </>
  );
}

interface Tile {
  name: string;
  value: string;
  beside: string;
}

/** A figure with its unit: a length below a meter in mm. */
function withUnit(value: number, unit: string, decimals: number): string {
  if (unit === "m") return Math.abs(value) < 1 ? `${shownNumber(1e3 * value, "mm", 1)} mm` : `${shownNumber(value, unit, 2)} m`;
  return `${shownNumber(value, unit, decimals)} ${unit}`;
}

/** The most important figures of a row. */
function tilesOf(tiles: Table, row: number): Tile[] {
  return tiles.columns
    .filter((c) => !c.isText && !c.key.endsWith(".success"))
    .map((column) => {
      const answered = tiles.column(column.key.replace(/correct$/, "success"));
      const both = column.key.endsWith(".correct") && answered && tiles.number(answered.key, row) !== null;
      const value = tiles.number(column.key, row);
      return {
        name: column.title,
        value: value === null ? "–" : withUnit(value, column.unit, column.decimals),
        beside: both ? `${tiles.shown(answered, row)} % answered` : "",
      };
    });
}

/** What a system alone did, in words. */
function aloneText(tiles: Table, systems: number): string {
  if (tiles.rows === 0) return "No run is finished yet.";
  if (tiles.rows > 1) return systems > 1 ? "This suite compares no two systems; each stands below." : "One system, with several kinds of labels or levels.";
  const shown = (key: string, decimals: number) => shownNumber(tiles.number(key, 0), tiles.column(key)?.unit ?? "", decimals);
  const set = ["second_tour", "held_out", "graded"].find((key) => tiles.has(`${key}.correct`) && tiles.number(`${key}.correct`, 0) !== null);
  const answers = set ? ` It answers ${shown(`${set}.correct`, 1)} % of the queries correctly ${tiles.column(`${set}.correct`)?.title.replace(/^correct,? /, "")}.` : "";
  const ate = tiles.number("ate_rmse_m", 0) === null ? "" : `, with an ATE of ${shown("ate_rmse_m", 3)} m`;
  return `${tiles.text("system", 0)} maps ${shown("completeness", 1)} % of the tour${ate}.${answers}`;
}

const kMostSystems = 8;

function Tiles({ folder, tiles, rows }: { folder: Folder; tiles: Table; rows: number[] }): JSX.Element {
  const several = new Set(rows.map((row) => tiles.text("labels", row)).filter((word) => word !== "none")).size > 1;
  return (
    <>
      {rows.slice(0, kMostSystems).map((row) => {
        const labels = tiles.text("labels", row);
        const style = styleOf(folder, tiles.text("system", row), labels, tiles.text("level", row));
        return (
          <section key={row} class="system" aria-label={tiles.text("system", row)}>
            <h3>
              <svg width="14" height="14" aria-hidden="true">
                <rect width="14" height="14" rx="3" fill={style.color} />
              </svg>
              {tiles.text("system", row)}
              {several && labels !== "none" ? `, ${labels} labels` : ""}
              {tiles.text("remark", row) !== "" && <span class="note"> ({tiles.text("remark", row)})</span>}
            </h3>
            <dl class="tiles">
              {tilesOf(tiles, row).map((tile) => (
                <div key={tile.name}>
                  <dt>{tile.name}</dt>
                  <dd>
                    {tile.value}
                    {tile.beside !== "" && <small>{tile.beside}</small>}
                  </dd>
                </div>
              ))}
            </dl>
          </section>
        );
      })}
      {rows.length > kMostSystems && <p class="note">{rows.length - kMostSystems} more systems stand in Table 2.</p>}
    </>
  );
}

function Plans({ images, place }: { images: PlaceImages; place: number }): JSX.Element {
  const [chosen, choose] = useNoted(`plan-${place}`, "0");
  const plan = images.plans[Number(chosen)] ?? images.plans[0]!;
  const name = (p: PlaceImages["plans"][number]) => `${p.system}${p.labels === "" ? "" : `, ${p.labels} labels`}`;
  const page = linkTo(["run", String(place), plan.run]);
  return (
    <figure class="plan">
      <a href={page}>
        <img src={`data:image/png;base64,${plan.png}`} alt={`Plan of ${plan.environment} with the paths of ${name(plan)}, queries and answers. Opens its page and replay.`} />
      </a>
      <figcaption>
        {images.plans.length > 1 && <Choice label="Plan of" options={images.plans.map((p, i) => ({ key: String(i), title: name(p) }))} value={chosen} onPick={choose} />}
        <a class="open" href={page}>
          Replay and page of this run
        </a>
      </figcaption>
    </figure>
  );
}

function Frames({ frames }: { frames: NonNullable<PlaceImages["frames"]> }): JSX.Element {
  if (frames.list.length === 0) return <p class="note">No frames of {frames.environment} are shown: {frames.problem}.</p>;
  return (
    <figure class="plan">
      <div class="frames">
        {frames.list.map((f) => (
          <img key={f.frame} src={`data:image/jpeg;base64,${f.jpeg}`} alt={`Frame ${f.frame} of ${frames.environment}`} />
        ))}
      </div>
      <figcaption class="note">
        {frames.environment}: frames {frames.list.map((f) => f.frame).join(", ")}
      </figcaption>
    </figure>
  );
}

/** The place: its drawing from above or, if there is none, its paths. */
function PlaceSeen({ place }: { place: number }): JSX.Element {
  return (
    <Piece<PlaceImages | null> piece={`${place}/place`}>
      {(images) => {
        if (images === null) return <Missing>There is nothing to show: no run left a path.</Missing>;
        return (
          <>
            {images.frames && <Frames frames={images.frames} />}
            {images.plans.length > 0 ? (
              <Plans images={images} place={place} />
            ) : (
              images.run &&
              images.queries && (
                <>
                  <RunFromAbove run={images.run} queries={new Table(images.queries)} brief />
                  <a class="open" href={linkTo(["run", String(place), images.run.name])}>
                    Replay and page of this run
                  </a>
                </>
              )
            )}
          </>
        );
      }}
    </Piece>
  );
}

/** The shares that a suite is judged by, with the other share beside them. */
function isShown(d: Difference): boolean {
  return d.unit === "%" && !d.pooled && (d.in_family || d.measure === "success" || d.measure === "correct");
}

function counted(count: number, one: string): string {
  return `${count} ${one}${count === 1 ? "" : "s"}`;
}

function Top({ folder, place, overview }: { folder: Folder; place: number; overview: Overview }): JSX.Element | null {
  const { suite, verdicts } = overview;
  const [open, setOpen] = useState(false); // charts are drawn once open: they need to know their width
  const [picked, setLevel] = useNoted(`level-${place}`, suite?.levels[0] ?? "");
  if (!suite || !verdicts || !overview.tiles) return null;
  const tiles = new Table(overview.tiles);
  const level = suite.levels.includes(picked) ? picked : (suite.levels[0] ?? "");
  const differences = verdicts.differences.filter((d) => d.level === level);
  const done = folder.failed + folder.missing === 0 ? counted(folder.runs, "run") : `${folder.runs} runs done, ${folder.failed} failed, ${folder.missing} missing`;
  return (
    <>
      <p class="lead">
        Suite {suite.name}: {counted(suite.systems.length, "system")} in {counted(suite.environments, "environment")}, {counted(suite.trials, "trial")}, labels {suite.labels.join(", ")}; {done}.
      </p>
      {overview.warnings.length > 0 && folder.problem === null && (
        <ul class="remarks">
          {overview.warnings.map((warning) => (
            <li key={warning}>{warning}</li>
          ))}
        </ul>
      )}
      <div class="first-screen">
        <div>
          {suite.levels.length > 1 && (
            <div class="choices">
              <Choice label="Level" options={suite.levels.map((key) => ({ key, title: key }))} value={level} onPick={setLevel} />
            </div>
          )}
          <Headlines headlines={verdicts.headlines.filter((h) => h.level === level)} alone={aloneText(tiles, suite.systems.length)} />
          <Tiles folder={folder} tiles={tiles} rows={tiles.where({ level })} />
          <p class="note">{overview.definitions}</p>
          <Differences all={differences.filter(isShown)} unit="%" />
        </div>
        <div>
          <PlaceSeen place={place} />
        </div>
      </div>
      {differences.length > 0 && (
        <details onToggle={(event) => setOpen(event.currentTarget.open)}>
          <summary>All comparisons</summary>
          {open && <Differences all={differences} unit="m" />}
          <DataTable id={`verdicts-${place}`} table={new Table(verdicts.table)} />
        </details>
      )}
      {overview.notes.length > 0 && (
        <ul class="note">
          {overview.notes.map((note) => (
            <li key={note}>{note}</li>
          ))}
        </ul>
      )}
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
                <Top folder={folder} place={place} overview={overview} />
                {overview.published_ate && (
                  <>
                    <h2>{new Table(overview.published_ate).title}</h2>
                    <DataTable id={`ate-${place}`} table={new Table(overview.published_ate)} />
                  </>
                )}
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
                        "held_out.correct",
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
