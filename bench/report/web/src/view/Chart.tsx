// SPDX-License-Identifier: Apache-2.0
// A chart with its title, units and source; saved as SVG or PNG.
import * as Plot from "@observablehq/plot";
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { ink, kDashes, useTheme } from "../theme";
import { saveChart } from "./save";

export interface LegendEntry {
  name: string;
  color: string;
  dash?: string;
  mark?: string; // a letter in place of a line
}

interface Props {
  title: string;
  about: string; // units and what it is made of
  legend?: LegendEntry[];
  /** How many elements each kind of mark has: "dot" -> the number of values. Tests count them. */
  marks: Record<string, number>;
  make: (width: number) => Plot.PlotOptions;
  wide?: boolean;
}

/** What all charts share. Plot's style element would be refused by the content-security policy; the
 * rules are in app.css, and saveChart() puts them into the file. */
export function drawn(options: Plot.PlotOptions, width: number): SVGSVGElement {
  const { text } = ink();
  const made = Plot.plot({
    width,
    marginLeft: 58,
    marginBottom: 42,
    ...options,
    style: undefined,
    className: "plot",
    figure: false,
  } as Plot.PlotOptions);
  const svg = (made instanceof SVGSVGElement ? made : made.querySelector("svg")) as SVGSVGElement;
  for (const style of svg.querySelectorAll("style")) style.remove();
  // A screen reader sees the whole as one labeled image, without its parts.
  for (const part of svg.querySelectorAll("[aria-label]")) part.removeAttribute("aria-label");
  svg.setAttribute("color", text);
  svg.setAttribute("fill", "currentColor");
  svg.setAttribute("font-family", "system-ui, sans-serif");
  svg.setAttribute("font-size", "12");
  svg.setAttribute("text-anchor", "middle");
  return svg;
}

export function Chart({ title, about, legend = [], marks, make, wide }: Props): JSX.Element {
  const theme = useTheme();
  const place = useRef<HTMLDivElement>(null);
  const [width, setWidth] = useState(0);
  useEffect(() => {
    const box = place.current;
    if (!box) return undefined;
    const watch = new ResizeObserver(([entry]) => {
      if (entry) setWidth(Math.floor(entry.contentRect.width));
    });
    watch.observe(box);
    return () => watch.disconnect();
  }, []);
  useEffect(() => {
    if (!place.current || width < 40) return;
    const svg = drawn(make(width), width);
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", `${title}. ${about}`);
    place.current.replaceChildren(svg);
  }, [width, theme, make]);

  const save = (kind: "svg" | "png") => {
    const svg = place.current?.querySelector("svg");
    if (svg) void saveChart(svg, { title, about, legend }, kind);
  };
  return (
    <figure class={wide ? "chart wide" : "chart"} data-marks={JSON.stringify(marks)}>
      <figcaption>
        <strong>{title}</strong>
        <span class="note">{about}</span>
      </figcaption>
      {legend.length > 0 && (
        <ul class="legend">
          {legend.map((entry) => (
            <li key={entry.name}>
              {entry.mark ? (
                <svg width="14" height="14" aria-hidden="true">
                  <text x="7" y="12" text-anchor="middle" font-size="15" font-weight="bold" fill={entry.color}>
                    {entry.mark}
                  </text>
                </svg>
              ) : (
                <svg width="26" height="12" aria-hidden="true">
                  <line
                    x1="1"
                    x2="25"
                    y1="6"
                    y2="6"
                    stroke={entry.color}
                    stroke-width="3"
                    stroke-dasharray={entry.dash ?? kDashes[0]}
                  />
                </svg>
              )}
              {entry.name}
            </li>
          ))}
        </ul>
      )}
      <div class="plot-place" ref={place} />
      <p class="saves">
        <button type="button" onClick={() => save("svg")} aria-label={`Save ${title} as SVG`}>
          SVG
        </button>
        <button type="button" onClick={() => save("png")} aria-label={`Save ${title} as PNG`}>
          PNG
        </button>
      </p>
    </figure>
  );
}
