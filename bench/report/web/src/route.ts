// SPDX-License-Identifier: Apache-2.0
// The reader's place is in the address, after the #, so that every place has a link.
import { useEffect, useState } from "preact/hooks";

export interface Route {
  page: string[];
  at: URLSearchParams;
}

export function currentRoute(): Route {
  const [path = "", query = ""] = location.hash.replace(/^#\/?/, "").split("?");
  const page = path.split("/").filter(Boolean).map(safeDecode);
  return { page: page.length > 0 ? page : ["overview"], at: new URLSearchParams(query) };
}

function safeDecode(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

export function linkTo(page: string[], at: Record<string, string | number> = {}): string {
  const query = new URLSearchParams(
    Object.entries(at).map(([key, value]) => [key, String(value)] as [string, string]),
  ).toString();
  return `#/${page.map(encodeURIComponent).join("/")}${query === "" ? "" : `?${query}`}`;
}

/** Notes something about the place without adding a step to the history; "" removes it. */
export function note(changes: Record<string, string>): void {
  const { page, at } = currentRoute();
  for (const [key, value] of Object.entries(changes))
    if (value === "") at.delete(key);
    else at.set(key, value);
  const query = at.toString();
  const hash = `#/${page.map(encodeURIComponent).join("/")}${query === "" ? "" : `?${query}`}`;
  history.replaceState(null, "", hash);
}

/** A choice that is kept in the address unless it is the first one, so that it has a link and the
 * browser's Back button returns to it. @param key  unique on its page */
export function useNoted(key: string, first: string): [string, (value: string) => void] {
  useRoute(); // drawn again when a link is followed
  const [, redraw] = useState(0);
  const set = (value: string) => {
    note({ [key]: value === first ? "" : value });
    redraw((n) => n + 1);
  };
  return [currentRoute().at.get(key) ?? first, set];
}

export function useRoute(): Route {
  const [route, setRoute] = useState(currentRoute);
  useEffect(() => {
    const follow = () => setRoute(currentRoute());
    addEventListener("hashchange", follow);
    return () => removeEventListener("hashchange", follow);
  }, []);
  return route;
}
