// SPDX-License-Identifier: Apache-2.0
// Charts as files: with title, legend, units and source, which are next to them on the page.
import { ink } from "../theme";
import type { LegendEntry } from "./Chart";

interface About {
  title: string;
  about: string;
  legend: LegendEntry[];
}
const kNames = "http://www.w3.org/2000/svg";

function element(name: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const made = document.createElementNS(kNames, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.textContent = text;
  return made;
}

/** Lines of at most `most` characters, broken between words. */
function lines(text: string, most: number): string[] {
  const made: string[] = [""];
  for (const word of text.split(" ")) {
    const last = made[made.length - 1] ?? "";
    if (last !== "" && last.length + word.length + 1 > most) made.push(word);
    else made[made.length - 1] = last === "" ? word : `${last} ${word}`;
  }
  return made;
}

export function standalone(chart: SVGSVGElement, { title, about, legend }: About): SVGSVGElement {
  const width = Number(chart.getAttribute("width"));
  const height = Number(chart.getAttribute("height"));
  const { text, faint, paper } = ink();
  const notes = lines(about, Math.max(30, Math.floor(width / 6)));
  const top = 26 + (legend.length > 0 ? 20 : 0);
  const whole = top + height + 14 * notes.length + 8;
  const svg = element("svg", {
    width,
    height: whole,
    viewBox: `0 0 ${width} ${whole}`,
    "font-family": "system-ui, sans-serif",
    fill: text,
  }) as SVGSVGElement;
  svg.append(element("rect", { width, height: whole, fill: paper }));
  svg.append(element("text", { x: 8, y: 18, "font-size": 14, "font-weight": "bold" }, title));
  let x = 8;
  for (const entry of legend) {
    svg.append(
      element("line", {
        x1: x,
        x2: x + 24,
        y1: 36,
        y2: 36,
        stroke: entry.color,
        "stroke-width": 3,
        "stroke-dasharray": entry.dash ?? "0",
      }),
    );
    svg.append(element("text", { x: x + 29, y: 40, "font-size": 12 }, entry.name));
    x += 45 + 7 * entry.name.length;
  }
  const copy = chart.cloneNode(true) as SVGSVGElement;
  copy.setAttribute("x", "0");
  copy.setAttribute("y", String(top));
  copy.setAttribute("overflow", "visible");
  svg.append(copy);
  notes.forEach((line, i) => {
    svg.append(element("text", { x: 8, y: top + height + 14 * (i + 1), "font-size": 11, fill: faint }, line));
  });
  return svg;
}

function download(name: string, address: string): void {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}

export async function saveChart(chart: SVGSVGElement, about: About, kind: "svg" | "png"): Promise<void> {
  const svg = standalone(chart, about);
  const name = `${about.title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "")}.${kind}`;
  const text = new XMLSerializer().serializeToString(svg);
  const address = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
  if (kind === "svg") {
    download(name, address);
    return;
  }
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = 2 * Number(svg.getAttribute("width"));
  canvas.height = 2 * Number(svg.getAttribute("height"));
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  download(name, canvas.toDataURL("image/png"));
}
