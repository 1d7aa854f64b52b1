// SPDX-License-Identifier: Apache-2.0
// What pages share: loading pieces of data, notes on what is missing, folders side by side.
import { Component, type ComponentChildren, type JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { type Folder, folders, load } from "../data";

/** A piece of data: undefined while it loads, an Error if it is missing. */
export function usePiece<T>(piece: string): T | Error | undefined {
  const [found, setFound] = useState<T | Error | undefined>(undefined);
  useEffect(() => {
    let live = true;
    setFound(undefined);
    load<T>(piece).then(
      (value) => live && setFound(value),
      (error: Error) => live && setFound(error),
    );
    return () => {
      live = false;
    };
  }, [piece]);
  return found;
}

interface PieceProps<T> {
  piece: string;
  children: (value: T) => ComponentChildren;
}
export function Piece<T>({ piece, children }: PieceProps<T>): JSX.Element {
  const found = usePiece<T>(piece);
  if (found === undefined) return <p class="loading">Loading …</p>;
  if (found instanceof Error) return <Missing>{found.message}.</Missing>;
  return <Guarded><Drawn of={() => children(found)} /></Guarded>;
}

/** Draws inside Guarded, which catches what fails. */
function Drawn({ of }: { of: () => ComponentChildren }): JSX.Element {
  return <>{of()}</>;
}

/** If a part of a page cannot be drawn, shows an error there instead of losing the whole page. */
class Guarded extends Component<{ children: ComponentChildren }, { error: string | null }> {
  override state = { error: null as string | null };
  override componentDidCatch(error: Error): void {
    this.setState({ error: error.message });
  }
  override render(): JSX.Element {
    return this.state.error === null ? <>{this.props.children}</> : <Missing>This cannot be shown, its data are damaged: {this.state.error}.</Missing>;
  }
}

/** States what is missing, in place of an empty chart. */
export function Missing({ children }: { children: ComponentChildren }): JSX.Element {
  return <p class="missing">{children}</p>;
}

/** The same for each results folder, side by side where there is room. */
export function PerFolder({
  children,
  points = "runs",
}: {
  children: (folder: Folder, place: number) => ComponentChildren;
  points?: "first" | "runs" | "all"; // which points of a sweep the page shows
}): JSX.Element {
  return (
    <>
    {folders.length > 1 && <p class="note">Each folder's charts have axes of their own: compare numbers, not lengths.</p>}
    <div class={folders.length > 1 ? "folders several" : "folders"}>
      {folders.map((folder, place) => (
        <section key={place} class="folder" aria-label={folder.name}>
          {folders.length > 1 && <h2 class="folder-name">{folder.name}</h2>}
          {folder.problem !== null && <Missing>{folder.problem}</Missing>}
          {folder.first_point !== null && points === "first" && <p class="remarks">This suite sweeps settings. What stands here is at its first point, {folder.first_point}; the page Sweeps shows all.</p>}
          {folder.first_point !== null && points === "runs" && <p class="remarks">This suite sweeps settings. Each run stands here at the first point that it maps for; the page Sweeps shows all.</p>}
          <Guarded><Drawn of={() => children(folder, place)} /></Guarded>
        </section>
      ))}
    </div>
    </>
  );
}

interface ChoiceProps {
  label: string;
  options: { key: string; title: string }[];
  value: string;
  onPick: (key: string) => void;
}
export function Choice({ label, options, value, onPick }: ChoiceProps): JSX.Element {
  return (
    <label class="choice">
      {label}{" "}
      <select value={value} onChange={(event) => onPick(event.currentTarget.value)}>
        {options.map((option) => (
          <option key={option.key} value={option.key}>
            {option.title}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Facts as a list of terms and values. */
export function Facts({ facts }: { facts: [string, ComponentChildren][] }): JSX.Element {
  return (
    <dl class="facts">
      {facts.map(([term, value]) => (
        <div key={term}>
          <dt>{term}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
