// SPDX-License-Identifier: Apache-2.0
// The replay of a run: play, step, scrub, speed; the current time is in the address.
import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { type RunPaths, type Table, load } from "../data";
import type { ReplayData, ReplayView } from "../replay_types";
import { currentRoute, note, useRoute } from "../route";
import { colorOf, ink, useTheme } from "../theme";
import type { WrittenViews } from "../views";
import { LastKeyframe } from "./Views";
import { Choice, Missing, Piece } from "./parts";

interface Props {
  run: RunPaths;
  queries: Table;
  rows: number[];
  piece: string | null; // what was recorded by repeating the run; null if it was not repeated
  views: string | null; // the piece with the images of that recording
}

let script: Promise<void> | null = null;
function loadScript(): Promise<void> {
  script ??= new Promise((resolve, reject) => {
    const element = document.createElement("script");
    element.src = "replay.js";
    element.onload = () => resolve();
    element.onerror = () => reject(new Error("replay.js is missing"));
    document.head.append(element);
  });
  return script;
}

type Place3 = [number, number, number];
function placesOf(queries: Table, rows: number[]): { truths: Place3[]; right: Place3[]; wrong: Place3[] } {
  const made = { truths: [] as Place3[], right: [] as Place3[], wrong: [] as Place3[] };
  for (const row of rows) {
    const of = (kind: string): Place3 | null => {
      const all = ["x", "y", "z"].map((axis) => queries.number(`${kind}_${axis}`, row));
      return all.some((v) => v === null) ? null : (all as Place3);
    };
    const truth = of("true");
    const answer = of("estimated");
    if (truth) made.truths.push(truth);
    if (answer) (queries.text("outcome", row) === "false positive" ? made.wrong : made.right).push(answer);
  }
  return made;
}

function Player({ run, queries, rows, piece, views, focus, onFail }: Props & { focus: boolean; onFail: (why: string) => void }): JSX.Element {
  const theme = useTheme();
  const canvas = useRef<HTMLCanvasElement>(null);
  const view = useRef<ReplayView | null>(null);
  const path = (run.truth ?? run.estimate)!;
  const end = path.ms[path.ms.length - 1] ?? 0;
  const clamp = (ms: number) => Math.min(end, Math.max(0, ms));
  const linked = () => clamp(Number(currentRoute().at.get("t") ?? 0) || 0);
  const [ms, setMs] = useState(linked);
  const [playing, setPlaying] = useState(false);
  const [speed, setSpeed] = useState("4");
  const [layers, setLayers] = useState<Record<string, boolean>>({});
  const [through, setThrough] = useState("orbit");
  const [cut, setCut] = useState("2.0");
  const [data, setData] = useState<ReplayData | null>(null);
  const places = useMemo(() => placesOf(queries, rows), [queries, rows]);

  useEffect(() => {
    // A link to a different time of a replay that is already open.
    const follow = () => currentRoute().at.has("t") && (setPlaying(false), setMs(linked()));
    addEventListener("hashchange", follow);
    return () => removeEventListener("hashchange", follow);
  }, [run]);

  // For the arrow keys; a page that opens with its replay stays where its reader is.
  useEffect(() => (focus ? canvas.current?.focus({ preventScroll: true }) : undefined), []);

  useEffect(() => {
    let live = true;
    Promise.all([loadScript(), piece ? load<ReplayData>(piece) : Promise.resolve(null)]).then(
      ([, recorded]) => {
        if (!live || !canvas.current || !globalThis.modelhouseReplay) return;
        try {
          const { paper, text } = ink();
          view.current = globalThis.modelhouseReplay(canvas.current, run, recorded, {
            paper, text, estimate: colorOf(0), keyframe: colorOf(3), right: colorOf(2), wrong: colorOf(5), queries: places,
          });
          setData(recorded);
          setLayers(Object.fromEntries(view.current.layers.map((name) => [name, name !== "occupancy" || !recorded?.mesh])));
          for (const name of view.current.layers) view.current.setLayer(name, name !== "occupancy" || !recorded?.mesh);
          view.current.show(ms);
        } catch (error) {
          onFail(`This browser shows no three dimensions: ${(error as Error).message}`);
        }
      },
      (error: Error) => live && onFail(error.message),
    );
    return () => {
      live = false;
      view.current?.close();
      view.current = null;
    };
  }, [run, theme]);

  // With the picture, not after it: a link followed right after a step must not be overwritten.
  useLayoutEffect(() => {
    view.current?.show(ms);
    if (!playing) note({ t: String(Math.round(ms)) });
  }, [ms, playing]);

  useEffect(() => {
    if (!playing) return undefined;
    let last = performance.now();
    let handle = requestAnimationFrame(function next(now: number) {
      const step = (now - last) * Number(speed);
      last = now;
      setMs((before) => {
        if (before + step >= end) setPlaying(false);
        return clamp(before + step);
      });
      handle = requestAnimationFrame(next);
    });
    return () => cancelAnimationFrame(handle);
  }, [playing, speed]);

  /** Goes to the next or previous pose of the path. */
  const step = (by: number) => {
    setPlaying(false);
    const here = by > 0 ? path.ms.findIndex((t) => t > ms + 0.5) : path.ms.findLastIndex((t) => t < ms - 0.5);
    if (here >= 0) setMs(path.ms[here] ?? ms);
  };
  const inliers = run.calls ? run.calls.inliers[Math.max(0, run.calls.ms.findLastIndex((t) => t <= ms))] : null;
  return (
    <section class="replay" aria-label="Replay" data-ms={Math.round(ms)}>
      <canvas
        ref={canvas}
        role="img"
        tabIndex={0}
        aria-label="The scene with true and estimated camera; space plays, arrow keys step"
        onKeyDown={(event) => {
          if (event.key === " ") setPlaying(!playing);
          else if (event.key === "ArrowRight") step(1);
          else if (event.key === "ArrowLeft") step(-1);
          else return;
          event.preventDefault();
        }}
      />
      <div class="choices">
        <button type="button" onClick={() => step(-1)}>Step back</button>
        <button type="button" onClick={() => (ms >= end && setMs(0), setPlaying(!playing))}>
          {playing ? "Pause" : "Play"}
        </button>
        <button type="button" onClick={() => step(1)}>Step forward</button>
        <input type="range" class="scrub" aria-label="Moment of the tour, ms" min={0} max={end} step={10} value={ms} onInput={(event) => (setPlaying(false), setMs(Number(event.currentTarget.value)))} />
        <output>{(ms / 1e3).toFixed(2)} s{inliers === null || inliers === undefined ? "" : `, ${inliers} inliers`}</output>
        <Choice label="Speed" options={["0.25", "1", "4", "16"].map((key) => ({ key, title: `${key}×` }))} value={speed} onPick={setSpeed} />
        <Choice
          label="View"
          options={[{ key: "orbit", title: "from outside" }, ...(run.truth ? [{ key: "true", title: "true camera" }] : []), ...(run.estimate ? [{ key: "estimated", title: "estimated camera" }] : [])]}
          value={through}
          onPick={(key) => (setThrough(key), view.current?.setThrough(key as "orbit"))}
        />
        {data?.mesh && (
          <Choice label="Cut at" options={["1.0", "1.5", "2.0", "99"].map((key) => ({ key, title: key === "99" ? "nothing" : `${key} m` }))} value={cut} onPick={(key) => (setCut(key), view.current?.setCut(Number(key)))} />
        )}
      </div>
      <div class="choices">
        {Object.entries(layers).map(([name, visible]) => (
          <label class="check" key={name}>
            <input type="checkbox" checked={visible} onChange={(event) => (setLayers({ ...layers, [name]: event.currentTarget.checked }), view.current?.setLayer(name, event.currentTarget.checked))} />{" "}
            {name}
          </label>
        ))}
      </div>
      {data && (
        <p class="note">
          Run again to be shown: {data.same ? "the same positions, bit for bit" : "its trajectory differs from that of the results, which another machine or version made"}. {data.landmarks.class.length} landmarks, {data.keyframes.length} keyframes
          {data.mesh && `; the scene has ${data.mesh.triangles} triangles of ${data.mesh.of_triangles}`}.
        </p>
      )}
      {data && (
        <ul class="legend">
          {Object.entries(data.landmarks.classes).map(([id, { name, color }]) => (
            <li key={id}>
              <svg width="12" height="12" aria-hidden="true"><rect width="12" height="12" fill={color} /></svg>
              {name}
            </li>
          ))}
        </ul>
      )}
      {data && views && <Piece<WrittenViews> piece={views}>{(seen) => <LastKeyframe views={seen} ms={ms} classes={data.landmarks.classes} />}</Piece>}
      {!data && !piece && <p class="note">Scene, keyframes, landmarks and pictures are not in this report: modelhouse report --replay {run.name} adds them.</p>}
    </section>
  );
}

export function Replay(props: Props): JSX.Element {
  const linked = useRoute().at.has("t");
  const [clicked, setClicked] = useState(false);
  const open = linked || clicked;
  const [why, setWhy] = useState("");
  if (!props.run.truth && !props.run.estimate) return <Missing>Without a path there is nothing to replay.</Missing>;
  if (why) return <Missing>{why}</Missing>;
  return open ? (
    <Player {...props} focus={clicked} onFail={setWhy} />
  ) : (
    <p>
      <button type="button" class="open" onClick={() => setClicked(true)}>
        Open the replay{props.piece ? "" : " (paths alone)"}
      </button>
    </p>
  );
}
