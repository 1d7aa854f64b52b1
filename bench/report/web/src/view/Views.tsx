// SPDX-License-Identifier: Apache-2.0
// Pictures that a run saw: a keyframe with its keypoints; a query beside its candidates.
import type { JSX } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { colorOf, ink, useTheme } from "../theme";
import { type Keypoint, type Pair, type WrittenViews, keypointsOf, pairsOf } from "../views";
import { Choice, Missing } from "./parts";

export type ClassColors = Record<string, { name: string; color: string }>;
const kGap = 8; // between two pictures
const kScale = 2; // canvas pixels per pixel of a picture

function useImage(jpeg: string): HTMLImageElement | null {
  const [image, setImage] = useState<HTMLImageElement | null>(null);
  useEffect(() => {
    const loading = new Image();
    loading.onload = () => setImage(loading);
    loading.src = `data:image/jpeg;base64,${jpeg}`;
    return () => void (loading.onload = null);
  }, [jpeg]);
  return image;
}

interface PictureProps {
  views: WrittenViews;
  jpegs: string[]; // side by side
  about: string;
  marks: Record<string, number>;
  draw: (context: CanvasRenderingContext2D, left: (place: number) => number) => void;
}
/** Pictures side by side, on a canvas, with something drawn over them. */
function Pictures({ views, jpegs, about, marks, draw }: PictureProps): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const first = useImage(jpegs[0] ?? "");
  const second = useImage(jpegs[1] ?? jpegs[0] ?? "");
  const left = (place: number) => place * (views.width_px + kGap);
  const width = left(jpegs.length - 1) + views.width_px;
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!context || !first || !second) return;
    context.setTransform(kScale, 0, 0, kScale, 0, 0);
    context.clearRect(0, 0, width, views.height_px);
    [first, second].slice(0, jpegs.length).forEach((image, place) => context.drawImage(image, left(place), 0, views.width_px, views.height_px));
    draw(context, left);
  }, [first, second, draw]);
  return <canvas ref={canvas} class="picture" role="img" aria-label={about} data-marks={JSON.stringify(marks)} width={width * kScale} height={views.height_px * kScale} />;
}

function ring(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

function drawKeypoints(context: CanvasRenderingContext2D, keypoints: Keypoint[], classes: ClassColors): void {
  context.lineWidth = 1;
  for (const { x, y, class: id, hasLandmark } of keypoints) {
    ring(context, x, y, 2.2);
    context.strokeStyle = context.fillStyle = classes[id]?.color ?? "#888888";
    if (hasLandmark) context.fill();
    else context.stroke();
  }
}

/** The last keyframe that was made up to a given time, with its keypoints. */
export function LastKeyframe({ views, ms, classes }: { views: WrittenViews; ms: number; classes: ClassColors }): JSX.Element {
  const place = views.keyframes.findLastIndex((keyframe) => keyframe.ms <= ms);
  const keyframe = views.keyframes[Math.max(0, place)];
  const keypoints = useMemo(() => (keyframe ? keypointsOf(keyframe.keypoints) : []), [keyframe]);
  const draw = useMemo(() => (context: CanvasRenderingContext2D) => drawKeypoints(context, keypoints, classes), [keypoints, classes]);
  if (!keyframe) return <Missing>The map has no keyframe.</Missing>;
  const known = keypoints.filter((k) => k.hasLandmark).length;
  return (
    <figure class="views" data-keyframe={Math.max(0, place)}>
      <Pictures views={views} jpegs={[keyframe.jpeg]} about={`Frame ${keyframe.frame} with its keypoints`} marks={{ keypoints: keypoints.length }} draw={draw} />
      <figcaption class="note">
        {place < 0 ? "The first keyframe" : "The last keyframe"}, frame {keyframe.frame}: {keypoints.length} keypoints in the colors of their classes; the {known} filled ones have a landmark in the finished map.
      </figcaption>
    </figure>
  );
}

const kTruths = [
  { truth: "right", title: "correct" },
  { truth: "wrong", title: "wrong" },
  { truth: "unknown", title: "not on a surface" },
] as const;
function colorOfTruth(truth: Pair["truth"]): string {
  return truth === "right" ? colorOf(2) : truth === "wrong" ? colorOf(5) : ink().faint;
}

function drawPairs(context: CanvasRenderingContext2D, pairs: Pair[], left: (place: number) => number): void {
  for (const { from, to, truth, isPenalized } of pairs) {
    context.strokeStyle = context.fillStyle = colorOfTruth(truth);
    context.lineWidth = truth === "wrong" ? 1 : 1.2;
    context.setLineDash(isPenalized ? [3, 3] : []);
    context.beginPath();
    context.moveTo(from[0], from[1]);
    context.lineTo(left(1) + to[0], to[1]);
    context.stroke();
    context.setLineDash([]);
    for (const [x, y] of [from, [left(1) + to[0], to[1]] as const]) {
      ring(context, x, y, 2);
      context.fill();
    }
  }
}

/** A query beside each of its candidates, with the matches by words between them. */
export function QueryViews({ views, set, frame }: { views: WrittenViews; set: string; frame: number }): JSX.Element {
  const theme = useTheme();
  const query = views.queries.find((q) => q.set === set && q.frame === frame);
  const [picked, setPicked] = useState("0");
  const candidate = query?.candidates[Number(picked)] ?? query?.candidates[0];
  const keyframe = candidate && views.keyframes[candidate.keyframe];
  const pairs = useMemo(() => (candidate ? pairsOf(candidate.pairs) : []), [candidate]);
  const keypoints = useMemo(() => (query ? keypointsOf(query.keypoints) : []), [query]);
  const draw = useMemo(
    () => (context: CanvasRenderingContext2D, left: (place: number) => number) => {
      if (keyframe) drawPairs(context, pairs, left);
      else drawKeypoints(context, keypoints, {});
    },
    [pairs, keypoints, keyframe, theme],
  );
  if (!query) return <Missing>The pictures of this query are not in the report: those of the first parameter point alone are.</Missing>;
  const counts = Object.fromEntries(kTruths.map(({ truth }) => [truth, pairs.filter((p) => p.truth === truth).length]));
  const penalized = pairs.filter((p) => p.isPenalized).length;
  return (
    <figure class="views" aria-label="The query beside its candidates">
      {query.candidates.length > 1 && (
        <div class="choices">
          <Choice
            label="Candidate"
            options={query.candidates.map((c, i) => ({ key: String(i), title: `${i + 1} of ${query.candidates.length}: frame ${views.keyframes[c.keyframe]?.frame ?? "?"}` }))}
            value={String(query.candidates.indexOf(candidate!))}
            onPick={setPicked}
          />
        </div>
      )}
      <Pictures
        views={views}
        jpegs={keyframe ? [query.jpeg, keyframe.jpeg] : [query.jpeg]}
        about={keyframe ? `The query, left, and the candidate, right, with ${pairs.length} matches` : "The query with its keypoints"}
        marks={{ pairs: pairs.length, ...counts }}
        draw={draw}
      />
      <figcaption>
        {keyframe ? (
          <>
            <span class="note">
              On the left the query (first attempt, which ended at stage {query.stage.replaceAll("_", " ")}), on the right candidate {query.candidates.indexOf(candidate!) + 1}, frame {keyframe.frame}. Lines are matches by words, correct if both ends show the same surface. Dashed: the {penalized} whose labels differ (equation 2).
            </span>
            <ul class="legend">
              {kTruths.map(({ truth, title }) => (
                <li key={truth}>
                  <svg width="18" height="10" aria-hidden="true"><line x1="0" x2="18" y1="5" y2="5" stroke={colorOfTruth(truth)} stroke-width="2.5" /></svg>
                  {counts[truth]} {title}
                </li>
              ))}
            </ul>
          </>
        ) : (
          <span class="note">Algorithm 1 chose no candidate. The query has {keypoints.length} keypoints.</span>
        )}
      </figcaption>
    </figure>
  );
}
