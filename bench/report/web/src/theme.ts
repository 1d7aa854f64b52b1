// SPDX-License-Identifier: Apache-2.0
import { useEffect, useState } from "preact/hooks";

export type Theme = "light" | "dark";
const kKey = "modelhouse-theme";

function remembered(): Theme | null {
  try {
    const word = localStorage.getItem(kKey);
    return word === "light" || word === "dark" ? word : null;
  } catch {
    return null; // a browser may deny storage to files
  }
}

const ofSystem = matchMedia("(prefers-color-scheme: dark)");
let chosen: Theme | null = remembered();
const followers = new Set<() => void>();

export function theme(): Theme {
  return chosen ?? (ofSystem.matches ? "dark" : "light");
}

function apply(): void {
  document.documentElement.dataset.theme = theme();
  for (const follow of followers) follow();
}
ofSystem.addEventListener("change", apply);
apply();

export function toggleTheme(): void {
  chosen = theme() === "dark" ? "light" : "dark";
  try {
    localStorage.setItem(kKey, chosen);
  } catch {
    // then it applies only to this page
  }
  apply();
}

export function useTheme(): Theme {
  const [now, setNow] = useState(theme);
  useEffect(() => {
    const follow = () => setNow(theme());
    followers.add(follow);
    return () => void followers.delete(follow);
  }, []);
  return now;
}

// After Okabe and Ito, "Color Universal Design", in an order whose grays differ in print.
const kColors: Record<Theme, string[]> = {
  light: ["#0065a3", "#d98a00", "#00805d", "#b4568c", "#3a9bd9", "#a33f00", "#5c5c5c"],
  dark: ["#5db3f0", "#f2b134", "#3ac99a", "#e79ac6", "#a8d4f5", "#ff8a4c", "#b5b5b5"],
};
export const kDashes = ["0", "6 3", "2 3", "8 3 2 3", "1 3", "10 4"];
export const kSymbols = ["circle", "square", "triangle", "diamond", "star", "cross", "wye"] as const;

/** The color halfway between two colors of the form #rrggbb. */
function halfWay(a: string, b: string): string {
  const part = (at: number) => Math.round((parseInt(a.slice(at, at + 2), 16) + parseInt(b.slice(at, at + 2), 16)) / 2);
  return `#${[1, 3, 5].map((at) => part(at).toString(16).padStart(2, "0")).join("")}`;
}

/** Colors that can be told apart; those beyond the seventh are paler. */
export function colorOf(index: number): string {
  const colors = kColors[theme()];
  const color = colors[index % colors.length] ?? "#888888";
  return index < colors.length ? color : halfWay(color, ink().paper);
}

/** Colors of text and background as in app.css, for charts that are saved as files. */
export function ink(): { text: string; faint: string; paper: string; grid: string } {
  return theme() === "dark"
    ? { text: "#e8e6e1", faint: "#a9a69f", paper: "#1b1d20", grid: "#3a3d42" }
    : { text: "#1c1d1f", faint: "#5b5d61", paper: "#ffffff", grid: "#dddbd6" };
}
